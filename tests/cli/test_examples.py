"""Real models: those of models/, and the examples of the OpenSCAD package, flattened by it. The answers for the flat files that
use only cube, sphere and cylinder are compared with an evaluator of a few lines that shares nothing with quoin; it works in
doubles, so points that it cannot tell (near a surface) are left out and counted."""
import math
import pathlib
import random
import re
import shutil
import subprocess
import unittest
from quoin import Case, SOURCE, main, run

EXAMPLES = pathlib.Path("/usr/share/openscad/examples")
PLAIN = {"group", "union", "difference", "intersection", "multmatrix", "color", "render", "cube", "sphere", "cylinder"}
TOKEN = re.compile(r'\s*("(?:[^"\\]|\\.)*"|[A-Za-z_$][\w$]*|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?inf|[-+]?nan|.)', re.S)
NEAR = 1e-7  # of this evaluator, which is approximate; quoin has no such number


def parse(text):
    """The flat dialect: a list of (word, arguments, children)."""
    tokens = [t for t in TOKEN.findall(text.strip()) if t.strip()]
    at = 0

    def value():
        nonlocal at
        t = tokens[at]
        at += 1
        if t == "[":
            items = []
            while tokens[at] != "]":
                items.append(value())
                at += tokens[at] == ","
            at += 1
            return items
        if t.startswith('"'):
            return t[1:-1]
        return {"true": True, "false": False, "undef": None}.get(t, None) if t.isalpha() and t not in ("inf", "nan") else float(t)

    def block(end):
        nonlocal at
        nodes = []
        while at < len(tokens) and tokens[at] != end:
            absent = False
            while tokens[at] in "%#*!":
                absent |= tokens[at] in "%*"
                at += 1
            if tokens[at] == ";":
                at += 1
                continue
            word, arguments = tokens[at], {}
            at += 2
            while tokens[at] != ")":
                if tokens[at + 1] == "=":
                    name = tokens[at]
                    at += 2
                    arguments[name] = value()
                else:
                    arguments[len(arguments)] = value()
                at += tokens[at] == ","
            at += 1
            children = []
            if tokens[at] == "{":
                at += 1
                children = block("}")
            at += 1
            if not absent:
                nodes.append((word, arguments, children))
        return nodes

    return block(None)


class Unsure(Exception):
    pass


def sure(x):
    if abs(x) < NEAR:
        raise Unsure
    return x < 0


def holds(node, p):
    word, a, children = node
    if word == "multmatrix":
        m = a[0]
        rows, out = [row[:3] for row in m[:3]], []
        det = sum(rows[0][i] * (rows[1][(i + 1) % 3] * rows[2][(i + 2) % 3] - rows[1][(i + 2) % 3] * rows[2][(i + 1) % 3]) for i in range(3))
        q = [p[i] - m[i][3] for i in range(3)]
        for i in range(3):  # Cramer
            c = [[q[r] if k == i else rows[r][k] for k in range(3)] for r in range(3)]
            out.append(sum(c[0][k] * (c[1][(k + 1) % 3] * c[2][(k + 2) % 3] - c[1][(k + 2) % 3] * c[2][(k + 1) % 3]) for k in range(3)) / det)
        return any([holds(c, out) for c in children])
    if word == "difference":
        inside = [holds(c, p) for c in children]
        return bool(inside) and inside[0] and not any(inside[1:])
    if word == "intersection":
        inside = [holds(c, p) for c in children]
        return bool(inside) and all(inside)
    if word == "cube":
        size = a["size"] if isinstance(a["size"], list) else [a["size"]] * 3
        low = [-s / 2 if a["center"] else 0 for s in size]
        return all([sure(max(low[i] - p[i], p[i] - low[i] - size[i])) for i in range(3)])
    if word == "sphere":
        return sure(math.hypot(*p) - a["r"])
    if word == "cylinder":
        h, z = a["h"], p[2] + (a["h"] / 2 if a["center"] else 0)
        radius = a["r1"] + (a["r2"] - a["r1"]) * z / h
        between = sure(max(-z, z - h))
        return between and sure(math.hypot(p[0], p[1]) - radius)
    return any([holds(c, p) for c in children])


def words(nodes):
    for word, _, children in nodes:
        yield word
        yield from words(children)


class Models(Case):
    def test_models_draw(self):
        models = sorted(p for p in (SOURCE / "models").iterdir() if p.suffix in (".scad", ".csg"))
        self.assertGreaterEqual(len(models), 20)
        for path in models:
            r = self.good(run("check", path))
            self.assertEqual(r.err, "", f"{path}: a model of ours has no warnings")
            self.assertNotIn("extent empty", r.out, path)
            self.good(run("render", path, "-o", self.folder / "x.png", "--imgsize", "80,60"))


@unittest.skipUnless(EXAMPLES.is_dir() and shutil.which("openscad"), "the package openscad is not installed")
class OpenSCAD(Case):
    def flat(self):
        for path in sorted(EXAMPLES.rglob("*.scad")):
            out = self.folder / (path.stem + ".csg")  # absolute: openscad takes a relative name from the model's folder
            subprocess.run(["openscad", "-o", str(out), str(path)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60, check=False)
            if out.exists():
                yield out

    def test_examples(self):
        rng = random.Random(2)
        plain, points, unsure, inside = 0, 0, 0, 0
        for path in self.flat():
            nodes = parse(path.read_text(errors="replace"))
            r = run("check", path, "--facets", "ignore", "--quiet")
            if not set(words(nodes)) <= PLAIN:
                self.assertIn(r.code, (0, 3), f"{path.name}: {r}")
                continue
            self.good(r)
            plain += 1
            self.good(run("render", path, "-o", self.folder / "x.png", "--imgsize", "80,60", "--quiet"))
            box = re.search(r"(?m)^box (.*)$", r.out)
            if not box:
                self.assertEqual(nodes, [], path.name)
                continue
            box = [float(x) for x in box[1].split()]
            batch = [[round(rng.uniform(box[i] - 1, box[i + 3] + 1), 3) for i in range(3)] for _ in range(300)]
            answers = self.good(run("query", path, "--facets", "ignore", "--quiet", stdin="\n".join(" ".join(map(repr, p)) for p in batch))).out.split()
            for p, answer in zip(batch, answers, strict=True):
                points += 1
                try:
                    want = any([holds(n, p) for n in nodes])
                except Unsure:
                    unsure += 1
                    continue
                inside += want
                self.assertEqual(answer, "inside" if want else "outside", f"{path.name} at {p}")
        self.assertGreaterEqual(plain, 15)
        self.assertGreater(inside, points // 50)
        self.assertLess(unsure, points // 20)


main()
