# QN_WIDE_ROUND: formulas of wide code, shares of their terms in u, c = QN_WIDE_ROUND u. A fused operation counts as two roundings (the baseline). Rows: 6.1 u and 4.1 u;
# of decimals (a coordinate within u more): 7.1 u and 5.1 u. h: rows, entry, products and sums, and the plane's place (2u); of decimals.
# QN_WIDE_MOVE: 6.1 + 5.2 / sqrt(QN_WIDE_SLOW), of decimals 7.1 + 6.2 / sqrt(QN_WIDE_SLOW), of QN_WIDE_MOVE QN_WIDE_ROUND.
# tight: QN_WIDE_ROUND 0.5
# tight: QN_WIDE_MOVE 0.75
row = v * ((1 + m) * (1 + s1) * (1 + s2) * (1 + s3) - (1 + r)) - (1 + r) * t;
slope = v * ((1 + m) * (1 + s1) * (1 + s2) - (1 + r));
h = y * ((1 + m) * (1 + p) * (1 + s1) * (1 + s2) * (1 + s3) * (1 + s4) - (1 + r)) - (1 + r) * (x + d + x * d);
c = @QN_WIDE_ROUND@ * 0x1p-53;
inverse = 1 / sqrt(@QN_WIDE_SLOW@);
{ |m| <= 0x1p-53 /\ |p| <= 0x1p-53 /\ |s1| <= 0x1p-53 /\ |s2| <= 0x1p-53 /\ |s3| <= 0x1p-53 /\ |s4| <= 0x1p-53 /\ |r| <= @QN_SHADOW@ /\ |v| <= 1 /\ |t| <= 0x1.0000000000004p-53
  /\ |y| <= 0x1.00000000001p0 /\ |x| <= 0x1.c666666666666p-51 /\ |d| <= 0x1.4666666666666p-51
  -> |row| <= 0x1.8666666666666p-51 /\ |slope| <= 0x1.0666666666666p-51 /\ |h| / c <= 1
     /\ (7.1 + 6.2 * inverse) / (@QN_WIDE_MOVE@ * @QN_WIDE_ROUND@) <= 1 }
