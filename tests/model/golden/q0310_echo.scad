echo("v", v = [1, 1 / 3, "x"], true, undef, 1 / 0);
cube(1);
echo(sqrt(2), [PI], "two\nlines\t|");
