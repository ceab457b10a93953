"""Pipes, slow input, full disks, closed streams, files written whole or not at all."""
import os
import pathlib
import resource
import select
import signal
import subprocess
import time
import unittest
from quoin import PROGRAM, Case, main, run

CUBE = "cube(1);"
FULL = pathlib.Path("/dev/full")


class Pipes(Case):
    def test_slow_input_is_answered_line_by_line(self):
        m = self.model(CUBE)
        p = subprocess.Popen([PROGRAM, "query", m], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        try:
            for text, want in ((b"0.5 0.5 0.5\n", b"inside\n"), (b"1 1 1\n5 5 5\n", b"boundary\noutside\n"), (b"0.5 0.", None), (b"5 0.5\n", b"inside\n")):
                p.stdin.write(text)
                p.stdin.flush()
                if want is None:
                    time.sleep(0.1)
                    self.assertFalse(select.select([p.stdout], [], [], 0)[0])
                    continue
                got, end = b"", time.monotonic() + 20
                while len(got) < len(want) and time.monotonic() < end and select.select([p.stdout], [], [], 20)[0]:
                    got += os.read(p.stdout.fileno(), 1000)
                self.assertEqual(got, want)
            p.stdin.close()
            self.assertEqual(p.wait(20), 0)
        finally:
            p.kill()
            p.wait()
            p.stdout.close()

    def test_reader_goes_away(self):
        """Quiet, code 4, and soon."""
        m = self.model(CUBE)
        text = b"0.5 0.5 0.5\n" * 300000
        source = self.folder / "points"
        source.write_bytes(text)
        for threads in ("1", "3"):
            with subprocess.Popen([PROGRAM, "query", m, "-i", source, "--threads", threads], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as p:
                self.assertEqual(p.stdout.readline(), b"inside\n")
                p.stdout.close()
                self.assertEqual(p.stderr.read(), b"")
                self.assertEqual(p.wait(30), 4)

    def test_reader_of_a_picture_goes_away(self):
        m = self.model(CUBE)
        read, write = os.pipe()
        os.close(read)
        r = run("render", m, "-o", "-", "--imgsize", "30,30", stdout=write)
        os.close(write)
        self.assertEqual((r.code, r.err), (4, ""))

    def test_non_blocking_pipes(self):
        m = self.model(CUBE)
        read, write = os.pipe()
        os.set_blocking(write, False)
        p = subprocess.Popen([PROGRAM, "query", m], stdin=subprocess.PIPE, stdout=write)
        os.close(write)
        n = 200000
        pid = os.fork()
        if pid == 0:
            os.close(read)
            p.stdin.write(b"0.5 0.5 0.5\n" * n)
            p.stdin.close()
            os._exit(0)
        p.stdin.close()
        time.sleep(0.3)
        with os.fdopen(read, "rb") as f:
            self.assertEqual(f.read(), b"inside\n" * n)
        os.waitpid(pid, 0)
        self.assertEqual(p.wait(), 0)


@unittest.skipUnless(FULL.exists(), "no /dev/full here")
class FullDisk(Case):
    def test_standard_output(self):
        m = self.model(CUBE)
        for args in (["--help"], ["--version"], ["ray", "--help"], ["query", m, 0, 0, 0], ["ray", m, 0, 0, 0, 1, 0, 0], ["check", m],
                     ["check", m, "--json"], ["tree", m], ["scene", m], ["render", m, "-o", "-", "--imgsize", "9,9"]):
            with open(FULL, "wb") as full:
                self.bad(run(*args, stdout=full), 4, "No space left")

    def test_many_lines(self):
        m = self.model(CUBE)
        with open(FULL, "wb") as full:
            r = self.bad(run("query", m, stdin="1 1 1\n" * 200000, stdout=full), 4, "No space left")
        self.assertEqual(r.err.count("\n"), 1)

    def test_a_device_is_not_replaced(self):
        m = self.model(CUBE)
        for command in ("tree", "scene"):
            self.bad(run(command, m, "-o", FULL), 4, "No space left", str(FULL))
        self.bad(run("render", m, "-o", FULL, "--imgsize", "9,9"), 4, "No space left", str(FULL))
        self.good(run("tree", m, "-o", "/dev/null"))
        for device in ("/dev/full", "/dev/null"):
            self.assertTrue(pathlib.Path(device).is_char_device())


class Files(Case):
    def limited(self, *args):
        """Runs with files limited to 100 bytes, which is how a full disk looks to a file."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        done = subprocess.run([PROGRAM, *map(str, args)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limit, timeout=60)
        return done.returncode, done.stderr.decode()

    def test_no_partial_file(self):
        m = self.model("".join(f"translate([{i}, 0, 0]) cube(1);" for i in range(50)))
        before = sorted(os.listdir(self.folder))
        for args in (["tree", m], ["scene", m], ["render", m, "--imgsize", "200,200"]):
            code, err = self.limited(*args, "-o", self.folder / "out")
            self.assertEqual(code, 4, err)
            self.assertIn("File too large", err)
            self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_an_old_file_stays_when_the_new_one_fails(self):
        m = self.model("".join(f"translate([{i}, 0, 0]) cube(1);" for i in range(50)))
        out = self.folder / "out"
        out.write_text("old")
        for args in (["tree", m], ["render", m, "--imgsize", "200,200"]):
            self.assertEqual(self.limited(*args, "-o", out)[0], 4)
            self.assertEqual(out.read_text(), "old")
        self.bad(run("tree", self.model("cube(", "bad.scad"), "-o", out), 3)
        self.assertEqual(out.read_text(), "old")

    def test_links_and_rights_are_kept(self):
        m = self.model(CUBE)
        real, link = self.folder / "real", self.folder / "link"
        real.write_text("old")
        real.chmod(0o640)
        link.symlink_to("real")
        self.good(run("tree", m, "-o", link))
        self.assertTrue(link.is_symlink())
        self.assertEqual(real.read_text(), run("tree", m).out)
        self.assertEqual(real.stat().st_mode & 0o777, 0o640)
        mask = os.umask(0)
        os.umask(mask)
        self.good(run("tree", m, "-o", self.folder / "fresh"))
        self.assertEqual((self.folder / "fresh").stat().st_mode & 0o777, 0o666 & ~mask)

    def test_a_long_name(self):
        name = "x" * 255
        self.good(run("tree", self.model(CUBE), "-o", self.folder / name))
        self.bad(run("tree", self.model(CUBE), "-o", self.folder / (name + "x")), 4, "too long")
        self.assertEqual(sorted(os.listdir(self.folder)), ["model.scad", name])

    def test_folders(self):
        m = self.model(CUBE)
        self.bad(run("tree", m, "-o", self.folder / "none" / "out"), 4, "No such file")
        self.bad(run("tree", m, "-o", self.folder), 4, "irectory")
        self.bad(run("query", m, "-i", self.folder), 4, "irectory")
        self.bad(run("query", m, "-i", self.folder / "none"), 4, "No such file")


class Streams(Case):
    def shell(self, text):
        done = subprocess.run(["sh", "-c", text, "sh", PROGRAM, str(self.model(CUBE))], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
        return done.returncode, done.stdout, done.stderr.decode()

    def test_closed_output(self):
        code, _, err = self.shell('"$1" query "$2" 0 0 0 >&-')
        self.assertEqual(code, 4)
        self.assertIn("Bad file descriptor", err)
        for command in ("check", "tree", "scene"):
            self.assertEqual(self.shell(f'"$1" {command} "$2" >&-')[0], 4)

    def test_closed_input(self):
        code, _, err = self.shell('"$1" query "$2" <&-')
        self.assertEqual(code, 4, err)
        self.assertEqual(self.shell('"$1" query "$2" 0 0 0 <&-')[:2], (0, b"boundary\n"))

    def test_closed_error(self):
        self.assertEqual(self.shell('"$1" query "$2" 0 0 x 2>&-')[0], 2)
        self.assertEqual(self.shell('"$1" check "$2".none 2>&-')[0], 4)


main()
