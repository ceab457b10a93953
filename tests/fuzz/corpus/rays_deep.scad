difference(){cube(8,center=true);difference(){sphere(3);difference(){cube(3,center=true);difference(){sphere(1);cube(0.5);}}}}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO