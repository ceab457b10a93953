translate([1, 2, 3]) x = 4;
cube(1);
