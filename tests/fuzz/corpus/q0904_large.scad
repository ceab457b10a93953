x = 3 ^ 100000;
cube(x);
y = 3 ^ 30000;
sphere(y);
