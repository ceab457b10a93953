// Spheres: an onion of four layers with one octant cut away. Layers share their spheres exactly, and the three
// cut planes are shared by all of them, so there is no seam and no gap.
r1 = 10;  r2 = 8;  r3 = 5.5;  r4 = 3;

color([0.80, 0.36, 0.27]) difference() { sphere(r1); sphere(r2); translate([0, -r1, 0]) cube(r1); }
color([0.90, 0.66, 0.40]) difference() { sphere(r2); sphere(r3); translate([0, -r1, 0]) cube(r1); }
color([0.95, 0.87, 0.72]) difference() { sphere(r3); sphere(r4); translate([0, -r1, 0]) cube(r1); }
color([0.29, 0.42, 0.48]) sphere(r4);
