hull() { cube(1); sphere(2); }
minkowski() { cube(1); qube(1); }
linear_extrude(height = 3) circle(r = 1);
module part(n = 3) { cube(n); }
part(4);
function f(x) = x * x;
cube(f(2));
for (i = [0 : 10]) translate([i, 0, 0]) cube(i);
if (true) cube(1); else sphere(1);
intersection_for (a = [1, 2]) cube(a);
let (a = 1) cube(a);
square(1);
import("x.stl");
surface(file = "x.dat");
text("x");
