"""quoin render. Pictures are read back with a small PNG decoder, so nothing of ours is trusted."""
import struct
import zlib
from quoin import Case, main, run

BALL = 'color([1, 0, 0]) sphere(10);'


def decode(data):
    """(width, height, rows of RGBA tuples) of an 8-bit RGB or RGBA PNG without interlace."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:20]
    at, idat, ended = 8, b"", False
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        at += 12 + length
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and colour in (2, 6) and interlace == 0
        ended = kind == b"IEND"
        idat += body if kind == b"IDAT" else b""
    assert ended
    n = 4 if colour == 6 else 3
    raw, rows, before = zlib.decompress(idat), [], bytearray(width * n)
    assert len(raw) == height * (width * n + 1)
    for y in range(height):
        f, line = raw[y * (width * n + 1)], bytearray(raw[y * (width * n + 1) + 1:(y + 1) * (width * n + 1)])
        for i in range(len(line)):
            a, b, c = line[i - n] if i >= n else 0, before[i], before[i - n] if i >= n else 0
            p = a + b - c
            paeth = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[f]) & 255
        rows.append([tuple(line[i:i + n]) for i in range(0, len(line), n)])
        before = line
    return width, height, rows


class Pictures(Case):
    def picture(self, text, *args):
        out = self.folder / "picture.png"
        self.good(run("render", self.model(text), "-o", out, *args), "")
        return decode(out.read_bytes())

    def test_sizes(self):
        for size, want in (([], (800, 600)), (["--imgsize", "31,17"], (31, 17)), (["--imgsize=1,1"], (1, 1)), (["--imgsize", "5,400"], (5, 400))):
            self.assertEqual(self.picture(BALL, *size)[:2], want)

    def test_what_is_seen(self):
        """A red ball before a camera whose geometry is known: its outline is where projection puts it."""
        w, h, rows = self.picture(BALL, "--imgsize", "201,101", "--no-antialias", "--camera", "0,-40,0,0,0,0", "--projection", "ortho", "--fov", "53.13010235415598")
        background = rows[0][0]

        def red(p):
            return p[0] > 2 * p[1] and p[0] > 2 * p[2]

        # tan(fov / 2) = 1/2, so the picture is 40 high at the distance of the point looked at: 101/40 pixels a unit.
        seen = [(x, y) for y in range(h) for x in range(w) if rows[y][x] != background]
        half = 10 * 101 / 40
        self.assertAlmostEqual((max(x for x, _ in seen) - min(x for x, _ in seen) + 1) / 2, half, delta=1)
        self.assertAlmostEqual((max(y for _, y in seen) - min(y for _, y in seen) + 1) / 2, half, delta=1)
        self.assertAlmostEqual((max(x for x, _ in seen) + min(x for x, _ in seen)) / 2, 100, delta=1)
        for x, y in seen:
            self.assertLess((x - 100) ** 2 + (y - 50) ** 2, (half + 1.5) ** 2)
        lit = [rows[y][x] for x, y in seen if red(rows[y][x])]
        self.assertGreater(len(lit), len(seen) // 4)

    def test_perspective(self):
        w, h, rows = self.picture(BALL, "--imgsize", "200,200", "--no-antialias", "--camera", "0,-26,0,0,0,0", "--projection=persp", "--fov", "90")
        background = rows[0][0]
        seen = [x for x in range(w) if rows[100][x] != background]
        # The outline of a ball of radius 10 at distance 26 is at tan = 10 / sqrt(26^2 - 10^2) = 10/24; the edge of the picture at 1.
        self.assertAlmostEqual((max(seen) - min(seen) + 1) / 2, 100 * 10 / 24, delta=1)

    def test_up_is_z(self):
        w, h, rows = self.picture("translate([0, 0, 10]) sphere(1);", "--imgsize", "60,60", "--camera", "0,-100,0,0,0,0", "--fov", "30")
        background = rows[59][0]
        ys = [y for y in range(60) for x in range(60) if rows[y][x] != background]
        self.assertTrue(ys and max(ys) < 30)
        w, h, rows = self.picture("translate([10, 0, 0]) sphere(1);", "--imgsize", "60,60", "--camera", "0,-100,0,0,0,0", "--fov", "30")
        xs = [x for y in range(60) for x in range(60) if rows[y][x] != background]
        self.assertTrue(xs and min(xs) > 30)

    def test_looking_straight_down(self):
        w, h, rows = self.picture("translate([0, 10, 0]) sphere(1);", "--imgsize", "60,60", "--camera", "0,0,100,0,0,0", "--fov", "30")
        ys = [y for y in range(60) for x in range(60) if rows[y][x] != rows[59][0]]
        self.assertTrue(ys and max(ys) < 30)  # +y is up

    def test_default_view_frames_the_solid(self):
        for args in ([], ["--fov", "60"], ["--fov", "5"], ["--projection", "ortho"], ["--projection", "ortho", "--fov", "50"]):
            w, h, rows = self.picture("translate([1000, -300, 20]) cube([3, 4, 5]);", "--imgsize", "120,90", *args)
            background = rows[0][0]
            seen = [(x, y) for y in range(h) for x in range(w) if rows[y][x] != background]
            self.assertGreater(len(seen), w * h // 20, args)
            self.assertTrue(min(x for x, _ in seen) > 0 and max(x for x, _ in seen) < w - 1 and min(y for _, y in seen) > 0
                            and max(y for _, y in seen) < h - 1, args)

    def test_threads_do_not_show(self):
        text = "difference() { cube(10, center = true); sphere(6); rotate([90, 0, 0]) cylinder(h = 20, r = 2, center = true); }"
        pictures = {self.picture(text, "--imgsize", "90,70", "--threads", n).__repr__() for n in (1, 2, 5)}
        self.assertEqual(len(pictures), 1)

    def test_options_change_the_picture(self):
        text = "cube([20, 20, 1], center = true); translate([0, 0, 5]) sphere(3);"
        base = self.picture(text, "--imgsize", "90,70")
        for args in (["--no-antialias"], ["--no-shadows"], ["--samples", "64"]):
            self.assertNotEqual(self.picture(text, "--imgsize", "90,70", *args)[2], base[2], args)

    def test_nothing_in_view(self):
        """A blank picture is written, and a warning says so, with its reason and a way out; not when asked to be quiet."""
        away = ["--camera", "0,-40,0,0,-80,0"]
        for text, args, words in (("", [], ["the solid is empty"]),
                                  ("difference() { cube(10); cube(10); }", [], ["the solid is empty"]),
                                  ("intersection() { sphere(1); translate([1.9, 1.9, 0]) sphere(1.2); }", [], ["no ray of the camera", "with --camera"]),
                                  (BALL, away, ["no ray of the camera", "leave --camera out"]),
                                  ("camera(eye = [0, -40, 0], look = [0, -80, 0]); " + BALL, [], ["no ray of the camera", "with --camera"])):
            out, model = self.folder / "blank.png", self.model(text)
            r = run("render", model, "-o", out, "--imgsize", "20,10", *args)
            self.assertEqual((r.code, r.out), (0, ""), r)
            self.assertEqual(len(r.err.splitlines()), 1, r)
            for word in [str(model) + ": warning: nothing is in view (", "[Q1006]"] + words:
                self.assertIn(word, r.err)
            w, h, rows = decode(out.read_bytes())
            self.assertEqual((w, h), (20, 10))
            self.assertEqual(len({p for row in rows for p in row}), 1)
            self.assertEqual(run("render", model, "-o", out, "--imgsize", "20,10", "--quiet", *args).err, "")
        # One ray of a thousand that meets the solid is enough.
        self.picture("sphere(1);", "--imgsize", "100,75", "--camera", "0,-100,0,0,0,0", "--fov", "60")

    def test_standard_output(self):
        m = self.model(BALL)
        r = self.good(run("render", m, "-o", "-", "--imgsize", "20,10"))
        out = self.folder / "same.png"
        self.good(run("render", m, "-o", out, "--imgsize", "20,10"))
        self.assertEqual(r.raw, out.read_bytes())

    def test_stats_and_progress(self):
        r = self.good(run("render", self.model(BALL), "-o", self.folder / "x.png", "--imgsize", "20,10", "--stats", "--progress", "--no-antialias"))
        stats = dict(line.split() for line in r.err.splitlines())  # progress is for a terminal only
        self.assertEqual(stats["camera_rays"], "200")
        self.assertEqual(stats["refined_pixels"], "0")
        self.assertIn("render_seconds", stats)


class Wrong(Case):
    def test_values(self):
        m, out = self.model(BALL), self.folder / "x.png"
        for option, values in {
            "--imgsize": ("", "0,5", "5", "5,", ",5", "5,5,5", "-5,5", "5,5x", "99999,5", "5;5", "1e2,5", "5,0x5"),
            "--camera": ("", "1,2,3", "1,2,3,4,5,6,7", "1,2,3,4,5,x", "1,2,3,1,2,3", "1,2,3,4,5,inf", "1,2,3,4,5,nan", "1,2,3,4,5,1e999", "1,2,3,4,5,0x6"),
            "--projection": ("", "perspective?", "isometric"),
            "--fov": ("", "0", "180", "-5", "x", "1,2", "nan"),
            "--samples": ("", "0", "2", "15", "1024", "x"),
        }.items():
            for value in values:
                self.bad(run("render", m, "-o", out, f"{option}={value}"), 2, option, "quoin render --help")
        self.assertFalse(out.exists())
        self.bad(run("render", m), 2, "-o OUT.png")

    def test_values_that_are_fine(self):
        m, out = self.model(BALL), self.folder / "x.png"
        self.good(run("render", m, "-o", out, "--imgsize", "9x8", "--camera", "-1.5,-2e1,+3, 0 0,0.5", "--fov", "1e1", "--projection", "o"))

    def test_no_partial_file(self):
        bad = self.model("sphere(;", "bad.scad")
        self.bad(run("render", bad, "-o", self.folder / "x.png"), 3)
        m = self.model(BALL)
        self.bad(run("render", m, "-o", self.folder / "none" / "x.png", "--imgsize", "9,9"), 4, "No such file")
        self.bad(run("render", m, "-o", self.folder, "--imgsize", "9,9"), 4, "irectory")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["bad.scad", "model.scad"])

    def test_only_names_of_pictures_that_are_written(self):
        m = self.model("sphere(1);")
        for name in ("out.jpg", "out.STL", ".svg"):
            out = self.folder / name
            self.bad(run("render", m, "-o", out, "--imgsize", "9,9"), 2, name, "PNG")
            self.assertFalse(out.exists())
        for name in ("out.PNG", "out", "out.v2", "a.jpg.png"):
            self.good(run("render", m, "-o", self.folder / name, "--imgsize", "9,9"), "")
            self.assertEqual((self.folder / name).read_bytes()[:4], b"\x89PNG")

    def test_a_model_is_not_replaced_by_its_picture(self):
        m = self.model(BALL)
        (self.folder / "other.png").symlink_to(m)
        for name in (m, self.folder / "." / m.name, self.folder / "other.png"):
            self.bad(run("render", m, "-o", name, "--imgsize", "9,9"), 2, "would replace its own model")
            self.assertEqual(m.read_text(), BALL)


main()
