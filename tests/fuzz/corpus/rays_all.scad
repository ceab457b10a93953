union(){intersection(){cube(2);sphere(2);}difference(){cylinder(h=3,r=1);cone(3,1);}}
//@OOOOS¥SOO²SOOOSSS