// Superquadrics in a row: e rounds around z, n along it. Box, cylinder, ball, cushion, top, star. These are not algebraic for
// general exponents; see docs/exactness.md for what is promised of them.
r = [2, 2, 2];
rotate([0, 0, 20]) color([0.29, 0.40, 0.58]) translate([0, 0, 2]) superquadric(r = r, e = 0.3, n = 0.3);
color([0.25, 0.52, 0.56]) translate([5, 0, 2]) superquadric(r = r, e = 1, n = 0.3);
color([0.52, 0.62, 0.46]) translate([10, 0, 2]) superquadric(r = r, e = 1, n = 1);
color([0.85, 0.68, 0.38]) translate([15, 0, 2]) rotate([0, 0, 20]) superquadric(r = r, e = 0.3, n = 1.5);
color([0.80, 0.48, 0.34]) translate([20, 0, 2]) superquadric(r = r, e = 1, n = 2.5);
color([0.58, 0.30, 0.37]) translate([25, 0, 2]) rotate([0, 0, 20]) superquadric(r = r, e = 2.5, n = 2.5);

color([0.90, 0.88, 0.84]) translate([-3, -3.5, -0.8]) cube([31, 7, 0.8]);
camera(eye = [15, -40, 22], look = [12.5, -0.3, 1.2], fov = 32);
