# QN_MAP_E: a row X = ((r0 y0 + r1 y1) + r2 y2) + r3 of the filter. r: the entry's error; v, t: y as computed and its error, weight 1; m, s: product and sums;
# w: what the weight's own evaluation lacks, and v1 the last product. D: two sums, d rounded. First without the evaluation: 6.01 u and 5.01 u, which quad.g uses.
# tight: QN_MAP_E 0.95
share = v * ((1 + m) * (1 + s1) * (1 + s2) * (1 + s3) - (1 + r)) - (1 + r) * t;
slope = v * ((1 + m) * (1 + s1) * (1 + s2) - (1 + r)) - (1 + r) * t;
last = (1 + s1) - (1 + r);
{ |m| <= 0x1p-53 /\ |s1| <= 0x1p-53 /\ |s2| <= 0x1p-53 /\ |s3| <= 0x1p-53 /\ |r| <= @QN_SHADOW@ /\ |v| <= 1 /\ |t| <= 0x1.0000000000004p-53 /\ |w| <= 0x1.8p-51
  -> |share| <= 0x1.80a3d70a3d70ap-51 /\ |slope| <= 0x1.40a3d70a3d70ap-51 /\ share / (1 + w) in [-@QN_MAP_E@, @QN_MAP_E@] /\ slope / (1 + w) in [-@QN_MAP_E@, @QN_MAP_E@]
     /\ last / (1 + w) in [-@QN_MAP_E@, @QN_MAP_E@] }
