// A saddle cut by a box: a hyperbolic-paraboloid roof on four posts. The slab lies between one saddle and the same
// saddle lowered; the posts end in it.
a = 5.2;  b = 5.2;  side = 16;  thick = 0.6;

color([0.80, 0.52, 0.38]) translate([0, 0, 8]) rotate([0, 0, 45]) intersection() {
  saddle(a = a, b = b);
  difference() {
    rotate([0, 0, -45]) cube([side, side, 11], center = true);
    translate([0, 0, -thick]) saddle(a = a, b = b);
  }
}
color([0.90, 0.87, 0.80]) intersection() {
  union() {
    translate([-7.6, -7.6, 0]) cube([1, 1, 12.5]);
    translate([6.6, 6.6, 0]) cube([1, 1, 12.5]);
    translate([6.6, -7.6, 0]) cube([1, 1, 12.5]);
    translate([-7.6, 6.6, 0]) cube([1, 1, 12.5]);
  }
  translate([0, 0, 8 - thick/2]) rotate([0, 0, 45]) saddle(a = a, b = b);
}
color([0.56, 0.60, 0.56]) translate([0, 0, -0.5]) cube([24, 24, 1], center = true);
color([0.40, 0.43, 0.46]) translate([-3, -3, 0]) cube([6, 6, 0.8]);
