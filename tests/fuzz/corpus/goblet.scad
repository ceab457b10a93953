// A goblet: the bowl a paraboloid with a smaller one taken out, the knop an ellipsoid, the stem a hyperboloid, the foot a
// cone; wine stands in it up to a plane.
silver = [0.76, 0.77, 0.79];

material(color = silver, specular = 0.6, shininess = 50) {
  difference() {
    translate([0, 0, 7]) paraboloid(h = 7, r = 4);
    translate([0, 0, 7.5]) paraboloid(h = 6.5, r = 3.75);
  }
  translate([0, 0, 5.2]) hyperboloid(h = 2.2, r = 1.0, rc = 0.42);
  translate([0, 0, 5.2]) ellipsoid(r = [0.95, 0.95, 0.55]);
  translate([0, 0, 1.4]) hyperboloid(h = 1.9, r = 1.3, rc = 0.5);
  intersection() { ellipsoid(r = [3.4, 3.4, 1.1]); halfspace(n = [0, 0, -1], d = 0); }
}
material(color = [0.45, 0.10, 0.16], specular = 0.4, shininess = 80) intersection() {
  translate([0, 0, 7.5]) paraboloid(h = 6.5, r = 3.75);
  halfspace(n = [0, 0, 1], d = 13.3);
}
material(color = [0.86, 0.72, 0.36], specular = 0.6, shininess = 40) intersection() {   // a gilt band below the lip
  difference() {
    translate([0, 0, 7]) paraboloid(h = 7, r = 4.08);
    translate([0, 0, 7.5]) paraboloid(h = 6.5, r = 3.75);
  }
  translate([0, 0, 12.4]) cylinder(h = 0.7, r = 5);
}
color([0.42, 0.33, 0.30]) translate([0, 0, -0.8]) cylinder(h = 0.8, r = 6.5);
