union() { cube(1); camera(eye = [3, 3, 3]); }
translate([1, 0, 0]) light(at = [0, 0, 9]);
