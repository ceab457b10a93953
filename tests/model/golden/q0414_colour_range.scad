color([255, 0, 0]) cube(1);
color([0, 0, -1/256, 0.5]) cube(1);
color([-1, -1, -1, 1]) cube(1);
color([1, 0, 1]) cube(1);
color("red", 2) cube(1);
color([1, 0, 0, -1]) cube(1);
color("transparent") cube(1);
