camera(eye = [3, 3, 3]);
camera(eye = [4, 4, 4]);
background("white");
background([0, 0, 0]);
cube(1);
