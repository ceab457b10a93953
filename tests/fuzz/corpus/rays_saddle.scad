intersection(){saddle(1,1);cube(3,center=true);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO