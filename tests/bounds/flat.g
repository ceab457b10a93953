# QN_ROUND_FLAT, B = |h| + |o| = 1 and all times d. h - o = W, w = W (1 + e1), w' = -W e1; i = (1 + e2) / d; q d = w (1 + e2) (1 + e3); p, p' and w - p are exact. Roundings: of the
# residue (e5), of w' + l (e6), of their sum (e7), times i (e8). Granted: QN_ROUND_FLAT |h| + |o| |i| as computed (f1, e2, f2, f3).
# tight: QN_ROUND_FLAT 0.14
w = W * (1 + e1);
residue = w * (1 - (1 + e2) * (1 + e3));
far = l - W * e1;
after = (1 + e7) * (1 + e2) * (1 + e8);
error = residue * ((1 + e5) * after - 1) + far * ((1 + e6) * after - 1) - e;
granted = @QN_ROUND_FLAT@ * ((1 + f1) * (1 + e2) * (1 + f2) * (1 + f3));
{ |W| <= 1 /\ |l| <= 0x1p-53 /\ |e| <= 0x1.0001p-105 /\ |e1| <= 0x1p-53 /\ |e2| <= 0x1p-53 /\ |e3| <= 0x1p-53 /\ |e5| <= 0x1p-53 /\ |e6| <= 0x1p-53 /\ |e7| <= 0x1p-53
  /\ |e8| <= 0x1p-53 /\ |f1| <= 0x1p-53 /\ |f2| <= 0x1p-53 /\ |f3| <= 0x1p-53 -> error - granted <= 0 /\ error + granted >= 0 }
