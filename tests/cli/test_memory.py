"""--max-memory: what does not fit is refused with exit code 4 and words that name the option; what fits is answered as without it; the program stays near it."""
import os
import subprocess

from quoin import Case, COMMANDS, PROGRAM, main, run

SPHERES = "".join(f"translate([{3 * (i % 100)}, {3 * (i // 100)}, 0]) sphere(1);\n" for i in range(10000))
QUESTIONS = {"query": ["0", "0", "0"], "ray": ["-5", "0", "0", "1", "0", "0"]}


class Memory(Case):
    def arguments(self, command, model, limit):
        out = ["-o", self.folder / "out.png"] if command == "render" else []
        return [command, *out, "--threads", "1", *(["--max-memory", limit] if limit else []), model, *QUESTIONS.get(command, [])]

    def peak(self, command, model, limit):
        child = subprocess.Popen([PROGRAM, *map(str, self.arguments(command, model, limit))], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        return child.returncode, used.ru_maxrss / 1024

    def test_refused_under_a_small_limit_and_answered_under_a_large_one(self):
        model = self.model(SPHERES)
        for command in COMMANDS:
            self.bad(run(*self.arguments(command, model, "100k")), 4, "out of memory", "102400 bytes of --max-memory")
            self.assertEqual(list(self.folder.glob("*.png*")), [])
            usual, limited = (run(*self.arguments(command, model, limit)) for limit in (None, "1G"))
            self.good(limited, usual.out)
            for left in self.folder.glob("*.png"):
                left.unlink()

    def test_every_limit_is_a_clean_end(self):
        """Refusals at many places of the run: never another code, never a word but the option's, never a file."""
        model = self.model("".join(SPHERES.splitlines(True)[:1000]))
        good = 0
        for limit in [1, 1000, 30000, *range(100000, 3000000, 250000)]:
            for command in ("check", "ray", "render"):
                done = run(*self.arguments(command, model, str(limit)))
                good += done.code == 0
                if done.code != 0:
                    self.bad(done, 4, "--max-memory" if command != "ray" else "memory")
                    self.assertEqual(list(self.folder.glob("*.png*")), [])
                    self.assertEqual(done.out if command != "check" else "", "")
                for left in self.folder.glob("*.png"):
                    left.unlink()
        self.assertGreater(good, 3)

    def test_the_program_stays_near_it(self):
        if os.environ.get("QUOIN_SANITIZED"):
            self.skipTest("a sanitizer has memory of its own")
        model = self.model(SPHERES * 20)
        for limit in (30, 60): # a child begins with its parent's memory, some 30 MB
            code, peak = self.peak("check", model, f"{limit}M")
            self.assertEqual(code, 4)
            self.assertLess(peak, limit + 20)
        code, peak = self.peak("check", model, "2G")
        self.assertEqual(code, 0)
        self.assertGreater(peak, 50)

    def test_a_picture_counts(self):
        model = self.model("sphere(1);")
        self.bad(run("render", model, "-o", self.folder / "a.png", "--imgsize", "4000,4000", "--max-memory", "20M"), 4, "no picture of 4000 x 4000", "--max-memory")
        self.assertFalse((self.folder / "a.png").exists())

    def test_sizes(self):
        model = self.model("cube(1);")
        for size in ("100M", "1g", "2097152", "4096k", "4096K"):
            self.good(run("check", "--max-memory", size, model))
        for size in ("", "0", "-1", "1.5G", "10X", "10MB", "M", "99999999999999999999", "99999999999G", "0x10", "1 M"):
            self.bad(run("check", f"--max-memory={size}", model), 2, "--max-memory", "500M")


if __name__ == "__main__":
    main()
