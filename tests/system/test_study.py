"""`slamot study`: the same rows however they came to be; shards, kills, merges, MPI ranks, GNU parallel, mistakes."""
import os
import pathlib
import re
import resource
import shutil
import signal
import sqlite3
import subprocess
import time
import unittest

from program import PROGRAM, SOURCE, TIMEOUT_SECONDS, SlamotTest

MPI_PROGRAM = os.environ.get("SLAMOT_STUDY_MPI", str(pathlib.Path(PROGRAM).parent / "slamot_study_mpi"))
# All but cost and build. Numbers are kept as round-trip text and bytes, so equal texts are equal bits.
IDENTITY = ("SELECT key, source, scenario_point, variant, config_point, replicate, world_seed, estimator_seed, status,"
            " reason, estimate_hash, metrics, series FROM rows ORDER BY key")
FIELD = """[scenario]
dt = 0.2
steps = {steps}
[world]
landmarks = 40
box = -10,60,-30,30
[robot]
controller = constant
speed = 2
motion = steered
wheelbase = 2
speed_std = 0.2
[sensor.landmarks]
max_range = 30
range_std = 0.1
bearing_std_deg = 1
"""
EKF = "[run]\nestimator = ekf_slamot\n[motion]\nmodel = steered\nwheelbase = 2\n"
STUDY = """[study]
seed = 3
replicates = 12
short_replicates = 2
series = robot_nees
[scenario.near]
file = field.ini
sensor.landmarks.max_range = 12
[scenario.far]
file = field.ini
[config.classic]
file = ekf.ini
ekf_slamot.consistency = classic
[config.invariant]
file = ekf.ini
[config.blind]
file = ekf.ini
identities.landmarks = hidden
ekf_slamot.association.landmarks = known
on = near
"""
RUNS = 12 * (3 + 2)


class Study(SlamotTest):
    def setUp(self):
        super().setUp()
        self.files()

    def files(self, steps=15, study=STUDY):
        self.write("field.ini", FIELD.format(steps=steps))
        self.write("ekf.ini", EKF)
        self.write("small.ini", study)

    def rows(self, name):
        with sqlite3.connect(self.path(name)) as db:
            return db.execute(IDENTITY).fetchall()

    def study(self, db, *arguments, **expected):
        return self.slamot("study", "small.ini", "--db", db, *arguments, **expected)

    def serial(self):
        self.study("serial.db")
        rows = self.rows("serial.db")
        self.assertEqual(len(rows), RUNS)
        self.assertEqual(len({row[10] for row in rows if row[8] == "complete"}), 48)
        return rows

    def test_threads_shards_and_merge_give_the_serial_rows(self):
        serial = self.serial()
        self.study("threads.db", "--threads", 2)
        self.assertEqual(self.rows("threads.db"), serial)
        for k in (1, 2):
            self.study(f"shard{k}.db", "--shard", f"{k}/2")
            self.assertEqual(len(self.rows(f"shard{k}.db")), RUNS / 2)
        # A part is merged, told and no success, quiet or not.
        half = subprocess.run([PROGRAM, "-q", "study", "small.ini", "--db", "merged.db", "--merge", "gone.db", "shard1.db"],
                              cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_SECONDS)
        self.assertEqual(half.returncode, 1)
        self.assertIn("gone.db: is not there", half.stderr)
        self.assertIn("30 of 60 runs are there", half.stderr)
        self.study("merged.db", "--merge", "shard1.db", "shard2.db")
        self.assertEqual(self.rows("merged.db"), serial)

    def test_a_failing_run_is_a_row_and_its_reason_is_told(self):
        done = self.study("a.db")
        self.assertIn("60 of 60 runs are there, of which 12 failed", done.stderr)
        self.assertIn("12 x blind on near", done.stderr)
        failed = [row for row in self.rows("a.db") if row[8] == "failed"]
        self.assertEqual({row[3] for row in failed}, {"blind"})
        self.assertIn("identities", failed[0][9])
        # Failed rows are results: not run again unless asked for.
        self.assertIn("nothing was run", self.study("a.db").stdout)
        before = self.rows("a.db")
        self.assertIn("12 runs, 12 failed", self.study("a.db", "--retry-failed").stdout)
        self.assertEqual(self.rows("a.db"), before)
        for other in (["--list"], ["--no-run"], ["--merge", "a.db"]):
            self.study("a.db", "--retry-failed", *other, code=2)
        self.assertEqual(self.rows("a.db"), before)

    def test_a_longer_study_takes_over_the_shorter_ones_rows(self):
        self.study("a.db", "--short")
        short = self.rows("a.db")
        self.assertEqual(len(short), 10)
        self.assertIn("50 runs", self.study("a.db").stdout)
        self.assertEqual(self.rows("a.db"), self.serial())
        self.assertLessEqual(set(short), set(self.rows("a.db")))

    def start(self, db, *arguments):
        """A study of longer runs with its first rows written."""
        self.files(steps=400)
        run = subprocess.Popen([PROGRAM, "study", "small.ini", "--db", db, *arguments], cwd=self.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.kill)
        self.waitForRows(db, run)
        return run

    def waitForRows(self, db, run):
        deadline = time.monotonic() + TIMEOUT_SECONDS
        while True:
            self.assertIsNone(run.poll(), "the study ended before it could be interrupted")
            self.assertLess(time.monotonic(), deadline)
            try:
                if len(self.rows(db)) >= 3:
                    return
            except sqlite3.OperationalError:
                pass  # not there yet, or without its table
            time.sleep(0.01)

    def finishAndCompare(self, db):
        before = self.rows(db)
        self.assertLess(len(before), RUNS)
        self.study(db)
        self.assertEqual(self.rows(db), self.serial())
        self.assertLessEqual(set(before), set(self.rows(db)))

    def test_killed_and_resumed_gives_the_same_rows(self):
        for arguments in ([], ["--threads", "2"]):
            run = self.start("killed.db", *arguments)
            run.send_signal(signal.SIGKILL)
            run.communicate(timeout=TIMEOUT_SECONDS)
            self.finishAndCompare("killed.db")
            for file in self.folder.glob("*.db*"):
                file.unlink()

    def test_ctrl_c_keeps_the_rows_and_says_so(self):
        run = self.start("stopped.db")
        run.send_signal(signal.SIGINT)
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 1, stderr)
        self.assertIn("slamot: stopped; the rows so far are kept", stderr)
        self.finishAndCompare("stopped.db")

    def test_ctrl_c_stops_the_run_of_a_figure(self):
        self.files(steps=200000, study=STUDY + "[figure.map]\nkind = one_run\nsource = far\nconfig = classic\n"
                                               "show = map\n")
        run = subprocess.Popen([PROGRAM, "study", "small.ini", "--db", "a.db", "--no-run", "--export", "out"],
                               cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        # Figures are what is written last.
        while not (self.folder / "out/ranks.csv").exists():
            self.assertIsNone(run.poll())
            time.sleep(0.02)
        run.send_signal(signal.SIGINT)
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 1, stderr)
        self.assertIn("slamot: stopped while a run was made again for a figure", stderr)
        self.assertFalse((self.folder / "out/figures/map.svg").exists())

    def mpi(self, ranks, db, *arguments):
        if not shutil.which("mpirun") or not pathlib.Path(MPI_PROGRAM).exists():
            self.skipTest("no mpirun or no slamot_study_mpi (packages libboost-mpi-dev openmpi-bin)")
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        return subprocess.Popen(["mpirun", "-n", str(ranks), "--oversubscribe", MPI_PROGRAM, "small.ini", "--db", db,
                                 *arguments], cwd=self.folder, env=environment, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def test_mpi_ranks_give_the_serial_rows(self):
        for ranks in (1, 2, 3):
            run = self.mpi(ranks, f"ranks{ranks}.db")
            stdout, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
            self.assertEqual(run.returncode, 0, stderr)
            self.assertIn("60 runs, 12 failed", stdout)
        serial = self.serial()
        for ranks in (1, 2, 3):
            self.assertEqual(self.rows(f"ranks{ranks}.db"), serial)

    def test_a_killed_rank_ends_the_job_and_a_rerun_does_the_rest(self):
        self.files(steps=400)
        run = self.mpi(3, "ranks.db")
        self.addCleanup(run.kill)
        self.waitForRows("ranks.db", run)
        ranks = self.ranksOf(run)
        self.assertEqual(len(ranks), 3)
        os.kill(ranks[-1], signal.SIGKILL)
        run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertNotEqual(run.returncode, 0)
        self.finishAndCompare("ranks.db")

    def ranksOf(self, run):
        # The ranks are mpirun's children, in the order of their numbers.
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        return [int(pid) for pid in children if "slamot_study_mp" in pathlib.Path(f"/proc/{pid}/comm").read_text()]

    def test_a_stopped_rank_leaves_its_work_to_the_others(self):
        self.files(steps=400)
        run = self.mpi(3, "one.db")
        self.addCleanup(run.kill)
        self.waitForRows("one.db", run)
        os.kill(self.ranksOf(run)[-1], signal.SIGTERM)
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 0, stderr)
        self.assertEqual(self.rows("one.db"), self.serial())

    def test_all_ranks_stopped_is_no_success(self):
        self.files(steps=400)
        run = self.mpi(3, "all.db")
        self.addCleanup(run.kill)
        self.waitForRows("all.db", run)
        for pid in self.ranksOf(run)[1:]:
            os.kill(pid, signal.SIGTERM)
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertNotEqual(run.returncode, 0, stderr)
        self.assertIn("the same command does the rest", stderr)
        self.finishAndCompare("all.db")

    def test_mpi_mistakes_are_told_once(self):
        run = self.mpi(3, "ranks.db", "--replicates", "0")
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 2, stderr)
        self.write("small.ini", STUDY.replace("seed", "sead"))
        run = self.mpi(3, "ranks.db")
        _, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 2, stderr)
        self.assertEqual(stderr.count("did you mean 'seed'?"), 1, stderr)

    def test_gnu_parallel_gives_the_serial_rows(self):
        if not shutil.which("parallel"):
            self.skipTest("no GNU parallel (package parallel)")
        script = SOURCE / "scripts/study_parallel.sh"
        done = subprocess.run([script, "small.ini", "a b.db", "3", "--export", "out", "--threads", "1"], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "SLAMOT": PROGRAM}, timeout=TIMEOUT_SECONDS)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.rows("a b.db"), self.serial())
        self.assertTrue(any(self.path("out").iterdir()))

    def test_scripts_refuse_bad_usage(self):
        for name, tool in (("study_parallel", "parallel"), ("study_slurm", None)):
            if tool and not shutil.which(tool):
                continue
            for arguments, says in (([], "expected STUDY.ini DB"), (["gone.ini", "a.db", "2"], "gone.ini is not there"),
                                    (["small.ini", "a.db", "none"], "is 'none'")):
                done = subprocess.run([SOURCE / f"scripts/{name}.sh", *arguments], cwd=self.folder, text=True,
                                      capture_output=True, env={**os.environ, "SLAMOT": PROGRAM})
                self.assertEqual(done.returncode, 2)
                self.assertIn(f"{name}: ", done.stderr)
                self.assertIn(says, done.stderr)
            self.assertIn("Example", subprocess.run([SOURCE / f"scripts/{name}.sh", "--help"], text=True,
                                                    capture_output=True, check=True).stdout)

    def test_slurm_commands_do_the_shards_and_the_merge(self):
        # A stand-in for sbatch runs what it is given, as the array would.
        bin_folder = self.path("bin")
        bin_folder.mkdir()
        sbatch = bin_folder / "sbatch"
        sbatch.write_text('#!/usr/bin/env bash\n'
                          'for a in "$@"; do [[ $a == --array=1-* ]] && last=${a#--array=1-}; '
                          '[[ $previous == --wrap ]] && job=$a; previous=$a; done\n'
                          'for k in $(seq ${last:-1}); do SLURM_ARRAY_TASK_ID=$k bash -c "$job" >>jobs.txt || exit 1; done\n'
                          'echo 41\n')
        sbatch.chmod(0o755)
        done = subprocess.run([SOURCE / "scripts/study_slurm.sh", "--submit", "small.ini", "a b.db", "3"],
                              cwd=self.folder, text=True, capture_output=True, timeout=TIMEOUT_SECONDS,
                              env={**os.environ, "SLAMOT": PROGRAM, "PATH": f"{bin_folder}:{os.environ['PATH']}"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("job array 41", done.stdout)
        self.assertEqual(self.rows("a b.db"), self.serial())

    def test_logs_are_imported_once_and_found_again(self):
        self.write("sets/track/sensor.ini", "[sensor]\nrange_std = 0.1\nbearing_std_deg = 1\n[vehicle]\n"
                                            "model = differential\n")
        self.write("sets/track/odometry.csv", "t,v,omega\n" + "".join(f"{k / 10},1,0\n" for k in range(50)))
        self.write("sets/track/observations.csv", "t,kind,id,range,bearing\n" + "".join(
            f"{k / 10 + 0.05:.2f},landmark,3,{10 - 0.1 * k:.2f},0\n" for k in range(40)))
        self.write("ekf.ini", "[run]\nestimator = ekf_slamot\n")
        self.write("small.ini", "[study]\n[log.track]\nimport = csv\nfolder = track\nfiles = track.rawlog\n"
                                "[config.a]\nfile = ekf.ini\n[config.b]\nfile = ekf.ini\n")
        sets = {"SLAMOT_DATASETS": str(self.path("sets"))}
        self.study("a.db", env=sets)
        (imported,) = self.path("imported_logs").glob("track-*/track.rawlog")
        made = imported.stat().st_mtime_ns
        self.study("b.db", env=sets)
        self.assertEqual(imported.stat().st_mtime_ns, made)
        self.assertEqual(self.rows("a.db"), self.rows("b.db"))
        self.assertEqual([row[8] for row in self.rows("a.db")], ["complete"] * 2)
        # Other contents are another world.
        file = self.path("sets/track/odometry.csv")
        file.write_text(file.read_text().replace("1,0", "2,0"))
        self.study("a.db", env=sets)
        self.assertEqual(len(self.rows("a.db")), 4)
        # A killed import leaves a folder that may not be taken for the logs.
        for folder in self.path("imported_logs").glob("track-*/"):
            folder.with_name(folder.name + ".part").mkdir()
            shutil.rmtree(folder)
        self.study("a.db", env=sets)
        self.assertEqual(len(self.rows("a.db")), 4)

    def test_list_shows_worlds_and_keys_and_runs_nothing(self):
        listed = self.study("a.db", "--list", "--short").stdout
        self.assertIn("4 worlds, 10 runs", listed)
        self.assertFalse(self.path("a.db").exists())
        self.study("a.db", "--short")
        for row in self.rows("a.db"):
            self.assertIn(f"  {row[0]} {row[3]}", listed)
        self.assertEqual(self.study("a.db", "--list").stdout.count("(done)"), 10)

    def test_keep_leaves_the_runs_folders(self):
        self.study("a.db", "--short", "--keep", "kept")
        self.study("b.db", "--short")
        self.assertEqual(self.rows("a.db"), self.rows("b.db"))
        self.assertTrue(self.path("kept/far-2/invariant/trajectory.csv").exists())

    PAGE = "<!-- study small stamp -->\nold\n<!-- end -->\n"

    def test_a_pages_stamp_has_the_command_that_makes_it_again(self):
        self.write("a page.md", self.PAGE)
        self.write("small.ini", STUDY + "[check.c]\nsource = far\nconfig = classic\nfigure = robot.position.rmse\n"
                                        "statistic = mean\ninterval = 0, inf\nshort_interval = 0, inf\n")
        self.study("a.db", "--short", "--check", "--threads", 2, "--fill", "a page.md")
        command = re.search(": `(slamot study .*)`", self.path("a page.md").read_text()).group(1)
        self.assertEqual(command, "slamot study small.ini --db a.db --short --check --fill 'a page.md'")
        first = self.path("a page.md").read_text()
        subprocess.run(["bash", "-c", command.replace("slamot", f"'{PROGRAM}' -q", 1)], cwd=self.folder, check=True,
                       capture_output=True, timeout=TIMEOUT_SECONDS)
        self.assertEqual(self.path("a page.md").read_text(), first)
        self.study("a.db", "--replicates", 2, "--fill", "a page.md")
        self.assertIn("--db a.db --replicates 2 --fill", self.path("a page.md").read_text())

    def test_a_page_is_not_filled_from_no_rows(self):
        self.write("page.md", self.PAGE)
        self.study("a.db", "--no-run", "--fill", "page.md", code=2, says=["--fill: a.db has no rows of this study"])
        self.assertEqual(self.path("page.md").read_text(), self.PAGE)

    def test_options_that_contradict_each_other_are_refused(self):
        for arguments, says in ((["--short", "--replicates", "3"], "--short and --replicates"),
                                (["--no-run", "--shard", "1/2"], "--shard: expected without --no-run"),
                                (["--merge", "b.db", "--shard", "1/2"], "--shard: expected without"),
                                (["--keep", "kept", "--no-run"], "--keep: expected without"),
                                (["--keep", "kept", "--list"], "--keep: expected without")):
            self.study("a.db", *arguments, code=2, says=[says])

    def test_keep_says_of_which_rows_nothing_was_kept(self):
        self.study("a.db", "--short", "--shard", "1/2")
        there = len(self.rows("a.db"))
        kept = self.study("a.db", "--short", "--keep", "kept")
        self.assertIn(f"--keep: nothing was kept of {there} runs whose rows were there already; the same command with "
                      "a new --db", kept.stderr)
        fresh = self.study("b.db", "--short", "--keep", "fresh")
        self.assertNotIn("--keep", fresh.stderr)
        # Done again: all is there, kept by then.
        self.assertNotIn("--keep", self.study("b.db", "--short", "--keep", "fresh").stderr)

    def test_a_full_disk_is_a_sentence_and_keeps_the_rows(self):
        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        self.study("a.db", code=2, says=["a.db: "], preexec_fn=small_files)
        self.assertLess(len(self.rows("a.db")), RUNS)
        self.study("a.db")
        self.assertEqual(self.rows("a.db"), self.serial())

    def test_listing_stops_at_once(self):
        run = subprocess.Popen([PROGRAM, "study", "small.ini", "--db", "a.db", "--replicates", "1000000", "--list"],
                               cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.kill)
        self.assertIn("near-1 seed", run.stdout.readline())
        run.send_signal(signal.SIGINT)
        output, stderr = run.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(stderr, "slamot: stopped\n")
        self.assertNotIn("1000000 worlds", output)

    def test_mistakes_are_sentences(self):
        bad = [("study", "gone.ini", "--db", "a.db"), ("study", "small.ini", "--db", "gone/a.db"),
               ("study", "small.ini", "--db", "a.db", "--shard", "3/2"),
               ("study", "small.ini", "--db", "a.db", "--shard", "1"),
               ("study", "small.ini", "--db", "ekf.ini"), ("study", "small.ini"),
               ("study", "small.ini", "--db", "a.db", "--shard", "1/2", "--check"),
               ("study", "small.ini", "--db", "a.db", "--shard", "1/2", "--export", "out"),
               ("study", "small.ini", "--db", "a.db", "--shard", "1/2", "--fill", "page.md")]
        for arguments in bad:
            self.slamot(*arguments, code=2)
        self.write("small.ini", STUDY.replace("file = ekf.ini\nekf", "file = ekf.ini\nekff"))
        self.study("a.db", code=2, says=["small.ini:13", "ekff_slamot"])
        self.write("small.ini", "[study]\n[log.l]\nimport = mrclam\nfolder = gone\nfiles = *.rawlog\n"
                                "[config.c]\nfile = ekf.ini\n")
        self.study("b.db", code=2, says=["no gone in the datasets' folder", "nothing remains to run"],
                   env={"SLAMOT_DATASETS": str(self.folder)})


if __name__ == "__main__":
    unittest.main()
