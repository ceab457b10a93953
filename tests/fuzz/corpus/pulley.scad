// A pulley in its block. The groove is a hyperboloid of one sheet for a strap; spokes are what five elliptic windows
// leave; cheek plates touch the wheel's hub in a plane.
w = 5;  r = 10;
cheek = [0.34, 0.47, 0.50];  brass = [0.84, 0.67, 0.38];

rotate([90, 0, 0]) {
  color(brass) difference() {                              // the wheel
    union() {
      intersection() {
        cylinder(h = w, r = r, center = true);
        hyperboloid(h = w/2, r = r, rc = r - 2);
      }
      cylinder(h = w + 1, r = 3, center = true);
    }
    cylinder(h = w + 1, r = 1.5, center = true);
    rotate([0, 0, 18])  translate([5.4, 0, 0]) cylinder(h = w, r = [1.7, 1.9], center = true);
    rotate([0, 0, 90])  translate([5.4, 0, 0]) cylinder(h = w, r = [1.7, 1.9], center = true);
    rotate([0, 0, 162]) translate([5.4, 0, 0]) cylinder(h = w, r = [1.7, 1.9], center = true);
    rotate([0, 0, 234]) translate([5.4, 0, 0]) cylinder(h = w, r = [1.7, 1.9], center = true);
    rotate([0, 0, 306]) translate([5.4, 0, 0]) cylinder(h = w, r = [1.7, 1.9], center = true);
  }
  color([0.55, 0.58, 0.62]) {                              // the axle, riveted over
    cylinder(h = w + 4, r = 1.5, center = true);
    translate([0, 0, w/2 + 1.7]) intersection() { ellipsoid(r = [2.2, 2.2, 0.9]); halfspace(n = [0, 0, -1], d = 0); }
    translate([0, 0, -w/2 - 1.7]) intersection() { ellipsoid(r = [2.2, 2.2, 0.9]); halfspace(n = [0, 0, 1], d = 0); }
  }
  color(cheek) {                                           // the cheeks and the yoke
    translate([0, 0, w/2 + 0.5]) cylinder(h = 1.2, r = 3.6);
    translate([-2.2, 0, w/2 + 0.5]) cube([4.4, 14, 1.2]);
    translate([0, 0, -w/2 - 1.7]) cylinder(h = 1.2, r = 3.6);
    translate([-2.2, 0, -w/2 - 1.7]) cube([4.4, 14, 1.2]);
    translate([-2.2, 12, -w/2 - 1.7]) cube([4.4, 2, w + 3.4]);
  }
  color([0.55, 0.58, 0.62]) difference() {                 // the eye
    translate([0, 16.4, 0]) ellipsoid(r = [2.9, 2.9, 1.2]);
    translate([0, 16.4, 0]) cylinder(h = 4, r = 1.5, center = true);
  }
  // the strap: half a ring over the wheel, and two straight ends, in planes that touch the ring
  color([0.86, 0.80, 0.66]) {
    intersection() {
      difference() { cylinder(h = 2.4, r = 9.3, center = true); cylinder(h = 2.4, r = 8.3, center = true); }
      halfspace(n = [0, -1, 0], d = 0);
    }
    translate([8.3, -14, -1.2]) cube([1, 14, 2.4]);
    translate([-9.3, -9, -1.2]) cube([1, 9, 2.4]);
  }
  color([0.42, 0.44, 0.48]) translate([8.8, -15.6, 0]) ellipsoid(r = [2.3, 2.6, 2.3]);
}
