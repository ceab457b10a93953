scale([1, 0, 1]) cube(1);
multmatrix([[1, 2, 3], [2, 4, 6], [0, 0, 1]]) cube(1);
