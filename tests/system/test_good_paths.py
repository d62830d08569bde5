"""What must work: a log made, looked at, run, measured again, converted."""
import gzip
import json
import re
import shutil
import subprocess
import unittest

from program import DEMO, EKF, SOURCE, SlamotTest


class GoodPaths(SlamotTest):
    def demo(self):
        self.slamot("simulate", DEMO, "-o", "demo.rawlog", "--seed", "3")

    def test_simulate_info_run_and_eval_agree(self):
        self.demo()
        info = json.loads(self.slamot("info", "demo.rawlog", "--json").stdout)
        counts = {s["label"]: s for s in info["sensors"]}
        self.slamot("run", EKF, "demo.rawlog", "-o", "out", "--set", "start.pose=truth", "--set", "motion.model=steered",
                    "--set", "motion.wheelbase=2")
        summary = self.summary()
        self.assertEqual(summary["status"], "complete")
        self.assertEqual(summary["counts"]["odometry"], counts["odometry"]["count"])
        self.assertEqual(summary["counts"]["detections"],
                         counts["landmarks"]["detections"] + counts["movers"]["detections"])
        self.slamot("-q", "eval", "out", "--truth", "demo.truth", "--json", "metrics.json")
        self.assertEqual(json.loads(self.path("metrics.json").read_text()), summary["metrics"])
        # The TUM file is the same trajectory with its covariances left out.
        self.slamot("-q", "eval", "out/trajectory.tum", "--truth", "demo.truth", "--json", "tum.json")
        tum = json.loads(self.path("tum.json").read_text())
        # Poses go through sines and cosines of half angles: rounding of metres.
        self.assertAlmostEqual(tum["ate"]["position"]["rmse"], summary["metrics"]["ate"]["position"]["rmse"], delta=1e-9)

    def test_the_shipped_log_is_what_its_command_makes_and_runs(self):
        shipped = SOURCE / "rawlogs/demo.rawlog"
        self.slamot("simulate", DEMO, "-o", "demo.rawlog")
        self.assertEqual(gzip.decompress(self.path("demo.rawlog").read_bytes()), gzip.decompress(shipped.read_bytes()))
        self.slamot("run", SOURCE / "config/runs/demo.ini", shipped, "-o", "out")
        self.assertLess(self.summary()["metrics"]["robot"]["position"]["rmse"], 1.0)

    def test_somebody_elses_files_are_not_overwritten(self):
        self.demo()
        truth = self.path("demo.truth/landmarks.csv").read_bytes()
        self.slamot("run", EKF, "demo.rawlog", "-o", "demo.truth", code=2, says=["demo.truth", "landmarks.csv", "new folder"])
        self.assertEqual(self.path("demo.truth/landmarks.csv").read_bytes(), truth)

    def test_every_shipped_scenario_makes_a_log(self):
        for scenario in sorted((SOURCE / "config/scenarios").glob("*.ini")):
            with self.subTest(scenario=scenario.name):
                self.slamot("-q", "simulate", scenario, "-o", f"{scenario.stem}.rawlog")

    def test_the_same_seed_gives_the_same_bytes(self):
        self.demo()
        self.slamot("simulate", DEMO, "-o", "again.rawlog", "--seed", "3")
        self.slamot("simulate", DEMO, "-o", "other.rawlog", "--seed", "4")
        one, again, other = (self.path(n).read_bytes() for n in ("demo.rawlog", "again.rawlog", "other.rawlog"))
        self.assertEqual(one, again)
        self.assertNotEqual(one, other)
        for threads in (1, 3):
            self.run_log("demo.rawlog", "--threads", threads, out=f"out{threads}")
        self.assertEqual(self.summary("out1")["estimate_sha256"], self.summary("out3")["estimate_sha256"])

    def test_convert_there_and_back(self):
        self.demo()
        self.slamot("convert", "demo.rawlog", "-o", "frames.rawlog", "--format", "action-frames")
        self.slamot("convert", "frames.rawlog", "-o", "back.rawlog", "--format", "observations")
        sensors = [{s["label"]: s["detections"] for s in json.loads(self.slamot("info", log, "--json").stdout)["sensors"]
                    if s["detections"]} for log in ("demo.rawlog", "frames.rawlog", "back.rawlog")]
        self.assertEqual(sensors[0], sensors[1])
        self.assertEqual(sensors[0], sensors[2])
        for log in ("frames.rawlog", "back.rawlog"):
            self.run_log(log)
            self.assertEqual(self.summary()["status"], "complete")

    def test_convert_cuts_and_filters(self):
        self.demo()
        self.slamot("convert", "demo.rawlog", "-o", "cut.rawlog", "--label", "landmarks", "--from", "+10", "--to", "+20")
        sensors = {s["label"]: s for s in json.loads(self.slamot("info", "cut.rawlog", "--json").stdout)["sensors"]}
        self.assertEqual(sorted(sensors), ["landmarks", "odometry"])
        self.assertEqual(sensors["odometry"]["count"], 101)  # 10 s to 20 s, both ends, each 0.1 s
        for arguments, says in ((["--label", "landmark"], ["--label landmark", "did you mean"]),
                                (["--from", "+20", "--to", "+10"], ["--from/--to", "expected times within"]),
                                (["--from", "+1000"], ["--from/--to"]), (["--from", "noon"], ["noon"])):
            self.slamot("convert", "demo.rawlog", "-o", "x.rawlog", *arguments, code=2, says=says)
        self.slamot("convert", "demo.rawlog", "-o", "demo.rawlog", code=2, says=["is the log that is read"])

    def test_mrpts_own_tool_counts_the_same_objects(self):
        if not shutil.which("rawlog-edit"):
            self.skipTest("mrpt-apps is not installed")
        self.demo()
        self.run_log("demo.rawlog")
        for log in ("demo.rawlog", "out/estimate.rawlog", self.logs / "frames.rawlog"):
            ours = json.loads(self.slamot("info", log, "--json").stdout)
            theirs = subprocess.run(["rawlog-edit", "--info", "-i", str(log)], cwd=self.folder, capture_output=True,
                                    text=True, timeout=120, check=True).stdout
            found = re.search(r"^Overall number of objects\s*:\s*(\d+)", theirs, re.MULTILINE)
            self.assertIsNotNone(found, theirs)
            self.assertEqual(int(found.group(1)), ours["objects"], log)


if __name__ == "__main__":
    unittest.main()
