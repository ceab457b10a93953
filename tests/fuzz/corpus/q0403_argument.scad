cube(size = 1, centre = true);
sphere(1, colour = "red");
render(convexity = 2) cube(1);
