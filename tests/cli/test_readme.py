"""The README tells the truth: its console blocks are run, and what it shows is what comes out."""
import os
import pathlib
import re
import subprocess
from quoin import PROGRAM, SOURCE, Case, main


def steps(text):
    """(command, expected output) pairs of all ```console blocks, in order."""
    for block in re.findall(r"(?ms)^```console\n(.*?)^```", text):
        lines, at = block.splitlines(keepends=True), 0
        while at < len(lines):
            assert lines[at].startswith("$ "), lines[at]
            command = lines[at][2:]
            at += 1
            here = re.search(r"<<'(\w+)'", command)
            while here and lines[at - 1].strip() != here[1]:
                command += lines[at]
                at += 1
            out = ""
            while at < len(lines) and not lines[at].startswith("$ "):
                out += lines[at]
                at += 1
            yield command, out


class Readme(Case):
    def test_console(self):
        bin_ = self.folder / "bin"
        bin_.mkdir()
        (bin_ / "quoin").symlink_to(pathlib.Path(PROGRAM).resolve())
        env = dict(os.environ, PATH=f"{bin_}:{os.environ['PATH']}")
        count = 0
        for command, want in steps((SOURCE / "README.md").read_text()):
            done = subprocess.run(["sh", "-c", command], cwd=self.folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60)
            self.assertEqual(done.stdout.decode(), want, command)
            count += 1
        self.assertGreater(count, 8)

    def test_links(self):
        for page in [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]:
            for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
                self.assertTrue((page.parent / target).exists(), f"{page.name}: {target}")


main()
