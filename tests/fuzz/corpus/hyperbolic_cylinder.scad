// Hyperbolic cylinders, written as general quadrics x^2 - z^2/4 <= a^2 and y^2 - z^2/4 <= a^2: their meet is a square
// vase with a waist. The hollow is the same pair of surfaces, smaller.
a = 4;  i = 3.5;

color([0.30, 0.40, 0.58]) difference() {
  intersection() {
    quadric([1, 0, -1/4, 0, 0, 0, 0, 0, 0, -a*a]);
    quadric([0, 1, -1/4, 0, 0, 0, 0, 0, 0, -a*a]);
    translate([-10, -10, -8]) cube([20, 20, 19]);
  }
  intersection() {
    quadric([1, 0, -1/4, 0, 0, 0, 0, 0, 0, -i*i]);
    quadric([0, 1, -1/4, 0, 0, 0, 0, 0, 0, -i*i]);
    translate([-10, -10, -7]) cube([20, 20, 18]);
  }
}
color([0.86, 0.76, 0.55]) translate([-7, -7, -9]) cube([14, 14, 1]);
