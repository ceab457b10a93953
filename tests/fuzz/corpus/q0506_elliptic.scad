cylinder(h = 1, r1 = [2, 1], r2 = [1, 1]);
cylinder(h = 1, r1 = [2, 1], r2 = [4, 2]);
