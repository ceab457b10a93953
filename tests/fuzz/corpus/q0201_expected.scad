cube;
sphere(1 2);
translate([1, 2) cube(1);
=4;
cube(1).x;
x = sin(a = 3);
