cylinder(h=2,r1=[2,1],r2=[4,2]);ellipsoid([1,2,3],base=[1,1,1],axis=[1,2,3]);
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO