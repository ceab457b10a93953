union() {
  cube(1);
  sphere(2;
  x = [1, 2;
