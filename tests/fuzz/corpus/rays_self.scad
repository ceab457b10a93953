difference(){rotate([10,20,30])cube(2);rotate([10,20,30])translate([0,0,1])cube(2);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO