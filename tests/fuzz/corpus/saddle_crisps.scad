// A saddle cut by an elliptic cylinder: three crisps. Each is the shell between a saddle and the same saddle raised.
a = 3.6;  b = 3.1;  thick = 0.28;

color([0.90, 0.72, 0.38]) intersection() {
  cylinder(h = 6.6, r = [6.2, 4.6], center = true);
  difference() { translate([0, 0, thick]) saddle(a = a, b = b); saddle(a = a, b = b); }
}
color([0.86, 0.64, 0.31]) translate([0.4, 0.2, 1.5]) rotate([4, -3, 14]) intersection() {
  cylinder(h = 6.6, r = [6.2, 4.6], center = true);
  difference() { translate([0, 0, thick]) saddle(a = a, b = b); saddle(a = a, b = b); }
}
color([0.93, 0.78, 0.45]) translate([-0.3, -0.1, 3.2]) rotate([-5, 4, 33]) intersection() {
  cylinder(h = 6.6, r = [6.2, 4.6], center = true);
  difference() { translate([0, 0, thick]) saddle(a = a, b = b); saddle(a = a, b = b); }
}
