"""The traps in which solid modellers fall: decimals, turned copies, near and flush faces, tangencies. Every answer here is known by hand."""
import itertools
from quoin import Case, main, run


class Traps(Case):
    def sides(self, model, points):
        text = "\n".join(" ".join(str(x) for x in p) for p in points)
        return self.good(run("query", model, stdin=text)).out.split()

    def ray(self, model, *ray, options=()):
        return self.good(run("ray", model, *options, *ray)).out.strip()

    def test_decimals_that_cancel(self):
        """8.1 - 9 + 0.9 is 0 in decimals and -3.3e-16 in doubles."""
        m = self.model("difference() { cube([10, 10, 1]); translate([5, 5, 8.1 - 9 + 0.9]) cylinder(h = 1, r = 1); }")
        self.assertEqual(self.ray(m, 5, 5, -5, 0, 0, 1), "0")
        self.assertEqual(self.ray(m, 2, 5, -5, 0, 0, 1), "1 5 6")
        self.assertEqual(self.sides(m, [(5, 5, 0), (5, 5, 1), (5, 6, 0.5), (5, 6.5, 0)]), ["outside", "outside", "boundary", "boundary"])

    def test_minus_its_turned_copy(self):
        for turn in ("rotate(90)", "rotate([90, 0, 0])", "rotate(a = 120, v = [1, 1, 1])", "rotate(30) rotate(60)"):
            for place in ("", "translate([0.1, 0.2, 0.3]) "):
                m = self.model(f"{place} difference() {{ cube(10, center = true); {turn} cube(10, center = true); }}")
                for ray in ((-20, 1, 2, 1, 0, 0), (-20, 5, 0, 1, 0, 0), (-20, -20, -20, 1, 1, 1), (5, 5, -20, 0, 0, 1)):
                    self.assertEqual(self.ray(m, *ray), "0", turn)
                self.assertEqual(set(self.sides(m, itertools.product((-5, 0, 5), repeat=3))), {"outside"}, turn)

    def test_near_is_not_equal(self):
        m = self.model("cube(1); translate([1 + 8.8e-11, 0, 0]) cube(1);")
        self.assertEqual(self.ray(m, -1, 0.5, 0.5, 1, 0, 0), "2 1 2 2.0000000000879998 3.0000000000879998")
        self.assertEqual(self.sides(m, [(1, 0.5, 0.5), ("1.00000000004", 0.5, 0.5), ("1.000000000088", 0.5, 0.5)]), ["boundary", "outside", "boundary"])
        r = self.good(run("check", m))
        self.assertIn("8.8e-11 from", r.err)
        self.assertIn("near_pairs 1\n", r.out)
        self.assertEqual(self.ray(m, -1, 0.5, 0.5, 1, 0, 0, options=("--snap", "1e-10")), "1 1 3.0000000000879998")

    def test_a_sphere_touches_a_plane(self):
        both = "sphere(10); translate([-20, -20, 10]) cube(40);"
        m = self.model("intersection() { %s }" % both)
        self.assertEqual(self.sides(m, [(0, 0, 10), (0, 0, 9), (0, 0, 11)]), ["outside"] * 3)
        self.assertEqual(self.ray(m, 0, 0, -20, 0, 0, 1), "0")
        m = self.model("difference() { sphere(10); translate([-20, -20, 10]) cube(40); }")
        self.assertEqual(self.sides(m, [(0, 0, 10), (0, 0, 9)]), ["boundary", "inside"])
        self.assertEqual(self.ray(m, 0, 0, -20, 0, 0, 1), "1 10 30")
        m = self.model("sphere(10);")
        self.assertEqual(self.ray(m, -20, 0, 10, 1, 0, 0, options=("--contacts",)), "0 contacts 1 20")
        m = self.model(both)
        self.assertEqual(self.sides(m, [(0, 0, 10)]), ["boundary"])
        self.assertEqual(self.ray(m, 0, 0, -20, 0, 0, 1), "1 10 70")  # through the one point, without an end there

    def test_a_rounded_box(self):
        """Half sizes 3, rounded by 1: slabs, cylinders tangent to them, spheres tangent to those."""
        parts = [f"cube({size}, center = true);" for size in ([6, 4, 4], [4, 6, 4], [4, 4, 6])]
        for a, b in itertools.product((-2, 2), repeat=2):
            parts.append(f"translate([{a}, {b}, -2]) cylinder(h = 4, r = 1);")
            parts.append(f"translate([{a}, -2, {b}]) rotate([-90, 0, 0]) cylinder(h = 4, r = 1);")
            parts.append(f"translate([-2, {a}, {b}]) rotate([0, 90, 0]) cylinder(h = 4, r = 1);")
            parts += [f"translate([{a}, {b}, {c}]) sphere(1);" for c in (-2, 2)]
        m = self.model("\n".join(parts))
        self.assertEqual(self.ray(m, -10, 0, 0, 1, 0, 0), "1 7 13")  # no wall within
        self.assertEqual(self.ray(m, -10, 2, 0, 1, 0, 0), "1 7 13")  # along the tangents
        self.assertEqual(self.ray(m, -10, 2, 2, 1, 0, 0), "1 7 13")  # through centres of spheres
        self.assertEqual(self.ray(m, -10, 0, 3, 1, 0, 0, options=("--boundary",)), "0 boundary 1 8 12")  # in a face: flat to the tangents
        self.assertEqual(self.ray(m, 0, 0, 0, 1, 1, 1, options=("--from", "0")), "1 0 2.5773502691896257")  # 2 + 1/sqrt 3
        self.assertEqual(self.sides(m, [(2, 2, 2), (2, 2, 3), (2, 0, 3), (2, 0, 2), (2.6, 2.8, 0), (2.6, 2.8, 2), (3, 3, 0)]),
                         ["inside", "boundary", "boundary", "inside", "boundary", "boundary", "outside"])

    def test_a_clean_hole(self):
        m = self.model("difference() { cube([10, 10, 5]); translate([5, 5, 0]) cylinder(h = 5, r = 2); }")
        self.assertEqual(self.ray(m, 5, 5, -9, 0, 0, 1, options=("--contacts", "--boundary")), "0 boundary 0 contacts 0")
        self.assertEqual(self.sides(m, [(5, 5, 0), (5, 5, 5), (7, 5, 5), (6.2, 6.6, 0), (8, 5, 5)]), ["outside", "outside", "boundary", "boundary", "boundary"])
        self.assertIn("distinct_surfaces 7\n", self.good(run("check", m)).out)

    def test_a_menger_sponge(self):
        """Of the second level, 400 cubes in a grid of 9: every face lies in a plane with others."""
        def there(cell):
            return all(sum(c // s % 3 == 1 for c in cell) < 2 for s in (1, 3))
        cells = [c for c in itertools.product(range(9), repeat=3) if there(c)]
        self.assertEqual(len(cells), 400)
        m = self.model("\n".join(f"translate([{x} / 10, {y} / 10, {z} / 10]) cube(0.1);" for x, y, z in cells))
        r = self.good(run("check", m))
        self.assertIn("distinct_surfaces 30\nextent bounded\n", r.out)
        self.assertIn("near_pairs 0\n", r.out)
        kept = set(cells)
        grid = list(itertools.product(range(9), repeat=3))
        points, want = [], []
        for x, y, z in grid:
            points.append((f"{x / 10 + 0.05:.2f}", f"{y / 10 + 0.05:.2f}", f"{z / 10 + 0.05:.2f}"))
            want.append("inside" if (x, y, z) in kept else "outside")
            sides = ((x, y, z) in kept) + ((x - 1, y, z) in kept)  # the face between two cells
            points.append((f"0.{x}", f"{y / 10 + 0.05:.2f}", f"{z / 10 + 0.05:.2f}"))
            want.append(("outside", "boundary", "inside")[sides])
            around = sum((x - a, y - b, z - c) in kept for a, b, c in itertools.product((0, 1), repeat=3))  # the corner of eight cells
            points.append((f"0.{x}", f"0.{y}", f"0.{z}"))
            want.append("outside" if around == 0 else "inside" if around == 8 else "boundary")
        self.assertEqual(self.sides(m, points), want)
        self.assertEqual(self.ray(m, "0.45", "0.45", -1, 0, 0, 1), "0")
        self.assertEqual(self.ray(m, "0.05", "0.05", 0, 0, 0, 10), "1 0 0.089999999999999997")


if __name__ == "__main__":
    main()
