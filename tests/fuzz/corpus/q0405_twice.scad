cube(1, size = 2);
sphere(r = 1, r = 2);
