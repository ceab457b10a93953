// Constants and parts out of reach drop out; materials merge; gates are flat.
difference() {
  union() { color("red") cube(10); color("blue") translate([5, 0, 0]) cube(10); }
  translate([100, 0, 0]) sphere(3);
  difference() { translate([2, 2, 2]) cube(3); translate([4, 4, 4]) cube(3); }
  group() {}
}
intersection() { cube(1); translate([3, 0, 0]) cube(1); }
%sphere(100);
