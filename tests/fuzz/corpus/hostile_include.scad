include <hostile_include.scad>
use <hostile_include.scad>
cube(1);