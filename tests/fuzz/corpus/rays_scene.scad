camera(eye=[3,3,3]);light(at=[1,2,3]);color("red")material(shininess=3)name("a")cube(1);background([1,1,1]);
//@OOOOOSKOOSOOOPQSTUSSSKKKOSOOSOWOOKOO