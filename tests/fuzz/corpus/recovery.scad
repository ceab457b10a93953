// every mistake of one file is told in one run, and none twice
width = 10
height = 4;
difference() {
  cube([width, height 3]);
  translate([1, 2, 3] sphere(r = widht);
  cylindre(h = heigth);
  rotate(45) { cube(1); }
}
sphere(2);
}
x = (1 + 2;
cube(x);
