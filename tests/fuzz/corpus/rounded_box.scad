// A rounded box: three slabs, twelve cylinders, eight spheres, tangent to one another. Every seam is a tangency; none
// shows. A lid's joint is cut round it, and a hollow of the same build is taken out. OpenSCAD reads this file as well.
x = 20;  y = 14;  z = 10;  r = 2;                       // outside, and radius of the edges
color([0.42, 0.58, 0.55]) difference() {
  union() {
    translate([r, r, 0]) cube([x - 2*r, y - 2*r, z]);
    translate([r, 0, r]) cube([x - 2*r, y, z - 2*r]);
    translate([0, r, r]) cube([x, y - 2*r, z - 2*r]);
    // edges along x
    translate([r, r, r]) rotate([0, 90, 0]) cylinder(h = x - 2*r, r = r);
    translate([r, y - r, r]) rotate([0, 90, 0]) cylinder(h = x - 2*r, r = r);
    translate([r, r, z - r]) rotate([0, 90, 0]) cylinder(h = x - 2*r, r = r);
    translate([r, y - r, z - r]) rotate([0, 90, 0]) cylinder(h = x - 2*r, r = r);
    // along y
    translate([r, y - r, r]) rotate([90, 0, 0]) cylinder(h = y - 2*r, r = r);
    translate([x - r, y - r, r]) rotate([90, 0, 0]) cylinder(h = y - 2*r, r = r);
    translate([r, y - r, z - r]) rotate([90, 0, 0]) cylinder(h = y - 2*r, r = r);
    translate([x - r, y - r, z - r]) rotate([90, 0, 0]) cylinder(h = y - 2*r, r = r);
    // along z
    translate([r, r, r]) cylinder(h = z - 2*r, r = r);
    translate([x - r, r, r]) cylinder(h = z - 2*r, r = r);
    translate([r, y - r, r]) cylinder(h = z - 2*r, r = r);
    translate([x - r, y - r, r]) cylinder(h = z - 2*r, r = r);
    // corners
    translate([r, r, r]) sphere(r);
    translate([x - r, r, r]) sphere(r);
    translate([r, y - r, r]) sphere(r);
    translate([x - r, y - r, r]) sphere(r);
    translate([r, r, z - r]) sphere(r);
    translate([x - r, r, z - r]) sphere(r);
    translate([r, y - r, z - r]) sphere(r);
    translate([x - r, y - r, z - r]) sphere(r);
  }
  // the joint of the lid: a groove all round
  difference() {
    translate([0, 0, 6.6]) cube([x, y, 0.3]);
    translate([r, 0.5, 6.6]) cube([x - 2*r, y - 1, 0.3]);
    translate([0.5, r, 6.6]) cube([x - 1, y - 2*r, 0.3]);
    translate([r, r, 6.6]) cylinder(h = 0.3, r = r - 0.5);
    translate([x - r, r, 6.6]) cylinder(h = 0.3, r = r - 0.5);
    translate([r, y - r, 6.6]) cylinder(h = 0.3, r = r - 0.5);
    translate([x - r, y - r, 6.6]) cylinder(h = 0.3, r = r - 0.5);
  }
  // a thumb notch, and a slot for coins in the lid
  translate([x/2, 0, 6.75]) rotate([-90, 0, 0]) cylinder(h = 0.4, r = 1.6);
  translate([x/2 - 3, y/2 - 0.4, z - 2]) cube([6, 0.8, 2]);
}
color([0.87, 0.72, 0.42]) translate([x/2, y/2 - 0.15, z - 0.6]) rotate([-90, 0, 0]) cylinder(h = 0.3, r = 2.2);
