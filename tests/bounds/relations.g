# Constants that follow from others, and those that only need room.
# tight: QN_SHADOW 0.999999
# tight: QN_SUPER_FRAME 0.67
# tight: QN_SUPER_LOW 0.74
# tight: QN_PRINT_GROW 0.85
# tight: QN_WIDE_SPOT 0.0001
# tight: QN_POINT_BOX_SLACK 0.999
u = 0x1p-53;
zero = 0;
{ zero in [0, 0] ->
     @QN_SHADOW@ - u * (1 + 0x1p-49) >= 0                                          # a ball's centre rounded to nearest
  /\ @QN_FLUSH_WEIGHT@ * u - @QN_FLUSH@ in [0, 0]                                  # a weight whose u-th part is what flushing loses
  /\ @QN_WIDE_SHY_ROOT@ * @QN_WIDE_SHY_ROOT@ * @QN_WIDE_SHY@ - 1 in [0, 0]
  /\ @QN_WIDE_SPOT@ - 4 * u >= 0
  /\ @QN_POINT_BOX_SLACK@ - (1 + 2 * u) / (1 - u) * (1 + u) * (1 + u) >= 0
  /\ @QN_SUPER_NORM(1,1)@ - 14 * u >= 0                                            # (2 + 4 + 2e + 4 + 2n) u
  /\ @QN_ROUND_EVAL@ - 171 * u * u >= 0 /\ @QN_ROUND_PAIR_EVAL@ - 246 * u * u >= 0 # the counts of the section
  /\ @QN_ROUND_SLOPE@ - 21 * u >= 0
  /\ @QN_SUPER_FRAME@ - (84 + 3) * u * u >= 0 /\ @QN_SUPER_LOW@ - 3 * u * u * (1 + 0x1p-40) >= 0   # the counts of the section
  /\ @QN_PRINT_GROW@ - (3.5 + 2 * sqrt(14) * (1 + sqrt(14)) * (37 / 12) + 14.7 * 14.7 * @QN_PRINT_ERROR@) >= 0
  /\ @QN_PRINT_CELL@ - 8 * @QN_PRINT_ERROR@ in [0, 0] }
