v = [for (i = [0 : 3]) i * i];
r = [0 : 10];
w = let (a = 1) a;
f = function (x) x;
cube(v[1] + r[0]);
