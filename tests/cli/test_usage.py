"""Options, help, exit codes of wrong usage."""
import re
from quoin import COMMANDS, Case, main, run

CUBE = "cube(2, center = true);"


class Help(Case):
    def test_help_names_every_command(self):
        r = self.good(run("--help"))
        for command in COMMANDS:
            self.assertRegex(r.out, rf"(?m)^  {command} ")
        self.assertEqual(r.err, "")

    def test_version(self):
        self.assertRegex(self.good(run("--version")).out, r"^quoin \d+\.\d+\.\d+\n$")

    def test_each_command_has_help(self):
        for command in COMMANDS:
            r = self.good(run(command, "--help"))
            self.assertTrue(r.out.startswith(f"Usage: quoin {command} "), r)
            for option in ("--threads", "--stats", "--help", "--quiet", "--facets", "--max-memory"):
                self.assertIn(option, r.out)
            self.assertEqual(run("help", command).out, r.out)
            self.assertEqual(run(command, "-h").out, r.out)

    def test_help_of_help(self):
        for word in ("--help", "-h"):
            self.assertEqual(self.good(run("help", word)).out, run("--help").out)

    def test_only_query_answers_no(self):
        for command in COMMANDS:
            self.assertEqual("  --exit-code " in run(command, "--help").out, command == "query")

    def test_every_option_in_the_help_is_taken(self):
        """What the help lists is known, and what takes a value in the help does so."""
        for command in COMMANDS:
            rows = re.findall(r"(?m)^  (?:-\w, )?--([a-z-]+)( \S+)?", run(command, "--help").out)
            self.assertGreaterEqual(len(rows), 5)
            for name, value in rows:
                if name == "help":
                    continue
                r = run(command, f"--{name}") if value else run(command, f"--{name}=3")
                self.bad(r, 2, "needs a value" if value else "takes no value", f"--{name}")

    def test_lines_are_short(self):
        for args in [["--help"]] + [[c, "--help"] for c in COMMANDS]:
            for line in run(*args).out.splitlines():
                self.assertLessEqual(len(line), 130, line)


class Wrong(Case):
    def test_no_command(self):
        self.bad(run(), 2, "no command", "quoin --help")

    def test_unknown_command(self):
        self.bad(run("rendr"), 2, "'rendr'", "did you mean 'render'?")
        self.bad(run("xyzzyxyzzy"), 2, "unknown command 'xyzzyxyzzy'")
        self.bad(run("--hlep"), 2, "did you mean '--help'?")
        self.bad(run(self.model(CUBE)), 2, "the command comes before the model")

    def test_unknown_option(self):
        m = self.model(CUBE)
        self.bad(run("render", m, "--imgsise", "3,4"), 2, "unknown option '--imgsise'", "did you mean '--imgsize'?", "quoin render --help")
        self.bad(run("ray", m, "--boundry"), 2, "'--boundary'")
        self.bad(run("render", m, "--proj=ortho"), 2, "did you mean '--projection'?")
        self.bad(run("query", m, "-stats"), 2, "--stats")
        r = self.bad(run("query", m, "--wholly-unlike-anything"), 2, "unknown option")
        self.assertNotIn("did you mean", r.err)

    def test_model_is_missing(self):
        for command in COMMANDS:
            self.bad(run(command), 2, "no MODEL given", f"quoin {command} --help")

    def test_one_model(self):
        m = self.model(CUBE)
        for command in ("check", "tree", "scene"):
            self.bad(run(command, m, "other.scad"), 2, "'other.scad'", "one too many")
        self.bad(run("render", m, "other.scad", "-o", self.folder / "x.png"), 2, "one too many")

    def test_values(self):
        m = self.model(CUBE)
        for value in ("x", "-1", "1.5", "", "99999999999999999999", "0x2", "1 "):
            self.bad(run("query", m, f"--threads={value}", 0, 0, 0), 2, "--threads")
        self.bad(run("query", m, "--facets", "some", 0, 0, 0), 2, "auto, honour or ignore")

    def test_control_bytes_do_not_reach_the_terminal(self):
        r = self.bad(run("\x1b[31mred"), 2, "?[31mred")
        self.assertNotIn("\x1b", r.err)
        r = self.bad(run("query", self.model(CUBE), "1\x1b]0;t\x07", 2, 3), 2, "not a number")
        self.assertNotIn("\x1b", r.err)
        self.bad(run("x" * 100000), 2, "xxx...'")


class Forms(Case):
    def test_long_and_short_forms(self):
        m = self.model(CUBE)
        out = self.folder / "tree"
        self.good(run("tree", m, "-o", out))
        want = out.read_bytes()
        self.assertTrue(want)
        for form in (["-o" + str(out)], ["--output", out], [f"--output={out}"], ["-qo", out], ["-qo" + str(out)]):
            out.unlink()
            self.good(run("tree", m, *form))
            self.assertEqual(out.read_bytes(), want)
            out.unlink()
            self.good(run("tree", *form, m))
            self.assertEqual(out.read_bytes(), want)

    def test_double_dash_ends_options(self):
        m = self.model(CUBE, "-odd-.scad")
        self.bad(run("check", m.name, cwd=self.folder), 2)
        self.good(run("check", "--", m.name, cwd=self.folder))
        self.bad(run("query", "--", m.name, "--json", cwd=self.folder), 2, "'--json' is not a number")

    def test_a_negative_number_is_a_number(self):
        m = self.model(CUBE)
        self.good(run("query", m, "-1", "-.5", "-0.5e0"), "boundary\n")
        self.good(run("query", m, "--threads", 1, "-3", "-4e-1", "-5", "--quiet"), "outside\n")
        self.good(run("ray", m, "-3", "-0.5", "-0.5", "2", "-0", "-0"), "1 1 2\n")
        self.bad(run("query", m, "-inf", 0, 0), 2, "'-inf' is not a number")
        self.bad(run("query", m, "-nan", 0, 0), 2, "'-nan' is not a number")

    def test_model_on_standard_input(self):
        self.good(run("query", "-", 0, 0, 0, stdin=CUBE), "inside\n")
        self.good(run("check", "-", stdin=CUBE))
        self.bad(run("query", "-", stdin=CUBE), 2, "cannot both come from standard input")
        points = self.folder / "points"
        points.write_text("0 0 0\n1 0 0\n")
        self.good(run("query", "-", "-i", points, stdin=CUBE), "inside\nboundary\n")
        self.bad(run("check", "-", stdin="cube(2\n"), 3, "<stdin>:")


main()
