"""Hostile files: each gets an answer or a clear error in seconds, within the memory that --max-memory allows, and nothing is left half written."""
import os
import random
import resource
import subprocess
import time

from quoin import Case, PROGRAM, main

DEEP = 100000
SANITIZED = bool(os.environ.get("QUOIN_SANITIZED"))
SLOWER = float(os.environ.get("QUOIN_TEST_SLOWER", 10 if SANITIZED else 3))
SECONDS = 2.0 * SLOWER  # 2 s on an idle machine; of processor time, which a busy one stretches
MANY = 2000 if SLOWER > 3 else 20000


def doubling(last):
    """Vectors of two vectors of two vectors: 2^61 numbers in a thousand bytes."""
    return "v0 = [1, 1];" + "".join(f"v{i + 1} = [v{i}, v{i}];" for i in range(60)) + last


def repeated(what, count):
    return "".join(f"x{i} = {what};" for i in range(count))


class Hostile(Case):
    def ask(self, text, codes, *words, command="check", options=("--max-memory", "1G", "--threads", "1"), path=None, stdin=subprocess.DEVNULL):
        """Runs the command on a text: one of the codes, each of the words on standard error, in time. Gives what it said and the memory it took, in MB."""
        path = path or self.model(text)
        before = time.monotonic()
        with open(self.folder / "err", "wb") as err, open(self.folder / "out", "wb") as out:
            child = subprocess.Popen([PROGRAM, command, *options, str(path)], stdin=stdin, stdout=out, stderr=err,
                                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(20 * SLOWER), int(20 * SLOWER))))
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        said = (self.folder / "err").read_text("utf-8", "replace")
        self.assertIn(child.returncode, codes, said[:2000])
        for word in words:
            self.assertIn(word, said)
        self.assertNotIn("Sanitizer", said)
        self.assertLess(len(said), 200000)
        self.assertLess(used.ru_utime + used.ru_stime, SECONDS, f"{time.monotonic() - before:.1f} s by the clock")
        return said, 0 if SANITIZED else used.ru_maxrss / 1024

    # --- nesting

    def test_brackets_nested_deep(self):
        self.ask("{" * DEEP, [3], "never closed")
        self.ask("{" * DEEP + "cube(1);" + "}" * DEEP, [0])
        self.ask("cube(" + "(" * DEEP + "1" + ")" * DEEP + ");", [0])
        self.ask("x = " + "[" * DEEP + "1" + "]" * DEEP + ";", [3], "Q0901")
        self.ask("x = " + "[" * DEEP, [3])
        self.ask("}" * DEEP, [3], "Q0204")
        self.ask("x = " + "-" * DEEP + "1; y = " + "!" * DEEP + "1; z = " + "1?" * DEEP + "1" + ":0" * DEEP + ";", [0])
        self.ask("x = " + "abs(" * DEEP + "1" + ")" * DEEP + ";", [0])
        self.ask("{" * 200001, [3], "Q0901")

    def test_statements_nested_deep(self):
        for word in ("union()", "difference()", "translate([1, 2, 3])", "rotate([90, 0, 0])", "mirror([1, 0, 0])", 'name("a")', "color([1, 0, 0])"):
            self.ask(word * DEEP + "cube(1);", [0])
        self.ask("difference() { cube(2);" * 20000 + "sphere(1);" + "}" * 20000, [0])

    def test_transforms_whose_numbers_grow(self):
        for word in ("scale(3)", "scale(2)", "scale(1/3)", "multmatrix([[3, 1, 0, 1], [0, 5, 1, 1], [1, 0, 7, 1]])"):
            said, _ = self.ask(word * DEEP + "cube(1);", [3], "a limit was met")
            self.assertEqual(said.count("\n"), 1)
            self.ask(word * 200 + "cube(1);", [0])

    def test_concentric_spheres(self):
        self.ask("".join(f"difference() {{ sphere({i + 1});" for i in range(3000)) + "}" * 3000, [0])

    def test_turns_by_irrational_angles(self):
        for word in ("rotate(a = 30)", "rotate(a = 20, v = [1, 2, 3])", "rotate([10, 20, 30])", "rotate([10, 0, 0]) rotate([0, 0, 70])"):
            self.ask(word * (DEEP // word.count("rotate")) + "cube(1);", [0])

    def test_leaves_under_one_tower(self):
        turned = "rotate(a = 30, v = [1, 2, 3]) "
        inside = "".join(f"sphere(r = {i + 1});" for i in range(4000))
        self.ask(turned * 2000 + "{" + inside + "}", [0])
        boxes = "".join(f"translate([{2 * i}, 0, 0]) cube(1);" for i in range(4000))
        self.ask("multmatrix([[1, 0.1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1]]) " * 2000 + "{" + boxes + "}", [0])
        self.ask("union() { sphere(1);" * 8000 + "}" * 8000, [0], options=("--max-memory", "1G", "--threads", "1", "--near", "1"))

    # --- rays and points in many surfaces

    def ask_ray(self, text, codes, *numbers, options=("--boundary", "--contacts")):
        if SANITIZED and codes == [3]:
            return []  # the effort is spent as slowly as the program runs
        rays = self.folder / "rays"
        rays.write_text(" ".join(map(str, numbers)) + "\n")
        said, _ = self.ask(text, codes, command="ray" if len(numbers) == 6 else "query",
                           options=("--max-memory", "1G", "--threads", "1", "-i", str(rays), *(options if len(numbers) == 6 else ("--names",))))
        if codes == [0]:
            return (self.folder / "out").read_text().split()
        self.assertIn("a limit was met", said)
        return []

    def test_contacts_at_many_places(self):
        n = MANY
        touching = "".join(f"translate([{3 * i},1,0]) sphere(1);" for i in range(n))
        out = self.ask_ray(touching, [0], 0, 0, 0, 1, 0, 0, options=("--contacts",))
        self.assertEqual(out, ["0", "contacts", str(n), *(str(3 * i) for i in range(n))])
        random.Random(1).shuffle(order := list(range(n)))
        irrational = "".join(f"translate([{3 * i},{3 * i},sqrt(2)]) sphere(sqrt(2));" for i in order)
        self.assertEqual(self.ask_ray(irrational, [0], 0, 0, 0, 1, 1, 0, options=("--contacts",)), out)
        holes = "difference() { union() {" + touching + "}" + "".join(f"translate([{3 * i},0,0]) sphere(1/2);" for i in range(0, n, 2)) + "}"
        out = self.ask_ray(holes, [0], 0, 0, 0, 1, 0, 0, options=("--contacts",))
        self.assertEqual(out, ["0", "contacts", str(n // 2), *(str(3 * i) for i in range(1, n, 2))])

    def test_contacts_of_many_at_one_place(self):
        nested = "".join(f"translate([0,{i + 1},0]) sphere({i + 1});" for i in range(MANY))
        self.assertEqual(self.ask_ray(nested, [0], 0, 0, 0, 1, 0, 0, options=("--contacts",)), ["0", "contacts", "1", "0"])

    def test_contacts_in_many_faces(self):
        n = MANY
        boxes = "".join(f"translate([0,-1,{-i - 1}]) cube([{6 * n},1,{2 * i + 2}]);" for i in range(n // 2))
        spheres = "".join(f"translate([{3 * i},1,0]) sphere(1);" for i in range(n // 2))
        self.ask_ray("intersection() { union() {" + boxes + "} union() {" + spheres + "} }", [3], 0, 0, 0, 1, 0, 0)

    def test_rays_along_faces(self):
        n = MANY
        row = "".join(f"translate([{2 * i},0,0]) cube(1);" for i in range(n))
        self.assertEqual(self.ask_ray(row, [0], 0, 0, 0, 1, 0, 0)[:3], ["0", "boundary", str(n)])
        outlines = "".join(f"translate([{i},0,{-i - 1}]) cube([{2 * n - 2 * i},1,{2 * i + 2}]);" for i in range(n))
        self.assertEqual(self.ask_ray(outlines, [0], 0, 0, 0, 1, 0, 0), ["0", "boundary", "1", "0", str(2 * n), "contacts", "0"])

    def slices(self, n, step):
        return "".join(f"translate([{step * i},0,0]) multmatrix([[1,0,0,0],[0,{n},{i},0],[0,{-i},{n},0]]) cube(1);" for i in range(n))

    def test_rays_along_many_planes(self):
        self.assertEqual(self.ask_ray(self.slices(3000, 0), [0], 0, 0, 0, 1, 0, 0), ["0", "boundary", "1", "0", "1", "contacts", "0"])
        self.assertEqual(self.ask_ray(self.slices(3000, 2), [0], 0, 0, 0, 1, 0, 0)[:3], ["0", "boundary", "3000"])
        self.ask_ray(self.slices(20000, 2), [3], 0, 0, 0, 1, 0, 0)

    def turned(self, n, what):
        """n solids about the z axis, each with a tangent plane of its own there."""
        return "".join(f"multmatrix([[{n},{-i},0,0],[{i},{n},0,0],[0,0,1,0]]) {what.format(i)};" for i in range(n))

    def test_rays_along_generators(self):
        cylinder = "translate([1,0,0]) cylinder(r=1,h=1)"
        self.assertEqual(self.ask_ray(self.turned(1000, cylinder), [0], 0, 0, 0, 0, 0, 1), ["0", "boundary", "1", "0", "1", "contacts", "0"])
        block = "translate([-5,-5,-5]) cube(20);"
        self.assertEqual(self.ask_ray(block + self.turned(1000, cylinder), [0], 0, 0, 0, 0, 0, 1), ["1", "-5", "15", "boundary", "0", "contacts", "0"])
        tangent = "".join(f"translate([{i + 1},0,0]) cylinder(r={i + 1},h=1);" for i in range(1000))
        self.assertEqual(self.ask_ray(tangent, [0], 0, 0, 0, 0, 0, 1), ["0", "boundary", "1", "0", "1", "contacts", "0"])
        self.ask_ray(block + self.turned(8000, "translate([1,0,{0}/7]) cylinder(r=1,h=24000)"), [3], 0, 0, 0, 0, 0, 1)

    def test_rays_along_saddles(self):
        def saddles(n):
            return "intersection() { cube(9); union() {" + "".join(f"quadric([0,0,0,0,1,{i + 1},{-(i * i % 7 + 1)},{i % 5 + 1},0,0]);" for i in range(n)) + "} }"
        self.assertEqual(self.ask_ray(saddles(40), [0], 0, 0, 0, 0, 0, 1)[:2], ["0", "boundary"])
        self.ask_ray(saddles(150), [3], 0, 0, 0, 0, 0, 1)

    def test_points_on_many_surfaces(self):
        n = MANY // 2
        for text in ("".join(f"translate([0,0,{i + 1}]) sphere({i + 1});" for i in range(n)),
                     "".join(f"halfspace(n=[{i},{i * i + 1},{i * i % 7 + 1}],d=0);" for i in range(n)),
                     "".join(f"translate([0,0,-1]) cone(h=1,r={i + 1});" for i in range(n)),
                     self.turned(n, "translate([0,0,-1]) cone(h=1,r=1)"), self.slices(n, 0)):
            out = self.ask_ray(text, [0], 0, 0, 0)
            self.assertEqual((out[0], len(out)), ("boundary", n + 1))

    # --- near surfaces

    def near(self, text, *options, codes=(0,), words=()):
        self.ask(text, list(codes), *words, options=("--max-memory", "1G", "--threads", "1", "--quiet", *options))
        return dict(line.split(" ", 1) for line in (self.folder / "out").read_text().splitlines() if line.startswith(("near_pairs", "snapped")))

    def test_near_surfaces_about_one_centre(self):
        n = MANY
        for what in ("sphere({0});", "cylinder(r={0},h=1);", "scale([1,2,3]) sphere({0});", "cylinder(r={0},h={0});", "translate([0,0,{0}]) cone(r={0},h={0});"):
            self.assertEqual(self.near("".join(what.format(i + 1) for i in range(n)), "--near", "0.5", "--snap", "0.5"), {"near_pairs": "0", "snapped": "0"})
        shells = "".join(f"sphere({i + 1}); sphere({i + 1}.001);" for i in range(n))
        self.assertEqual(self.near(shells, "--near", "0.001")["near_pairs"], str(n))
        self.assertEqual(self.near(shells, "--near", "0.001", "--snap", "0.001"), {"near_pairs": "0", "snapped": str(n)})

    def test_near_boxes_at_one_place(self):
        n = MANY
        row = "".join(f"translate([{i}e-4,0,0]) cube(3);" for i in range(n))  # no more than one of four stands
        self.assertEqual(self.near(row, "--near", "1e-5"), {"near_pairs": "0"})
        told = self.near(row, "--near", "1e-4", "--snap", "3e-4")
        self.assertEqual(told["near_pairs"], "0")
        self.assertGreater(int(told["snapped"]), 5 * n // 4)
        every = self.near("".join(f"translate([{i}e-9,{i}e-9,{i}e-9]) cube(1);" for i in range(n)), "--near", "1")
        self.assertTrue(n < MANY or every["near_pairs"].endswith(" and more"))

    def test_near_planes_at_angles(self):
        n = MANY // 4
        self.near(self.slices(n, 0))
        self.near("".join(f"multmatrix([[1,0,0,0],[0,1,0,0],[{i}e-6,{i * i % 997}e-6,1,0]]) cube(1);" for i in range(n)))
        self.near("".join(f"multmatrix([[1,0,0,0],[0,1,0,0],[{i}e-6,{i * i % 997}e-6,1,0]]) cube(1);" for i in range(n)), "--snap", "1e-3")

    def test_near_surfaces_of_many_shapes(self):
        if MANY < 20000:
            return  # the effort is spent as slowly as the program runs
        shapes = "".join(f"scale([1,1,1+{i}e-10]) sphere(1);" for i in range(8000))
        self.assertEqual(self.near(shapes), {"near_pairs": "0 and more"})
        self.near(shapes, "--snap", "1e-3", codes=[3], words=["Q1104"])

    # --- polyhedra

    @staticmethod
    def prism(n, curve="{0}"):
        """Over n points of a parabola: two faces of n corners, and n of four."""
        points = ",".join(f"[{i},{curve.format(i * i)},{z}]" for z in (0, 1) for i in range(n))
        sides = ",".join(f"[{i},{n + i},{n + (i + 1) % n},{(i + 1) % n}]" for i in range(n))
        return f"polyhedron(points=[{points}],faces=[{list(range(n))},{list(range(2 * n - 1, n - 1, -1))},{sides}]);"

    def test_faces_of_thousands_of_corners(self):
        self.ask(self.prism(4000), [0])
        self.ask(self.prism(1000) * 2, [0])
        self.ask(self.prism(1000, "{0}e-30"), [0])
        n = 2000
        points = ",".join(f"[{i},{i * i},0]" for i in range(n)) + f",[{n // 2},{n * n // 2},1]"
        self.ask(f"polyhedron(points=[{points}],faces=[{list(range(n))}," + ",".join(f"[{(i + 1) % n},{i},{n}]" for i in range(n)) + "]);", [0])

    def test_polyhedra_that_are_many(self):
        tetrahedron = "polyhedron(points=[[0,0,0],[{0},0,0],[0,{0}.5,0],[0,0,{0}.25]],faces=[[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);"
        self.ask("".join(tetrahedron.format(i + 1) for i in range(MANY)), [0])
        head = "p=[[0,0,0],[1,0,0],[0,1,0],[0,0,1]];f=[[0,1,2],[0,3,1],[0,2,3],[1,3,2]];"
        self.ask(head + "".join(f"translate([{i},0,0]) polyhedron(p,f);" for i in range(MANY)), [0])

    def test_polyhedra_again_and_again(self):
        points = "p = [" + ",".join(f"[{i},{i * i},{z}]" for z in (0, 1) for i in range(2000)) + "];"
        faces = "f = [" + str(list(range(2000))) + "];"
        self.ask(points + faces + "polyhedron(p, f);" * 2000, [3])
        self.ask(points + "polyhedron(p, []);" * 20000, [3, 0])

    # --- numbers

    def test_huge_exponents(self):
        for number in ("1e999999999", "1e-9999999999", "1E+99999999999999999999999", "0.1e4002", "1e4001"):
            self.ask(f"cube({number});", [3], "Q0903")
        self.ask("cube(0e99999999999999999999); sphere(1e4000);", [0])

    def test_a_million_digits(self):
        million = 10 ** 6
        self.ask("cube(" + "7" * million + ");", [3], "Q0902")
        self.ask("cube(0." + "9" * million + ");", [3], "Q0902")
        self.ask("cube(" + "0" * million + "1);", [0])
        self.ask("cube(1e" + "0" * million + "1);", [0])
        self.ask("cube(0." + "0" * million + "1);", [3], "Q0903")
        self.ask("sphere(0." + "7" * 9999 + ");", [3], "Q0904")

    def test_numbers_that_grow(self):
        self.ask("x = 2" + "^9" * 40 + ";", [3])
        self.ask("a0 = 3;" + "".join(f"a{i + 1} = a{i} * a{i};" for i in range(60)), [3], "Q0904")
        self.ask("a0 = 1/3;" + "".join(f"a{i + 1} = a{i} * a{i} + a{i} / 7;" for i in range(30)), [3], "Q0904")

    def test_long_numbers_again_and_again(self):
        head = "a = 3^80000; b = 7^40000; c = 1/3^40000;"
        for what in ("a/b", "a % b", "3^80000", "sqrt(a)", "a^(1/3)", "c + 1/b", "a == b", "floor(a/b)"):
            self.ask(head + repeated(what, 20000), [3, 0])
        self.ask(head + "echo(a);" * 20000, [3], "Q0910")
        self.ask("a = 3^20000;" + "cube(a);" * 50000, [3], "Q0910")

    # --- values

    def test_vectors_that_double(self):
        for last in ("x = v60 + v60;", "x = -v60;", "x = v60 * 2;", "x = 2 / v60;", "w0 = [1, 1];" + "".join(f"w{i + 1} = [w{i}, w{i}];" for i in range(60)) + "x = v60 == w60;"):
            _, memory = self.ask(doubling(last), [3], "Q0910")
            self.assertLess(memory, 700)
        self.ask(doubling("echo(v60); cube(len(v60));"), [0])

    def test_matrices(self):
        row = "r = [" + ",".join(["1"] * 1000) + "]; m = [" + ",".join(["r"] * 1000) + "];"
        for last in ("x = m * m;", repeated("m * r", 300), repeated("r * m", 300), repeated("m + m", 300)):
            self.ask(row + last, [3], "Q0910")
        self.ask(row + "x = m * r;", [0])
        self.ask("v = [" + "1," * 100000 + "1];" + repeated("max(v)", 10000), [3], "Q0910")

    def test_strings(self):
        s = 's = "' + "\u00e9" * 50000 + '";'
        self.ask(s + repeated("s[49999]", 50000), [3], "Q0910")
        self.ask(s + repeated("len(s)", 50000), [3], "Q0910")
        self.ask(s + "name(s) cube(1);" * 5000, [3], "Q0910")

    def test_much_of_one_thing(self):
        self.ask("x = 1;" * DEEP, [0], "Q0308", "more of Q0308")
        self.ask("cube(q);" * DEEP, [3], "Q0908")
        self.ask("cube(0);" * DEEP, [0], "more of Q0501")
        self.ask("sphere(" + "1," * DEEP + "1);", [0])
        self.ask(";" * 10 ** 6 + "sphere(1);" * DEEP, [0])
        self.ask("polyhedron(points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], faces = [" + "[0,1,2]," * DEEP + "]);", [3], "Q0907")
        self.ask("cylinder(h = 1, r = 1, $fn = 1e300);", [0, 3], options=("--facets", "honour"))

    # --- bytes

    def test_bytes_that_are_no_text(self):
        for text in (b"cube(1);\0", b"\0" * DEEP, "cube(1);".encode("utf-16-le"), "\ufeffcube(1);".encode("utf-16"), "cube(1);".encode("utf-32")):
            self.ask(text, [3], "Q0101")
        self.ask(b"cube(1); \xff\xfe\xc0\x80", [3], "Q0102")
        self.ask(b'name("\xed\xa0\x80") cube(1);', [3], "Q0102")
        self.ask(bytes(range(128, 256)) * 5000, [3], "Q0102")
        self.ask(b"\xef\xbb\xbfcube(1);", [0])
        self.ask(b"cube(1);\r\nsphere(2); // a comment\r\n", [0])
        self.ask(b"cube(1);\r" * DEEP, [0])

    def test_what_never_ends(self):
        self.ask("/*" * DEEP, [3], "Q0104")
        self.ask('"' * (DEEP + 1), [3], "Q0103")
        self.ask('"\n' * DEEP, [3])
        self.ask('x = "' + "\\q" * DEEP, [3], "Q0105")
        self.ask("cube(" + "a /* */ " * DEEP, [3])
        self.ask("/" * DEEP, [0])

    def test_nothing_and_a_lot_of_nothing(self):
        self.ask("", [0])
        hundred = 10 ** (7 if SANITIZED else 8)
        for text in (b" " * hundred, b"\n" * hundred, b"//" + b"x" * hundred, b"/*" + b"*" * hundred + b"*/"):
            self.ask(text, [0])
            self.ask(text, [4], "--max-memory", options=("--max-memory", "5M" if SANITIZED else "50M"))

    # --- files

    def test_no_file(self):
        self.ask(None, [4], "Q0801", path=self.folder)
        self.ask(None, [4], "Q0801", path=self.folder / "not there")
        self.ask(None, [0], path="/dev/null")
        with open("/dev/zero", "rb") as zero:
            _, memory = self.ask(None, [4], "--max-memory", path="-", stdin=zero, options=("--max-memory", "100M"))
            self.assertLess(memory, 150)
        _, memory = self.ask(None, [4], "--max-memory", path="/dev/zero", options=("--max-memory", "100M"))
        self.assertLess(memory, 150)


if __name__ == "__main__":
    main()
