// Ten materials under three lights: the same ball, its finish going from chalk to glaze; in front, the metals.
background([0.80, 0.84, 0.87]);
camera(eye = [0, -33, 27], look = [0, 0.7, 1.0], up = [0, 0, 1], fov = 29);
light(at = [-20, -24, 34], color = [0.72, 0.69, 0.64]);
light(at = [26, -12, 18], color = [0.30, 0.34, 0.42]);
light(direction = [0.1, 0.6, -1], color = [0.18, 0.18, 0.18]);

// chalk
material(color = [0.93, 0.91, 0.87], ambient = 0.25, diffuse = 0.75, specular = 0)
  translate([-10, 4, 2]) sphere(2);
// terracotta
material(color = [0.72, 0.37, 0.27], ambient = 0.2, diffuse = 0.8, specular = 0.05, shininess = 4)
  translate([-5, 4, 2]) sphere(2);
// waxed
material(color = [0.47, 0.56, 0.42], ambient = 0.2, diffuse = 0.7, specular = 0.15, shininess = 10)
  translate([0, 4, 2]) sphere(2);
// lacquer
material(color = [0.25, 0.42, 0.62], ambient = 0.15, diffuse = 0.7, specular = 0.5, shininess = 40)
  translate([5, 4, 2]) sphere(2);
// glaze
material(color = [0.62, 0.20, 0.27], ambient = 0.15, diffuse = 0.65, specular = 0.9, shininess = 160)
  translate([10, 4, 2]) sphere(2);

// copper
material(color = [0.72, 0.45, 0.30], ambient = 0.2, diffuse = 0.45, specular = 0.45, shininess = 14)
  translate([-10, -3, 0]) cylinder(h = 3, r = 1.7);
// brass
material(color = [0.80, 0.64, 0.33], ambient = 0.2, diffuse = 0.45, specular = 0.6, shininess = 24)
  translate([-5, -3, 0]) cone(h = 4, r = 2);
// steel
material(color = [0.60, 0.63, 0.67], ambient = 0.2, diffuse = 0.4, specular = 0.7, shininess = 30)
  translate([0, -3, 0]) paraboloid(base = [0, 0, 0], axis = [0, 0, 1], h = 3.4, r = 2);
// silver
material(color = [0.86, 0.87, 0.88], ambient = 0.2, diffuse = 0.5, specular = 0.9, shininess = 90)
  translate([5, -3, 1.5]) hyperboloid(h = 1.5, r = 1.8, rc = 0.9);
// iron
material(color = [0.28, 0.28, 0.31], ambient = 0.2, diffuse = 0.5, specular = 0.35, shininess = 8)
  translate([10, -3, 1.6]) superquadric(r = [1.7, 1.7, 1.6], e = 0.4, n = 0.4);

material(color = [0.64, 0.65, 0.63], ambient = 0.25, diffuse = 0.75, specular = 0) halfspace(n = [0, 0, 1], d = 0);
