# QN_DISC_E: fl(fl(h h) - fl(a c)), each rounding relative to the number as computed. QN_ROOT_E: ((a s + 2h) s) + c, its terms' shares.
# tight: QN_DISC_E 0.8
# tight: QN_ROOT_E 0.94
{ |e| <= 0x1p-53 /\ |e1| <= 0x1p-53 /\ |e2| <= 0x1p-53 /\ |e3| <= 0x1p-53
  -> |e / (1 + e)| <= @QN_DISC_E@ /\ |(1 + e) * (1 + e1) * (1 + e2) * (1 + e3) - 1| <= @QN_ROOT_E@ /\ |(1 + e) * (1 + e1) * (1 + e2) - 1| <= @QN_ROOT_E@ }
