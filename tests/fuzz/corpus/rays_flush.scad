difference(){cube([4,4,4],center=true);translate([0,0,-2])cylinder(h=4,r=1);}
//@SOKOOSOOSOOSOOO