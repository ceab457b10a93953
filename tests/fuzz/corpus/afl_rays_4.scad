difference(){hyperboloid(2,3,gap=2^-600.5);}
//@OOXOOSKOOSOOOPQSTUSSSKCKOSOOSOWOOK