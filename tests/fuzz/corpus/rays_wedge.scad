union(){wedge([1,2,3]);translate([1,0,0])mirror([1,0,0])wedge([1,2,3]);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO