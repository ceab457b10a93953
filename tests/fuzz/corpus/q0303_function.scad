cube(sqr(4));
cube(sphere(4));
cube(nothing_like_it(1));
