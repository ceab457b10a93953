// Paraboloids: a dish with its receiver at the focus, r^2 / 4h above the vertex. Dish and hollow are one paraboloid
// moved along its axis.
r = 10;  h = 4;  skin = 0.35;
focus = r*r / (4*h);

translate([0, 0, 13]) rotate([38, 0, 32]) {
  color([0.90, 0.90, 0.88]) difference() {
    paraboloid(h = h, r = r);
    translate([0, 0, skin]) paraboloid(h = h, r = r);
  }
  color([0.35, 0.37, 0.40]) {                               // three struts from the rim to the receiver
    cylinder(base = [9.4, 0, 3.6], axis = [-9.4, 0, focus - 3.6], r = 0.16, h = 9.7);
    rotate([0, 0, 120]) cylinder(base = [9.4, 0, 3.6], axis = [-9.4, 0, focus - 3.6], r = 0.16, h = 9.7);
    rotate([0, 0, 240]) cylinder(base = [9.4, 0, 3.6], axis = [-9.4, 0, focus - 3.6], r = 0.16, h = 9.7);
  }
  color([0.77, 0.38, 0.28]) cone(base = [0, 0, focus + 1.2], axis = [0, 0, -1], r = 0.9, h = 1.8);
  color([0.77, 0.38, 0.28]) translate([0, 0, focus + 1.2]) cylinder(h = 0.8, r = 0.9);
  color([0.35, 0.37, 0.40]) translate([0, 0, -1.2]) sphere(1.5);                    // the joint behind the vertex
}
color([0.47, 0.50, 0.54]) cylinder(h = 11.6, r1 = 2.2, r2 = 1.1);
color([0.38, 0.40, 0.44]) cylinder(h = 1, r = 4.5);
