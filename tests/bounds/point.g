# QN_POINT_MAP_E: as map.g, divided by the weight as computed (five roundings). QN_POINT_FORM_E: as quad.g's c with that bound for a row; over
# the bound's own ten roundings. QN_POINT_BALL_E: y = fl(x - c) squared and summed against r2 (8u), without what is due to e, over ten roundings.
# tight: QN_POINT_MAP_E 0.85
# tight: QN_POINT_FORM_E 0.9
# tight: QN_POINT_BALL_E 0.85
row = v * ((1 + m) * (1 + s1) * (1 + s2) * (1 + s3) - (1 + r)) - (1 + r) * t;
C = z * ((1 + q) * (1 + p) * (1 + s1) * (1 + s2) * (1 + s3) * (1 + s4) * (1 + s5) - (1 + r)) - (1 + r) * f * (2 * x + ff);
L = 2 * (x * ((1 + p) * (1 + s1) * (1 + s2) - (1 + r)) - (1 + r) * f);
B = (1 + q) * (1 + s1) * (1 + s2) * (1 + s3) - (1 + m) * (1 + m);
R = (1 + s1) - (1 + r2);
{ |m| <= 0x1p-53 /\ |q| <= 0x1p-53 /\ |p| <= 0x1p-53 /\ |s1| <= 0x1p-53 /\ |s2| <= 0x1p-53 /\ |s3| <= 0x1p-53 /\ |s4| <= 0x1p-53 /\ |s5| <= 0x1p-53 /\ |r| <= @QN_SHADOW@
  /\ |v| <= 1 /\ |t| <= 0x1.0000000000004p-53 /\ |w| <= 0x1.4p-51 /\ |o| <= 0x1.4p-50 /\ z in [0, 0x1.00000000001p0] /\ |x| <= 1 /\ |f| <= @QN_POINT_MAP_E@ /\ |ff| <= @QN_POINT_MAP_E@
  /\ |r2| <= 0x1p-50
  -> row / (1 + w) in [-@QN_POINT_MAP_E@, @QN_POINT_MAP_E@] /\ C / (1 + o) in [-@QN_POINT_FORM_E@, @QN_POINT_FORM_E@] /\ L / (1 + o) in [-@QN_POINT_FORM_E@, @QN_POINT_FORM_E@]
     /\ B / (1 + o) in [-@QN_POINT_BALL_E@, @QN_POINT_BALL_E@] /\ R / (1 + o) in [-@QN_POINT_BALL_E@, @QN_POINT_BALL_E@] }
