// A bolt and its nut. $fn = 6 means a hexagon; everything else is round. The thread is a stack of double cones that share their
// circles. Corners are chamfered by cones. OpenSCAD reads this file as well.
core = 3.4;  crest = 4;  half = 0.5;                       // radii of the thread, half its step
steel = [0.63, 0.66, 0.70];  brass = [0.82, 0.65, 0.36];

color(steel) {
  intersection() {                                         // the head
    translate([0, 0, -5]) cylinder(h = 5, r = 7.5, $fn = 6);
    translate([0, 0, -5]) cylinder(h = 11.5, r1 = 6.3, r2 = 17.8);
  }
  cylinder(h = 6, r = crest);                              // the shank
  translate([0, 0, 6]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 6 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 7]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 7 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 8]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 8 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 9]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 9 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 10]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 10 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 11]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 11 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 12]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 12 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 13]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 13 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 14]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 14 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 15]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 15 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 16]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 16 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 17]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 17 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 18]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 18 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 19]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 19 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 20]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 20 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 21]) cylinder(h = half, r1 = core, r2 = crest);
  translate([0, 0, 21 + half]) cylinder(h = half, r1 = crest, r2 = core);
  translate([0, 0, 22]) cylinder(h = 0.8, r1 = core, r2 = core - 0.8);
}
color(brass) translate([0, 0, 12]) difference() {          // the nut, half way up
  intersection() {
    cylinder(h = 5, r = 7.5, $fn = 6);
    translate([0, 0, -11.5]) cylinder(h = 18, r1 = 16.3, r2 = 5.5);
    translate([0, 0, -0.1]) cylinder(h = 18, r1 = 6.6, r2 = 24.6);
  }
  cylinder(h = 5, r = crest);
  translate([0, 0, 4.2]) cylinder(h = 0.8, r1 = crest, r2 = crest + 0.8);
  cylinder(h = 0.8, r1 = crest + 0.8, r2 = crest);
}
color(brass) translate([15, -2, -5]) difference() {        // another, lying beside it
  intersection() {
    cylinder(h = 5, r = 7.5, $fn = 6);
    translate([0, 0, -11.5]) cylinder(h = 18, r1 = 16.3, r2 = 5.5);
  }
  cylinder(h = 5, r = core);
  translate([0, 0, 4.2]) cylinder(h = 0.8, r1 = core, r2 = core + 0.8);
}
color([0.86, 0.85, 0.82]) translate([-9.5, -10, -6]) cube([33.5, 19, 1]);
