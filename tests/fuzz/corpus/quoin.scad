// A quoin is the dressed stone that makes a corner true: large stones, turned in alternate courses, bond two walls of brick.
// Everything is flush: stones touch bricks and each other in shared planes, without mortar and without a gap.
t = 4;  course = 2.4;  long = 7;
stone_a = [0.86, 0.81, 0.71];  stone_b = [0.79, 0.73, 0.63];
brick_a = [0.68, 0.38, 0.30];  brick_b = [0.74, 0.45, 0.35];  brick_c = [0.61, 0.34, 0.28];

color(stone_a) translate([-long, 0, 0*course]) cube([long, t, course]);
color(stone_b) translate([-t, 0, 1*course]) cube([t, long, course]);
color(stone_a) translate([-long, 0, 2*course]) cube([long, t, course]);
color(stone_b) translate([-t, 0, 3*course]) cube([t, long, course]);
color(stone_a) translate([-long, 0, 4*course]) cube([long, t, course]);
color(stone_b) translate([-t, 0, 5*course]) cube([t, long, course]);
color(stone_a) translate([-long, 0, 6*course]) cube([long, t, course]);
color(stone_b) translate([-t, 0, 7*course]) cube([t, long, course]);
// bricks: three to a stone's height, bonded; each is 0.8 high
color(brick_a) {
  translate([-10, 0, 0]) cube([3, t, 0.8]); translate([-13, 0, 0]) cube([3, t, 0.8]);
  translate([-t, 7, 0]) cube([t, 3, 0.8]); translate([-16, 0, 0.8]) cube([1.5, t, 0.8]);
  translate([-t, 11.5, 0.8]) cube([t, 3, 0.8]); translate([-t, 14.5, 0.8]) cube([t, 1.5, 0.8]);
  translate([-t, 4, 1.6]) cube([t, 3, 0.8]); translate([-t, 7, 1.6]) cube([t, 3, 0.8]);
  translate([-t, 8.5, 2.4]) cube([t, 3, 0.8]); translate([-7, 0, 3.2]) cube([3, t, 0.8]);
  translate([-16, 0, 3.2]) cube([3, t, 0.8]); translate([-t, 10, 3.2]) cube([t, 3, 0.8]);
  translate([-14.5, 0, 4]) cube([3, t, 0.8]); translate([-16, 0, 4]) cube([1.5, t, 0.8]);
  translate([-t, 8.5, 4]) cube([t, 3, 0.8]); translate([-t, 7, 4.8]) cube([t, 3, 0.8]);
  translate([-t, 10, 4.8]) cube([t, 3, 0.8]); translate([-t, 8.5, 5.6]) cube([t, 3, 0.8]);
  translate([-t, 14.5, 5.6]) cube([t, 1.5, 0.8]); translate([-16, 0, 6.4]) cube([3, t, 0.8]);
  translate([-11.5, 0, 7.2]) cube([3, t, 0.8]); translate([-14.5, 0, 7.2]) cube([3, t, 0.8]);
  translate([-t, 14.5, 7.2]) cube([t, 1.5, 0.8]); translate([-7, 0, 8]) cube([3, t, 0.8]);
  translate([-t, 7, 8.8]) cube([t, 1.5, 0.8]); translate([-t, 8.5, 8.8]) cube([t, 3, 0.8]);
  translate([-t, 11.5, 8.8]) cube([t, 3, 0.8]); translate([-t, 4, 9.6]) cube([t, 3, 0.8]);
  translate([-11.5, 0, 10.4]) cube([3, t, 0.8]); translate([-t, 4, 10.4]) cube([t, 1.5, 0.8]);
  translate([-t, 5.5, 10.4]) cube([t, 3, 0.8]); translate([-t, 11.5, 10.4]) cube([t, 3, 0.8]);
  translate([-t, 14.5, 10.4]) cube([t, 1.5, 0.8]); translate([-13, 0, 11.2]) cube([3, t, 0.8]);
  translate([-16, 0, 11.2]) cube([3, t, 0.8]); translate([-t, 4, 11.2]) cube([t, 3, 0.8]);
  translate([-t, 13, 11.2]) cube([t, 3, 0.8]); translate([-t, 8.5, 12]) cube([t, 3, 0.8]);
  translate([-8.5, 0, 13.6]) cube([3, t, 0.8]); translate([-10, 0, 14.4]) cube([3, t, 0.8]);
  translate([-t, 10, 14.4]) cube([t, 3, 0.8]); translate([-t, 13, 14.4]) cube([t, 3, 0.8]);
  translate([-11.5, 0, 15.2]) cube([3, t, 0.8]); translate([-14.5, 0, 15.2]) cube([3, t, 0.8]);
  translate([-16, 0, 15.2]) cube([1.5, t, 0.8]); translate([-t, 4, 15.2]) cube([t, 1.5, 0.8]);
  translate([-t, 5.5, 15.2]) cube([t, 3, 0.8]); translate([-t, 8.5, 15.2]) cube([t, 3, 0.8]);
  translate([-10, 0, 16]) cube([3, t, 0.8]); translate([-t, 7, 16]) cube([t, 3, 0.8]);
  translate([-t, 13, 16]) cube([t, 3, 0.8]); translate([-5.5, 0, 16.8]) cube([1.5, t, 0.8]);
  translate([-10, 0, 17.6]) cube([3, t, 0.8]); translate([-13, 0, 17.6]) cube([3, t, 0.8]);
  translate([-16, 0, 17.6]) cube([3, t, 0.8]); translate([-t, 7, 17.6]) cube([t, 3, 0.8]);
  translate([-t, 10, 17.6]) cube([t, 3, 0.8]); translate([-8.5, 0, 18.4]) cube([3, t, 0.8]);
}
color(brick_b) {
  translate([-16, 0, 0]) cube([3, t, 0.8]); translate([-t, 4, 0]) cube([t, 3, 0.8]);
  translate([-t, 10, 0]) cube([t, 3, 0.8]); translate([-t, 13, 0]) cube([t, 3, 0.8]);
  translate([-8.5, 0, 0.8]) cube([1.5, t, 0.8]); translate([-14.5, 0, 0.8]) cube([3, t, 0.8]);
  translate([-t, 4, 0.8]) cube([t, 1.5, 0.8]); translate([-t, 5.5, 0.8]) cube([t, 3, 0.8]);
  translate([-10, 0, 1.6]) cube([3, t, 0.8]); translate([-13, 0, 1.6]) cube([3, t, 0.8]);
  translate([-t, 10, 1.6]) cube([t, 3, 0.8]); translate([-t, 13, 1.6]) cube([t, 3, 0.8]);
  translate([-14.5, 0, 2.4]) cube([3, t, 0.8]); translate([-16, 0, 2.4]) cube([1.5, t, 0.8]);
  translate([-t, 7, 2.4]) cube([t, 1.5, 0.8]); translate([-t, 11.5, 2.4]) cube([t, 3, 0.8]);
  translate([-10, 0, 3.2]) cube([3, t, 0.8]); translate([-t, 7, 3.2]) cube([t, 3, 0.8]);
  translate([-t, 13, 3.2]) cube([t, 3, 0.8]); translate([-5.5, 0, 4]) cube([1.5, t, 0.8]);
  translate([-8.5, 0, 4]) cube([3, t, 0.8]); translate([-t, 14.5, 4]) cube([t, 1.5, 0.8]);
  translate([-10, 0, 4.8]) cube([3, t, 0.8]); translate([-13, 0, 4.8]) cube([3, t, 0.8]);
  translate([-t, 13, 4.8]) cube([t, 3, 0.8]); translate([-14.5, 0, 5.6]) cube([3, t, 0.8]);
  translate([-16, 0, 5.6]) cube([1.5, t, 0.8]); translate([-t, 5.5, 5.6]) cube([t, 3, 0.8]);
  translate([-t, 11.5, 5.6]) cube([t, 3, 0.8]); translate([-10, 0, 6.4]) cube([3, t, 0.8]);
  translate([-13, 0, 6.4]) cube([3, t, 0.8]); translate([-t, 4, 6.4]) cube([t, 3, 0.8]);
  translate([-t, 7, 6.4]) cube([t, 3, 0.8]); translate([-t, 10, 6.4]) cube([t, 3, 0.8]);
  translate([-t, 13, 6.4]) cube([t, 3, 0.8]); translate([-16, 0, 7.2]) cube([1.5, t, 0.8]);
  translate([-t, 8.5, 7.2]) cube([t, 3, 0.8]); translate([-10, 0, 8]) cube([3, t, 0.8]);
  translate([-16, 0, 8]) cube([3, t, 0.8]); translate([-t, 7, 8]) cube([t, 3, 0.8]);
  translate([-t, 13, 8]) cube([t, 3, 0.8]); translate([-13, 0, 9.6]) cube([3, t, 0.8]);
  translate([-t, 10, 9.6]) cube([t, 3, 0.8]); translate([-t, 13, 9.6]) cube([t, 3, 0.8]);
  translate([-16, 0, 10.4]) cube([1.5, t, 0.8]); translate([-t, 8.5, 10.4]) cube([t, 3, 0.8]);
  translate([-5.5, 0, 12]) cube([1.5, t, 0.8]); translate([-14.5, 0, 12]) cube([3, t, 0.8]);
  translate([-16, 0, 12]) cube([1.5, t, 0.8]); translate([-t, 14.5, 12]) cube([t, 1.5, 0.8]);
  translate([-10, 0, 12.8]) cube([3, t, 0.8]); translate([-13, 0, 12.8]) cube([3, t, 0.8]);
  translate([-16, 0, 12.8]) cube([3, t, 0.8]); translate([-5.5, 0, 13.6]) cube([1.5, t, 0.8]);
  translate([-11.5, 0, 13.6]) cube([3, t, 0.8]); translate([-14.5, 0, 13.6]) cube([3, t, 0.8]);
  translate([-t, 8.5, 13.6]) cube([t, 3, 0.8]); translate([-16, 0, 14.4]) cube([3, t, 0.8]);
  translate([-t, 7, 14.4]) cube([t, 3, 0.8]); translate([-t, 11.5, 15.2]) cube([t, 3, 0.8]);
  translate([-13, 0, 16]) cube([3, t, 0.8]); translate([-t, 4, 16]) cube([t, 3, 0.8]);
  translate([-8.5, 0, 16.8]) cube([3, t, 0.8]); translate([-11.5, 0, 16.8]) cube([3, t, 0.8]);
  translate([-14.5, 0, 16.8]) cube([3, t, 0.8]); translate([-t, 7, 16.8]) cube([t, 1.5, 0.8]);
  translate([-t, 8.5, 16.8]) cube([t, 3, 0.8]); translate([-t, 11.5, 16.8]) cube([t, 3, 0.8]);
  translate([-7, 0, 17.6]) cube([3, t, 0.8]); translate([-t, 13, 17.6]) cube([t, 3, 0.8]);
  translate([-11.5, 0, 18.4]) cube([3, t, 0.8]); translate([-t, 14.5, 18.4]) cube([t, 1.5, 0.8]);
}
color(brick_c) {
  translate([-11.5, 0, 0.8]) cube([3, t, 0.8]); translate([-t, 8.5, 0.8]) cube([t, 3, 0.8]);
  translate([-16, 0, 1.6]) cube([3, t, 0.8]); translate([-5.5, 0, 2.4]) cube([1.5, t, 0.8]);
  translate([-8.5, 0, 2.4]) cube([3, t, 0.8]); translate([-11.5, 0, 2.4]) cube([3, t, 0.8]);
  translate([-t, 14.5, 2.4]) cube([t, 1.5, 0.8]); translate([-13, 0, 3.2]) cube([3, t, 0.8]);
  translate([-11.5, 0, 4]) cube([3, t, 0.8]); translate([-t, 7, 4]) cube([t, 1.5, 0.8]);
  translate([-t, 11.5, 4]) cube([t, 3, 0.8]); translate([-16, 0, 4.8]) cube([3, t, 0.8]);
  translate([-t, 4, 4.8]) cube([t, 3, 0.8]); translate([-8.5, 0, 5.6]) cube([1.5, t, 0.8]);
  translate([-11.5, 0, 5.6]) cube([3, t, 0.8]); translate([-t, 4, 5.6]) cube([t, 1.5, 0.8]);
  translate([-5.5, 0, 7.2]) cube([1.5, t, 0.8]); translate([-8.5, 0, 7.2]) cube([3, t, 0.8]);
  translate([-t, 7, 7.2]) cube([t, 1.5, 0.8]); translate([-t, 11.5, 7.2]) cube([t, 3, 0.8]);
  translate([-13, 0, 8]) cube([3, t, 0.8]); translate([-t, 10, 8]) cube([t, 3, 0.8]);
  translate([-5.5, 0, 8.8]) cube([1.5, t, 0.8]); translate([-8.5, 0, 8.8]) cube([3, t, 0.8]);
  translate([-11.5, 0, 8.8]) cube([3, t, 0.8]); translate([-14.5, 0, 8.8]) cube([3, t, 0.8]);
  translate([-16, 0, 8.8]) cube([1.5, t, 0.8]); translate([-t, 14.5, 8.8]) cube([t, 1.5, 0.8]);
  translate([-10, 0, 9.6]) cube([3, t, 0.8]); translate([-16, 0, 9.6]) cube([3, t, 0.8]);
  translate([-t, 7, 9.6]) cube([t, 3, 0.8]); translate([-8.5, 0, 10.4]) cube([1.5, t, 0.8]);
  translate([-14.5, 0, 10.4]) cube([3, t, 0.8]); translate([-10, 0, 11.2]) cube([3, t, 0.8]);
  translate([-t, 7, 11.2]) cube([t, 3, 0.8]); translate([-t, 10, 11.2]) cube([t, 3, 0.8]);
  translate([-8.5, 0, 12]) cube([3, t, 0.8]); translate([-11.5, 0, 12]) cube([3, t, 0.8]);
  translate([-t, 7, 12]) cube([t, 1.5, 0.8]); translate([-t, 11.5, 12]) cube([t, 3, 0.8]);
  translate([-7, 0, 12.8]) cube([3, t, 0.8]); translate([-t, 7, 12.8]) cube([t, 3, 0.8]);
  translate([-t, 10, 12.8]) cube([t, 3, 0.8]); translate([-t, 13, 12.8]) cube([t, 3, 0.8]);
  translate([-16, 0, 13.6]) cube([1.5, t, 0.8]); translate([-t, 7, 13.6]) cube([t, 1.5, 0.8]);
  translate([-t, 11.5, 13.6]) cube([t, 3, 0.8]); translate([-t, 14.5, 13.6]) cube([t, 1.5, 0.8]);
  translate([-13, 0, 14.4]) cube([3, t, 0.8]); translate([-t, 4, 14.4]) cube([t, 3, 0.8]);
  translate([-8.5, 0, 15.2]) cube([1.5, t, 0.8]); translate([-t, 14.5, 15.2]) cube([t, 1.5, 0.8]);
  translate([-16, 0, 16]) cube([3, t, 0.8]); translate([-t, 10, 16]) cube([t, 3, 0.8]);
  translate([-16, 0, 16.8]) cube([1.5, t, 0.8]); translate([-t, 14.5, 16.8]) cube([t, 1.5, 0.8]);
  translate([-5.5, 0, 18.4]) cube([1.5, t, 0.8]); translate([-14.5, 0, 18.4]) cube([3, t, 0.8]);
  translate([-16, 0, 18.4]) cube([1.5, t, 0.8]); translate([-t, 7, 18.4]) cube([t, 1.5, 0.8]);
  translate([-t, 8.5, 18.4]) cube([t, 3, 0.8]); translate([-t, 11.5, 18.4]) cube([t, 3, 0.8]);
}
// a plinth below, a cornice above with a cavetto: a quarter of a cylinder hollowed out along each wall
color(stone_a) {
  translate([-16, -0.8, -1.6]) cube([16.8, t + 0.8, 1.6]);
  translate([-t, -0.8, -1.6]) cube([t + 0.8, 16.8, 1.6]);
}
color(stone_a) translate([0, 0, 8*course]) difference() {
  union() {
    translate([-16, -1.2, 0]) cube([17.2, t + 1.2, 2]);
    translate([-t, -1.2, 0]) cube([t + 1.2, 17.2, 2]);
  }
  cylinder(base = [-16, -1.2, 0], axis = [1, 0, 0], r = 1.2, h = 18);
  cylinder(base = [1.2, -2, 0], axis = [0, 1, 0], r = 1.2, h = 19);
}
