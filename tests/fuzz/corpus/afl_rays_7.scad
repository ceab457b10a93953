difference(){superquadric(1e4000,65);}
//@Oß_OOS@OSOOdifference(){superquadric([1e401,2,1],+5);}
//ÿ;}
//@matr