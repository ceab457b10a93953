include <lib/parts.scad>
use <more.scad>;
part_of_lib(3);
cube(value_of_lib);
