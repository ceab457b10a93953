cube("big");
cube([1, 2]);
translate("x") cube(1);
sphere(r = [1, 2]);
cube(1, center = "yes");
multmatrix([1, 2, 3]) cube(1);
name(3) cube(1);
quadric(matrix = [[1]]);
sphere(undef);
