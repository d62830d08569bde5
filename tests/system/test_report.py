"""`slamot report` and `slamot compare`: pages from the files of runs, and sentences where there is nothing to show."""
import json
import os
import re
import shutil
import unittest

from program import DEMO, EKF, SOURCE, SlamotTest


class Pages(SlamotTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        import subprocess

        from program import PROGRAM
        subprocess.run([PROGRAM, "-q", "simulate", DEMO, "-o", cls.logs / "demo.rawlog", "--set", "scenario.steps=60"],
                       check=True)

    def run_with_page(self, out="out", *arguments):
        self.slamot("-q", "run", SOURCE / "config/runs/demo.ini", self.logs / "demo.rawlog", "-o", out, "--set",
                    "output.figure=false", *arguments)

    def page(self, name="out/report.html"):
        return self.path(name).read_text()

    def test_the_page_of_a_run_is_made_again_byte_by_byte(self):
        self.run_with_page()
        first = self.page()
        self.path("out/report.html").unlink()
        self.slamot("report", "out")
        self.assertEqual(self.page(), first)

    def test_two_runs_differ_by_times_alone(self):
        """What is measured anew is the machine's: the rest of the page is the same."""
        for out in ("one", "two"):
            self.run_with_page(out, "--set", "output.steps=false")
        pages = []
        for out in ("one", "two"):
            summary = self.summary(out)
            summary["time"], summary["peak_memory_mb"] = {}, 0
            self.path(f"{out}/summary.json").write_text(json.dumps(summary))
            self.slamot("report", out)
            pages.append(self.page(f"{out}/report.html"))
        self.assertEqual(pages[0], pages[1])

    def test_what_the_page_says_runs_it_again(self):
        self.run_with_page("out", "--seed", "5")
        texts = re.findall(r"<pre id=\"text-\d+\" tabindex=\"0\">(.*?)</pre>", self.page(), flags=re.DOTALL)
        command, settings, digest = texts
        self.write("run.ini", settings)
        self.slamot("-q", *command.split()[1:4], "-o", "again", *command.split()[6:])
        self.assertEqual(self.summary("again")["estimate_sha256"], digest)
        self.assertEqual(self.summary("again")["estimate_sha256"], self.summary()["estimate_sha256"])

    def test_pictures(self):
        if not shutil.which("rsvg-convert") or not shutil.which("node"):
            self.skipTest("nodejs, node-vega or librsvg2-bin is not installed")
        self.run_with_page()
        self.slamot("report", "out", "--pictures", "pictures")
        names = {p.stem for p in self.path("pictures").iterdir()}
        self.assertEqual(names, set(re.findall(r"data-figure=\"([^\"]+)\"", self.page())))
        for name in names:
            self.assertTrue(self.path(f"pictures/{name}.png").read_bytes().startswith(b"\x89PNG"))
            self.assertTrue(self.path(f"pictures/{name}.svg").read_text().startswith("<svg"))

    def test_without_truth_and_without_the_page(self):
        self.run_with_page()
        with_truth = self.page()
        self.slamot("report", "out", "--truth", "none", "-o", "plain.html")
        self.assertIn("id=\"nees\"", with_truth)
        self.assertNotIn("id=\"nees\"", self.page("plain.html"))
        self.assertEqual(self.page(), with_truth)
        self.assertIn("position RMSE", with_truth)
        self.assertNotIn("position RMSE", self.page("plain.html"))
        self.slamot("report", "out", "--truth", "nowhere", code=2, says=["nowhere"])
        self.run_with_page("bare", "--set", "output.report=false")
        self.assertFalse(self.path("bare/report.html").exists())

    def test_a_truth_that_is_named_counts_for_metrics_too(self):
        self.run_with_page()
        wanted = self.summary()["metrics"]["robot"]["position"]["rmse"]
        # As far away as no error is: everything is 1000 m off in x.
        shutil.copytree(self.logs / "demo.truth", self.path("moved.truth"))
        rows = self.path("moved.truth/robot.csv").read_text().split()
        moved = [rows[0]] + [f"{t},{float(x) + 1000!r},{rest}" for t, x, rest in (row.split(",", 2) for row in rows[1:])]
        self.write("moved.truth/robot.csv", "\n".join(moved) + "\n")
        rmse = lambda page: float(re.search(r"position RMSE \[m\]</th><td[^>]*>([^ <]+)", self.page(page))[1])
        self.assertAlmostEqual(rmse("out/report.html"), wanted, delta=1e-3 * wanted)  # four digits are shown
        self.slamot("report", "out", "--truth", "moved.truth", "-o", "moved.html")
        self.assertAlmostEqual(rmse("moved.html"), 1000, delta=5 * wanted)
        self.slamot("compare", "out", "--truth", "moved.truth", "-o", "compared.html")
        self.assertAlmostEqual(rmse("compared.html"), 1000, delta=5 * wanted)
        self.slamot("compare", "out", "--truth", "nowhere", code=2, says=["nowhere"])
        # The run's own, broken: the page comes without and says why.
        summary = self.summary()
        summary["truth"] = str(self.path("moved.truth"))
        self.path("out/summary.json").write_text(json.dumps(summary))
        self.write("moved.truth/robot.csv", "t,x\n")
        self.slamot("report", "out")
        self.assertIn("cannot be used any more", self.page())

    def test_a_log_with_a_strange_name_is_text(self):
        shutil.copy(self.logs / "demo.rawlog", self.path("<script>alert(1)</script>.rawlog".replace("/", "_")))
        self.slamot("-q", "run", EKF, "<script>alert(1)<_script>.rawlog", "-o", "out", "--set", "output.figure=false")
        self.assertNotIn("<script>alert", self.page())

    def test_a_log_whose_name_is_no_utf8_has_its_page_and_picture(self):
        name = os.fsdecode(b"drive_\xff.rawlog")
        shutil.copy(self.logs / "demo.rawlog", self.path(name))
        done = self.slamot("-q", "run", SOURCE / "config/runs/demo.ini", name, "-o", "out")
        self.assertNotIn("no report", done.stderr)
        self.assertIn("drive_\N{REPLACEMENT CHARACTER}", self.page())
        self.assertIn("drive_\N{REPLACEMENT CHARACTER}", self.page("out/overview.vg.json"))

    def test_broken_and_foreign_folders_are_refused(self):
        self.slamot("report", "nowhere", code=2, says=["nowhere", "output folder of a run"])
        self.run_with_page()
        self.path("out/steps.csv").write_text("t,landmarks\n1,2\n")
        self.slamot("report", "out", code=2, says=["out/steps.csv", "tracks"])
        self.slamot("compare", "out", "nowhere", code=2)
        self.path("out/steps.csv").unlink()
        self.slamot("report", "out", "-o", "no/such/page.html", code=(1, 2), says=["no/such/page.html"])

    def test_comparison(self):
        self.run_with_page("one")
        self.run_with_page("classic", "--set", "ekf_slamot.consistency=classic")
        done = self.slamot("compare", "one", "classic", "-o", "both.html")
        self.assertLessEqual(max(len(line) for line in done.stdout.split("\n")), 80)
        rmse = next(line for line in done.stdout.split("\n") if "position RMSE [m]" in line)
        wanted = [self.summary(run)["metrics"]["robot"]["position"]["rmse"] for run in ("one", "classic")]
        found = [float(number.rstrip("*")) for number in rmse.split()[3:]]
        for value, text in zip(wanted, found):
            self.assertAlmostEqual(value, text, delta=1e-3 * value)  # four digits are shown
        best = rmse.split()[3 + wanted.index(min(wanted))]
        self.assertTrue(best.endswith("*"), rmse)
        self.assertIn("Comparison of runs", self.page("both.html"))
        self.assertNotIn("not of the same logs", self.page("both.html"))


if __name__ == "__main__":
    unittest.main()
