"""quoin ray."""
import json
import random
from quoin import Case, main, run

TWO = 'name("a") cube(1); name("b") translate([3, 0, 0]) cube(1);'


class Text(Case):
    def test_line(self):
        m = self.model(TWO)
        self.good(run("ray", m, -1, 0.5, 0.5, 1, 0, 0), "2 1 2 4 5\n")
        self.good(run("ray", m, -1, 0.5, 0.5, -2, 0, 0), "2 -2.5 -2 -1 -0.5\n")
        self.good(run("ray", m, -1, 5, 5, 1, 0, 0), "0\n")
        self.good(run("ray", m, stdin="-1 .5 .5 1 0 0 # one\n\n0.5,0.5,-7,0,0,2\n"), "2 1 2 4 5\n1 3.5 4\n")

    def test_numbers_are_rounded_to_nearest(self):
        self.good(run("ray", self.model("cube(1);"), 0, 0.5, 0.5, 3, 0, 0), "1 0 0.33333333333333331\n")
        # sqrt(2) is 1.4142135623730950488..., its nearest double prints as 1.4142135623730951.
        self.good(run("ray", self.model("sphere(2);"), 1, 1, 0, 0, 0, 1), "1 -1.4142135623730951 1.4142135623730951\n")

    def test_infinite(self):
        m = self.model("halfspace(n = [1, 0, 0], d = 2);")
        self.good(run("ray", m, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 1),
                  "1 -inf 2\n1 -2 inf\n1 -inf inf\n0\n")
        r = self.good(run("ray", m, "--json", 0, 0, 0, 1, 0, 0))
        self.assertEqual(json.loads(r.out), {"inside": [{"enter": {"t": "-inf"}, "leave": {"t": 2}}]})

    def test_from_to(self):
        m = self.model(TWO)
        ray = [-1, 0.5, 0.5, 1, 0, 0]
        self.good(run("ray", m, "--from", 0, *ray), "2 1 2 4 5\n")
        self.good(run("ray", m, "--from", "1.5", *ray), "2 1.5 2 4 5\n")
        self.good(run("ray", m, "--to=1.5", *ray), "1 1 1.5\n")
        self.good(run("ray", m, "--from", "-inf", "--to", "inf", *ray), "2 1 2 4 5\n")
        self.good(run("ray", m, "--from", "-3", "--to", "0.999", *ray), "0\n")
        self.good(run("ray", m, "--from", 0, -1, 0.5, 0.5, -1, 0, 0), "0\n")
        self.good(run("ray", self.model("translate([0.1, 0, 0]) cube(1);"), "--from", "0.1", "--to", "0.2", 0, 0.5, 0.5, 1, 0, 0),
                  "1 0.10000000000000001 0.20000000000000001\n")
        for option in ("--from", "--to"):
            self.bad(run("ray", m, option, "x", *ray), 2, option, "'x'")
        self.bad(run("ray", m, "--from", 2, "--to", 1, *ray), 2, "beyond")

    def test_surfaces(self):
        m = self.model('name("pin") cylinder(h = 2, r = 1);')
        self.good(run("ray", m, "--surfaces", -2, 0, 1, 1, 0, 0), "1\t1\tpin\tbody\t3\tpin\tbody\n")
        self.good(run("ray", m, "--surfaces", 0, 0, -1, 0, 0, 1), "1\t1\tpin\tcap0\t3\tpin\tcap1\n")
        self.good(run("ray", m, "--surfaces", "--from", 2, 0, 0, -1, 0, 0, 1), "1\t2\t-\t-\t3\tpin\tcap1\n")
        r = self.good(run("ray", self.model('name("a b") cube(1);'), "--surfaces", -1, 0.5, 0.5, 1, 0, 0))
        count, t0, name0, face0, t1, name1, face1 = r.out.rstrip("\n").split("\t")
        self.assertEqual((count, t0, name0, t1, name1), ("1", "1", "a b", "2", "a b"))
        self.assertRegex(face0, r"^face \d+$")
        self.assertRegex(face1, r"^face \d+$")
        self.assertNotEqual(face0, face1)

    def test_a_cut_is_named_after_what_cuts(self):
        m = self.model('difference() { name("block") cube(3); name("drill") translate([1.5, 1.5, 0]) cylinder(h = 3, r = 1); }')
        self.good(run("ray", m, "--json", "--surfaces", -1, 1.5, 1.5, 1, 0, 0))
        ends = json.loads(run("ray", m, "--json", "--surfaces", -1, 1.5, 1.5, 1, 0, 0).out)["inside"]
        self.assertEqual([(e["enter"]["t"], e["enter"]["part"], e["leave"]["t"], e["leave"]["part"], e["leave"]["surface"]) for e in ends[:1]],
                         [(1, "block", 1.5, "drill", "body")])

    def test_boundary(self):
        m = self.model("cube(1);")
        self.good(run("ray", m, "--boundary", -1, 0, 0.5, 1, 0, 0), "0 boundary 1 1 2\n")
        self.good(run("ray", m, -1, 0, 0.5, 1, 0, 0), "0\n")
        self.good(run("ray", m, "--boundary", -1, 0.5, 0.5, 1, 0, 0), "1 1 2 boundary 0\n")
        r = self.good(run("ray", m, "--boundary", "--json", -1, 0, 0.5, 1, 0, 0))
        self.assertEqual(json.loads(r.out), {"inside": [], "boundary": [{"enter": {"t": 1}, "leave": {"t": 2}}]})
        # The wall between two boxes that share a face is no boundary.
        two = self.model("cube(1); translate([0, -1, 0]) cube(1);")
        self.good(run("ray", two, "--boundary", -1, 0, 0.5, 1, 0, 0), "1 1 2 boundary 0\n")

    def test_contacts(self):
        m = self.model("sphere(5);")
        self.good(run("ray", m, "--contacts", -7, 5, 0, 1, 0, 0), "0 contacts 1 7\n")
        self.good(run("ray", m, "--contacts", -7, 3, 4, 1, 0, 0), "0 contacts 1 7\n")
        self.good(run("ray", m, "--boundary", "--contacts", -7, 3, 4, 1, 0, 0), "0 boundary 0 contacts 1 7\n")
        self.good(run("ray", m, "--contacts", -7, 3, "4.00000000000000000001", 1, 0, 0), "0 contacts 0\n")
        r = self.good(run("ray", m, "--contacts", -7, 3, "3.99999999999999999999", 1, 0, 0))
        self.assertEqual(r.out.split()[0], "1")
        r = self.good(run("ray", m, "--contacts", "--json", "--surfaces", -7, 5, 0, 1, 0, 0))
        contact, = json.loads(r.out)["contacts"]
        self.assertEqual((contact["t"], contact["surface"]), (7, "body"))


class Wrong(Case):
    def test_lines(self):
        m = self.model("cube(1);")
        r = self.bad(run("ray", m, stdin="0.5 0.5 -1 0 0 1\n0 0 0 0 -0 0e9\n"), 2, "<stdin>:2:7: error: ", "direction is zero")
        self.assertEqual(r.out, "1 1 2\n")
        self.bad(run("ray", m, stdin="1 2 3 4 5\n"), 2, "<stdin>:1:9: error: ", "ox oy oz dx dy dz")
        self.bad(run("ray", m, stdin="1 2 3 4 5 6 7\n"), 2, "<stdin>:1:13: error: ")
        self.bad(run("ray", m, stdin="1 2 3 4 5 6g\n"), 2, "<stdin>:1:11: error: ", "'6g'")

    def test_arguments(self):
        m = self.model("cube(1);")
        self.bad(run("ray", m, 0, 0, 0, 0, 0, 0), 2, "direction of ray 1 is zero")
        self.bad(run("ray", m, 0, 0, 0, 0, 0), 2, "5 numbers of 6")
        r = self.bad(run("ray", m, 0.5, 0.5, -1, 0, 0, 1, 1, 2, 3, 4, "five", 6), 2, "'five'", "ray 2, number 5")
        self.assertEqual(r.out, "1 1 2\n")


