cube(1)
sphere(2);
sphere(1) { cube(2); }
camera(eye = [1, 1, 1]) cube(1);
