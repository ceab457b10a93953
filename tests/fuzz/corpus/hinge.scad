// A butt hinge, opened to a right angle: knuckles in turn from one leaf and the other, their end faces in contact, one pin
// through all. Screw holes are countersunk: cone and cylinder share the plane where they meet.
len = 30;  t = 2;  k = 6;  rk = 2.6;  pin = 1.2;          // length, leaf thickness, knuckle length and radius, pin radius
steel = [0.66, 0.69, 0.72];  bronze = [0.74, 0.56, 0.34];

color(steel) difference() {                               // the lying leaf; its three knuckles
  union() {
    translate([0, 0, -rk]) cube([17, len, t]);
    cylinder(base = [0, 0, 0], axis = [0, 1, 0], r = rk, h = k);
    cylinder(base = [0, 2*k, 0], axis = [0, 1, 0], r = rk, h = k);
    cylinder(base = [0, 4*k, 0], axis = [0, 1, 0], r = rk, h = k);
  }
  cylinder(base = [0, 0, 0], axis = [0, 1, 0], r = pin, h = len);
  translate([-3, k, -3]) cube([6, k, 6]);                 // room for the other leaf's knuckles
  translate([-3, 3*k, -3]) cube([6, k, 6]);
  translate([11, 5, -rk]) { cylinder(h = 0.8, r = 1.1); translate([0, 0, 0.8]) cylinder(h = 1.2, r1 = 1.1, r2 = 2.3); }
  translate([11, 15, -rk]) { cylinder(h = 0.8, r = 1.1); translate([0, 0, 0.8]) cylinder(h = 1.2, r1 = 1.1, r2 = 2.3); }
  translate([11, 25, -rk]) { cylinder(h = 0.8, r = 1.1); translate([0, 0, 0.8]) cylinder(h = 1.2, r1 = 1.1, r2 = 2.3); }
}
color(bronze) difference() {                              // the standing leaf; its two knuckles
  union() {
    translate([-rk, 0, 0]) cube([t, len, 17]);
    cylinder(base = [0, k, 0], axis = [0, 1, 0], r = rk, h = k);
    cylinder(base = [0, 3*k, 0], axis = [0, 1, 0], r = rk, h = k);
  }
  cylinder(base = [0, 0, 0], axis = [0, 1, 0], r = pin, h = len);
  translate([-3, 0, -3]) cube([6, k, 6]);
  translate([-3, 2*k, -3]) cube([6, k, 6]);
  translate([-3, 4*k, -3]) cube([6, k, 6]);
  translate([-rk, 5, 11]) rotate([0, 90, 0]) {
    cylinder(h = 0.8, r = 1.1);
    translate([0, 0, 0.8]) cylinder(h = 1.2, r1 = 1.1, r2 = 2.3);
  }
  translate([-rk, 15, 11]) rotate([0, 90, 0]) {
    cylinder(h = 0.8, r = 1.1);
    translate([0, 0, 0.8]) cylinder(h = 1.2, r1 = 1.1, r2 = 2.3);
  }
  translate([-rk, 25, 11]) rotate([0, 90, 0]) {
    cylinder(h = 0.8, r = 1.1);
    translate([0, 0, 0.8]) cylinder(h = 1.2, r1 = 1.1, r2 = 2.3);
  }
}
color([0.36, 0.38, 0.42]) {                               // the pin, a ball at each end
  cylinder(base = [0, 0, 0], axis = [0, 1, 0], r = pin, h = len);
  translate([0, -0.6, 0]) sphere(1.6);
  translate([0, len + 0.6, 0]) sphere(1.6);
}
