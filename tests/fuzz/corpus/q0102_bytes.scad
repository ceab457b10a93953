cube(1);
sphere(2) Â§;
cylinder(â€œ1â€);
// ÿ in a comment is no matter
name("aÿb") cube(1);
cube(şÿ);
