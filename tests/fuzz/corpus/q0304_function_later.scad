cube(len(str(4)));
