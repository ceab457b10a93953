name("a\qb") cube(1);
name("\x00") cube(1);
name("caf\u00e9 \x41") cube(1);
