// A chain wheel: a disc whose teeth are what 24 rollers leave, with 24 small cylinders rounding their tips; six round
// windows, a hub with bore and keyway. Windows, bore and keyway are flush with both faces. OpenSCAD reads this file as
// well.
t = 3;  pitch = 20;  roller = 1.9;                         // thickness, radius of the rollers' circle, of a roller
steel = [0.58, 0.62, 0.67];

difference() {
  color(steel) union() {
    cylinder(h = t, r = 20.3);
    rotate([0, 0, 7.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 22.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 37.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 52.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 67.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 82.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 97.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 112.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 127.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 142.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 157.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 172.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 187.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 202.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 217.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 232.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 247.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 262.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 277.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 292.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 307.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 322.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 337.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    rotate([0, 0, 352.5]) translate([20.3, 0, 0]) cylinder(h = t, r = 0.95);
    translate([0, 0, -2]) cylinder(h = t + 4, r = 6);      // the hub
  }
  color([0.82, 0.56, 0.33]) union() {                      // the rollers
    rotate([0, 0, 0]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 15]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 30]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 45]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 60]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 75]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 90]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 105]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 120]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 135]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 150]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 165]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 180]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 195]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 210]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 225]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 240]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 255]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 270]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 285]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 300]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 315]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 330]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
    rotate([0, 0, 345]) translate([pitch, 0, 0]) cylinder(h = t, r = roller);
  }
  color([0.36, 0.50, 0.54]) union() {                      // windows
    rotate([0, 0, 0]) translate([11.6, 0, 0]) cylinder(h = t, r = 3.6);
    rotate([0, 0, 60]) translate([11.6, 0, 0]) cylinder(h = t, r = 3.6);
    rotate([0, 0, 120]) translate([11.6, 0, 0]) cylinder(h = t, r = 3.6);
    rotate([0, 0, 180]) translate([11.6, 0, 0]) cylinder(h = t, r = 3.6);
    rotate([0, 0, 240]) translate([11.6, 0, 0]) cylinder(h = t, r = 3.6);
    rotate([0, 0, 300]) translate([11.6, 0, 0]) cylinder(h = t, r = 3.6);
  }
  color([0.82, 0.56, 0.33]) translate([0, 0, -2]) cylinder(h = t + 4, r = 3.2);
  color([0.82, 0.56, 0.33]) translate([-0.8, 0, -2]) cube([1.6, 4.2, t + 4]);
}
