"""Ctrl-C and kill during a run, and a second run into the same folder."""
import signal
import subprocess
import time
import unittest

from program import EKF, PROGRAM, TIMEOUT_SECONDS, SlamotTest


class Interrupted(SlamotTest):
    def start(self):
        """A run of the slow log that has written its first full lines."""
        run = subprocess.Popen([PROGRAM, "run", str(EKF), str(self.logs / "slow.rawlog"), "-o", "out"],
                               cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.kill)
        trajectory = self.path("out/trajectory.csv.part")
        deadline = time.monotonic() + TIMEOUT_SECONDS
        while not trajectory.exists() or trajectory.stat().st_size < 2000:
            self.assertIsNone(run.poll(), "the run ended before it could be interrupted")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        return run

    def interrupt(self, number):
        run = self.start()
        run.send_signal(number)
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 1, stderr)
        self.judgeSentence("\n".join(l for l in stderr.split("\n") if not l.startswith("running ")), stderr)
        self.assertIn("stopped", stderr)
        self.assertEqual(self.summary()["status"], "stopped")
        self.assertEqual(self.partFiles(), [])
        rows = self.path("out/trajectory.csv").read_text().splitlines()
        self.assertGreater(len(rows), 5)
        self.assertLess(len(rows), 500)
        self.assertGreater(self.summary()["counts"]["landmarks"], 0)

    def test_ctrl_c_stops_cleanly_with_all_outputs(self):
        self.interrupt(signal.SIGINT)

    def test_so_does_sigterm(self):
        self.interrupt(signal.SIGTERM)

    def test_a_killed_run_leaves_part_files_readable_to_the_last_full_line(self):
        run = self.start()
        run.send_signal(signal.SIGKILL)
        run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertIn("trajectory.csv.part", self.partFiles())
        self.assertFalse(self.path("out/trajectory.csv").exists())
        self.assertFalse(self.path("out/summary.json").exists())
        text = self.path("out/trajectory.csv.part").read_text()
        columns = text.splitlines()[0].count(",")
        full = text[:text.rindex("\n")].split("\n")
        self.assertGreater(len(full), 5)
        for line in full:
            self.assertEqual(line.count(","), columns)
        # The next run into the same folder leaves nothing of the killed one.
        self.run_log(self.logs / "good.rawlog")
        self.assertEqual(self.partFiles(), [])
        self.assertEqual(self.summary()["status"], "complete")

    def test_a_second_run_replaces_the_first(self):
        self.run_log(self.logs / "good.rawlog")
        first = self.summary()
        self.run_log(self.logs / "good.rawlog", "--set", "output.rawlog=false")
        self.assertEqual(self.summary()["estimate_sha256"], first["estimate_sha256"])
        self.assertFalse(self.path("out/estimate.rawlog").exists())
        self.assertFalse(self.path("out/estimate.rawlog.sha256").exists())
        self.run_log(self.logs / "no_odometry.rawlog", code=2)
        self.assertFalse(self.path("out/summary.json").exists(), "an old summary would pass for that of the failed run")


if __name__ == "__main__":
    unittest.main()
