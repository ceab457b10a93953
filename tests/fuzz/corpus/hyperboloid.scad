// A hyperboloid of one sheet: a cooling tower. The shell is the difference of two hyperboloids that share their lower
// cap; its top is cut by a plane; arches let the air in at the foot.
h = 20;  r = 13;  waist = 7.5;  skin = 0.5;

color([0.82, 0.79, 0.74]) difference() {
  intersection() {
    hyperboloid(h = h, r = r, rc = waist);
    halfspace(n = [0, 0, 1], d = 8);
  }
  hyperboloid(h = h, r = r - skin, rc = waist - skin);
  // eight arches through both walls, four cutters
  translate([0, 0, -h]) {
    cylinder(base = [-20, 0, 0], axis = [1, 0, 0], r = [3.2, 1.7], h = 40);
    rotate([0, 0, 45])  cylinder(base = [-20, 0, 0], axis = [1, 0, 0], r = [3.2, 1.7], h = 40);
    rotate([0, 0, 90])  cylinder(base = [-20, 0, 0], axis = [1, 0, 0], r = [3.2, 1.7], h = 40);
    rotate([0, 0, 135]) cylinder(base = [-20, 0, 0], axis = [1, 0, 0], r = [3.2, 1.7], h = 40);
  }
}
// the ground plate
color([0.75, 0.38, 0.31]) translate([0, 0, -h - 0.8]) cylinder(h = 0.8, r = 16);
