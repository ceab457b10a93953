cube(1, true, 3, 4);
