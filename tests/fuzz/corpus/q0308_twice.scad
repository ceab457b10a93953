r = 1;
cube(r);
r = 2;
