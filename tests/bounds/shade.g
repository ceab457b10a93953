# QN_SHADE_POINT: t the double nearest to T, m = fl(t d), p = fl(o + m): the product within 2u of T d, relatively, and the sum within u of itself; the constant grants
# twice as much.
# tight: QN_SHADE_POINT 0.49
@rnd = float<ieee_64, ne>;
t = rnd(T); d = rnd(d_); o = rnd(o_);
m = rnd(t * d);
{ |T| in [0x1p-400, 0x1p400] /\ |d| in [0x1p-400, 0x1p400] -> |m -/ (T * d)| <= @QN_SHADE_POINT@ }
# ----
@rnd = float<ieee_64, ne>;
m = rnd(m_); o = rnd(o_); p = rnd(o + m);
{ |o + m| in [0x1p-1000, 0x1p1000] -> |p -/ (o + m)| <= 0x1p-53 }
