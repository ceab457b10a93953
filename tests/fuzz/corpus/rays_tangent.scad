union(){sphere(1);translate([2,0,0])sphere(1);translate([0,2,0])cylinder(h=2,r=1,center=true);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO