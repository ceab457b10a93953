# QN_PRINT_TERM: a fingerprint's term s beta beta': beta's share (entry, difference, product, three subtractions), twice; s, two products, four sums; over the sum of
# magnitudes as computed (two units at least).
# tight: QN_PRINT_TERM 0.78
beta = (1 + r) * (1 + d) * (1 + m) * (1 + b1) * (1 + b2) * (1 + b3);
term = (1 + r) * beta * beta * (1 + p) * (1 + q) * (1 + s1) * (1 + s2) * (1 + s3) * (1 + s4) - 1;
{ |r| <= 0x1.02p-53 /\ |d| <= 0x1p-53 /\ |m| <= 0x1p-53 /\ |b1| <= 0x1p-53 /\ |b2| <= 0x1p-53 /\ |b3| <= 0x1p-53 /\ |p| <= 0x1p-53 /\ |q| <= 0x1p-53
  /\ |s1| <= 0x1p-53 /\ |s2| <= 0x1p-53 /\ |s3| <= 0x1p-53 /\ |s4| <= 0x1p-53 /\ |w| <= 0x1p-49
  -> term / (1 + w) in [-@QN_PRINT_TERM@, @QN_PRINT_TERM@] }
