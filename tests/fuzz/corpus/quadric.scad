// General quadrics: nothing here is rotated. The bore along the cube's diagonal a = [-1, -1, 1] is the cylinder of radius
// r
//     x^2 + y^2 + z^2 - xy + xz + yz <= (3/2) r^2
// by its ten coefficients. The ellipsoid in it is x'Qx <= 0 with Q = 4 - aa' (a symmetric matrix): 8 long and 4 across
// along a, so it touches the bore in a circle.
r = 4;  s = 12;

difference() {
  color([0.82, 0.78, 0.69]) translate([-s/2, -s/2, -s/2]) cube(s);
  color([0.76, 0.42, 0.32]) quadric([1, 1, 1, -1, 1, 1, 0, 0, 0, -1.5*r*r]);
}
color([0.27, 0.48, 0.54]) quadric(matrix = [[ 3, -1,  1,   0],
                                            [-1,  3,  1,   0],
                                            [ 1,  1,  3,   0],
                                            [ 0,  0,  0, -64]]);
