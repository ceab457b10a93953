# QN_SUPPORT_SLACK(n), n u: shares of the terms of support functions with the sum's roundings (docs/bounds.md, the table). norm3: quotient, square, two sums, root and product,
# at most 4.6 u; and the last product and sum, u of the result (1/2 granted by the term's own sum).
# tight: QN_SUPPORT_SLACK(8) 0.7
# tight: QN_SUPPORT_SLACK(12) 0.8
under = (1 + q) * (1 + q) * (1 + m) * (1 + s1) * (1 + s2);
norm = sqrt(under) * (1 + e1) * (1 + e2) * (1 + g);
box = (1 + a) * (1 + m) * (1 + s1) * (1 + s2) * (1 + e1) - 1;
sphere = (1 + a) * (1 + e3) * norm * (1 + b1) * (1 + b2) * (1 + b3) * (1 + b4) - 1;
{ |a| <= 0x1p-53 /\ |q| <= 0x1p-53 /\ |m| <= 0x1p-53 /\ |s1| <= 0x1p-53 /\ |s2| <= 0x1p-53 /\ |e1| <= 0x1p-53 /\ |e2| <= 0x1p-53 /\ |e3| <= 0x1p-53 /\ |g| <= 0x1p-60
  /\ |b1| <= 0x1p-53 /\ |b2| <= 0x1p-53 /\ |b3| <= 0x1p-53 /\ |b4| <= 0x1p-53
  -> |norm - 1| <= 0x1.266666666666ap-51 /\ |box| + 0x1p-53 <= @QN_SUPPORT_SLACK(8)@ /\ |sphere| <= @QN_SUPPORT_SLACK(12)@ }
