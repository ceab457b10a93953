union(){cube(1);translate([1,0,0])cube(1);translate([0,1,0])cube(1);translate([0.5,0.5,1])sphere(0.5);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO