# Places on a ball, rho = 1, G = 2^-24: a coordinate with the rounding operators. What is said to be on the grid is exact, |Z| <= 1.7 G, and Y + Z is within 4u G of
# (o - c) - c' + t d, c' (x) as stored, m = t d exactly. Fused operations first, then m in two parts.
# tight: QN_BALL_GRID 4
# tight: QN_BALL_EVAL 0.8
# tight: QN_BALL_OFF 0.9
# tight: QN_BALL_SLOPE 0.3
@rnd = float<ieee_64, ne>;
c = rnd(c_); o = rnd(o_); x = rnd(x_); g = @QN_BALL_GRID@;
cg = rnd(c + g); on = rnd(cg - g); shift = rnd(g - on);
cc = rnd(c - on); rest = rnd(cc + x);
a = rnd(o + shift);
back = rnd(a - shift); oo = rnd(o - back); orest = rnd(oo - rest);
at = rnd(m + a);
move = rnd(at - a); mrest = rnd(m - move);
Y = rnd(at - g); Z = rnd(mrest + orest);
off = (Y + Z) - (((o - c) - x) + m);
{ |c| <= 0x1.0001p25 /\ |o - c| <= 0x1.0001p24 /\ |x| <= 0x1.001p-28 /\ |m| <= 0x1p24 ->
  on - (cg - g) in [0,0] /\ shift - (g - on) in [0,0] /\ back - (a - shift) in [0,0] /\ move - (at - a) in [0,0] /\ Y - (at - g) in [0,0]
  /\ |Z| <= 0x1.b333p-24 /\ |off| <= 0x1p-75 }
on - c -> (on - (cg - g)) + (cg - (c + g));
c - on -> 0 - ((on - (cg - g)) + (cg - (c + g)));
o + shift -> (o - c) + (shift - (g - on)) + g + (c - on);
o - back -> 0 - ((back - (a - shift)) + (a - (o + shift)));
m - move -> 0 - ((move - (at - a)) + (at - (m + a)));
off -> (Y - (at - g)) + (Z - (mrest + orest)) + (mrest - (m - move)) - (move - (at - a)) + (orest - (oo - rest)) + (oo - (o - back)) - (back - (a - shift)) - (rest - (cc + x)) - (cc - (c - on)) + (shift - (g - on));
# ----
@rnd = float<ieee_64, ne>;
c = rnd(c_); o = rnd(o_); x = rnd(x_); g = @QN_BALL_GRID@;
cg = rnd(c + g); on = rnd(cg - g); shift = rnd(g - on);
cc = rnd(c - on); rest = rnd(cc + x);
a = rnd(o + shift);
back = rnd(a - shift); oo = rnd(o - back); orest = rnd(oo - rest);
h = rnd(m); low = m - h;
at = rnd(h + a);
move = rnd(at - a); mm = rnd(h - move); mrest = rnd(mm + low);
Y = rnd(at - g); Z = rnd(mrest + orest);
off = (Y + Z) - (((o - c) - x) + m);
{ |c| <= 0x1.0001p25 /\ |o - c| <= 0x1.0001p24 /\ |x| <= 0x1.001p-28 /\ |m| <= 0x1p24 ->
  on - (cg - g) in [0,0] /\ shift - (g - on) in [0,0] /\ back - (a - shift) in [0,0] /\ move - (at - a) in [0,0] /\ Y - (at - g) in [0,0]
  /\ |Z| <= 0x1.b333p-24 /\ |off| <= 0x1p-75 }
on - c -> (on - (cg - g)) + (cg - (c + g));
c - on -> 0 - ((on - (cg - g)) + (cg - (c + g)));
o + shift -> (o - c) + (shift - (g - on)) + g + (c - on);
o - back -> 0 - ((back - (a - shift)) + (a - (o + shift)));
h - move -> 0 - ((move - (at - a)) + (at - (h + a)));
off -> (Y - (at - g)) + (Z - (mrest + orest)) + (mrest - (mm + low)) + (mm - (h - move)) - (move - (at - a)) + (orest - (oo - rest)) + (oo - (o - back)) - (back - (a - shift)) - (rest - (cc + x)) - (cc - (c - on)) + (shift - (g - on));
# ----
# p, beside its exact part: small = -r2' + sum Z (y + Y), y = fl(Y + Z), not fused: a term is rounded four times at most (k, f1 to f4: product and three sums), 13.4 G in all;
# y + Y is off by u |y| and, rounded, u |y + Y|, of 1.7 G 3.92 (y, v); r2 - R (half a unit of the grid of squares, G^2) and r2' as a float (of u 4.1, within 2^-23 of itself)
# are rounded in their sum and three more; Y + Z is off by 4u G, which 2 sum |y| + 12u G takes.
G = 0x1p-24;
u = 0x1p-53;
terms = 13.4 * G * ((1 + f1) * (1 + f2) * (1 + f3) * (1 + f4) - 1);
sums = 1.7 * G * 3.92 * (y + v * (2 + y)) * ((1 + f1) * (1 + f2) * (1 + f3) * (1 + f4));
rest = 0.51 * G * G * ((1 + k) * (1 + f2) * (1 + f3) * (1 + f4) - 1) + 4.1 * u * (1 + x) * ((1 + k) * (1 + f2) * (1 + f3) * (1 + f4)) - 4.1 * u;
places = (7.84 + 12 * u * G) * 4 * u * G;
{ |f1| <= 0x1p-53 /\ |f2| <= 0x1p-53 /\ |f3| <= 0x1p-53 /\ |f4| <= 0x1p-53 /\ |k| <= 0x1p-53 /\ |y| <= 0x1p-53 /\ |v| <= 0x1p-53 /\ |x| <= 0x1p-23
  -> (|terms| + |sums| + |rest| + |places|) / @QN_BALL_EVAL@ <= 1 }
# ----
# c', known to 2^-23 off; and S = y . d over rho |d|: y rounded and off by 4u G, the product and three sums, of sum |y d| <= 2.26.
zero = 0;
share = 2.26 * ((1 + e) * (1 + p) * (1 + s1) * (1 + s2) * (1 + s3) - 1);
{ zero in [0, 0] /\ |e| <= 0x1p-53 /\ |p| <= 0x1p-53 /\ |s1| <= 0x1p-53 /\ |s2| <= 0x1p-53 /\ |s3| <= 0x1p-53
  -> 7.84 * 0x1p-23 / @QN_BALL_OFF@ <= 1 /\ (|share| + 1.74 * 0x1p-75 + 1.74 * 0x1p-76) / @QN_BALL_SLOPE@ <= 1 }
