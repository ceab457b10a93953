"""quoin query."""
import json
import random
from quoin import Case, main, run

# A plate with a hole through it, flush with both faces, and a pin that fills the hole's lower half.
PLATE = """
difference() { name("plate") cube([10, 10, 2]); name("hole") translate([5, 5, 0]) cylinder(h = 2, r = 2); }
name("pin") translate([5, 5, 0]) cylinder(h = 1, r = 2);
"""


class Sides(Case):
    def test_arguments(self):
        m = self.model("cube(1);")
        self.good(run("query", m, 0.5, 0.5, 0.5, 1, 1, 1, 2, 0, 0), "inside\nboundary\noutside\n")
        self.good(run("query", m, "0.5,0.5,0.5", "1 1", "1"), "inside\nboundary\n")

    def test_lines(self):
        text = "# points\n\n0.5 0.5 0.5\n  1,1,1  # a corner\n\t2\t0 , 0\r\n   \n0 0 0"
        self.good(run("query", self.model("cube(1);"), stdin=text), "inside\nboundary\noutside\nboundary\n")
        self.good(run("query", self.model("cube(1);"), stdin=""), "")
        self.good(run("query", self.model("cube(1);"), stdin="# nothing"), "")

    def test_decimals_are_exact(self):
        m = self.model("translate([0.3, 0, 0]) cube(0.1);")
        self.good(run("query", m, "0.4", "0.05", "0.05"), "boundary\n")  # 0.3 + 0.1 == 0.4, not so in doubles
        self.good(run("query", m, "0.40000000000000000000000000000000000001", "0.05", "0.05"), "outside\n")
        self.good(run("query", m, "0.39999999999999999999999999999999999999", "0.05", "0.05"), "inside\n")
        self.good(run("query", m, "4e-1", "+.05", "50E-3"), "boundary\n")
        m = self.model("translate([0, 0, 8.1 - 9 + 0.9]) cube(1);")
        self.good(run("query", m, 0.5, 0.5, 0), "boundary\n")

    def test_curved(self):
        m = self.model("sphere(5);")
        self.good(run("query", m, "3", "4", "0", "3", "4", "1e-30", "3", "3.9999999999999999999999", "0"), "boundary\noutside\ninside\n")

    def test_regularised(self):
        m = self.model(PLATE)
        # In the hole above the pin; on the pin's top; in the seam of pin and plate; on the rim where all three meet.
        self.good(run("query", m, 5, 5, 1.5, 5, 5, 1, 7, 5, 0.5, 7, 5, 1, 7, 5, 1.5), "outside\nboundary\ninside\nboundary\nboundary\n")

    def test_names(self):
        m = self.model(PLATE)
        self.good(run("query", m, "--names", 1, 1, 1, 5, 5, 0.5, 50, 0, 0), "inside\tplate\ninside\tplate\thole\tpin\noutside\n")
        m = self.model('name("a\\tb \\"c\\"\\\\d") cube(1);')
        self.good(run("query", m, "--names", 0.5, 0.5, 0.5), 'inside\ta\\tb "c"\\\\d\n')
        r = self.good(run("query", m, "--names", "--json", 0.5, 0.5, 0.5))
        self.assertEqual(json.loads(r.out), {"side": "inside", "parts": ['a\tb "c"\\d']})

    def test_many_names(self):
        count = 100
        m = self.model("".join(f'name("n{i}") cube({i + 1});' for i in range(count)))
        self.good(run("query", m, "--names", 0.5, 0.5, 0.5), "inside" + "".join(f"\tn{i}" for i in range(count)) + "\n")

    def test_json(self):
        r = self.good(run("query", self.model("cube(1);"), "--json", stdin="0.5 0.5 0.5\n1 1 1\n2 2 2\n"))
        self.assertEqual([json.loads(line) for line in r.out.splitlines()], [{"side": s} for s in ("inside", "boundary", "outside")])

    def test_exit_code(self):
        m = self.model("cube(1);")
        self.assertEqual(run("query", m, "--exit-code", 0.5, 0.5, 0.5).code, 0)
        self.assertEqual(run("query", m, "--exit-code", 0.5, 0.5, 0.5, 1, 1, 1).code, 1)
        self.assertEqual(run("query", m, "--exit-code", stdin="0.5 0.5 0.5\n3 3 3\n0.5 0.5 0.5\n").code, 1)
        self.assertEqual(run("query", m, stdin="3 3 3\n").code, 0)
        self.assertEqual(run("query", m, "--exit-code", stdin="3 3 3\nx\n").code, 2)

    def test_stats(self):
        r = self.good(run("query", self.model("cube(1);"), "--stats", stdin="0.5 0.5 0.5\n" * 3), "inside\n" * 3)
        stats = dict(line.split() for line in r.err.splitlines())
        self.assertEqual(stats["points"], "3")
        self.assertEqual(stats["exact_points"], "0")
        r = self.good(run("query", self.model("cube(1);"), "--stats", stdin="0.5 0.5 0.5\n1 1 1\n0.5 1 0.5\n"), "inside\nboundary\nboundary\n")
        stats = dict(line.split() for line in r.err.splitlines())
        self.assertEqual((stats["points"], stats["exact_points"]), ("3", "2"))
        self.assertIn("read_seconds", stats)
        self.assertIn("exact_signs", stats)


