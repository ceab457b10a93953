rotate([00,91]) intersection(){saddle(111e-4000);saddle(121);cube(importer=true);}
//@OOOO,SKOOSOd;cube(importer=tÿue);}
//@OSOOSOWÿ0.6