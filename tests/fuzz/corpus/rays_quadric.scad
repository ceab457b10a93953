intersection(){quadric([1,1,-1,0,0,0,0,0,0,0]);cube(4,center=true);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO