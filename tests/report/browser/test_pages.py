"""The pages in a browser, opened as files: nothing complains, everything is drawn, sliders and boxes do what they say,
keys are enough, and who cannot see well can read it."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import chromium

SOURCE = pathlib.Path(__file__).resolve().parents[3]
SLAMOT = os.environ.get("SLAMOT_PROGRAM", str(SOURCE / "build/release/bin/slamot"))
AUDIT = (pathlib.Path(__file__).parent / "audit.js").read_text()
# WCAG 2.1, success criterion 1.4.3.
LEAST_CONTRAST = 4.5
NAMED_ROLES = {"button", "checkbox", "combobox", "heading", "image", "link", "navigation", "region", "slider", "table",
               "textbox"}
DATASETS = pathlib.Path(os.environ.get("SLAMOT_DATASETS", "/nowhere"))


@unittest.skipUnless(chromium.PROGRAM, "the Debian package chromium is not installed")
class Pages(unittest.TestCase):
    """One IMM run with truth, tracks, modes; the comparison of it with another; a study of two rows."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="slamot_pages_"))
        cls.slamot("simulate", SOURCE / "config/scenarios/paper1.ini", "-o", "p1.rawlog", "--seed", "7")
        for name, config in (("imm", "paper1_imm.ini"), ("ekf", "paper1_ekf.ini")):
            cls.slamot("run", SOURCE / "config/runs" / config, "p1.rawlog", "-o", name, "--set", "output.figure=false")
        cls.slamot("compare", "imm", "ekf", "-o", "comparison.html")
        cls.slamot("study", SOURCE / "config/studies/consistency.ini", "--db", "rows.db", "--replicates", "2", "--report",
                   "study.html")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def slamot(cls, *arguments):
        done = subprocess.run([SLAMOT, "-q", *map(str, arguments)], cwd=cls.folder, capture_output=True, text=True,
                              timeout=300)
        if done.returncode != 0:
            raise AssertionError(f"slamot {arguments}: {done.returncode}\n{done.stderr}")
        return done

    def open(self, name="imm/report.html", **how):
        return chromium.Page(self.folder / name, **how)

    def test_every_page_draws_all_its_figures_without_a_complaint_or_a_request(self):
        for name in ("imm/report.html", "comparison.html", "study.html"):
            for dark in (False, True):
                with self.subTest(page=name, dark=dark), self.open(name, dark=dark) as page:
                    page.wait_for_figures()
                    figures = page.evaluate("document.querySelectorAll('figure[data-figure]').length")
                    drawn = page.evaluate("document.querySelectorAll('figure svg, figure canvas').length")
                    self.assertGreater(figures, 0)
                    self.assertEqual(drawn, figures)
                    self.assertEqual(page.evaluate("document.documentElement.dataset.theme"), "dark" if dark else "light")
                    self.assertEqual(page.complaints, [])

    def test_the_check_of_complaints_can_fail(self):
        with self.open() as page:
            page.evaluate("setTimeout(() => { throw new Error('on purpose'); }), fetch('http://localhost:9/').catch(() => 0)")
            self.assertTrue(any("on purpose" in c for c in page.complaints), page.complaints)
            self.assertTrue(any("localhost:9" in c for c in page.complaints), page.complaints)

    def test_the_slider_moves_the_robot_and_the_words(self):
        with self.open() as page:
            picture = "document.querySelector('.replay canvas').toDataURL()"
            words = "document.querySelector('.replay .state').textContent"
            end, end_words = page.evaluate(picture), page.evaluate(words)
            page.evaluate("(() => { const s = document.querySelector('.replay input[type=range]'); s.value = 40;"
                          " s.dispatchEvent(new Event('input')); })()")
            self.assertNotEqual(page.evaluate(picture), end)
            times = page.evaluate("JSON.parse(document.querySelector('.replay script').textContent).times")
            self.assertTrue(page.evaluate(words).startswith(f"{times[40]:.2f} s of {times[-1]:.2f} s"), page.evaluate(words))
            self.assertTrue(end_words.startswith(f"{times[-1]:.2f} s"), end_words)
            # The keyboard alone: one step back, then to the start.
            page.evaluate("document.querySelector('.replay .stage').focus()")
            page.key("ArrowLeft")
            self.assertTrue(page.evaluate(words).startswith(f"{times[39]:.2f} s"), page.evaluate(words))
            page.key("Home")
            self.assertTrue(page.evaluate(words).startswith("0.00 s"), page.evaluate(words))
            self.assertEqual(page.complaints, [])

    def test_landmarks_appear_as_time_goes_on(self):
        with self.open() as page:
            count = "Number(/(\\d+) landmarks/.exec(document.querySelector('.replay .state').textContent)[1])"
            at_end = page.evaluate(count)
            page.evaluate("document.querySelector('.replay .stage').focus()")
            page.key("Home")
            self.assertLess(page.evaluate(count), at_end)
            summary = json.loads((self.folder / "imm/summary.json").read_text())
            self.assertEqual(at_end, summary["counts"]["landmarks"])

    def test_play_goes_on_and_pause_stops_it(self):
        with self.open() as page:
            page.evaluate("document.querySelector('.speed').value = '1'")
            page.evaluate("document.querySelector('.play').click()")
            page.wait_for("Number(document.querySelector('.replay input[type=range]').value) > 0")
            page.evaluate("document.querySelector('.play').click()")
            self.assertEqual(page.evaluate("document.querySelector('.play').textContent"), "Play")
            frame = page.evaluate("document.querySelector('.replay input[type=range]').value")
            page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            self.assertEqual(page.evaluate("document.querySelector('.replay input[type=range]').value"), frame)

    def test_a_layer_is_hidden_and_shown_again(self):
        with self.open() as page:
            page.wait_for_figures()
            box = "[...document.querySelectorAll('#figure-map .choices label')].find((l) => l.textContent.includes('ellipses')).firstChild"
            picture = "document.querySelector('#figure-map svg').outerHTML"
            before = page.evaluate(picture)
            page.evaluate(f"{box}.click()")
            without = page.evaluate(picture)
            self.assertNotEqual(without, before)
            page.evaluate(f"{box}.click()")
            self.assertEqual(page.evaluate(picture), before)
            self.assertEqual(page.complaints, [])

    def test_axes_move_by_buttons_and_keys_and_come_back(self):
        with self.open() as page:
            page.wait_for_figures()
            # Labels of the axes: which elements Vega reuses for them may differ.
            picture = "[...document.querySelectorAll('#figure-robot_errors svg text')].map((t) => t.textContent).sort()"
            before = page.evaluate(picture)
            page.evaluate("document.querySelector('#figure-robot_errors [aria-label=\"Zoom in\"]').click()")
            self.assertNotEqual(page.evaluate(picture), before)
            page.evaluate("document.querySelector('#figure-robot_errors .canvas').focus()")
            zoomed = page.evaluate(picture)
            page.key("ArrowRight", shift=True)
            self.assertNotEqual(page.evaluate(picture), zoomed)
            page.key("0")
            self.assertEqual(page.evaluate(picture), before)

    def test_zoom_moves_every_panel_that_can_be_moved(self):
        with self.open() as page:
            page.wait_for_figures()
            # A figure of two time spans and a panel that does not move: one after the other must not be forgotten.
            found = page.evaluate("""(() => {
                const panel = (x, moves, equal) => ({equal, x: {domain: x, moves}, y: {domain: [0, 1], moves: true}});
                const plot = Object.create(Plot.prototype);
                plot.panels = [panel([0, 9], false, false), panel([0, 10], true, false), panel([0, 10], true, false),
                               panel([0, 4], true, false), panel([0, 4], true, true)];
                plot.domains = plot.panels.map(({x, y}) => ({x: x.domain, y: y.domain}));
                const tools = Object.create(PlotTools.prototype);
                tools.plot = plot;
                tools.zoomAll(0.5);
                return plot.domains.map(({x, y}) => [x, y]);
            })()""")
            self.assertEqual(found, [[[0, 9], [0, 1]], [[2.5, 7.5], [0, 1]], [[2.5, 7.5], [0, 1]], [[1, 3], [0, 1]],
                                     [[1, 3], [0.25, 0.75]]])

    def test_values_are_read_by_arrow_keys_and_said(self):
        with self.open() as page:
            page.wait_for_figures()
            figure = "document.querySelector('#figure-robot_errors')"
            words = f"{figure}.querySelector('.readout').textContent"
            self.assertEqual(page.evaluate(f"{figure}.querySelector('.canvas').getAttribute('role')"), "group")
            self.assertEqual(page.evaluate(f"{figure}.querySelector('.readout').getAttribute('aria-live')"), "polite")
            self.assertTrue(page.evaluate(f"{figure}.querySelector('svg').closest('[role=img]').getAttribute('aria-label')"))
            page.evaluate(f"{figure}.querySelector('.canvas').focus()")
            page.key("ArrowRight")
            middle = page.evaluate(words)
            self.assertRegex(middle, r"Error in x.*Time since the start \[s\] 1[45].*Error -?\d")
            page.key("ArrowRight")
            self.assertNotEqual(page.evaluate(words), middle)
            page.key("ArrowDown")
            self.assertTrue(page.evaluate(words).startswith("Error in y"), page.evaluate(words))
            self.assertEqual(page.complaints, [])

    def test_only_colours_are_swapped_in_the_dark(self):
        with self.open(dark=True) as page:
            found = page.evaluate("""theme.themed({title: 'white', text: {value: '#222222'}, name: 'constructor',
                fill: {value: '#222222'}, axes: [{labelColor: '#222222', title: '#222222'}], stroke: 'constructor'})""")
            self.assertEqual(found, {"title": "white", "text": {"value": "#222222"}, "name": "constructor",
                                     "fill": {"value": "#E8E8E8"}, "axes": [{"labelColor": "#E8E8E8", "title": "#222222"}],
                                     "stroke": "constructor"})
            robot = "document.querySelector('.replay .key [data-colour=\"#0072B2\"]').getAttribute('fill')"
            self.assertEqual(page.evaluate(robot), "#3A9AD9")

    def test_dragging_the_replay_ends_with_the_pointer(self):
        with self.open() as page:
            page.evaluate("document.querySelector('.replay canvas').scrollIntoView()")
            picture = "document.querySelector('.replay canvas').toDataURL()"
            x, y, width = page.evaluate("(() => { const b = document.querySelector('.replay canvas').getBoundingClientRect();"
                                        " return [b.left + b.width / 2, b.top + b.height / 2, b.width]; })()")
            mouse = lambda kind, right, **how: page.send("Input.dispatchMouseEvent", type=kind, x=x + right, y=y, **how)
            mouse("mousePressed", 0, button="left", clickCount=1)
            mouse("mouseMoved", 30, button="left", buttons=1)
            before = page.evaluate(picture)
            mouse("mouseMoved", width, button="left", buttons=1)  # beyond the picture: the pointer is held
            outside = page.evaluate(picture)
            self.assertNotEqual(outside, before)
            mouse("mouseReleased", width, button="left", clickCount=1)
            mouse("mouseMoved", 10)
            self.assertEqual(page.evaluate(picture), outside)

    def test_true_landmarks_are_drawn_on_coarse_screens_too(self):
        """Where a pixel of the screen is more than one of the page, the canvas has fewer pixels than its box."""
        with self.open() as page:
            count = page.evaluate("""(() => {
                const replay = Object.create(Replay.prototype), drawn = [];
                const context = new Proxy({}, {get: (_, name) => (x, y) => { if (name === 'moveTo') drawn.push([x, y]); },
                                               set: () => true});
                Object.assign(replay, {data: {colours: {}}, context, frame: 0, box: {width: 100, height: 100},
                                       canvas: {width: 50, height: 50}, toX: (x) => x, toY: (y) => y, line: () => 0});
                replayLayers.truth(replay, {robot: {x: [], y: []}, targets: [], landmarks: {x: [80, 120], y: [80, 20]}});
                return drawn.length;
            })()""")
            self.assertEqual(count, 2)  # the two strokes of the one within

    def test_values_are_read_where_the_pointer_is(self):
        with self.open() as page:
            page.wait_for_figures()
            page.evaluate("document.querySelector('#figure-robot_errors').scrollIntoView()")
            place = page.evaluate("(() => { const b = document.querySelector('#figure-robot_errors svg').getBoundingClientRect();"
                                  " return [b.left + b.width / 2, b.top + 80]; })()")
            page.send("Input.dispatchMouseEvent", type="mouseMoved", x=place[0], y=place[1])
            text = page.evaluate("document.querySelector('#figure-robot_errors .readout').textContent")
            self.assertRegex(text, r"Time since the start \[s\] 1[45].*Error -?\d")

    def test_the_colours_can_be_chosen(self):
        with self.open() as page:
            page.wait_for_figures()
            background = "getComputedStyle(document.body).backgroundColor"
            light = page.evaluate(background)
            page.evaluate("(() => { const s = document.getElementById('theme'); s.value = 'dark';"
                          " s.dispatchEvent(new Event('change')); })()")
            self.assertNotEqual(page.evaluate(background), light)
            self.assertEqual(page.evaluate("getComputedStyle(document.querySelector('#figure-map svg')).backgroundColor"),
                             "rgb(21, 24, 28)")
            self.assertEqual(page.complaints, [])

    def test_it_prints_in_light_colours_with_every_figure(self):
        with self.open(dark=True) as page:
            page.wait_for_figures()
            page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
            self.assertEqual(page.evaluate("document.documentElement.dataset.theme"), "light")
            # Images come late: the heat map must be there at once.
            image = "document.querySelector('#figure-correlation image')"
            self.assertTrue(page.evaluate(f"{image} && {image}.getAttributeNames().some((n) => /href/.test(n) && {image}.getAttribute(n).startsWith('data:image/png'))"))
            page.evaluate("window.dispatchEvent(new Event('afterprint'))")
            self.assertEqual(page.evaluate("document.documentElement.dataset.theme"), "dark")
            page.print_to_pdf(self.folder / "page.pdf")
            self.assertTrue((self.folder / "page.pdf").read_bytes().startswith(b"%PDF"))

    def test_it_can_be_read_and_used_by_all(self):
        for name in ("imm/report.html", "comparison.html", "study.html"):
            for dark in (False, True):
                with self.subTest(page=name, dark=dark), self.open(name, dark=dark) as page:
                    page.wait_for_figures()
                    found = page.evaluate(AUDIT)
                    self.assertGreater(len(found["contrasts"]), 50)
                    self.assertEqual([c for c in found["contrasts"] if c["ratio"] < LEAST_CONTRAST], [])
                    self.assertEqual(found["faults"], [])

                    # What the browser tells a screen reader.
                    nodes = page.accessible_nodes()
                    self.assertGreater(len([role for role, _ in nodes if role in NAMED_ROLES]), 10)
                    self.assertEqual([role for role, name in nodes if role in NAMED_ROLES and not name.strip()], [])

    def test_the_audit_can_fail(self):
        with self.open() as page:
            page.evaluate("document.querySelector('main').insertAdjacentHTML('beforeend', "
                          "'<p style=\"color:#aaa\">pale</p><input type=\"text\"><h5>deep</h5><svg></svg>')")
            found = page.evaluate(AUDIT)
            self.assertIn(("textbox", ""), page.accessible_nodes())
            self.assertTrue([c for c in found["contrasts"] if c["text"] == "pale" and c["ratio"] < LEAST_CONTRAST])
            self.assertEqual(len(found["faults"]), 3, found["faults"])

    def test_a_narrow_window_needs_no_sideways_scrolling(self):
        for name in ("imm/report.html", "comparison.html", "study.html"):
            for width in (800, 400):
                with self.subTest(page=name, width=width), self.open(name, width=width) as page:
                    page.wait_for_figures()
                    self.assertLessEqual(page.evaluate("document.documentElement.scrollWidth"), width)


@unittest.skipUnless(chromium.PROGRAM, "the Debian package chromium is not installed")
class PagesOfRealLogs(unittest.TestCase):
    """MRCLAM 6 and Victoria Park, where SLAMOT_DATASETS has them."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="slamot_real_pages_"))

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def slamot(self, *arguments):
        done = subprocess.run([SLAMOT, "-q", *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)

    def expect_a_page_that_works(self, dataset, importer, out, log, config):
        data = DATASETS / dataset
        if not data.is_dir():
            self.skipTest(f"{dataset} is absent: set SLAMOT_DATASETS")
        self.slamot("import", importer, data, "-o", out)
        self.slamot("run", SOURCE / "config/runs" / config, log, "-o", "out")
        self.assertLess((self.folder / "out/report.html").stat().st_size, 5e6)
        with chromium.Page(self.folder / "out/report.html") as page:
            page.wait_for_figures()
            count = page.evaluate("document.querySelectorAll('figure[data-figure]').length")
            self.assertGreater(count, 5)
            self.assertEqual(page.evaluate("document.querySelectorAll('figure svg, figure canvas').length"), count)
            picture = "document.querySelector('.replay canvas').toDataURL()"
            truth = "document.querySelector('.replay input[value=truth]')"
            at_end = page.evaluate(picture)
            page.evaluate(f"{truth}.click()")
            self.assertTrue(page.evaluate(picture) != at_end, "truth is not hidden")
            page.evaluate(f"{truth}.click()")
            self.assertTrue(page.evaluate(picture) == at_end, "truth is not shown again")
            page.evaluate("document.querySelector('.replay .stage').focus()")
            page.key("Home")
            self.assertTrue(page.evaluate(picture) != at_end, "the slider changes nothing")
            box = "document.querySelector('#figure-map .choices input')"
            map_picture = "document.querySelector('#figure-map svg').outerHTML"
            before = page.evaluate(map_picture)
            page.evaluate(f"{box}.click()")
            self.assertTrue(page.evaluate(map_picture) != before, "the map's layer is not hidden")
            self.assertEqual(page.complaints, [])

    def test_mrclam(self):
        self.expect_a_page_that_works("mrclam_6", "mrclam", "logs", "logs/robot_1.rawlog", "mrclam_imm.ini")

    def test_victoria_park(self):
        self.expect_a_page_that_works("victoria_park", "victoria-park", "park.rawlog", "park.rawlog", "victoria_park.ini")


if __name__ == "__main__":
    unittest.main()
