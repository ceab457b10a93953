difference() {
  cube([40, 20, 10], center = true);
  translate([0, 0, -5]) cylinder(h = 10, r = 4);
}
