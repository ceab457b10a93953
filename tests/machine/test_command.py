"""The command on a machine that fails: allocations refused one by one and at random, reads and writes that are short, interrupted or fail,
threads that do not start, files that cannot be put in place, a kill half-way. See shim.c."""
import os
import pathlib
import random
import re
import signal
import struct
import subprocess
import sys
import time
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from quoin import PROGRAM, Case, main  # noqa: E402

SHIM = os.environ["QUOIN_SHIM"]
SEED = int(os.environ.get("SHIM_TEST_SEED", "1"))
MODEL = """difference() { name("plate") cube([4, 3, 1]); translate([1, 1, 0]) cylinder(h = 1, r = 0.5); translate([3, 1, -1]) rotate(20) cylinder(h = 3, r = 0.3, $fn = 6); }
color("red") translate([0, 0, 2]) sphere(1); translate([0, 0, 4.0000001]) sphere(1); translate([0, 3.00000001, 0]) cube(1);
for (i = [0 : 3]) translate([i, 5, sin(i * 10)]) sphere(sqrt(2) / 3);
"""
MODEL_PLAIN = MODEL.replace("for (i = [0 : 3]) ", "i = 2; ")


def png_is_whole(data):
    """Whether a PNG file has all its chunks with their sums, to its end."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return False
    at = 8
    while at + 12 <= len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        end = at + 12 + length
        if end > len(data) or zlib.crc32(data[at + 4:end - 4]) != struct.unpack(">I", data[end - 4:end])[0]:
            return False
        at = end
        if kind == b"IEND":
            return at == len(data)
    return False


class Machine(Case):
    def setUp(self):
        super().setUp()
        self.solid = self.model(MODEL_PLAIN)
        self.points = self.folder / "points"
        self.points.write_text("".join(f"{i / 8} {i % 5} 0.5\n" for i in range(40)))
        self.rays = self.folder / "rays"
        self.rays.write_text("".join(f"{i / 8 - 1} {i % 5} -9 0 0 1\n" for i in range(40)))
        self.out = self.folder / "out"
        self.files = sorted(os.listdir(self.folder))

    def commands(self):
        m, o = self.solid, self.out
        return {
            "render": ["render", m, "-o", o, "--imgsize", "24,18", "--threads", "2"],
            "render to a pipe": ["render", m, "-o", "-", "--imgsize", "24,18", "--threads", "1"],
            "query": ["query", m, "-i", self.points, "--threads", "2"],
            "query one": ["query", m, "0.1", "0.2", "0.3"],
            "ray": ["ray", m, "-i", self.rays, "--threads", "1"],
            "ray one": ["ray", m, 0.5, 0.5, -9, 0, 0, 1],
            "check": ["check", m],
            "check json": ["check", m, "--json"],
            "check snap": ["check", m, "--snap", "0.001"],
            "tree": ["tree", m, "-o", o],
            "scene": ["scene", m, "--snap", "1e-6"],
            "help": ["render", "--help"],
        }

    def shimmed(self, args, stdin=None, timeout=120, **how):
        """The result, with the shim's report of it; the output file, when there is one, is part of the result."""
        report = self.folder / "report"
        report.unlink(missing_ok=True)
        env = {**os.environ, "LD_PRELOAD": SHIM, "SHIM_REPORT": str(report), **{f"SHIM_{k.upper()}": str(v) for k, v in how.items()}}
        done = subprocess.run([PROGRAM, *map(str, args)], stdin=stdin or subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=env, timeout=timeout)
        text = report.read_text() if report.exists() else ""
        done.counts = {w: int(n) for w, n in re.findall(r"(\w+) (\d+)", text)}
        report.unlink(missing_ok=True)
        done.file = self.out.read_bytes() if self.out.exists() else None
        return done

    def nothing_left(self, what):
        left = [name for name in sorted(os.listdir(self.folder)) if name not in self.files and name != "out"]
        self.assertEqual(left, [], what)

    def refused(self, name, args, good, r, how):
        """A run of which allocations were refused: the same answer, or out of memory and nothing changed."""
        what = (name, how, r.returncode, r.stderr[-500:])
        self.assertIn(r.returncode, (0, 4), what)
        self.assertNotIn(b"anitizer", r.stderr, what)
        if r.returncode == 0:
            self.assertEqual((r.stdout, r.file), (good.stdout, good.file), what)
        else:
            self.assertRegex(r.stdout if r.stdout.startswith(b"{") and not r.stderr else r.stderr, rb"(out of|Cannot allocate) memory", what)
            self.assertEqual(r.file, b"old" if good.file is not None else None, what)
            self.assertTrue(good.stdout.startswith(r.stdout) or (r.stdout.startswith(b"{") and b'"status":"ok"' not in r.stdout), what)
        self.assertEqual(r.counts.get("kept"), good.counts["kept"], what)
        self.nothing_left(what)

    def old(self, good):
        if good.file is not None:
            self.out.write_bytes(b"old")

    def test_each_allocation_refused(self):
        dice = random.Random(SEED)
        total = failed = 0
        for name, args in self.commands().items():
            self.out.unlink(missing_ok=True)
            good = self.shimmed(args)
            self.assertEqual(good.returncode, 0, (name, good.stderr))
            self.assertEqual(good.counts["refused"], 0)
            n = good.counts["allocations"]
            turns = list(range(1, n + 1)) if n <= 90 else list(range(1, 41)) + sorted(dice.sample(range(41, n - 9), 40)) + list(range(n - 9, n + 1))
            for k in turns:
                self.old(good)
                r = self.shimmed(args, refuse=k)
                self.refused(name, args, good, r, f"allocation {k} of {n}")
                total += 1
                failed += r.returncode != 0
            self.out.unlink(missing_ok=True)
        self.assertGreater(failed, total // 4)

    def test_allocations_refused_at_random(self):
        for name, args in self.commands().items():
            self.out.unlink(missing_ok=True)
            good = self.shimmed(args)
            for turn in range(6):
                self.old(good)
                how = {"seed": SEED * 1000 + turn, "one_in": (5, 20, 100, 300, 1000, 3000)[turn]}
                self.refused(name, args, good, self.shimmed(args, **how), how)
            self.out.unlink(missing_ok=True)

    def test_slow_and_interrupted_calls_change_nothing(self):
        for name, args in self.commands().items():
            self.out.unlink(missing_ok=True)
            good = self.shimmed(args)
            for how in ("short", "eintr", "again"):
                self.out.unlink(missing_ok=True)
                r = self.shimmed(args, read=how, write=how)
                self.assertEqual((r.returncode, r.stdout, r.file), (0, good.stdout, good.file), (name, how, r.stderr))

    def test_reads_fail(self):
        for name in ("query", "ray"):
            args = self.commands()[name]
            for k in (1, 2):
                with open(args[3], "rb") as f:
                    for way in (args, args[:2] + args[4:]):
                        f.seek(0)
                        r = self.shimmed(way, stdin=f, read=f"eio:{k}")
                        self.assertEqual(r.returncode, 4, (name, k, r.stderr))
                        self.assertIn(b"Input/output error", r.stderr)
        # Models are read by the C library, which the shim does not see: these fail in the kernel.
        for path, word in ((self.folder, b"directory"), ("/proc/self/mem", b"Input/output error")):
            if os.path.exists(path):
                for command in ("check", "tree", "query"):
                    r = self.shimmed([command, path])
                    self.assertEqual(r.returncode, 4, r.stderr)
                    self.assertIn(word, r.stderr)

    def test_a_file_that_shrinks(self):
        """A model cut short while it is read is a model, or an error of it: nothing worse."""
        whole = (MODEL_PLAIN * 3000).encode()
        path = self.folder / "shrinks"
        for turn in range(5):
            path.write_bytes(whole)
            p = subprocess.Popen([PROGRAM, "tree", path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.0005 * turn)
            os.truncate(path, len(whole) // (turn + 2))
            self.assertIn(p.wait(60), (0, 3))

    def test_writes_fail(self):
        for name, args in self.commands().items():
            if "-o" in args and args[0] == "render":
                continue  # through the C library: tests/cli/test_io.py
            self.out.unlink(missing_ok=True)
            self.old(self.shimmed(args))
            r = self.shimmed(args, write="eio:1")
            self.assertEqual(r.returncode, 4, (name, r.stderr))
            self.assertIn(b"Input/output error", r.stderr)
            self.assertIn(r.file, (None, b"old"))
            self.nothing_left(name)

    def test_a_file_that_cannot_be_put_in_place(self):
        for name, calls in (("tree", ("rename", "mkstemp", "close")), ("render", ("rename", "fclose"))):
            for call in calls:
                self.out.write_bytes(b"old")
                r = self.shimmed(self.commands()[name], fail=call)
                self.assertEqual((r.returncode, r.file), (4, b"old"), (name, call, r.stderr))
                self.assertIn(b"out", r.stderr)
                self.nothing_left((name, call))

    def test_threads_that_do_not_start(self):
        for name in ("render", "query", "check"):
            args = self.commands()[name]
            self.out.unlink(missing_ok=True)
            good = self.shimmed(args)
            self.out.unlink(missing_ok=True)
            r = self.shimmed(args, fail="pthread_create")
            self.assertEqual((r.returncode, r.stdout, r.file), (0, good.stdout, good.file), (name, r.stderr))

    def test_killed(self):
        """At any time: the old file stands, or the new one does, whole; besides there is at most the temporary file that docs/rendering.md names."""
        dice = random.Random(SEED)
        args = [PROGRAM, "render", self.solid, "-o", self.out, "--imgsize", "700,500", "--no-antialias", "--threads", "1"]
        start = time.monotonic()
        subprocess.run(args, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        took = time.monotonic() - start
        ends = {"old": 0, "new": 0, "temporary": 0}
        for turn in range(40):
            self.out.write_bytes(b"old")
            p = subprocess.Popen(args, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            if turn % 2:  # as soon as it writes
                until = time.monotonic() + 20
                while p.poll() is None and time.monotonic() < until and len(os.listdir(self.folder)) <= len(self.files) + 1:
                    pass
                time.sleep(dice.random() * 0.004)
            else:
                time.sleep(dice.random() * took * 1.2)
            p.kill()
            p.wait()
            now = self.out.read_bytes()
            self.assertTrue(now == b"old" or png_is_whole(now), len(now))
            ends["old" if now == b"old" else "new"] += 1
            for name in os.listdir(self.folder):
                if name not in self.files and name != "out":
                    self.assertRegex(name, r"^out\.\d+-\d+\.tmp$")
                    ends["temporary"] += 1
                    (self.folder / name).unlink()
        self.assertGreater(ends["old"], 0, ends)
        self.assertGreater(ends["temporary"], 0, ends)

    def test_a_full_disk(self):
        """A file system of 64 kB, where there is the right to make one."""
        script = (f"mount -t tmpfs -o size=64k none {self.folder} 2> /dev/null || exit 77; cd {self.folder} && printf old > out && head -c 57344 /dev/zero > filler && "
                  f"'{PROGRAM}' render '{os.environ['QUOIN_SOURCE']}/models/quoin.scad' -o out --imgsize 400,300; code=$?; ls -A; cat out; exit $code")
        done = subprocess.run(["unshare", "-m", "sh", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if done.returncode in (1, 77, 127):
            self.skipTest("no right to mount")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(b"No space left", done.stderr)
        self.assertEqual(done.stdout, b"filler\nout\nold")

    def test_places_that_cannot_be_written(self):
        (self.folder / "file").write_text("x")
        for out, word in ((self.folder / "none" / "out", "No such file"), (self.folder / "file" / "out", "Not a directory"), (self.folder, "directory")):
            for command in ("render", "tree", "scene"):
                done = subprocess.run([PROGRAM, command, self.solid, "-o", out, *(["--imgsize", "9,9"] if command == "render" else [])], stderr=subprocess.PIPE)
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertIn(word, done.stderr.decode())
        if os.geteuid() != 0:
            self.folder.chmod(0o500)
            done = subprocess.run([PROGRAM, "tree", self.solid, "-o", self.out], stderr=subprocess.PIPE)
            self.folder.chmod(0o700)
            self.assertEqual(done.returncode, 4, done.stderr)

    def test_streams_that_are_closed(self):
        """Each of the three closed, alone and together, and a reader that goes away: a code of the list, no signal, nothing in the wrong file."""
        for name, args in self.commands().items():
            words = " ".join(f"'{w}'" for w in [PROGRAM, *args])
            for shut in ("<&-", ">&-", "2>&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-"):
                self.out.unlink(missing_ok=True)
                done = subprocess.run(["sh", "-c", f"{words} {shut}"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, timeout=60)
                to_file = args[0] in ("render", "tree") and "-o" in args and args[args.index("-o") + 1] != "-"
                self.assertEqual(done.returncode, 4 if ">&-" in shut.replace("2>&-", "") and not to_file else 0, (name, shut, done.stderr))
            self.out.unlink(missing_ok=True)
            done = subprocess.run(["bash", "-c", f"{words} | head -c 1 > /dev/null; exit ${{PIPESTATUS[0]}}"], stderr=subprocess.PIPE, timeout=60)
            self.assertIn(done.returncode, (0, 4), name)
            self.assertEqual(done.stderr.replace(b"\r", b"").decode() if name not in ("check", "check json", "check snap", "scene") else "", "", name)


main()
