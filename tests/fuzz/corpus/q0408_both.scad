sphere(r = 1, d = 4);
cylinder(h = 1, r = 2, r1 = 3);
rotate([0, 0, 30], [1, 1, 1]) cube(1);
quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -1], matrix = [[1]]);
