"""`run --live` on a virtual display: keys, closing, Ctrl-C; and a sentence where there is no display."""
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

from program import PROGRAM, SOURCE, TIMEOUT_SECONDS, SlamotTest

TOOLS = [tool for tool in ("Xvfb", "xdotool") if not shutil.which(tool)]
# Sends WM_DELETE_WINDOW by Xlib; the layout of XClientMessageEvent on 64-bit systems.
CLOSE = """
import ctypes, struct, sys
x = ctypes.CDLL("libX11.so.6")
x.XOpenDisplay.restype = ctypes.c_void_p
x.XInternAtom.restype = ctypes.c_ulong
display, window = ctypes.c_void_p(x.XOpenDisplay(None)), int(sys.argv[1])
protocols, delete = (x.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
event = struct.pack("iLiPLLi5L", 33, 0, 1, display.value, window, protocols, 32, delete, 0, 0, 0, 0)
x.XSendEvent(display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.create_string_buffer(event, 192))
x.XFlush(display)
x.XSync(display, 0)
"""
CONFIG = SOURCE / "config/runs/demo.ini"


class NoDisplay(SlamotTest):
    def test_it_is_refused_before_anything_is_written(self):
        for display in ("", ":9999"):
            self.slamot("run", CONFIG, SOURCE / "rawlogs/demo.rawlog", "-o", "out", "--live", code=2,
                        says=["--live", "no display"], env={"DISPLAY": display})
            self.assertFalse(self.path("out").exists())


@unittest.skipIf(TOOLS, f"not installed: {' '.join(TOOLS)} (Debian packages xvfb and xdotool)")
class Live(SlamotTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        read, write = os.pipe()
        cls.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1200x900x24"],
                                      pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as announced:  # to the end of the line: the server dies of a reader that has gone
            cls.display = ":" + announced.readline().strip()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        super().tearDownClass()

    def start(self, *arguments):
        self.process = subprocess.Popen([PROGRAM, "-q", "run", CONFIG, SOURCE / "rawlogs/demo.rawlog", "-o", "out", "--live",
                                     "--set", "output.figure=false", *arguments], cwd=self.folder,
                                    stderr=subprocess.PIPE, text=True, env={**os.environ, "DISPLAY": self.display})
        self.addCleanup(lambda: self.process.poll() is None and self.process.kill())
        window = subprocess.run(["xdotool", "search", "--sync", "--onlyvisible", "--name", "slamot"], capture_output=True,
                                text=True, env={"DISPLAY": self.display, "PATH": os.environ["PATH"]},
                                timeout=TIMEOUT_SECONDS, check=True).stdout.split()
        self.window = window[0]
        self.xdotool("windowfocus", "--sync", self.window)

    def xdotool(self, *words):
        subprocess.run(["xdotool", *words], env={"DISPLAY": self.display, "PATH": os.environ["PATH"]}, check=True,
                       timeout=TIMEOUT_SECONDS)

    def wait(self):
        _, errors = self.process.communicate(timeout=TIMEOUT_SECONDS)
        return self.process.returncode, errors

    def wait_for_the_summary(self):
        end = time.monotonic() + TIMEOUT_SECONDS
        while not self.path("out/summary.json").exists():
            self.assertLess(time.monotonic(), end, "the run never ended")
            self.assertIsNone(self.process.poll(), "the program ended before its run")
            time.sleep(0.1)

    def without_window(self):
        self.slamot("-q", "run", CONFIG, SOURCE / "rawlogs/demo.rawlog", "-o", "plain", "--set", "output.figure=false",
                    "--set", "output.report=false")
        return self.summary("plain")["estimate_sha256"]

    def test_closing_by_key_leaves_the_run_alone(self):
        self.start()
        self.xdotool("key", "q")
        code, errors = self.wait()
        self.assertEqual(code, 0, errors)
        self.assertEqual(self.summary()["status"], "complete")
        self.assertEqual(self.summary()["estimate_sha256"], self.without_window())

    def close_by_the_title_bar(self):
        """What a window manager does; there is none here. xdotool of Debian 12 cannot."""
        subprocess.run([sys.executable, "-c", CLOSE, self.window], check=True, timeout=TIMEOUT_SECONDS,
                       env={"DISPLAY": self.display, "PATH": os.environ["PATH"]})

    def test_closing_by_the_title_bar_leaves_the_run_alone(self):
        wanted = self.without_window()
        # While it draws, and while it is paused.
        for pause in (False, True):
            with self.subTest(pause=pause):
                self.start()
                self.xdotool("key", "space" if pause else "plus")
                time.sleep(0.3)
                self.close_by_the_title_bar()
                code, errors = self.wait()
                self.assertEqual(code, 0, errors)
                self.assertEqual(self.summary()["status"], "complete")
                self.assertEqual(self.summary()["estimate_sha256"], wanted)

    def test_pauses_are_no_part_of_what_the_run_costs(self):
        begin = time.monotonic()
        self.start()
        self.xdotool("key", "space")
        time.sleep(3)
        self.xdotool("key", "q")
        self.assertEqual(self.wait()[0], 0)
        self.assertLess(self.summary()["time"]["wall_s"], time.monotonic() - begin - 3)

    def test_a_paused_run_waits_and_goes_on(self):
        self.start()
        self.xdotool("key", "space")
        time.sleep(8)  # longer than the whole run takes at its ten times real time
        self.assertFalse(self.path("out/summary.json").exists())
        for _ in range(4):
            self.xdotool("key", "plus")
        self.xdotool("key", "space")
        self.wait_for_the_summary()
        self.assertIsNone(self.process.poll(), "the window stays until it is closed")
        self.xdotool("key", "q")
        self.assertEqual(self.wait()[0], 0)

    def test_ctrl_c_ends_a_run_that_is_paused(self):
        self.start()
        self.xdotool("key", "space")
        time.sleep(0.5)
        self.process.send_signal(signal.SIGINT)
        code, errors = self.wait()
        self.assertEqual(code, 1, errors)
        self.assertEqual(self.summary()["status"], "stopped")


if __name__ == "__main__":
    unittest.main()
