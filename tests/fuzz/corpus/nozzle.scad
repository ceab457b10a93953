// A rocket nozzle: a hyperboloid of one sheet for the throat, a paraboloid for the chamber's dome. One quarter is cut away; its
// faces take the colour of the block that cuts them.
skin = 0.5;

difference() {
  color([0.72, 0.74, 0.77]) union() {
    intersection() {                                             // throat and bell
      hyperboloid(h = 12, r = 9, rc = 2.6);
      halfspace(n = [0, 0, 1], d = 5);
    }
    translate([0, 0, 5]) cylinder(h = 5, r = 5.2);               // chamber
    paraboloid(base = [0, 0, 10], axis = [0, 0, 1], r = 5.2, h = 4);
    translate([0, 0, 4.2]) cylinder(h = 0.8, r = 6.2);           // flange
    translate([0, 0, -12]) cylinder(h = 0.6, r = 9.5);           // rim
    translate([0, 0, 13.2]) cylinder(h = 2.4, r = 1.1);          // inlet
  }
  color([0.85, 0.52, 0.30]) union() {                            // the hollow
    intersection() {
      hyperboloid(h = 12, r = 9 - skin, rc = 2.6 - skin);
      halfspace(n = [0, 0, 1], d = 5);
    }
    translate([0, 0, 5]) cylinder(h = 5, r = 5.2 - skin);
    paraboloid(base = [0, 0, 10], axis = [0, 0, 1], r = 5.2 - skin, h = 4 - skin);
    translate([0, 0, 12]) cylinder(h = 3.6, r = 0.6);
  }
  color([0.93, 0.82, 0.62]) translate([0, -20, -12]) cube([20, 20, 28]);
}
