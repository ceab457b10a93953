"""Near surfaces in quoin check, and --snap in every command that compiles."""
import json
from quoin import Case, main, run

PLATE = """difference() {
  name("plate") cube([40, 20, 10], center = true);
  name("hole") cylinder(h = 10.000001, r = 4, center = true);
}
"""


class Snap(Case):
    def test_check_reports(self):
        m = self.model(PLATE)
        r = self.good(run("check", m))
        self.assertEqual(r.out.splitlines()[-1], "near_pairs 2")
        lines = r.err.splitlines()
        self.assertEqual(lines, [f"{m}:3:16: note: cap{i} of 'hole' is 5e-07 from face {4 + i} of 'plate' at {m}:2:17; "
                                 "--snap 5e-07 would make them one [Q1103]" for i in (0, 1)])
        self.assertEqual(self.good(run("check", "-q", m)).err, "")
        self.assertEqual(self.good(run("check", "--near", "0", m)).err, "")
        self.assertEqual(self.good(run("check", "--near", "4.99999e-7", m)).err, "")
        self.assertIn("near_pairs 2\n", self.good(run("check", "--near=5e-7", m)).out)

    def test_as_suggested(self):
        m = self.model(PLATE)
        r = self.good(run("check", "--snap", "5e-07", m))
        self.assertTrue(r.out.endswith("near_pairs 0\nsnapped 2\n"), r)
        self.assertIn("distinct_surfaces 7\n", r.out)
        self.assertEqual(r.err.splitlines()[0], f"{m}:3:16: note: cap0 of 'hole' moved by 5e-07 onto face 4 of 'plate' at {m}:2:17 [Q1101]")
        self.assertEqual(self.good(run("check", "--snap", "4e-7", m)).out.splitlines()[-1], "snapped 0")

    def test_a_suggestion_that_is_no_decimal(self):
        """A gap that is irrational, or a fraction, is rounded up: the suggestion works."""
        for text in ("sphere(sqrt(2)); sphere(1.41421356);", "cube(1); translate([1 / 3, 0, 1 / 3000000]) cube(1);"):
            m = self.model(text)
            limit = self.good(run("check", m)).err.split("--snap ")[1].split()[0]
            self.assertGreaterEqual(int(self.good(run("check", "-q", "--snap", limit, m)).out.split()[-1]), 1, text)

    def test_json(self):
        m = self.model(PLATE)
        got = json.loads(self.good(run("check", "--json", m)).out)
        self.assertEqual((got["near"]["complete"], len(got["near"]["pairs"]), got["near"]["limit"]), (True, 2, 20 / 100000))
        self.assertNotIn("snapped", got)
        pair = got["near"]["pairs"][0]
        self.assertEqual((pair["gap"], pair["exact"], pair["opposite"]), (5e-7, "5e-07", False))
        self.assertEqual(pair["faces"][0], {"name": "hole", "role": "cap0", "file": str(m), "line": 3, "column": 16})
        self.assertEqual(pair["faces"][1], {"name": "plate", "role": "face 4", "file": str(m), "line": 2, "column": 17})
        got = json.loads(self.good(run("check", "--json", "--snap", "1e-6", m)).out)
        self.assertEqual((got["near"]["pairs"], len(got["snapped"]["pairs"]), got["snapped"]["pairs"][1]["faces"][0]["role"]), ([], 2, "cap1"))
        self.assertEqual({d["code"] for d in got["diagnostics"]}, {"Q1101"})

    def test_few_lines_of_many(self):
        m = self.model("\n".join(f"translate([{i}.000001, 0, 0]) cube([1, 1 + {i}, 1]);" if i % 2 else f"translate([{i}, 0, 0]) cube([1, 1 + {i}, 1]);" for i in range(100)))
        r = self.good(run("check", m))
        self.assertIn("near_pairs 99\n", r.out)
        self.assertEqual(len(r.err.splitlines()), 11)
        self.assertIn("89 more pairs of near surfaces are not shown", r.err)
        self.assertEqual(len(json.loads(self.good(run("check", "--json", m)).out)["near"]["pairs"]), 99)
        r = self.good(run("check", "--snap", "0.000001", m))
        self.assertIn("snapped 99\n", r.out)
        self.assertEqual(r.err.count("[Q1101]"), 20)
        self.assertIn("79 more of Q1101 are not shown", r.err)

    def test_every_command(self):
        m = self.model(PLATE)
        self.assertEqual(self.good(run("query", "-q", m, 0, 0, "5.0000001")).out, "outside\n")
        film = self.model("cube(1); translate([1.000001, 0, 0]) cube(1);")
        point = ("1.0000005", "0.5", "0.5")
        self.assertEqual(self.good(run("query", "-q", film, *point)).out, "outside\n")
        self.assertEqual(self.good(run("query", "-q", "--snap", "1e-6", film, *point)).out, "inside\n")
        self.assertEqual(self.good(run("ray", "-q", "--snap", "1e-6", film, -1, "0.5", "0.5", 1, 0, 0)).out, "1 1 3.0000010000000001\n")
        self.assertIn("distinct", self.good(run("scene", "-q", "--snap=1e-6", film)).out)
        self.good(run("render", "-q", "--snap", "1e-6", "--imgsize", "16,16", film, "-o", self.folder / "a.png"))
        self.bad(run("tree", "--snap", "1e-6", film), 2, "unknown option")
        for option in ("--near", "--snap"):
            for value in ("1e99999", "1e-99999", "1e301", "0." + "1" * 2000):
                self.bad(run("check", option, value, film), 2, "is out of range for " + option)
            for value in ("0e99999", "1e-300", "+00.1"):
                self.good(run("check", "-q", option, value, self.model("cube(1);")))

    def test_a_film_is_gone(self):
        r = self.good(run("check", "--snap", "0.001", self.model("cube(1);\ntranslate([2, 0, 0])\n  cube([1, 1, 0.0005]);")))
        self.assertIn(":3:3: warning: snapping leaves nothing of this solid (two of its faces became one surface); snap with less to keep it [Q1102]", r.err)
        self.assertIn("leaves 1\n", r.out)

    def test_wrong_values(self):
        m = self.model("cube(1);")
        for option in ("--snap", "--near"):
            for value in ("", "x", "-1", "1e", "nan", "inf", "1,2", "0x1p-3", "1 "):
                self.bad(run("check", f"{option}={value}", m), 2, option)
        self.assertEqual(self.good(run("check", "--snap", "0", m)).out.splitlines()[-1], "snapped 0")


if __name__ == "__main__":
    main()
