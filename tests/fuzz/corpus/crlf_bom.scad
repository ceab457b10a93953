cube(1);
sphere(y);
