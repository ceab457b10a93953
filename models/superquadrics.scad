// Superquadrics: columns e = 0.3, 1, 2.5 (rounding around z), rows n = 0.3, 1, 2.5 (rounding along z): from box and
// cylinder by the ball to diamonds and stars. These are not algebraic for general exponents; see docs/exactness.md for
// what is promised of them.
color([0.29, 0.40, 0.58]) translate([0, 0, 2]) superquadric(r = [2, 2, 2], e = 0.3, n = 0.3);
color([0.25, 0.52, 0.56]) translate([5, 0, 2]) superquadric(r = [2, 2, 2], e = 1, n = 0.3);
color([0.38, 0.60, 0.52]) translate([10, 0, 2]) superquadric(r = [2, 2, 2], e = 2.5, n = 0.3);
color([0.52, 0.62, 0.46]) translate([0, -5, 2]) superquadric(r = [2, 2, 2], e = 0.3, n = 1);
color([0.80, 0.74, 0.50]) translate([5, -5, 2]) superquadric(r = [2, 2, 2], e = 1, n = 1);
color([0.86, 0.66, 0.38]) translate([10, -5, 2]) superquadric(r = [2, 2, 2], e = 2.5, n = 1);
color([0.80, 0.50, 0.36]) translate([0, -10, 2]) superquadric(r = [2, 2, 2], e = 0.3, n = 2.5);
color([0.70, 0.36, 0.32]) translate([5, -10, 2]) superquadric(r = [2, 2, 2], e = 1, n = 2.5);
color([0.54, 0.29, 0.36]) translate([10, -10, 2]) superquadric(r = [2, 2, 2], e = 2.5, n = 2.5);
color([0.90, 0.88, 0.84]) translate([-3, -13, -0.8]) cube([16, 16, 0.8]);
