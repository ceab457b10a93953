union(){cube(1);translate([1+2^-60,0,0])cube(1);translate([0,1+1e-30,0])cube(1);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO