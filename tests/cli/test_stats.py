"""--stats: one shape for every command, and figures that are true."""
import json

import quoin
from quoin import Case, run

SCENE = ["scene_leaves", "scene_dropped", "scene_surfaces", "scene_distinct_surfaces", "scene_gates", "scene_terms", "scene_copies", "scene_shared", "scene_bytes"]
WORK = ["rays", "points", "packets", "nodes", "leaves", "filter_sure", "exact_signs", "exact_orders", "exact_rays", "exact_points", "exact_roundings", "exact_forms",
        "leaves_each"]
LOAD = ["read_seconds", "compile_seconds", *SCENE]
MODEL = "difference() { cube(2); sphere(1); translate([9, 9, 9]) sphere(1); }\n"


class Stats(Case):
    def lines(self, result):
        pairs = [line.split(" ") for line in result.err.splitlines()]
        self.assertTrue(all(len(pair) == 2 for pair in pairs), result)
        return [name for name, _ in pairs], {name: float(value) for name, value in pairs}

    def test_names(self):
        m = self.model(MODEL)
        expected = {
            ("check", m): LOAD + ["peak_bytes"],
            ("scene", m): LOAD + ["peak_bytes"],
            ("tree", m): ["read_seconds", "peak_bytes"],
            ("query", m, 1, 1, 1): LOAD + ["answer_seconds"] + WORK + ["peak_bytes"],
            ("ray", m, 0, 0, -5, 0, 0, 1): LOAD + ["answer_seconds"] + WORK + ["peak_bytes"],
            ("render", m, "-o", self.folder / "x.png", "--imgsize", "16,16"):
                LOAD + ["render_seconds", "write_seconds", "camera_rays", "camera_hits", "shadow_rays", "refined_pixels"] + WORK + ["peak_bytes"],
        }
        for command, names in expected.items():
            found, _ = self.lines(self.good(run(*command, "--stats")))
            self.assertEqual(found, names, command)

    def test_truth(self):
        _, figures = self.lines(self.good(run("check", self.model(MODEL), "--stats")))
        self.assertEqual([figures[name] for name in SCENE[:6]], [2, 1, 7, 7, 1, 2])  # the far sphere takes nothing away; the near one is a term of what is taken
        self.assertTrue(100 < figures["scene_bytes"] < 1e6 < figures["peak_bytes"] < 1e9)
        rays = "0.5 0.5 -5 0 0 1\n" * 6 + "7 7 7 1 0 0\n"
        _, figures = self.lines(self.good(run("ray", self.model(MODEL), "--stats", stdin=rays)))
        self.assertEqual(figures["rays"], 7)
        self.assertGreaterEqual(figures["leaves"], 2)
        self.assertAlmostEqual(figures["leaves_each"], figures["leaves"] / 7, places=3)
        _, figures = self.lines(self.good(run("query", self.model(MODEL), "--stats", stdin="1.5 1.5 1.5\n" * 5)))
        self.assertEqual((figures["points"], figures["rays"]), (5, 0))
        _, figures = self.lines(self.good(run("ray", self.model("sphere(1);"), "--stats", stdin="0 1 -5 0 0 1\n")))  # touches
        self.assertGreater(figures["exact_signs"], 0)
        union = "".join(f"translate([{3 * i}, 0, 0]) sphere(1);" for i in range(100))
        _, figures = self.lines(self.good(run("check", self.model(union), "--stats")))
        self.assertEqual((figures["scene_leaves"], figures["scene_terms"], figures["scene_copies"]), (100, 100, 0))

    def test_json(self):
        m = self.model(MODEL)
        for command in (("check", m), ("query", m, 1, 1, 1), ("ray", m, 0, 0, -5, 0, 0, 1)):
            r = self.good(run(*command, "--stats", "--json"))
            plain, _ = self.lines(self.good(run(*command, "--stats")))
            self.assertEqual(len(r.err.splitlines()), 1, r)
            said = json.loads(r.err)
            self.assertEqual(list(said), ["stats"])
            self.assertEqual(list(said["stats"]), plain)
            self.assertTrue(all(isinstance(v, (int, float)) for v in said["stats"].values()))
            json.loads(r.out)

    def test_none_unasked(self):
        for command in (("check",), ("tree",), ("scene",)):
            self.assertEqual(self.good(run(*command, self.model("sphere(1);"))).err, "")


quoin.main()
