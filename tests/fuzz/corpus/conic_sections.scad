// Four cones, each cut by one plane: circle, ellipse, parabola, hyperbola. The face takes the colour of the half-space
// that cut it. The planes face the viewer along [3, -4]; the generators fall 2 for 1, so [6, -8, 5] is exactly parallel
// to one of them.
r = 6;  h = 12;
wood = [0.64, 0.46, 0.33];

intersection() {                                                      // across the axis: a circle
  color(wood) cone(h = h, r = r);
  color([0.93, 0.86, 0.70]) halfspace(n = [0, 0, 1], d = 5);
}
translate([12, 9, 0]) intersection() {                                // flatter than the generators: an ellipse
  color(wood) cone(h = h, r = r);
  color([0.78, 0.38, 0.31]) halfspace(n = [3, -4, 10], d = 44);
}
translate([-9, 12, 0]) intersection() {                               // parallel to a generator: a parabola
  color(wood) cone(h = h, r = r);
  color([0.85, 0.63, 0.34]) halfspace(n = [6, -8, 5], d = 30);
}
translate([3, 21, 0]) intersection() {                                // steeper: a hyperbola
  color(wood) cone(h = h, r = r);
  color([0.29, 0.50, 0.54]) halfspace(n = [3, -4, 0], d = 9);
}
