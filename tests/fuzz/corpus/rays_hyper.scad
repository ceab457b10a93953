difference(){hyperboloid(2,3,1);hyperboloid(h=2,r=1,gap=0.5);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO