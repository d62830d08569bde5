"""Logs that are whole, but lack something or hold odd values."""
import unittest

from program import DEAD_RECKONING, SlamotTest


class OddLogs(SlamotTest):
    def log(self, name):
        return self.logs / (name + ".rawlog")

    def test_without_odometry(self):
        self.run_log(self.log("no_odometry"), code=2,
                     says=["no_odometry.rawlog", "no odometry", "100 of 'landmarks' (before-odometry)"])
        self.assertIn("odometry: none", self.slamot("info", self.log("no_odometry")).stdout)

    def test_without_detections(self):
        self.run_log(self.log("no_detections"), code=2, says=["no_detections.rawlog", "no detection", "ekf_slamot"])
        self.run_log(self.log("no_detections"), config=DEAD_RECKONING)
        self.assertIn("needs detections", self.slamot("info", self.log("no_detections")).stdout)

    def test_without_identities(self):
        told = self.slamot("info", self.log("no_identities")).stdout
        self.assertRegex(told, r"ekf_slamot +can use it if it does without identities: the log has none")
        self.assertRegex(told, r"dead_reckoning +can use it\n")
        self.assertRegex(self.slamot("info", self.log("good")).stdout, r"ekf_slamot +can use it\n")
        self.run_log(self.log("no_identities"))

    def test_without_identities_where_only_they_count(self):
        known = [text for kind in ("landmarks", "movers") for text in ("--set", f"ekf_slamot.association.{kind}=known")]
        self.run_log(self.log("no_identities"), *known, code=2,
                     says=["no_identities.rawlog", "600 detections", "identities"])
        self.assertEqual(self.partFiles(), sorted(p.name for p in self.path("out").iterdir()))

    def test_with_unknown_labels_only(self):
        self.run_log(self.log("unknown_labels"), code=2, says=["100 of 'front camera' (no-role-in-[sensors])"])
        self.run_log(self.log("unknown_labels"), "--set", "sensors.front camera=landmarks")
        self.assertEqual(self.summary()["counts"]["landmarks"], 6)
        self.run_log(self.log("unknown_labels"), "--set", "sensors.front camera=ignore", code=2, says=["role-ignore"])

    def test_readings_that_are_no_numbers(self):
        self.run_log(self.log("some_unusable"))
        self.assertEqual(self.drops(), {("landmarks", "not-finite"): 200, ("landmarks", "range-not-positive"): 100})
        self.assertEqual(self.summary()["counts"]["detections"], 300)
        self.run_log(self.log("all_nan"), code=2, says=["600 of 'landmarks' (not-finite)"])

    def test_without_a_claim_of_noise(self):
        self.run_log(self.log("no_noise"), code=2, says=["'landmarks'", "[noise.landmarks]", "range_std", "bearing_std_deg"])
        self.run_log(self.log("no_noise"), "--set", "noise.landmarks.range_std=0.1", "--set",
                     "noise.landmarks.bearing_std_deg=1")
        self.assertIn("claims no noise", self.slamot("info", self.log("no_noise")).stdout)

    def test_time_that_goes_back(self):
        self.run_log(self.log("good"), out="in_order")
        self.run_log(self.log("time_back"))
        self.assertEqual(self.drops(), {("odometry", "late"): 1})
        self.assertEqual(self.summary()["estimate_sha256"], self.summary("in_order")["estimate_sha256"])
        self.assertIn("1 of 'odometry' (late)", self.slamot("info", self.log("time_back")).stdout)

    def test_stamps_that_are_none(self):
        self.run_log(self.log("some_without_stamp"))
        self.assertEqual(self.drops(), {("landmarks", "no-stamp"): 20})
        self.run_log(self.log("no_stamps"), code=2, says=["no_stamps.rawlog", "no odometry", "(no-stamp)"])

    def test_two_odometries(self):
        self.run_log(self.log("two_odometries"), code=2, says=["'odometry'", "'visual'", "[run] odometry"])
        self.run_log(self.log("two_odometries"), "--set", "run.odometry=visual")
        self.assertEqual(self.drops(), {("odometry", "other-odometry"): 100})
        self.run_log(self.log("two_odometries"), "--set", "run.odometry=gps", code=2, says=["other-odometry"])

    def test_a_label_that_is_no_text(self):
        self.run_log(self.log("odd_label"))
        self.assertEqual(sum(self.drops().values()), 10)
        self.slamot("info", self.log("odd_label"))
        self.slamot("info", self.log("odd_label"), "--json")

    def test_action_frames(self):
        self.run_log(self.log("frames"))
        self.assertEqual(self.summary()["counts"]["detections"], 600)
        self.run_log(self.log("frames_with_holes"))
        counts = self.summary()["counts"]
        self.assertEqual(counts["detections"], 600)
        self.assertEqual(counts["odometry_gaps"], 14)  # k = 3, 10, ..., 94

    def test_an_action_that_is_no_number_ends_it(self):
        for arguments in (["info", self.log("frames_with_nan")],
                          ["convert", self.log("frames_with_nan"), "-o", "x.rawlog"]):
            self.slamot(*arguments, code=2, says=["frames_with_nan.rawlog", "object", "not finite"])
        self.run_log(self.log("frames_with_nan"), code=2, says=["frames_with_nan.rawlog", "object", "not finite"])

    def test_a_model_the_odometry_cannot_feed(self):
        self.run_log(self.log("frames"), "--set", "motion.model=steered", code=2, says=["[motion] model"])


if __name__ == "__main__":
    unittest.main()
