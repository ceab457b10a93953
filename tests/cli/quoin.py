"""Runs the command; what the tests of tests/cli share."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["QUOIN"]
SOURCE = pathlib.Path(os.environ["QUOIN_SOURCE"])
COMMANDS = ["render", "query", "ray", "check", "tree", "scene"]


class Result:
    def __init__(self, done):
        self.code = done.returncode
        self.raw = done.stdout
        self.out = done.stdout.decode("utf-8", "replace")
        self.err = done.stderr.decode("utf-8", "replace")

    def __repr__(self):
        return f"exit {self.code}\nstdout: {self.out[:2000]}\nstderr: {self.err[:2000]}"


def run(*args, stdin=b"", cwd=None, stdout=subprocess.PIPE, timeout=40 * float(os.environ.get("QUOIN_TEST_SLOWER", 3))):
    done = subprocess.run([PROGRAM, *map(str, args)], input=stdin.encode() if isinstance(stdin, str) else stdin, stdout=stdout,
                          stderr=subprocess.PIPE, cwd=cwd, timeout=timeout)
    done.stdout = done.stdout or b""
    return Result(done)


class Case(unittest.TestCase):
    """A test case with a folder of its own and models by text."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="quoin-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def model(self, text, name="model.scad"):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def good(self, result, out=None):
        self.assertEqual(result.code, 0, result)
        if out is not None:
            self.assertEqual(result.out, out, result)
        return result

    def bad(self, result, code, *words):
        """It failed with this code, said something of each of these words, and neither crashed nor rambled."""
        self.assertEqual(result.code, code, result)
        for word in words:
            self.assertIn(word, result.err, result)
        self.assertNotIn("Sanitizer", result.err)
        self.assertLess(len(result.err), 20000)
        return result


def main():
    unittest.main(verbosity=1)
