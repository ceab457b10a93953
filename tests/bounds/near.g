# QN_NEAR_NORMAL, and planes' QN_NEAR_PLACE: entries are within 1.01u (s, t), a square, two sums and a root in the length, then the division. The offset's terms: entry,
# difference, product, three sums, division; over the computed sum of sizes (as many roundings). Components are within 5.6u of themselves.
# tight: QN_NEAR_NORMAL 0.042
length = sqrt((1 + t) * (1 + t) * (1 + m) * (1 + a) * (1 + b)) * (1 + r);
component = (1 + s) * (1 + q) / length - 1;
place = (1 + s) * (1 + f) * (1 + p) * (1 + d1) * (1 + d2) * (1 + d3) * (1 + q) / length - 1;
{ |s| <= 0x1.02p-53 /\ |t| <= 0x1.02p-53 /\ |m| <= 0x1p-53 /\ |a| <= 0x1p-53 /\ |b| <= 0x1p-53 /\ |r| <= 0x1p-53 /\ |q| <= 0x1p-53 /\ |f| <= 0x1p-53 /\ |p| <= 0x1p-53
  /\ |d1| <= 0x1p-53 /\ |d2| <= 0x1p-53 /\ |d3| <= 0x1p-53 /\ |w| <= 0x1p-49
  -> |component| <= 0x1.66666666p-51 /\ |component| <= @QN_NEAR_NORMAL@ /\ |place| <= 0x1.8p-50 /\ |place| / (1 + w) <= @QN_NEAR_PLACE@ }
# ----
# A centre: the 2x2 minor of components within 5.6u (products' sizes add up to 1 at most), 24u granted; a determinant's term, of three with sizes adding up to sqrt 3, 100u granted.
{ |a| <= 0x1.66666666p-51 /\ |b| <= 0x1.66666666p-51 /\ |m| <= 0x1p-53 /\ |s| <= 0x1p-53 /\ |p| <= 0x1p-53 /\ |x| <= 0x1p-53 /\ |y| <= 0x1p-53 /\ |z| <= 0x1p-53 /\ |n| <= 0x1.8p-49
  -> |(1 + a) * (1 + b) * (1 + m) * (1 + s) - 1| <= 0x1.8p-49 /\ sqrt(3) * |((1 + a) * (1 + p) * (1 + x) * (1 + y) * (1 + z) - 1) + n * (1 + a) * (1 + p) * (1 + x) * (1 + y) * (1 + z)| <= 0x1.9p-47 }
# ----
# What the counts come to: of centres with |det| >= 1/36, three times for the axis, and with |det| > QN_NEAR_FLAT; of shapes; of radii.
# tight: QN_NEAR_PLACE 0.35
# tight: QN_NEAR_SHAPE 0.03
# tight: QN_NEAR_FLAT 0.03
u = 0x1p-53;
zero = 0;
{ zero in [0, 0] -> 3 * (124 * 36 + 10) * u - 4 * @QN_NEAR_PLACE@ <= 0 /\ 3 * 135 * u - 4 * @QN_NEAR_PLACE@ <= 0 /\ 12 * 25 * u - @QN_NEAR_SHAPE@ * @QN_NEAR_FLAT@ <= 0
  /\ 40 * u - @QN_NEAR_NORMAL@ <= 0 /\ 35 * u - @QN_NEAR_PLACE@ <= 0 }
