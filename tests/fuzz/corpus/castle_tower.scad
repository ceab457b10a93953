// A round castle tower of dressed stones. The stones are flush with the wall: the wall is the ring without the stones,
// the stones are the ring within their places, and both have the same two cylinders for faces. Battlements, a door, arrow
// slits, and steps at the door.
r = 6;  inner = 4.6;  h = 18;
wall = [0.76, 0.71, 0.62];  stone_a = [0.62, 0.57, 0.50];  stone_b = [0.85, 0.80, 0.71];

color(wall) difference() {
  cylinder(h = h, r = r);
  cylinder(h = h, r = inner);
  rotate([0, 0, 0]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
  rotate([0, 0, 60]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
  rotate([0, 0, 120]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
  rotate([0, 0, 180]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
  rotate([0, 0, 240]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
  rotate([0, 0, 300]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
  rotate([0, 0, 47]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
  rotate([0, 0, 107]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
  rotate([0, 0, 167]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
  rotate([0, 0, 227]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
  rotate([0, 0, 287]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
  rotate([0, 0, 347]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
  rotate([0, 0, 9]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
  rotate([0, 0, 69]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
  rotate([0, 0, 129]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
  rotate([0, 0, 189]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
  rotate([0, 0, 249]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
  rotate([0, 0, 309]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
  rotate([0, 0, 31]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
  rotate([0, 0, 91]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
  rotate([0, 0, 151]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
  rotate([0, 0, 211]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
  rotate([0, 0, 271]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
  rotate([0, 0, 331]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
  rotate([0, 0, 18]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
  rotate([0, 0, 78]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
  rotate([0, 0, 138]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
  rotate([0, 0, 198]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
  rotate([0, 0, 258]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
  rotate([0, 0, 318]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
  rotate([0, 0, 40]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
  rotate([0, 0, 100]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
  rotate([0, 0, 160]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
  rotate([0, 0, 220]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
  rotate([0, 0, 280]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
  rotate([0, 0, 340]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
  rotate([0, 0, 2]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
  rotate([0, 0, 62]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
  rotate([0, 0, 122]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
  rotate([0, 0, 182]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
  rotate([0, 0, 242]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
  rotate([0, 0, 302]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
  rotate([0, 0, 49]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
  rotate([0, 0, 109]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
  rotate([0, 0, 169]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
  rotate([0, 0, 229]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
  rotate([0, 0, 289]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
  rotate([0, 0, 349]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
  rotate([0, 0, 11]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
  rotate([0, 0, 71]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
  rotate([0, 0, 131]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
  rotate([0, 0, 191]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
  rotate([0, 0, 251]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
  rotate([0, 0, 311]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
  translate([0, -1.4, 0]) cube([8, 2.8, 4]);                // the door
  cylinder(base = [0, 0, 4], axis = [1, 0, 0], r = 1.4, h = 8);
}
color(stone_a) difference() {
  intersection() {
    cylinder(h = h, r = r);
    union() {
      rotate([0, 0, 0]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
      rotate([0, 0, 120]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
      rotate([0, 0, 240]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
      rotate([0, 0, 107]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
      rotate([0, 0, 227]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
      rotate([0, 0, 347]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
      rotate([0, 0, 9]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
      rotate([0, 0, 129]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
      rotate([0, 0, 249]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
      rotate([0, 0, 91]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
      rotate([0, 0, 211]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
      rotate([0, 0, 331]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
      rotate([0, 0, 18]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
      rotate([0, 0, 138]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
      rotate([0, 0, 258]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
      rotate([0, 0, 100]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
      rotate([0, 0, 220]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
      rotate([0, 0, 340]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
      rotate([0, 0, 2]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
      rotate([0, 0, 122]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
      rotate([0, 0, 242]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
      rotate([0, 0, 109]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
      rotate([0, 0, 229]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
      rotate([0, 0, 349]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
      rotate([0, 0, 11]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
      rotate([0, 0, 131]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
      rotate([0, 0, 251]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
    }
  }
  cylinder(h = h, r = inner);
  translate([0, -1.4, 0]) cube([8, 2.8, 4]);
  cylinder(base = [0, 0, 4], axis = [1, 0, 0], r = 1.4, h = 8);
}
color(stone_b) difference() {
  intersection() {
    cylinder(h = h, r = r);
    union() {
      rotate([0, 0, 60]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
      rotate([0, 0, 180]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
      rotate([0, 0, 300]) translate([0, -1.1, 0]) cube([8, 2.2, 2]);
      rotate([0, 0, 47]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
      rotate([0, 0, 167]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
      rotate([0, 0, 287]) translate([0, -1.1, 2]) cube([8, 2.2, 2]);
      rotate([0, 0, 69]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
      rotate([0, 0, 189]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
      rotate([0, 0, 309]) translate([0, -1.1, 4]) cube([8, 2.2, 2]);
      rotate([0, 0, 31]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
      rotate([0, 0, 151]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
      rotate([0, 0, 271]) translate([0, -1.1, 6]) cube([8, 2.2, 2]);
      rotate([0, 0, 78]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
      rotate([0, 0, 198]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
      rotate([0, 0, 318]) translate([0, -1.1, 8]) cube([8, 2.2, 2]);
      rotate([0, 0, 40]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
      rotate([0, 0, 160]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
      rotate([0, 0, 280]) translate([0, -1.1, 10]) cube([8, 2.2, 2]);
      rotate([0, 0, 62]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
      rotate([0, 0, 182]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
      rotate([0, 0, 302]) translate([0, -1.1, 12]) cube([8, 2.2, 2]);
      rotate([0, 0, 49]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
      rotate([0, 0, 169]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
      rotate([0, 0, 289]) translate([0, -1.1, 14]) cube([8, 2.2, 2]);
      rotate([0, 0, 71]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
      rotate([0, 0, 191]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
      rotate([0, 0, 311]) translate([0, -1.1, 16]) cube([8, 2.2, 2]);
    }
  }
  cylinder(h = h, r = inner);
  translate([0, -1.4, 0]) cube([8, 2.8, 4]);
  cylinder(base = [0, 0, 4], axis = [1, 0, 0], r = 1.4, h = 8);
}
color(wall) translate([0, 0, h]) difference() {            // the crown: a corbel and eight merlons
  union() { cylinder(h = 1.5, r1 = r, r2 = 7); translate([0, 0, 1.5]) cylinder(h = 3.2, r = 7); }
  cylinder(h = 4.7, r = inner);
  translate([0, 0, 1.5]) cylinder(h = 3.2, r = 6);
  rotate([0, 0, 22.5]) translate([-8, -0.9, 2.9]) cube([16, 1.8, 1.8]);
  rotate([0, 0, 67.5]) translate([-8, -0.9, 2.9]) cube([16, 1.8, 1.8]);
  rotate([0, 0, 112.5]) translate([-8, -0.9, 2.9]) cube([16, 1.8, 1.8]);
  rotate([0, 0, 157.5]) translate([-8, -0.9, 2.9]) cube([16, 1.8, 1.8]);
}
color([0.55, 0.50, 0.44]) {                                 // steps, and the ground
  translate([0, -2.4, -0.5]) cube([8.6, 4.8, 0.5]);
  translate([0, 0, -1]) cylinder(h = 0.5, r = 9.5);
}
color([0.55, 0.62, 0.44]) translate([0, 0, -2]) cylinder(h = 1, r = 12);
color([0.40, 0.28, 0.20]) intersection() {                  // the door's leaf, inside the wall
  union() { translate([4.8, -1.4, 0]) cube([0.4, 2.8, 4]); cylinder(base = [4.8, 0, 4], axis = [1, 0, 0], r = 1.4, h = 0.4); }
  cylinder(h = h, r = r);
}
color([0.70, 0.32, 0.26]) {                                 // a flag
  translate([0, 0, h]) cylinder(h = 10, r = 0.2);
  translate([0, -0.06, h + 7.6]) wedge(size = [4, 0.12, 2.2]);
}
color([0.42, 0.33, 0.27]) translate([0, 0, h - 0.6]) cylinder(h = 0.6, r = inner);   // the platform
