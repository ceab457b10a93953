union(){paraboloid(2,2);translate([0,0,4])rotate([180,0,0])paraboloid(2,2);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO