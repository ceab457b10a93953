# Balls seen along a direction. What is not a float's: |P t d| takes sqrt 2 QN_OUTLINE_SKEW of |c* - o| + r*, |c* - o| <= |y| + 2 O (+ 2 off); places as computed take 16u O and 16u |y|.
# Shares of |y|, O and the radius r; QN_OUTLINE_SQUARE has room for 2^-41 r, twice in a square.
# tight: QN_OUTLINE_PLACE 0.17
# tight: QN_OUTLINE_SKEW 3
u = 0x1p-53;
skew = sqrt(2) * @QN_OUTLINE_SKEW@ * (1 + 0x1p-40);
zero = 0;
{ zero in [0, 0] -> skew + 16 * u - @QN_OUTLINE_PLACE@ * (1 - 0x1p-40) <= 0 /\ 2 * skew + 16 * u - @QN_OUTLINE_PLACE@ * (1 - 0x1p-40) <= 0 /\ skew + 0x1p-42 - 0x1p-41 <= 0 }
# ----
# Floats, in W = 1: the centre's place, W + D, and the middle, W, each rounded, along two axes: what W takes.
# tight: QN_OUTLINE_FLOAT 0.3
{ |a| <= 0x1p-24 /\ |m| <= 0x1p-24 -> sqrt(2) * |a - m| / @QN_OUTLINE_FLOAT@ <= 1 }
# ----
# The same relatively to D (along two axes, 2 x 2^-24 at most), the difference, squares and sums (not fused: product and sum), the radius' 2^-41, the reach's square in doubles and the limit.
# tight: QN_OUTLINE_SQUARE 0.9999984
seen = (1 + a) * (1 + a) * (1 + s) * (1 + s) * (1 + p) * (1 + q);
limit = @QN_OUTLINE_SQUARE@ * ((1 + g) * (1 + h) * (1 + l));
need = (1 + r) * (1 + r);
{ |a| <= 0x1p-23 /\ |s| <= 0x1p-24 /\ |p| <= 0x1p-24 /\ |q| <= 0x1p-24 /\ |l| <= 0x1p-24 /\ |g| <= 0x1p-53 /\ |h| <= 0x1p-53 /\ |r| <= 0x1p-41 -> seen * need - limit <= 0 }
