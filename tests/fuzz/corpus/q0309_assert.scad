assert(1 + 1 == 3, "arithmetic");
assert(0.1 + 0.2 == 0.3);