class WrongLines(Case):
    def test_among_many(self):
        """Lines are answered in groups: those before a wrong one are answered all the same, and its place is right."""
        m = self.model("cube(1);")
        for bad in (0, 1, 255, 256, 257, 511, 900):
            for wrong, what in (("0.5 0.5", "fewer"), ("0.5 x 0.5", "'x'"), ("1 2 3 4", "more"), ("1 2 1e99999", "exponent")):
                lines = ["0.5 0.5 0.5 # in" if i % 3 else "7,7,7" for i in range(1000)]
                lines[bad] = wrong
                want = "".join("inside\n" if i % 3 else "outside\n" for i in range(bad))
                for threads in (1, 3):
                    r = self.bad(run("query", m, "--threads", threads, stdin="\n".join(lines)), 2, f"<stdin>:{bad + 1}:", what)
                    self.assertEqual(r.out, want)

    def test_place(self):
        m = self.model("cube(1);")
        r = self.bad(run("query", m, stdin="0.5 0.5 0.5\n# c\n\n1 1 1 # here\n 2 1.2.3 0 # there\n9 9 9\n"), 2, "<stdin>:5:4: error: ", "'1.2.3'")
        self.assertEqual(r.out, "inside\nboundary\n")
        self.assertIn("\n   2 1.2.3 0 # there\n     ^^^^^\n", r.err)
        points = self.folder / "points.txt"
        points.write_text("1 2 x\n")
        self.bad(run("query", m, "--input", points), 2, f"{points}:1:5: error: ")

    def test_kinds(self):
        m = self.model("cube(1);")
        for text in ("1 2 nan", "1 2 inf", "1 2 -inf", "1 2 0x10", "1 2 1e", "1 2 1_000", "1 2 --3", "1 2 3e999999999999", "1 2 \u0663"):
            self.bad(run("query", m, stdin=text + "\n"), 2, "<stdin>:1:5: error: ")
            self.bad(run("query", m, "--", *text.split()), 2, "number 3")
        self.bad(run("query", m, stdin="1 2\n"), 2, "<stdin>:1:3: error: ", "x y z", "fewer")
        self.bad(run("query", m, stdin="1 2 3 4\n"), 2, "<stdin>:1:7: error: ", "x y z", "more")
        self.bad(run("query", m, stdin="1 2 3 4 5 6 7 8 9\n"), 2, "<stdin>:1:7: error: ")
        self.bad(run("query", m, stdin=b"1 2 3\x00junk\n"), 2, "<stdin>:1:6: error: ", "NUL")
        self.bad(run("query", m, 1, 2, 3, 4), 2, "1 number of 3")
        self.bad(run("query", m, 1, 2, ""), 2, "'' is not a number")

    def test_an_empty_field_is_no_blank(self):
        m = self.model("cube(1);")
        for text, column in (("1,,2,3", 3), ("1 , , 2,3", 5), (",1,2,3", 1), ("1,2,,3", 5), ("1,2,\t,3", 6)):
            self.bad(run("query", m, stdin="0 0 0\n" + text + "\n"), 2, f"<stdin>:2:{column}: error: no number before this comma (a field is empty) [Q1001]")
        self.good(run("query", m, stdin="1,2,3,\n1 , 2\t,3 ,, # a comment\n"), "outside\noutside\n")

    def test_only_what_is_marked(self):
        m = self.model("difference() { sphere(9); translate([5, 0, 0]) color(\"red\") !translate([0, 1, 0]) cube(1); } sphere(2);")
        self.good(run("query", m, "0.5 1.5 0.5", "5.5 1.5 0.5", "0 0 0"), "inside\noutside\noutside\n")
        self.assertNotIn("[1, 0, 0, 1]", run("scene", m).out)

    def test_numbers_that_are_not_finite_in_a_flat_file(self):
        m = self.model("cube([1, 1, inf]); multmatrix([[nan, -inf, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(1); inf2 = inf; sphere(2);")
        result = run("query", m, 0, 0, 1)
        self.good(result, "inside\n")
        self.assertEqual(result.err.count("[Q0502]"), 2, result)
        self.good(run("query", self.model("inf = 2; cube(inf);"), 2, 2, 2), "boundary\n")

    def test_junk(self):
        m = self.model("cube(1);")
        rng = random.Random(7)
        for size in (10, 1000, 3000000):
            self.bad(run("query", m, stdin=rng.randbytes(size)), 2, "<stdin>:")
        self.bad(run("query", m, stdin=b"\0" * 3000000), 2, "<stdin>:")
        self.bad(run("query", m, stdin=b"\n" * 70000 + b" " * 9000000), 2, "<stdin>:70001:1: error: ")
        self.bad(run("query", m, stdin="1" * 900000 + " 0 0\n"), 2, "<stdin>:1:1: error: ")

    def test_a_number_ends_at_any_place_of_a_line(self):
        m = self.model("cube(1);")
        wide = range(1, 21)
        text = "".join(f"{'0' * n}{between}{'0' * k}{between}1{end}\n" for n in wide for k in (1, 7, 8) for between in (" ", "\t", ",", "\r", "\v", "\f", ", ")
                       for end in ("", " ", "#2", " # 0 0"))
        self.good(run("query", m, stdin=text), "boundary\n" * text.count("\n"))
        for n in wide:
            self.bad(run("query", m, stdin=b"1 " + b"0" * n + b"\0" + b"0" * 12 + b" 1\n"), 2, f"<stdin>:1:{n + 3}: error: ", "NUL")
            for between in "!+*$'\x01\x7f\u00e9":
                self.bad(run("query", m, stdin=f"{'0' * n}{between}00000000 1\n"), 2, "<stdin>:1:", "fewer")

    def test_nothing_is_lost_on_many_threads(self):
        m = self.model("cube(1);")
        text = "0.5 0.5 0.5\n1 1 1\n2 2 2\n" * 20000
        for threads in (1, 2, 7):
            r = self.bad(run("query", m, "--threads", threads, stdin=text + "0 0 oh\n" + text + "wrong too\n"), 2, "<stdin>:60001:5: error: ")
            self.assertEqual(r.out, "inside\nboundary\noutside\n" * 20000)
            self.assertEqual(r.err.count("error:"), 1)


