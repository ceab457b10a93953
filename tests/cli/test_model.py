"""quoin check, tree and scene; and what is said of models that cannot be read."""
import json
import os
import random
from quoin import Case, SOURCE, main, run


class Check(Case):
    def holds(self, box, exact):
        """The box holds the exact one and is no larger than it but in the last bits (2^-48 of the size)."""
        size = max(abs(x) for x in exact)
        for got, want in zip(box[:3] + [-x for x in box[3:]], exact[:3] + [-x for x in exact[3:]], strict=True):
            self.assertLessEqual(got, want, box)
            self.assertLessEqual(want - got, size * 2 ** -48, box)

    def summary(self, text, *args):
        r = self.good(run("check", self.model(text), *args))
        return dict(line.split(" ", 1) for line in r.out.splitlines())

    def test_summary(self):
        s = self.summary("translate([1, 2, 3]) cube([4, 5, 6]);")
        self.holds([float(x) for x in s.pop("box").split()], [1, 2, 3, 5, 7, 9])
        self.assertEqual(s, {"leaves": "1", "surfaces": "6", "distinct_surfaces": "6", "extent": "bounded", "near_pairs": "0"})

    def test_shared_surfaces(self):
        s = self.summary("cube(1); translate([1, 0, 0]) cube(1);")  # y and z faces in common, and the one between them
        self.assertEqual((s["leaves"], s["surfaces"], s["distinct_surfaces"]), ("2", "12", "7"))
        self.holds([float(x) for x in s["box"].split()], [0, 0, 0, 2, 1, 1])

    def test_extent(self):
        self.assertEqual(self.summary("")["extent"], "empty")
        self.assertEqual(self.summary("intersection() { cube(1); translate([2, 0, 0]) cube(1); }")["extent"], "empty")
        self.assertEqual(self.summary("intersection() { halfspace(n = [0, 0, 1], d = 1); cube(1); }")["extent"], "bounded")
        self.assertEqual(self.summary("halfspace(n = [0, 0, 1], d = 1);")["extent"], "unbounded")

    def test_json(self):
        r = self.good(run("check", "--json", self.model("cube(2, center = true);")))
        got = json.loads(r.out)
        self.holds(got["box"]["min"] + got["box"]["max"], [-1, -1, -1, 1, 1, 1])
        self.assertEqual((got["status"], got["diagnostics"], got["leaves"], got["empty"], got["unbounded"]), ("ok", [], 1, False, False))
        got = json.loads(self.good(run("check", "--json", self.model("halfspace(n = [0, 0, 1], d = 1);"))).out)
        self.assertTrue(got["unbounded"])
        self.assertEqual(got["box"]["min"][0], "-inf")
        self.assertIsNone(json.loads(self.good(run("check", "--json", self.model(""))).out)["box"])

    def test_json_of_a_bad_model(self):
        path = self.model('cube(1);\n  cub\u00e9("x");\nnosuch(2);\n')
        r = run("check", "--json", path)
        self.assertEqual((r.code, r.err), (3, ""), r)
        got = json.loads(r.out)
        self.assertNotEqual(got["status"], "ok")
        self.assertGreaterEqual(len(got["diagnostics"]), 2)
        for d in got["diagnostics"]:
            self.assertEqual((d["severity"], d["file"]), ("error", str(path)))
            self.assertRegex(d["code"], r"^Q\d{4}$")
        self.assertEqual([d["line"] for d in got["diagnostics"]][-1], 3)
        self.assertNotIn("box", got)

    def test_all_errors_in_one_run(self):
        r = self.bad(run("check", self.model("nosuch(1);\ncube(1);\nalso_not(2);\ncube(;\n")), 3, "nosuch", "also_not", ".scad:1:1: error:", ".scad:3:1: error:", ".scad:4:")
        self.assertIn("\n  nosuch(1);\n  ^^^^^^\n", r.err)
        self.assertEqual(r.out, "")

    def test_warnings_and_quiet(self):
        m = self.model("cube(1);\ncube(0);\n")
        r = self.good(run("check", m))
        self.assertIn(".scad:2:", r.err)
        self.assertIn(": warning: ", r.err)
        for command in ("check", "tree", "scene", "query"):
            args = [0, 0, 0] if command == "query" else []
            self.assertIn(": warning: ", self.good(run(command, m, *args)).err)
            self.assertEqual(self.good(run(command, m, "--quiet", *args)).err, "")
            self.assertEqual(self.good(run(command, "-q", m, *args)).err, "")

    def test_facets(self):
        m = self.model("cylinder(h = 1, r = 2, $fn = 6);")
        # The corner of a hexagon with a vertex on +x is at distance r; the middle of its side is at r cos 30 < 1.75 < r.
        point = ["0", "1.75", "0.5"]
        self.good(run("query", m, *point), "outside\n")
        self.good(run("query", m, "--facets", "ignore", *point), "inside\n")
        self.good(run("query", m, "--facets=honour", *point), "outside\n")
        m = self.model("cylinder(h = 1, r = 2, $fn = 32);")
        point = ["1.9951", "0.0980", "0.5"]  # inside the circle, beyond the 32-gon's first side (cos(pi/32) * 2 = 1.99037)
        self.good(run("query", m, "--quiet", *point), "inside\n")
        self.good(run("query", m, "--quiet", "--facets", "honour", *point), "outside\n")


