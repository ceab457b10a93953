// Nothing is left.
intersection() { cube(1); translate([3, 0, 0]) cube(1); }
