// Steinmetz solids: what two, and what three, crossing cylinders have in common; beside them, three pipes that cross.
// The bicylinder has volume 16/3 r^3, the tricylinder 8 (2 - sqrt 2) r^3. OpenSCAD reads this file as well.
r = 3;  h = 9;

color([0.27, 0.47, 0.56]) translate([-8, -6, 0]) intersection() {
  rotate([90, 0, 0]) cylinder(h = h, r = r, center = true);
  rotate([0, 90, 0]) cylinder(h = h, r = r, center = true);
}
color([0.82, 0.55, 0.34]) translate([0, 0, 0]) intersection() {
  cylinder(h = h, r = r, center = true);
  rotate([90, 0, 0]) cylinder(h = h, r = r, center = true);
  rotate([0, 90, 0]) cylinder(h = h, r = r, center = true);
}
translate([9.5, 7.5, 0]) {
  color([0.87, 0.83, 0.74]) difference() {
    union() {
      cylinder(h = h, r = r, center = true);
      rotate([90, 0, 0]) cylinder(h = h, r = r, center = true);
      rotate([0, 90, 0]) cylinder(h = h, r = r, center = true);
    }
    cylinder(h = h, r = 2.2, center = true);
    rotate([90, 0, 0]) cylinder(h = h, r = 2.2, center = true);
    rotate([0, 90, 0]) cylinder(h = h, r = 2.2, center = true);
  }
}
