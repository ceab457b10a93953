// A parabolic cylinder, written as a general quadric: x^2 <= k z. A solar trough with its tube on the focal line, k/4
// above the vertex.
k = 24;  length = 26;  height = 6;  skin = 0.4;
focus = k / 4;

translate([0, 0, 7]) rotate([0, 28, 0]) {
  material(color = [0.74, 0.82, 0.88], specular = 0.6, shininess = 60) intersection() {     // the mirror
    difference() {
      quadric([1, 0, 0, 0, 0, 0, 0, 0, -k, 0]);
      translate([0, 0, skin]) quadric([1, 0, 0, 0, 0, 0, 0, 0, -k, 0]);
    }
    translate([-20, -length/2, -1]) cube([40, length, height + 1]);
  }
  color([0.78, 0.36, 0.27]) cylinder(base = [0, -length/2 - 1, focus], axis = [0, 1, 0], r = 0.6, h = length + 2);
  color([0.35, 0.37, 0.40]) {
    translate([-0.25, -length/2, 0]) cube([0.5, 0.5, focus]);
    translate([-0.25, -0.25, 0]) cube([0.5, 0.5, focus]);
    translate([-0.25, length/2 - 0.5, 0]) cube([0.5, 0.5, focus]);
    cylinder(base = [0, -length/2 - 1, -0.6], axis = [0, 1, 0], r = 0.7, h = length + 2);
  }
}
color([0.50, 0.53, 0.56]) {
  translate([-0.8, -length/2 - 1, 0]) cube([1.6, 1, 7]);
  translate([-0.8, length/2, 0]) cube([1.6, 1, 7]);
}
color([0.82, 0.76, 0.64]) translate([-11, -length/2 - 3, -0.8]) cube([22, length + 6, 0.8]);
