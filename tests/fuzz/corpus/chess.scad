// Chess pieces of quadrics on a board of flush squares: a pawn, a bishop, a rook and a knight. Feet are cylinders and
// ellipsoids, stems are hyperboloids whose lower end stands on the foot.
light_wood = [0.90, 0.78, 0.58];  dark_wood = [0.45, 0.29, 0.20];
ivory = [0.93, 0.88, 0.78];  ebony = [0.25, 0.22, 0.24];

// --- the board: two by four squares of side 6, each touching its neighbours -----------------------------------------
color(dark_wood) {
  translate([0, 0, -1]) cube([6, 6, 1]);   translate([12, 0, -1]) cube([6, 6, 1]);
  translate([6, 6, -1]) cube([6, 6, 1]);   translate([18, 6, -1]) cube([6, 6, 1]);
}
color(light_wood) {
  translate([6, 0, -1]) cube([6, 6, 1]);   translate([18, 0, -1]) cube([6, 6, 1]);
  translate([0, 6, -1]) cube([6, 6, 1]);   translate([12, 6, -1]) cube([6, 6, 1]);
}
color([0.33, 0.21, 0.15]) difference() {
  translate([-1, -1, -1.3]) cube([26, 14, 1.3]);
  translate([0, 0, -1]) cube([24, 12, 1]);
}

// --- pawn ---------------------------------------------------------------------------------------------------------
color(ivory) translate([3, 3, 0]) {
  cylinder(h = 0.6, r = 2.1);
  translate([0, 0, 0.6]) intersection() { ellipsoid(r = [2.0, 2.0, 0.9]); halfspace(n = [0, 0, -1], d = 0); }
  translate([0, 0, 3.1]) hyperboloid(h = 1.9, r = 1.35, rc = 0.7);
  translate([0, 0, 4.6]) ellipsoid(r = [1.35, 1.35, 0.3]);
  translate([0, 0, 5.6]) sphere(1.15);
}

// --- bishop: a slot sawn into the mitre ---------------------------------------------------------------------------
color(ivory) translate([15, 3, 0]) {
  cylinder(h = 0.6, r = 2.2);
  translate([0, 0, 0.6]) intersection() { ellipsoid(r = [2.1, 2.1, 1.1]); halfspace(n = [0, 0, -1], d = 0); }
  translate([0, 0, 3.9]) hyperboloid(h = 2.7, r = 1.4, rc = 0.7);
  translate([0, 0, 6.2]) ellipsoid(r = [1.5, 1.5, 0.3]);
  translate([0, 0, 6.7]) ellipsoid(r = [1.2, 1.2, 0.25]);
  difference() {
    translate([0, 0, 8.2]) ellipsoid(r = [1.15, 1.15, 1.6]);
    translate([0.5, -0.35, 8.6]) rotate([0, 35, 0]) translate([-0.13, -2, 0]) cube([0.26, 4, 3]);
  }
  translate([0, 0, 9.95]) sphere(0.36);
}

// --- rook: battlements cut by three bars --------------------------------------------------------------------------
color(ebony) translate([9, 9, 0]) {
  cylinder(h = 0.7, r = 2.3);
  translate([0, 0, 0.7]) intersection() { ellipsoid(r = [2.15, 2.15, 1.0]); halfspace(n = [0, 0, -1], d = 0); }
  translate([0, 0, 3.4]) hyperboloid(h = 2.4, r = 1.7, rc = 1.15);
  difference() {
    translate([0, 0, 5.4]) cylinder(h = 1.8, r1 = 1.6, r2 = 1.9);
    translate([0, 0, 6.2]) cylinder(h = 1, r = 1.25);
    translate([-3, -0.25, 6.5]) cube([6, 0.5, 0.7]);
    rotate([0, 0, 60]) translate([-3, -0.25, 6.5]) cube([6, 0.5, 0.7]);
    rotate([0, 0, 120]) translate([-3, -0.25, 6.5]) cube([6, 0.5, 0.7]);
  }
}

// --- knight: a slab of a few ellipsoids, its mane the rim of a cylinder ------------------------------------------------
color(ebony) translate([21, 9, 0]) {
  cylinder(h = 0.7, r = 2.3);
  translate([0, 0, 0.7]) intersection() { ellipsoid(r = [2.15, 2.15, 1.0]); halfspace(n = [0, 0, -1], d = 0); }
  rotate([0, 0, -130]) difference() {
    intersection() {
      union() {
        translate([-0.2, 0, 3.6]) rotate([0, -8, 0]) ellipsoid(r = [1.75, 1.3, 3.4]);          // neck and chest
        translate([1.1, 0, 6.1]) rotate([0, 32, 0]) ellipsoid(r = [2.1, 0.95, 1.0]);           // head
        translate([-0.35, 0, 5.6]) cylinder(base = [0, -0.28, 0], axis = [0, 1, 0], r = 1.95, h = 0.56); // mane
        cone(base = [0.15, 0.5, 6.8], axis = [-0.12, 0.15, 1], r = 0.42, h = 1.5);             // ears
        cone(base = [0.15, -0.5, 6.8], axis = [-0.12, -0.15, 1], r = 0.42, h = 1.5);
      }
      halfspace(n = [0, 0, -1], d = -0.7);
    }
    translate([1.9, 0, 3.3]) cylinder(base = [0, -2, 0], axis = [0, 1, 0], r = 1.35, h = 4);   // the throat
    translate([2.1, -2, 5.15]) rotate([0, 38, 0]) cube([2, 4, 0.16]);                          // the mouth
    translate([1.05, 0.95, 6.55]) sphere(0.2);                                                 // eyes
    translate([1.05, -0.95, 6.55]) sphere(0.2);
  }
}

camera(eye = [33, -27, 24], look = [12.3, 5.2, 2.0], fov = 30);
light(direction = [0.75, 0.62, -1.25], color = [0.85, 0.83, 0.8]);
light(direction = [-1, 0.9, -0.5], color = [0.28, 0.29, 0.32]);
