// A plate, a hole flush with both faces, a notch in thirds.
difference() {
  name("plate") cube([40, 20, 10], center = true);
  translate([0, 0, -5]) cylinder(h = 10, r = 4);
  translate([20 - 1/3, -1, -5]) cube([1/3, 2, 10]);
}
