difference(){cylinder(h=1,r=2,$fn=6);cylinder(h=1,r=1,$fn=3);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO