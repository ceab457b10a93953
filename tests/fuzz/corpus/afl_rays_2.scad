intersection(){cone(2,2);translate([0,0,2])rotate([180,0,7])cone(2,2);}
//@°OOOOSKOO¬OO1e-300SSSKKKOSOOSOWOOKOo