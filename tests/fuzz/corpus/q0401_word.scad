cyllinder(h = 1);
union() { speher(1); }
sqrt(4);
flurb() { cube(1); qube(2); }
