cube(1.2.3);
cube(1e);
cube(5abc);
cube(.);
