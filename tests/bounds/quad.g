# QN_QUAD_*_E: the coefficients along a line, from rows within 6.01 u Omega and 5.01 u Delta (map.g). Shares, divided by |s| Omega' Omega and alike.
# z = X^2 / (Omega' Omega) <= 1 + 6u; x = X / Omega'; t = the row's error / Omega, tt the same / Omega'. s: the entry; q, p, a..: square, product and sums.
# tight: QN_QUAD_A_E 0.85
# tight: QN_QUAD_H_E 0.95
# tight: QN_QUAD_C_E 0.98
# tight: QN_QUAD_K_E 0.85
A = z * ((1 + q) * (1 + p) * (1 + a1) * (1 + a2) - (1 + s)) - (1 + s) * d * (2 * x + dd);
C = z * ((1 + q) * (1 + p) * (1 + a1) * (1 + a2) * (1 + a3) * (1 + a4) - (1 + s)) - (1 + s) * t * (2 * x + tt);
L = 2 * (y * ((1 + p) * (1 + a1) * (1 + a2) - (1 + s)) - (1 + s) * t);
K = (1 + a1) - (1 + s);
# h: half = O D / (Omega Delta' + Omega' Delta), about 1/2 at most; both = the rows' errors in it, 6.01 u at most
H = half * ((1 + q) * (1 + p) * (1 + a1) * (1 + a2) * (1 + a3) - (1 + s)) + (1 + s) * both;
M = y * ((1 + p) * (1 + a1) - (1 + s)) - (1 + s) * d;
{ |q| <= 0x1p-53 /\ |p| <= 0x1p-53 /\ |a1| <= 0x1p-53 /\ |a2| <= 0x1p-53 /\ |a3| <= 0x1p-53 /\ |a4| <= 0x1p-53 /\ |s| <= @QN_SHADOW@
  /\ z in [0, 0x1.00000000001p0] /\ |x| <= 1 /\ |y| <= 0x1.00000000001p0 /\ |half| <= 0x1.00000000001p-1
  /\ |t| <= 0x1.80a3d70a3d70ap-51 /\ |tt| <= 0x1.80a3d70a3d70ap-51 /\ |both| <= 0x1.80a3d70a3d70ap-51 /\ |d| <= 0x1.80a3d70a3d70ap-51 /\ |dd| <= 0x1.80a3d70a3d70ap-51
  -> |A| <= @QN_QUAD_A_E@ /\ |C| <= @QN_QUAD_C_E@ /\ |L| <= @QN_QUAD_C_E@ /\ |K| <= @QN_QUAD_K_E@ /\ |H| <= @QN_QUAD_H_E@ /\ |M| <= @QN_QUAD_H_E@ }
