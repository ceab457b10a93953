// A mug of coffee on a saucer. The handle is an elliptic cylinder with a smaller one out of it, its edges softened by an
// ellipsoid; the mug's wall is cut from it by the same cylinder that is the mug's inside.
r = 4;  h = 9;  wall = 0.45;
glaze = [0.29, 0.46, 0.55];

material(color = glaze, specular = 0.5, shininess = 60) {
  rotate([0, 0, 38]) difference() {
    union() {
      cylinder(h = h, r = r);
      intersection() {                                       // the handle
        difference() {
          cylinder(base = [3.6, -0.8, 4.6], axis = [0, 1, 0], r = [3.4, 3.5], h = 1.6);
          cylinder(base = [3.6, -0.8, 4.6], axis = [0, 1, 0], r = [2.3, 2.5], h = 1.6);
        }
        translate([3.6, 0, 4.6]) ellipsoid(r = [3.8, 1.15, 3.9]);
      }
    }
    translate([0, 0, wall]) cylinder(h = h - wall, r = r - wall);
  }
}
material(color = [0.36, 0.22, 0.14], specular = 0.35, shininess = 90)
  translate([0, 0, wall]) cylinder(h = 7.6 - wall, r = r - wall);
material(color = [0.92, 0.90, 0.85], specular = 0.4, shininess = 40) difference() {   // the saucer
  translate([0, 0, -0.9]) intersection() {
    paraboloid(h = 1.5, r = 8);
    halfspace(n = [0, 0, -1], d = -0.1);
  }
  translate([0, 0, -0.4]) paraboloid(h = 1.5, r = 8);
  cylinder(h = 1, r = 4.2);
}
color([0.62, 0.47, 0.35]) translate([0, 0, -1.6]) cylinder(h = 0.8, r = 11);
camera(eye = [18.5, -20.7, 18], look = [0.4, -0.3, 2.0], fov = 39);
