# QN_POLYHEDRON_SIDE: s = ((n0 p0 + n1 p1) + n2 p2) - d from doubles nearest to the seven numbers. A term has the roundings of its two factors, of its product and of three sums at
# most (e1 to e6), and that share of it is the error. The sum of sizes as computed has as many (f1 to f6), and its product with the bound one more (g).
# tight: QN_POLYHEDRON_SIDE 0.74
share = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * (1 + e6) - 1;
granted = @QN_POLYHEDRON_SIDE@ * ((1 + f1) * (1 + f2) * (1 + f3) * (1 + f4) * (1 + f5) * (1 + f6) * (1 + g));
{ |e1| <= 0x1p-53 /\ |e2| <= 0x1p-53 /\ |e3| <= 0x1p-53 /\ |e4| <= 0x1p-53 /\ |e5| <= 0x1p-53 /\ |e6| <= 0x1p-53 /\
  |f1| <= 0x1p-53 /\ |f2| <= 0x1p-53 /\ |f3| <= 0x1p-53 /\ |f4| <= 0x1p-53 /\ |f5| <= 0x1p-53 /\ |f6| <= 0x1p-53 /\ |g| <= 0x1p-53 ->
  share - granted <= 0 /\ share + granted >= 0 }
# ----
# Equal numbers that were rounded to 256 bits each, to 2^-200 of one another, have doubles that differ by less than the constant does of the greater.
{ |e1| <= 0x1p-53 /\ |e2| <= 0x1p-53 /\ |e3| <= 0x1p-199 /\ |g| <= 0x1p-53 -> (1 + e1) - (1 + e3) * (1 + e2) - @QN_POLYHEDRON_SIDE@ * (1 + e1) * (1 + g) <= 0 }
