cube(1);
/* no end
sphere(2);
