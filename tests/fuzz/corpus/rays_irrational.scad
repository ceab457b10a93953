union(){rotate(30)cube(sqrt(2));rotate([0,0,30])translate([sqrt(2),0,0])cube(sqrt(2));}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO