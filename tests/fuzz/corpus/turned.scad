// Irrational rotations: the cube turned onto itself, and two ways to a quarter turn.
difference() { cube(1); rotate(a = 120, v = [1, 1, 1]) cube(1); }
translate([5, 0, 0]) { rotate([0, 0, 30]) rotate([0, 0, 60]) cube([1, 2, 3]); rotate([0, 0, 90]) cube([1, 2, 3]); }
translate([10, 0, 0]) rotate([0, 0, 45]) cube(1);
