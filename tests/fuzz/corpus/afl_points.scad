// F shared within and across decimals, sides tupned, quadrics in several writings.
cube([0.3, 1, 1]);
translate([0.1 + 0.2, 0, 0]) cube([0.7, 1, 1]);
sphere(2);
ellipsoid(r = [2, 2, 2]);
quadric([-1, -1, -1, 0, 0, 0, 0, 0, 0, 0], d = -2);
