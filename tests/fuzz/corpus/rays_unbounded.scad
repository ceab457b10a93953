difference(){halfspace([0,0,1],1);cylinder(h=1,r=0.25);sphere([1]);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO