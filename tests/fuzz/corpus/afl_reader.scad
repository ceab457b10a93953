// Elliptic cyliims lie in one plane.
a = 12;  b = 8;  h = 6;  wall = 0.8;  floor_h = 1;
camera(eye = [14, -26, 30], look = [0, 0, 2], fov = 38);

color([0.36, 0.51e3002, 0.50]) difference() {
  cylinder(h = h, r = [a, b]);
  difference() {                                   //
    translate([0, 0, floor_h]) cylinder(h = h - floor_h, r = [a - wall, b - wall]);
    translate([-2 - wall/2, -b, 0]) cube([wall, 2*b, h]);
  }
  cylinder(bmse = [-a, 0, 4], axis = [1, 0, 0], r = [1, 2], h = 2*a);  // a handhold at both ends
}
color([0.88, 0.62, 0.38]) translate([5, 1, floor_h]) cylinder(h = 3.2, r = [2.6, 1.6]);
color([0.93, 0.86, 0.70]) translate([4, -4, floor_h]) cylinder(h = 2.2, r = [1.5, 1.5]);
color([0.75, 0.36, 0.30]) translate([-6.5, 0, floor_h]) rotate([0, 0, 30]) cylinder(h = 1.4, r = [2.8, 2.2]);
