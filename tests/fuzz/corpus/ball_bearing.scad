// A ball bearing, a quarter of its rings cut away. Races: the outer one an ellipsoid of revolution, the inner one a
// hyperboloid, both touching the balls' equators; twelve balls in a cage.
pitch = 14;  ball = 2.4;  w = 7;                 // radius of the balls' circle, of a ball; width of the rings
steel = [0.70, 0.73, 0.77];

difference() {
  union() {
    color(steel) difference() {                  // outer ring
      cylinder(h = w, r = 20, center = true);
      cylinder(h = w, r = 15.6, center = true);
      ellipsoid(r = [pitch + ball, pitch + ball, 7]);
    }
    color(steel) difference() {                  // inner ring
      intersection() {
        cylinder(h = w, r = 12.6, center = true);
        hyperboloid(h = w, r = 16, rc = pitch - ball);
      }
      cylinder(h = w, r = 8.5, center = true);
    }
  }
  color([0.62, 0.65, 0.70]) translate([0, -30, -w]) cube([30, 30, 2*w]);   // the quarter towards the viewer
}
color([0.82, 0.62, 0.33]) difference() {          // the cage, bored for the balls
  cylinder(h = 2.6, r = 14.7, center = true);
  cylinder(h = 2.6, r = 13.3, center = true);
  rotate([0, 0, 15]) translate([pitch, 0, 0]) sphere(2.5);   rotate([0, 0, 45]) translate([pitch, 0, 0]) sphere(2.5);
  rotate([0, 0, 75]) translate([pitch, 0, 0]) sphere(2.5);   rotate([0, 0, 105]) translate([pitch, 0, 0]) sphere(2.5);
  rotate([0, 0, 135]) translate([pitch, 0, 0]) sphere(2.5);  rotate([0, 0, 165]) translate([pitch, 0, 0]) sphere(2.5);
  rotate([0, 0, 195]) translate([pitch, 0, 0]) sphere(2.5);  rotate([0, 0, 225]) translate([pitch, 0, 0]) sphere(2.5);
  rotate([0, 0, 255]) translate([pitch, 0, 0]) sphere(2.5);  rotate([0, 0, 285]) translate([pitch, 0, 0]) sphere(2.5);
  rotate([0, 0, 315]) translate([pitch, 0, 0]) sphere(2.5);  rotate([0, 0, 345]) translate([pitch, 0, 0]) sphere(2.5);
}
material(color = [0.86, 0.88, 0.91], specular = 0.7, shininess = 70) {
  rotate([0, 0, 15]) translate([pitch, 0, 0]) sphere(ball);   rotate([0, 0, 45]) translate([pitch, 0, 0]) sphere(ball);
  rotate([0, 0, 75]) translate([pitch, 0, 0]) sphere(ball);   rotate([0, 0, 105]) translate([pitch, 0, 0]) sphere(ball);
  rotate([0, 0, 135]) translate([pitch, 0, 0]) sphere(ball);  rotate([0, 0, 165]) translate([pitch, 0, 0]) sphere(ball);
  rotate([0, 0, 195]) translate([pitch, 0, 0]) sphere(ball);  rotate([0, 0, 225]) translate([pitch, 0, 0]) sphere(ball);
  rotate([0, 0, 255]) translate([pitch, 0, 0]) sphere(ball);  rotate([0, 0, 285]) translate([pitch, 0, 0]) sphere(ball);
  rotate([0, 0, 315]) translate([pitch, 0, 0]) sphere(ball);  rotate([0, 0, 345]) translate([pitch, 0, 0]) sphere(ball);
}