class Trees(Case):
    def models(self):
        return sorted(p for p in (SOURCE / "models").iterdir() if p.suffix in (".scad", ".csg"))

    def test_tree_reads_back(self):
        for path in self.models():
            tree = self.good(run("tree", path, "-q")).out
            again = self.model(tree, "again.csg")
            r = self.good(run("tree", again))
            self.assertEqual(r.out, tree, path)

    def test_exact_numbers_survive(self):
        tree = self.good(run("tree", self.model("a = 1 / 3; translate([a, 0.1, 8.1 - 9 + 0.9]) cube([1e-30, 2, sqrt(2)]);"))).out
        m = self.model(tree, "again.csg")
        self.assertEqual(self.good(run("tree", m)).out, tree)
        self.good(run("query", m, "0.3333333333333333333333333333333334", 1, 1, "0.34", 0.1, 0), "inside\noutside\n")

    def test_the_scene_of_the_tree_is_the_scene(self):
        """Places in the text name parts without a name, so all are given one."""
        text = 'name("a") cube(2); difference() { name("b") sphere(3); name("c") rotate([10, 20, 30]) cylinder(h = 9, r = 1, center = true); }'
        tree = self.good(run("tree", self.model(text))).out
        self.assertEqual(run("scene", self.model(tree, "again.csg")).out, self.good(run("scene", self.model(text))).out)

    def test_scene_does_not_depend_on_threads(self):
        for path in self.models()[:6]:
            self.assertEqual(run("scene", path, "--threads", 1).out, self.good(run("scene", path, "--threads", 4)).out)

    def test_output_file(self):
        m = self.model("cube(1);")
        for command in ("tree", "scene"):
            want = self.good(run(command, m)).out
            self.assertTrue(want)
            self.good(run(command, m, "-o", "out.txt", cwd=self.folder), "")
            self.assertEqual((self.folder / "out.txt").read_text(), want)
            self.good(run(command, m, "-o", "-"), want)


class Unreadable(Case):
    def test_missing(self):
        for command in ("check", "tree", "scene"):
            self.bad(run(command, self.folder / "none.scad"), 4, "none.scad", "No such file")
        self.bad(run("query", self.folder / "none.scad", 0, 0, 0), 4, "No such file")
        self.bad(run("render", self.folder / "none.scad", "-o", self.folder / "x.png"), 4, "No such file")
        self.assertEqual(os.listdir(self.folder), [])

    def test_directory(self):
        self.bad(run("check", self.folder), 4, "irectory")

    def test_no_right(self):
        if os.geteuid() == 0:
            self.skipTest("root may read everything")
        m = self.model("cube(1);")
        m.chmod(0)
        self.bad(run("check", m), 4, "ermission")

    def test_binary_junk(self):
        rng = random.Random(3)
        for size in (1, 3, 64, 5000, 300000):
            m = self.model(rng.randbytes(size), "junk.scad")
            self.assertIn(run("check", m).code, (0, 3))
            self.assertIn(run("check", "--json", m).code, (0, 3))
        self.bad(run("check", self.model(b"cube(1);\0cube(2);")), 3)
        self.bad(run("check", self.model(b"\x7fELF\x02\x01\x01" + bytes(500))), 3)
        self.bad(run("check", self.model(b"\x89PNG\r\n\x1a\n" + bytes(500))), 3)

    def test_truncated(self):
        text = (SOURCE / "models" / "pipe_flange.scad").read_text()
        for cut in range(1, len(text), 41):
            r = run("check", self.model(text[:cut]))
            self.assertIn(r.code, (0, 3), r)
            self.assertEqual(r.code == 3, "error:" in r.err, r)

    def test_deep(self):
        for open_, close, depth in (("union() {", "}", 100000), ("translate([1, 0, 0]) ", "", 100000)):
            r = run("check", self.model(open_ * depth + "cube(1);" + close * depth))
            self.assertIn(r.code, (0, 3), r)
            if r.code == 3:
                self.assertIn("deep", r.err)
        self.bad(run("check", self.model("x = " + "(" * 1000000 + "1;")), 3)
        self.bad(run("check", self.model("union() {" * 1000000)), 3)


main()
