cube([1, 1 / 0, 2]);
sphere(r = 0 / 0);
translate([0, 0, -1 / 0]) cube(1);
multmatrix([[1, 0, 0, sqrt(-1)]]) cube(1);
rotate(tan(90)) cube(1);
