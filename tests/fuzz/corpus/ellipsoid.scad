// Ellipsoids: four river stones, each touching the one below in a single point, on a slab.
// Heights are sums of semi-axes, so every contact is a tangency, neither a gap nor an overlap.
slab = 1.2;
c1 = 2.6;  c2 = 1.9;  c3 = 1.3;  c4 = 0.8;

color([0.55, 0.57, 0.58]) translate([0, 0, slab + c1]) ellipsoid(r = [6.2, 5.0, c1]);
color([0.70, 0.62, 0.54]) translate([0, 0, slab + 2*c1 + c2]) ellipsoid(r = [4.0, 4.6, c2]);
color([0.42, 0.47, 0.50]) translate([0, 0, slab + 2*c1 + 2*c2 + c3]) ellipsoid(r = [3.2, 2.5, c3]);
color([0.83, 0.79, 0.72]) translate([0, 0, slab + 2*c1 + 2*c2 + 2*c3 + c4]) ellipsoid(r = [1.6, 1.7, c4]);

color([0.87, 0.82, 0.72]) cylinder(h = slab, r = [10, 8]);
