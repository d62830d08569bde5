"""Truth folders that are missing, broken or of another time; metrics on what cannot be measured."""
import json
import shutil
import unittest

from program import DEMO, EKF, SlamotTest


class TruthAndEval(SlamotTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        import subprocess

        from program import PROGRAM
        subprocess.run([PROGRAM, "-q", "simulate", DEMO, "-o", cls.logs / "demo.rawlog", "--set", "scenario.steps=100"],
                       check=True)
        subprocess.run([PROGRAM, "-q", "run", EKF, cls.logs / "demo.rawlog", "-o", cls.logs / "demo_out", "--set",
                        "output.figure=false", "--set", "start.pose=truth"], check=True)

    def truth(self):
        copy = self.path("truth")
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.logs / "demo.truth", copy)
        return copy

    def both(self, truth, **expected):
        """The same answer from `run` and `eval`."""
        self.run_log(self.logs / "demo.rawlog", "--truth", truth, **expected)
        self.slamot("eval", self.logs / "demo_out", "--truth", truth, **expected)

    def test_folders(self):
        self.both("nowhere", code=2, says=["nowhere", "expected one with truth"])
        self.both(self.write("file", ""), code=2, says=["file", "expected one with truth"])
        self.path("empty").mkdir()
        self.both("empty", code=2, says=["empty", "expected robot.csv"])
        self.both(self.logs / "demo_out", code=2, says=["is the output of a run"])

    def test_no_truth_is_no_error(self):
        self.run_log(self.logs / "demo.rawlog", "--truth", "none")
        self.assertIsNone(self.summary()["metrics"])
        self.run_log(self.logs / "good.rawlog")
        self.assertIsNone(self.summary()["metrics"])

    def test_broken_tables(self):
        for name, old, new, says in (("robot.csv", ",", ";", ["robot.csv:1", "'t'"]),
                                     ("robot.csv", "t,x", "t,xx", ["robot.csv:1", "column 'x'"]),
                                     ("landmarks.csv", "\n0,", "\nzero,", ["landmarks.csv:2", "'zero'", "integer"]),
                                     ("truth.json", "{", "", ["truth.json", "expected a JSON object"])):
            file = self.truth() / name
            text = file.read_text()
            self.assertIn(old, text)
            file.write_text(text.replace(old, new, 1) if name != "robot.csv" or old != "," else text.replace(old, new))
            self.both("truth", code=2, says=says)

        file = self.truth() / "robot.csv"
        lines = file.read_text().splitlines()
        for change, says in ((lines[:5] + [lines[3]] + lines[5:], ["robot.csv:6", "later than the row before"]),
                             (lines[:5] + ["1,2"] + lines[5:], ["robot.csv:6", "2 fields", "expected 4"]),
                             (lines[:5] + [lines[5].rsplit(",", 1)[0] + ",nan"] + lines[6:], ["robot.csv:6", "finite"]),
                             (lines[:5] + ["x" + lines[5]] + lines[6:], ["robot.csv:6", "decimal seconds"]),
                             ([], ["robot.csv:1", "header"])):
            file.write_text("".join(line + "\n" for line in change))
            self.both("truth", code=2, says=says)
        self.truth().joinpath("target_x.csv").write_text("t,x,y\n")
        self.both("truth", code=2, says=["target_x.csv", "target_7.csv"])

    def test_truth_of_another_time_matches_nothing_and_says_so(self):
        file = self.truth() / "robot.csv"
        head, *rows = file.read_text().splitlines()
        moved = [str(float(row.split(",")[0]) - 1e9) + "," + row.split(",", 1)[1] for row in rows]
        file.write_text("\n".join([head] + moved) + "\n")
        shown = self.slamot("eval", self.logs / "demo_out", "--truth", "truth", "--json", "m.json").stdout
        self.assertIn("Robot: 0 of", shown)
        metrics = json.loads(self.path("m.json").read_text())
        self.assertNotIn("robot", metrics)
        self.assertIn("truth", metrics["absent"]["robot"])
        self.run_log(self.logs / "demo.rawlog", "--truth", "truth")
        self.run_log(self.logs / "demo.rawlog", "--truth", "truth", "--set", "start.pose=truth", code=2,
                     says=["[start] pose = truth", "no robot pose"])
        self.run_log(self.logs / "good.rawlog", "--set", "start.pose=truth", code=2, says=["no truth was given"])

    def test_what_is_no_run(self):
        truth = self.logs / "demo.truth"
        self.slamot("eval", "none", "--truth", truth, code=2, says=["none", "expected"])
        self.path("empty").mkdir()
        self.slamot("eval", "empty", "--truth", truth, code=2, says=["empty/trajectory.csv"])
        for text, says in (("", ["no rows"]), ("1 2 3\n", ["line 1", "3 numbers", "the 8"]),
                           ("1 2 3 4 0 0 0 1\n1 2 3 4 0 0 0 1\n", ["line 2", "after the line before"]),
                           ("1 2 3 4 0 0 0 0\n", ["line 1", "quaternion"]),
                           ("1e18 2 3 4 0 0 0 1\n", ["line 1", "seconds"]),
                           ("1 2 3 4 0 0 0 x\n", ["line 1", "'x'", "finite number"])):
            self.slamot("eval", self.write("t.tum", text), "--truth", truth, code=2, says=["t.tum", *says])
        for assignment in ("eval.foo=1", "foo.bar=1", "eval"):
            self.slamot("eval", self.logs / "demo_out", "--truth", truth, "--set", assignment, code=2, says=["--set"])
        self.slamot("eval", self.logs / "demo_out", "--truth", truth, "--json", "none/m.json", code=2,
                    says=["none/m.json"])

    def test_a_damaged_output_folder(self):
        out = self.path("out")
        for name, change, says in (("trajectory.csv", lambda s: s.replace("c_xx", "cxx"), ["trajectory.csv:1", "c_xx"]),
                                   ("tracks.csv", lambda s: s.replace("existence", "exists"), ["tracks.csv:1"]),
                                   ("landmarks.csv", lambda s: s.replace("\n", "\nx", 1), ["landmarks.csv:2"]),
                                   ("innovations.csv", lambda s: s.replace("initiated", "born", 1), ["innovations.csv"])):
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(self.logs / "demo_out", out)
            (out / name).write_text(change((out / name).read_text()))
            self.slamot("eval", out, "--truth", self.logs / "demo.truth", code=2, says=says)


if __name__ == "__main__":
    unittest.main()
