# One operation in doubles, rounded to nearest: (1 + e), |e| <= QN_U. A sum of doubles has no least size, a product has.
# tight: QN_U 0.99
@rnd = float<ieee_64, ne>;
{ |x| in [0x1p-1021, 0x1p1000] -> |rnd(x) -/ x| <= @QN_U@ }
# ----
@rnd = float<ieee_64, ne>;
a = rnd(a_); b = rnd(b_);
{ |a + b| in [0x1p-1074, 0x1p1000] -> |rnd(a + b) -/ (a + b)| <= @QN_U@ }
