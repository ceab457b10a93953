# QN_DD_EVAL: a term K x y in double-doubles, an operation within 2^-102; K, two coordinates, two products, six sums. QN_SLOPE_E: in doubles, the gradient
# times d: K, x (2u), product, three sums, d_j, two sums.
# tight: QN_DD_EVAL 0.6
# tight: QN_SLOPE_E 0.8
{ |k| <= 0x1p-105 /\ |a| <= 0x1p-102 /\ |b| <= 0x1p-102 /\ |p| <= 0x1p-102 /\ |q| <= 0x1p-102
  /\ |s1| <= 0x1p-102 /\ |s2| <= 0x1p-102 /\ |s3| <= 0x1p-102 /\ |s4| <= 0x1p-102 /\ |s5| <= 0x1p-102 /\ |s6| <= 0x1p-102
  /\ |e1| <= 0x1p-53 /\ |e2| <= 0x1p-53 /\ |e3| <= 0x1p-53 /\ |e4| <= 0x1p-53 /\ |e5| <= 0x1p-53 /\ |e6| <= 0x1p-53 /\ |e7| <= 0x1p-53 /\ |e8| <= 0x1p-53 /\ |x| <= 0x1p-52
  -> |(1 + k) * (1 + a) * (1 + b) * (1 + p) * (1 + q) * (1 + s1) * (1 + s2) * (1 + s3) * (1 + s4) * (1 + s5) * (1 + s6) - 1| <= @QN_DD_EVAL@
     /\ |(1 + e1) * (1 + x) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8) - 1| <= @QN_SLOPE_E@ }
