"""Runs the slamot program in a folder of its own and judges how it ended."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SLAMOT_PROGRAM", str(SOURCE / "build/release/bin/slamot"))
MAKE_LOGS = os.environ.get("SLAMOT_MAKE_LOGS", str(SOURCE / "build/release/bin/make_logs"))
EKF = SOURCE / "config/ekf_slamot.ini"
DEAD_RECKONING = SOURCE / "config/dead_reckoning.ini"
DEMO = SOURCE / "config/scenarios/demo.ini"

# No test waits this long: it only tells a hang from an answer.
TIMEOUT_SECONDS = 120
# What a user's sentence never holds: C++ names of exceptions, call stacks, assertions.
INTERNALS = re.compile(r"std::|terminate called|[Cc]all ?stack|BACKTRACE|basic_string|bad_alloc|filesystem error|\[json")


class SlamotTest(unittest.TestCase):
    """Every test runs in a new, empty folder. `cls.logs` holds what make_logs and `simulate` wrote, once a class."""

    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(tempfile.mkdtemp(prefix="slamot_system_"))
        cls.logs = cls.shared / "logs"
        cls.logs.mkdir()
        subprocess.run([MAKE_LOGS, str(cls.logs)], check=True, timeout=TIMEOUT_SECONDS)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.shared, ignore_errors=True)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=self.shared))

    def path(self, name):
        return self.folder / name

    def write(self, name, content):
        file = self.path(name)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return file

    def slamot(self, *arguments, code=0, says=(), env=None, **options):
        """Runs the program; checks exit code and, when it failed, that it said so in exactly one sentence that holds
        every text of `says`. Returns the finished process."""
        done = subprocess.run([PROGRAM, *map(str, arguments)], stdout=options.pop("stdout", subprocess.PIPE),
                              stderr=subprocess.PIPE, timeout=TIMEOUT_SECONDS, cwd=self.folder, text=True,
                              errors="replace", env={**os.environ, **(env or {})}, **options)
        told = f"slamot {' '.join(map(str, arguments))}\nexit code {done.returncode}\nstderr: {done.stderr}"
        codes = code if isinstance(code, tuple) else (code,)
        self.assertIn(done.returncode, codes, told)
        if done.returncode != 0:
            self.judgeSentence(done.stderr, told)
        for text in says:
            self.assertIn(text, done.stderr, told)
        return done

    def judgeSentence(self, stderr, told):
        lines = [line for line in stderr.split("\n") if line]
        self.assertEqual(len(lines), 1, f"one sentence was expected\n{told}")
        self.assertTrue(lines[0].startswith("slamot: "), told)
        self.assertIsNone(INTERNALS.search(lines[0]), told)
        self.assertLess(len(lines[0]), 600, told)

    def run_log(self, log, *arguments, config=EKF, out="out", **expected):
        return self.slamot("-q", "run", config, log, "-o", out, "--set", "output.figure=false", "--set",
                           "output.report=false", *arguments, **expected)

    def summary(self, out="out"):
        return json.loads(self.path(out).joinpath("summary.json").read_text())

    def drops(self, out="out"):
        return {(d["sensor"], d["reason"]): d["count"] for d in self.summary(out)["drops"]}

    def partFiles(self, out="out"):
        return sorted(p.name for p in self.path(out).glob("*.part"))