class Many(Case):
    def test_order_and_threads(self):
        m = self.model("translate([-1, -1, -1]) cube(2); translate([2, 0, 0]) sphere(1);")
        rng = random.Random(11)
        lines, want = [], []
        for _ in range(30000):
            x, y, z = (rng.randrange(-20, 36) for _ in range(3))
            lines.append(f"{x / 10} {y / 10} {z / 10}")
            box = 10 - max(abs(x), abs(y), abs(z))        # in tenths, exact integers
            ball = 100 - (x - 20) ** 2 - y * y - z * z
            want.append("inside" if box > 0 or ball > 0 else "boundary" if box == 0 or ball == 0 else "outside")
        for kind in ("inside", "boundary", "outside"):
            self.assertGreater(want.count(kind), 100)
        text = "\n".join(lines)
        for threads in (1, 2, 3, 8):
            r = self.good(run("query", m, "--threads", threads, stdin=text))
            self.assertEqual(r.out.split("\n")[:-1], want)

    def test_a_solid_minus_itself_is_empty(self):
        points = "0 0 0\n0.5 0.5 0.5\n1 0.5 0.5\n1 1 1\n0.5 0.5 0\n"
        for other in ("cube(1);", "rotate(90) translate([0, -1, 0]) cube(1);", "rotate(120, [1, 1, 1]) cube(1);"):
            self.good(run("query", self.model("difference() { cube(1); " + other + " }"), stdin=points), "outside\n" * 5)

    def test_empty_model(self):
        self.good(run("query", self.model(""), 0, 0, 0), "outside\n")
        self.good(run("query", self.model("halfspace(n = [0, 0, 1], d = 0);"), 1e9, 0, -1, 5, 5, 0, 0, 0, "1e-300"),
                  "inside\nboundary\noutside\n")


main()
