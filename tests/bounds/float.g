# QN_FLOAT_STEP, QN_FLOAT_TINY: down(v) = f - (f QN_FLOAT_STEP + QN_FLOAT_TINY) in floats, f = float(v), is at most v (in [1, 2]; other binades are that times a power of two, but for
# QN_FLOAT_TINY, which is only more there).
# tight: QN_FLOAT_STEP 0.25
@flt = float<ieee_32, ne>;
f = flt(v);
p = flt(@QN_FLOAT_STEP@ * f);
g = flt(p + @QN_FLOAT_TINY@);
down = flt(f - g);
{ v in [1, 2] -> down - v <= 0 }
down - v -> (down - (f - g)) + (f - v) - g;
# ----
# QN_WIDE_FLOAT: three roundings of floats in a slab's parameter against one widening.
# tight: QN_WIDE_FLOAT 0.1
{ |a| <= 0x1p-24 /\ |b| <= 0x1p-24 /\ |c| <= 0x1p-24 -> |(1 + a) * (1 + b) * (1 + c) - 1| <= @QN_WIDE_FLOAT@ }
