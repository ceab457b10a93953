// A die: a cube rounded by a ball, with inlaid pips. Each pip is sunk by a cylinder and filled by the same cylinder, so
// its face lies in the die's face: flush, with nothing above and no gap around. The die stands on its slab without a
// joint.
pip = 1.1;  deep = 0.8;

translate([0, 0, 6]) {
  color([0.90, 0.86, 0.77]) difference() {
    intersection() { cube(12, center = true); sphere(8.6); }
    cylinder(base = [0, 0, 6], axis = [0, 0, -1], r = pip, h = deep);
    cylinder(base = [-3, -3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [-3, 0, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [-3, 3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [3, -3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [3, 0, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [3, 3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [-3, -6, -3], axis = [0, 1, 0], r = pip, h = deep);
    cylinder(base = [3, -6, 3], axis = [0, 1, 0], r = pip, h = deep);
    cylinder(base = [-3, 6, -3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [-3, 6, 3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [0, 6, 0], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [3, 6, -3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [3, 6, 3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [6, -3, -3], axis = [-1, 0, 0], r = pip, h = deep);
    cylinder(base = [6, 0, 0], axis = [-1, 0, 0], r = pip, h = deep);
    cylinder(base = [6, 3, 3], axis = [-1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, -3, -3], axis = [1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, -3, 3], axis = [1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, 3, -3], axis = [1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, 3, 3], axis = [1, 0, 0], r = pip, h = deep);
  }
  color([0.62, 0.22, 0.22]) {                              // the inlays
    cylinder(base = [0, 0, 6], axis = [0, 0, -1], r = pip, h = deep);
    cylinder(base = [-3, -3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [-3, 0, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [-3, 3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [3, -3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [3, 0, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [3, 3, -6], axis = [0, 0, 1], r = pip, h = deep);
    cylinder(base = [-3, -6, -3], axis = [0, 1, 0], r = pip, h = deep);
    cylinder(base = [3, -6, 3], axis = [0, 1, 0], r = pip, h = deep);
    cylinder(base = [-3, 6, -3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [-3, 6, 3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [0, 6, 0], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [3, 6, -3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [3, 6, 3], axis = [0, -1, 0], r = pip, h = deep);
    cylinder(base = [6, -3, -3], axis = [-1, 0, 0], r = pip, h = deep);
    cylinder(base = [6, 0, 0], axis = [-1, 0, 0], r = pip, h = deep);
    cylinder(base = [6, 3, 3], axis = [-1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, -3, -3], axis = [1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, -3, 3], axis = [1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, 3, -3], axis = [1, 0, 0], r = pip, h = deep);
    cylinder(base = [-6, 3, 3], axis = [1, 0, 0], r = pip, h = deep);
  }
}
color([0.33, 0.45, 0.42]) translate([-10, -10, -1]) cube([20, 20, 1]);
