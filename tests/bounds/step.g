# QN_STEP: x + fl(QN_STEP x + 2^-1074) is at least the next double: in [1, 2) the neighbour of a double x is 2^-52 away, and other binades are this one times a power of
# two. What is added is at least 2^-52, so the sum, rounded, is off x by more than 2^-53, and both are multiples of 2^-52. (Below the normal numbers 2^-1074 does it.)
# tight: QN_STEP 0.5
@rnd = float<ieee_64, ne>;
x = rnd(x_);
sum = x + @QN_STEP@ * x;
up = rnd(sum);
{ x in [1, 0x1.fffffffffffffp0] -> up - x >= 0x1p-52 }
up - x -> (up - sum) + @QN_STEP@ * x;
