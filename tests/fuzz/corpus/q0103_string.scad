name("open) cube(1);
sphere(wrong);
