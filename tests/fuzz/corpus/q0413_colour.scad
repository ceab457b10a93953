color("gren") cube(1);
color("#12345") cube(1);
color("#1234") cube(1);
color([-1, -1, -1, 1]) cube(1);
