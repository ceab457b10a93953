cube(1 +);
x = ;
translate([1,,2]) cube(1);
sphere(r = );
