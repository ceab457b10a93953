v = [1, 2, 3];
cube(v[3]);
cube(v[-1]);
x = [1, 2].z;
y = "abc"[3];
