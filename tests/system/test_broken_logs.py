"""Logs that are missing, junk, cut or flipped: through info, run and convert alike."""
import gzip
import random
import shutil
import unittest

from program import SlamotTest


class BrokenLogs(SlamotTest):
    def everywhere(self, log, **expected):
        """The same answer from every command that reads a log."""
        self.slamot("info", log, **expected)
        self.slamot("info", log, "--json", **expected)
        self.slamot("convert", log, "-o", "converted.rawlog", **expected)
        self.run_log(log, **expected)

    def good(self):
        return (self.logs / "good.rawlog").read_bytes()

    def plain(self):
        return gzip.decompress(self.good())

    def test_no_file_folder_empty_and_junk(self):
        self.everywhere("none.rawlog", code=2, says=["none.rawlog", "no such file", "expected a rawlog"])
        self.path("folder").mkdir()
        self.everywhere("folder", code=2, says=["folder", "no regular file", "expected a rawlog"])
        self.everywhere("/dev/null", code=2, says=["/dev/null", "expected a rawlog"])
        self.write("empty.rawlog", b"")
        self.everywhere("empty.rawlog", code=2, says=["empty.rawlog", "is empty", "expected a rawlog"])
        for junk in (b"t,x,y\n1,2,3\n", b"\x89PNG\r\n\x1a\n", b"x", b"\x00" * 1000, gzip.compress(b"no log"),
                     random.Random(1).randbytes(5000)):
            self.write("junk.rawlog", junk)
            self.everywhere("junk.rawlog", code=2, says=["junk.rawlog", "expected a rawlog"])
        self.write("nothing.rawlog", gzip.compress(b""))
        self.everywhere("nothing.rawlog", code=2, says=["nothing.rawlog", "expected a rawlog"])

    def test_a_cut_log_gives_the_outputs_up_to_the_break_and_exit_2(self):
        for name, whole in (("gz", self.good()), ("plain", self.plain())):
            rows = []
            for part in (0.25, 0.5, 0.9):
                # Plus one: an uncompressed log that is cut between two objects shows nothing.
                self.write("cut.rawlog", whole[:int(len(whole) * part) + 1])
                self.everywhere("cut.rawlog", code=2, says=["cut.rawlog", "break", "object"])
                self.assertEqual(self.summary()["status"], "truncated")
                self.assertIn("object", self.summary()["end_message"])
                self.assertEqual(self.partFiles(), [])
                rows.append(len(self.path("out/trajectory.csv").read_text().splitlines()))
                self.slamot("info", "converted.rawlog")
            self.assertEqual(rows, sorted(set(rows)), name)
            self.assertGreater(rows[0], 10, name)

    def test_a_log_cut_to_almost_nothing(self):
        for whole in (self.good(), self.plain()):
            for length in (1, 2, 9, 20, 31, 40):
                self.write("cut.rawlog", whole[:length])
                self.everywhere("cut.rawlog", code=2, says=["cut.rawlog"])

    def test_every_flip_in_a_gz_log_is_noticed(self):
        chance = random.Random(7)
        whole = self.good()
        for _ in range(8):
            flipped = bytearray(whole)
            # The first ten bytes are the gz header, of which not all carry data (RFC 1952, 2.3.1).
            flipped[chance.randrange(10, len(whole))] ^= 1 << chance.randrange(8)
            self.write("flipped.rawlog", bytes(flipped))
            self.slamot("info", "flipped.rawlog", code=2, says=["flipped.rawlog"])
            self.run_log("flipped.rawlog", code=2, says=["flipped.rawlog"])

    def test_a_flip_in_a_plain_log_never_crashes(self):
        chance = random.Random(8)
        whole = self.plain()
        noticed = 0
        for _ in range(15):
            flipped = bytearray(whole)
            flipped[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
            self.write("flipped.rawlog", bytes(flipped))
            # A changed number is not told from a true one (exit 0); 1 where the numbers became impossible.
            noticed += self.run_log("flipped.rawlog", code=(0, 1, 2)).returncode != 0
        self.assertGreater(noticed, 0, "class names and sizes make up a good part of a log")
        self.assertIn("no checksum", self.slamot("info", self.write("plain.rawlog", whole)).stdout)

    def test_a_checksum_beside_the_log_shows_every_change(self):
        import hashlib
        whole = self.plain()
        self.write("log.rawlog", whole)
        self.write("log.rawlog.sha256", hashlib.sha256(whole).hexdigest() + "  log.rawlog\n")
        self.everywhere("log.rawlog")
        self.assertIn("checksum: matches", self.slamot("info", "log.rawlog").stdout)
        chance = random.Random(9)
        for _ in range(5):
            flipped = bytearray(whole)
            flipped[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
            self.write("log.rawlog", bytes(flipped))
            self.everywhere("log.rawlog", code=2, says=["log.rawlog", "differs from its checksum"])
        shutil.copy(self.logs / "good.rawlog", self.path("bad.rawlog"))
        for text in ("", "not a checksum\n"):
            self.write("bad.rawlog.sha256", text)
            self.everywhere("bad.rawlog", code=2, says=["bad.rawlog.sha256"])


if __name__ == "__main__":
    unittest.main()
