$fn = 100;
cylinder(h = 1, r = 1);
sphere(1);
cylinder(h = 1, r = 1, $fn = 6);
