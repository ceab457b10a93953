// A hyperboloid of two sheets: a diabolo, its two cups on one axle. The hollows are the same kind of surface with a
// wider gap, capped in the same planes, so the rims are clean.
h = 7;  r = 6;

rotate([90, 0, 24]) {
  color([0.24, 0.45, 0.56]) difference() {
    hyperboloid(h = h, r = r, gap = 1.2);
    hyperboloid(h = h, r = r - 0.5, gap = 1.9);
  }
  color([0.86, 0.70, 0.38]) cylinder(h = 3.6, r = 0.7, center = true);
  color([0.86, 0.70, 0.38]) hyperboloid(h = 1.1, r = 1.5, rc = 0.95);
  // a band around each rim
  color([0.90, 0.55, 0.32]) difference() {
    cylinder(h = 2*h, r = r + 0.25, center = true);
    cylinder(h = 2*h - 1.2, r = 9, center = true);
    cylinder(h = 2*h, r = r - 0.5, center = true);
  }
}
