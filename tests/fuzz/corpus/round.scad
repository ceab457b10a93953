// One of each round kind.
paraboloid(h = 2, r = 3);
cylinder(h = 4, r1 = 2, r2 = 0, base = [10, 0, 0], axis = [0, 0, -1]);
translate([20, 0, 0]) hyperboloid(h = 3, r = 5, rc = 4);
translate([40, 0, 0]) hyperboloid(h = 5, r = 4, gap = 3);
translate([0, 20, 0]) intersection() { saddle(a = 1, b = 2); cube(4, center = true); }
translate([0, 40, 0]) superquadric(r = [1, 2, 3], e = 0.5, n = 1.5);
translate([0, 60, 0]) wedge([1, 2, 3]);
