difference(){superquadric([1,2,1],0.5,1.5);sphere(0.5);}
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO