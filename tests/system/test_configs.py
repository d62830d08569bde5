"""Mistakes on the command line, in config and scenario files, and with plugins and folders."""
import os
import unittest

from program import DEMO, EKF, PROGRAM, SlamotTest


class Usage(SlamotTest):
    def test_a_label_that_the_log_does_not_have(self):
        done = self.run_log(self.logs / "good.rawlog", "--set", "sensors.landmark=landmarks")
        self.assertEqual(done.stderr, "slamot: warning: [sensors] names sensor 'landmark', which the log does not have "
                                      "(did you mean 'landmarks'?)\n")
        self.assertEqual(len(self.summary()["warnings"]), 1)
        self.assertEqual(self.run_log(self.logs / "good.rawlog").stderr, "")

    def test_the_command_line(self):
        self.slamot(code=2, says=["subcommand"])
        self.slamot("simulat", code=2, says=["'simulat'", "did you mean 'simulate'?"])
        self.slamot("run", code=2, says=["config is required", "slamot run --help"])
        self.slamot("run", EKF, self.logs / "good.rawlog", code=2, says=["--out"])
        self.slamot("run", EKF, self.logs / "good.rawlog", "-o", "out", "--frob", code=2, says=["--frob"])
        for threads in ("0", "-1", "two", "1.5"):
            self.run_log(self.logs / "good.rawlog", "--threads", threads, code=2, says=["--threads", "1 to 1024"])
        for seed in ("-1", "1.5", "abc", "99999999999999999999999"):
            self.run_log(self.logs / "good.rawlog", "--seed", seed, code=2, says=["seed", seed, "whole number"])
            self.slamot("simulate", DEMO, "-o", "x.rawlog", "--seed", seed, code=2, says=["seed", seed, "whole number"])
        for command in ("simulate", "import", "convert", "info", "run", "eval", "plugins", "config"):
            self.assertIn("Example: slamot " + command, self.slamot(command, "--help").stdout)
        self.assertIn("slamot 0.", self.slamot("--version").stdout)

    def test_standard_output_that_is_full(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("there is no /dev/full")
        for arguments in (["info", self.logs / "good.rawlog"], ["config", "ekf_slamot"], ["plugins"]):
            with open("/dev/full", "w") as full:
                self.slamot(*arguments, code=1, stdout=full)


class Configs(SlamotTest):
    def run_config(self, text, *arguments, **expected):
        return self.run_log(self.logs / "good.rawlog", *arguments, config=self.write("my.ini", text), **expected)

    def test_files(self):
        log = self.logs / "good.rawlog"
        self.run_log(log, config="none.ini", code=2, says=["none.ini", "no such config file"])
        self.path("folder").mkdir()
        self.run_log(log, config="folder", code=2, says=["folder", "config file"])
        self.run_config(b"\x00\x01\x02", code=2, says=["my.ini", "expected INI text"])
        self.run_config((self.logs / "good.rawlog").read_bytes(), code=2, says=["my.ini"])
        self.run_config("")  # all defaults

    def test_mistakes_name_file_line_and_what_was_expected(self):
        for text, says in (
                ("[run]\nestimater = x\n", ["my.ini:2", "'estimater'", "did you mean 'estimator'?"]),
                ("[rum]\nseed = 1\n", ["my.ini:1", "[rum]", "did you mean 'run'?"]),
                ("seed = 1\n", ["my.ini:1", "before any section"]),
                ("[run\nseed = 1\n", ["my.ini:1", "[name]"]),
                ("[run]\nseed\n", ["my.ini:2", "expected key = value"]),
                ("[run]\nseed = 1\nseed = 2\n", ["my.ini:3", "twice", "line 2"]),
                ("[run]\n[log]\n[run]\n", ["my.ini:3", "twice", "line 1"]),
                ("[run]\nestimator = kalman\n", ["'kalman'", "ekf_slamot"]),
                ("[run]\nestimator =\n", ["estimator"]),
                ("[run]\nseed = 3.9\n", ["my.ini:2", "'3.9'", "whole number"]),
                ("[log]\nstep = 0\n", ["my.ini:2", "step", "(0, 3600]"]),
                ("[noise]\nrange_std = nan\n", ["my.ini:2", "range_std", "above 0"]),
                ("[noise]\nrange_std = 0,1\n", ["my.ini:2", "'0,1'"]),
                ("[motion]\nmodel = tracked\n", ["my.ini:2", "steered | differential"]),
                ("[motion]\nwheelbase = -1\n", ["my.ini:2", "wheelbase"]),
                ("[ekf_slamot.target]\nschedule = 15:caa\n", ["my.ini:2", "schedule"]),
                ("[ekf_slamot.outliers]\ngate_probability = 1\n", ["my.ini:2", "(0, 1)"]),
                ("[dead_reckoning]\nnoise_scale = 0\n", ["my.ini:2", "above 0"]),
                ("[start]\npose = 1,2,inf\n", ["my.ini:2", "x,y,theta_deg"]),
                ("[eval]\nprobability = 2\n", ["my.ini:2", "probability"])):
            self.run_config(text, code=2, says=says)
            self.assertFalse(self.path("out/summary.json").exists(), text)

    def test_assignments(self):
        for assignment, says in (("seed=1", ["section.key=value"]), ("run.seed", ["section.key=value"]),
                                 ("=", ["section.key=value"]), ("run.=1", ["section.key=value"]),
                                 ("run.sead=1", ["did you mean 'seed'?"]), ("rum.seed=1", ["did you mean 'run'?"]),
                                 ("run.seed=", ["''"]), ("ekf_slamot.outliers.treatment=drop", ["inflate"])):
            self.run_log(self.logs / "good.rawlog", "--set", assignment, code=2, says=["--set " + assignment, *says])
        self.run_log(self.logs / "good.rawlog", "--set", "run.seed=4", "--set", "run.seed=5")
        self.assertEqual(self.summary()["seed"], 5)

    def test_plugins(self):
        self.write("plugins/libslamot_fake.so", "no library\n")
        self.write("plugins/libslamot_empty.so", "")
        env = {"SLAMOT_PLUGIN_PATH": str(self.path("plugins")) + ":/none/such"}
        listed = self.slamot("plugins", env=env)
        self.assertIn("ekf_slamot", listed.stdout)
        self.assertIn("libslamot_fake.so", listed.stderr)
        self.assertIn("libslamot_empty.so", listed.stderr)
        self.run_config("[run]\nestimator = fake\n", code=2, env=env, says=["'fake' was refused", "libslamot_fake.so"])
        self.run_config("", env=env)
        self.slamot("config", "ekf_slamto", code=2, says=["'ekf_slamto'", "did you mean 'ekf_slamot'?"])
        # A library that is no plugin: the record is missing.
        core = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "lib", "libslamot_core.so")
        os.symlink(core, self.path("plugins/libslamot_core_again.so"))
        self.assertIn("is no slamot plugin", self.slamot("plugins", env=env).stderr)

    def test_output_folders_that_cannot_be(self):
        self.write("file", "")
        for out in ("file", "file/below", "/proc/none"):
            self.run_log(self.logs / "good.rawlog", out=out, code=2, says=[out, "expected a folder"])
            self.slamot("simulate", DEMO, "-o", out + "/x.rawlog", code=2, says=[out, "expected a folder"])
        self.path("taken/trajectory.csv/below").mkdir(parents=True)
        self.run_log(self.logs / "good.rawlog", out="taken", code=2, says=["taken/trajectory.csv"])

    def test_a_full_disk(self):
        import resource
        import signal

        def little_room():
            # Writing past the limit then fails as on a full disk, instead of killing the program.
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        self.run_log(self.logs / "good.rawlog", code=2, says=["out/", "cannot be written"], preexec_fn=little_room,
                     restore_signals=False)
        self.assertFalse(self.path("out/summary.json").exists())
        self.assertTrue(self.path("out/trajectory.csv.part").exists() or self.path("out/tracks.csv.part").exists())
        self.slamot("simulate", DEMO, "-o", "x.rawlog", code=(1, 2), says=["x.rawlog", "cannot be written"],
                    preexec_fn=little_room, restore_signals=False)
        self.assertFalse(self.path("x.rawlog").exists())


class Scenarios(SlamotTest):
    def test_mistakes(self):
        text = DEMO.read_text()
        self.slamot("simulate", "none.ini", "-o", "x.rawlog", code=2, says=["none.ini"])
        for old, new, says in (("steps = 600", "steps = -1", ["steps"]), ("dt = 0.1", "dt = 0", ["dt"]),
                               ("steps = 600", "stepps = 600", ["did you mean 'steps'?"]),
                               ("[world]", "[wordl]", ["[wordl]"]), ("kind = uniform", "kind = round", ["kind"]),
                               ("box = -50,50,-50,50", "box = 50,-50,-50,50", ["box"]),
                               ("box = -50,50,-50,50", "box = 1,2", ["box"]),
                               ("min_distance = 6", "min_distance = 600", ["min_distance"]),
                               ("controller = waypoints", "controller = joystick", ["controller"]),
                               ("model = schedule", "model = bus", ["model"]),
                               ("schedule = 0:cv 15:ct:12", "schedule = 0:cv 15:cc:12", ["schedule"]),
                               ("range_std = 0.1", "range_std = much", ["range_std"]),
                               ("appear = 8\nvanish = 50", "appear = 50\nvanish = 8", ["vanish"])):
            self.assertIn(old, text)
            scenario = self.write("scenario.ini", text.replace(old, new, 1))
            self.slamot("simulate", scenario, "-o", "x.rawlog", code=2, says=["scenario.ini", *says])
            self.assertEqual(list(self.folder.glob("x.*")), [], new)

    def test_a_scenario_is_not_overwritten_by_its_log(self):
        scenario = self.write("scenario.ini", DEMO.read_text())
        self.slamot("simulate", scenario, "-o", scenario, code=2, says=["scenario.ini"])
        self.assertEqual(scenario.read_text(), DEMO.read_text())


if __name__ == "__main__":
    unittest.main()
