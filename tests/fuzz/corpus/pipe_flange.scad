// A pipe flange. Every hole is exactly as deep as the plate is thick: its caps lie in the plate's two faces, and it comes
// out clean with no "+ 0.01". The raised face, the neck and the bore share planes too. OpenSCAD reads this file as well.
plate = 3;  r = 14;  bore = 5;  neck = 7;  bolts = 10.8;  hole = 1.25;
difference() {
  color([0.55, 0.61, 0.67]) union() {
    cylinder(h = plate, r = r);
    translate([0, 0, plate]) cylinder(h = 5, r1 = 8.2, r2 = neck);
    translate([0, 0, plate + 5]) cylinder(h = 4, r = neck);
    translate([0, 0, -0.6]) cylinder(h = 0.6, r = 8.6);
  }
  color([0.47, 0.53, 0.60]) translate([0, 0, -0.6]) cylinder(h = plate + 9.6, r = bore);
  color([0.80, 0.50, 0.33]) {
    translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 45]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 90]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 135]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 180]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 225]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 270]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
    rotate([0, 0, 315]) translate([bolts, 0, 0]) cylinder(h = plate, r = hole);
  }
}
