// A biconvex lens: the meet of two balls, in a ring on a stand. The rim circle is where the two spheres cross; the ring's
// bore is a cylinder through that circle: all three surfaces share it.
R = 13;  d = 12;                        // radius of the balls, half the distance of their centres: thickness 2 (R - d)
rim = 5;                                // sqrt(R^2 - d^2): 5, 12, 13

translate([0, 0, 11]) {
  material(color = [0.62, 0.80, 0.86], specular = 0.9, shininess = 90) intersection() {
    translate([-d, 0, 0]) sphere(R);
    translate([d, 0, 0]) sphere(R);
  }
  color([0.80, 0.64, 0.36]) difference() {
    cylinder(base = [-0.7, 0, 0], axis = [1, 0, 0], r = rim + 0.9, h = 1.4);
    cylinder(base = [-0.7, 0, 0], axis = [1, 0, 0], r = rim, h = 1.4);
  }
}
color([0.80, 0.64, 0.36]) {
  translate([0, 0, 1]) cylinder(h = 4.3, r = 0.55);
  translate([0, 0, 4.2]) ellipsoid(r = [0.9, 0.9, 0.5]);
  translate([0, 0, 1]) paraboloid(base = [0, 0, 0], axis = [0, 0, 1], r = 2.4, h = 1.2);
}
color([0.36, 0.27, 0.22]) cylinder(h = 1, r = 5);
camera(eye = [22, -17, 17], look = [0, 0, 7.9], fov = 40);
light(direction = [-0.6, 0.9, -1.2], color = [0.8, 0.8, 0.8]);
light(at = [30, -10, 12], color = [0.35, 0.35, 0.38]);
