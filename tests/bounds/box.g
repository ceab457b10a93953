# QN_BOX_SLACK, with the rounding operators. The parameter at which the line meets a plane, m a float, is within 3.01 u of (m - o) / d; and the bound lowered at last, x - QN_BOX_SLACK |x|,
# x > 0, whose product is exact, is at most x (1 - 5.04 u), which is what the derivation needs of it. (Leaving, and x < 0, are mirror images; other binades are this one times a
# power of two.)
# tight: QN_BOX_SLACK 0.75
@rnd = float<ieee_64, ne>;
m = float<ieee_32, ne>(m_); o = rnd(o_); d = rnd(d_);
s = rnd(m - o); i = rnd(1 / d); t = rnd(s * i);
{ |m - o| in [0x1p-500, 0x1p401] /\ d in [0x1p-400, 2] -> |t -/ ((m - o) * (1 / d))| <= 0x1.8147ae147ae14p-52 }
# ----
@rnd = float<ieee_64, ne>;
x = rnd(x_);
moved = x - @QN_BOX_SLACK@ * x;
low = rnd(moved);
need = 0x1.428f5c28f5c29p-51;
{ x in [1, 2] -> low - x * (1 - need) <= 0 }
low - x * (1 - need) -> (low - moved) + x * (need - @QN_BOX_SLACK@);
