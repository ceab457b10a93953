scale([1,1,1e-9])sphere(3);translate([0,0,2])scale([1e9,1,1])cube(1);
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO