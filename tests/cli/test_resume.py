"""A bake that was killed is continued by the next run, and gives the same bytes."""

import os
import signal
import subprocess
import time
import unittest

from toolbox import BIN, BUNNY, WRONG_USAGE, ToolTest, limit_file_size

EARLY = {**os.environ, "PRTKIT_CHECKPOINT_SECONDS": "0.1"}


class Resume(ToolTest):
    def setUp(self):
        super().setUp()
        self.mesh, self.out = self.folder / "bunny.glb", self.folder / "b.transfer.exr"
        self.done("prt-import", BUNNY, "-o", self.mesh)
        self.partial = self.folder / "b.transfer.exr.partial"

    def kill_when(self, size, *options):
        """Starts a bake and kills it when the file of unfinished work has `size` bytes."""
        process = subprocess.Popen([BIN / "prt-transfer", self.mesh, "-o", self.out, *options],
                                   stderr=subprocess.DEVNULL, env=EARLY)
        while not self.partial.exists() or self.partial.stat().st_size < size:
            self.assertIsNone(process.poll(), "ended before it was killed")
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertFalse(self.out.exists())

    def test_a_killed_bake_is_continued(self):
        options = ["--rays", "512", "--bounces", "1"]
        self.done("prt-transfer", self.mesh, "-o", self.out, *options)
        expected = self.out.read_bytes()
        self.assertFalse(self.partial.exists())  # not worth it, after less than ten seconds
        self.out.unlink()
        for size in (1_000_000, 2_000_000, 6_000_000):  # twice in the shadows, then in the bounces
            self.kill_when(size, *options)
        report = self.folder / "report.json"
        result = self.done("prt-transfer", self.mesh, "-o", self.out, "--report", report, *options)
        self.assertRegex(result.stderr, r"continuing an interrupted run, which traced \d+% of")
        resumed = self.load(report)["resumed_vertex_count"]
        self.assertGreater(resumed, 10_000)
        self.assertEqual(self.out.read_bytes(), expected)
        self.assertFalse(self.partial.exists())

    def test_a_reference_picture_is_continued(self):
        picture, light = self.folder / "r.exr", self.folder / "light.json"
        self.done("prt-light", "--constant", "1,1,1", "-o", light)
        command = ("prt-render", self.mesh, "-o", picture, "--light", light, "--reference",
                   "--bounces", 1, "--samples", 64, "--size", "256x256")
        self.done(*command)
        expected = picture.read_bytes()
        picture.unlink()
        partial = self.folder / "r.exr.partial"
        process = subprocess.Popen([BIN / command[0], *map(str, command[1:])], env=EARLY,
                                   stderr=subprocess.DEVNULL)
        while not partial.exists() or partial.stat().st_size < 500_000:
            self.assertIsNone(process.poll(), "ended before it was killed")
            time.sleep(0.002)
        process.kill()
        process.wait()
        result = self.done(*command)
        self.assertRegex(result.stderr, r"continuing an interrupted run, which traced \d+% of")
        self.assertEqual(picture.read_bytes(), expected)
        self.assertFalse(partial.exists())

    def test_other_options_start_anew(self):
        self.kill_when(1_000_000, "--rays", "512")
        result = self.done("prt-transfer", self.mesh, "-o", self.out, "--rays", "64")
        self.assertNotIn("continuing", result.stderr)
        self.assertFalse(self.partial.exists())

    def test_a_full_disk_takes_the_checkpoint_and_not_the_output(self):
        result = self.done("prt-transfer", self.mesh, "-o", self.out, "--rays", "64", "--bounces", "1",
                           env={**EARLY, "PRTKIT_CHECKPOINT_SECONDS": "0"},
                           preexec_fn=limit_file_size(5_000_000))
        self.assertIn("cannot be continued", result.stderr)
        self.assertTrue(self.out.exists())
        self.assertFalse(self.partial.exists())

    def test_the_time_has_to_be_a_number(self):
        self.refused(WRONG_USAGE, "PRTKIT_CHECKPOINT_SECONDS", "prt-transfer", self.mesh, "-o",
                     self.out, env={**EARLY, "PRTKIT_CHECKPOINT_SECONDS": "soon"})


if __name__ == "__main__":
    unittest.main()