class Superquadrics(Case):
    """Lines in the surface, which are in the solid nowhere, and lines so near beside it that no double tells them from these: in caps, along rulings, edges and upright."""
    EXPONENT = 2 / 7.5

    def ends(self, form, *numbers):
        words = self.good(run("ray", self.model(f"superquadric({form});"), "--", *numbers)).out.split()
        self.assertEqual(len(words), 1 + 2 * int(words[0]))
        return [float(t) for t in words[1:]]

    def near(self, got, want):
        self.assertEqual(len(got), len(want))
        for a, b in zip(got, want):
            self.assertLess(abs(a - b), 2**-40)

    def crossing(self, a, b):
        """Where (1.25 + t, 1.5 + t) crosses the outline of superquadric([1, 2, 1], 7.5, 0), between a and b."""
        beyond = lambda t: abs(1.25 + t)**self.EXPONENT + abs((1.5 + t) / 2)**self.EXPONENT > 1
        self.assertNotEqual(beyond(a), beyond(b))
        for _ in range(100):
            m = (a + b) / 2
            a, b = (m, b) if beyond(m) == beyond(a) else (a, m)
        return a

    def test_in_and_beside_a_cap(self):
        star = "[1, 2, 1], 7.5, 0"
        self.assertEqual(self.ends(star, 1.25, 1.5, 1, 1, 1, 0), [])
        self.assertEqual(self.ends(star, 1.25, 1.5, "1.00000000000000001", 1, 1, 0), [])
        self.near(self.ends(star, 1.25, 1.5, "0.99999999999999999", 1, 1, 0),
                  [self.crossing(-1.6, -1.5), self.crossing(-1.5, -1.4), self.crossing(-1.35, -1.25), self.crossing(-1.25, -1.1)])

    def test_upright(self):
        self.assertEqual(self.ends("1, 4, 0", 0.25, 0.25, -5, 0, 0, 1), [])
        self.assertEqual(self.ends("1, 4, 0", "0.2500000000000000001", 0.25, -5, 0, 0, 1), [])
        self.near(self.ends("1, 4, 0", "0.2499999999999999999", 0.25, -5, 0, 0, 1), [4, 6])

    def test_rulings(self):
        for n in (2, 3, 7.5):  # in the plane z = 0 an exponent of 2 makes a square
            self.assertEqual(self.ends(f"1, 2, {n}", 0, 1, 0, 1, -1, 0), [])
            self.assertEqual(self.ends(f"1, 2, {n}", 0, "1.00000000000000000001", 0, 1, -1, 0), [])
            self.near(self.ends(f"1, 2, {n}", 0, "0.99999999999999999999", 0, 1, -1, 0), [0, 1])
        self.assertEqual(self.ends("1, 4, 2", 0, 0, 1, 0.25, 0.25, -1), [])  # from the tip to the star below it
        self.assertEqual(self.ends("1, 4, 2", 0, 0, "1.0000000000000000000001", 0.25, 0.25, -1), [])
        self.near(self.ends("1, 4, 2", 0, 0, "0.9999999999999999999999", 0.25, 0.25, -1), [0, 1])
        self.assertEqual(self.ends("1, 0, 3", "0.216", 0, "0.512", 0, 1, 0), [])  # (3/5)^2 + (4/5)^2 = 1
        self.assertEqual(self.ends("1, 0, 3", "0.216", 0, "0.51200000000000000001", 0, 1, 0), [])
        self.near(self.ends("1, 0, 3", "0.216", 0, "0.51199999999999999999", 0, 1, 0), [-0.216, 0.216])

    def test_exponents_without_bounds(self):
        for form in ("1, 222222265", "1, 1e9, 1e9", "[1, 2, 1], 0.000001, 1e7"):
            self.assertEqual(self.ends(form, -5, -2, 0.3, 1, 0.4, 0.1), [])
        self.near(self.ends("1, 1e9", -5, 0, 0, 1, 0, 0), [4, 6])


class Many(Case):
    def test_order_and_threads(self):
        n = 40
        m = self.model("".join(f"translate([{2 * i}, 0, 0]) cube(1);" for i in range(n)))
        rng = random.Random(5)
        lines, want = [], []
        for _ in range(4000):
            start, first = rng.randrange(-9, 90), rng.randrange(n)
            lines.append(f"{start} 0.5 0.5 -1 0 0" if first % 2 else f"{start} .5 .5 1 0 0")
            ends = [(start - 2 * i - 1, start - 2 * i) for i in reversed(range(n))] if first % 2 else [(2 * i - start, 2 * i + 1 - start) for i in range(n)]
            want.append(" ".join([str(n)] + [f"{a} {b}" for a, b in ends]))
        text = "\n".join(lines) + "\n"
        for threads in (1, 2, 5):
            r = self.good(run("ray", m, "--threads", threads, stdin=text))
            self.assertEqual(r.out.split("\n")[:-1], want)


main()
