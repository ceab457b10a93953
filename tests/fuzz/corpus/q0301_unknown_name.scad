width = 4;
cube(widht);
sphere(radius);
cube(sphere);
