difference() {
  cube([1, 2, 3]);
  translate([0, 0,