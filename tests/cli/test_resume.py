"""Work that was killed is continued by the next run, and gives the same bytes."""

import os
import subprocess
import time
import unittest

from toolbox import BIN, BUNNY, WRONG_USAGE, ToolTest, limit_file_size

EARLY = {**os.environ, "PRTKIT_CHECKPOINT_SECONDS": "0"}


class Resume(ToolTest):
    def setUp(self):
        super().setUp()
        self.mesh, self.out = self.folder / "bunny.glb", self.folder / "b.transfer.exr"
        self.made_once(lambda: self.done("prt-import", BUNNY, "-o", self.mesh))

    def kill_when(self, size, *command):
        """Starts a tool that writes self.out, and kills it when its unfinished work has `size`
        bytes."""
        partial = self.partial()
        process = subprocess.Popen([BIN / command[0], *map(str, command[1:])], env=EARLY,
                                   stderr=subprocess.DEVNULL)
        while not partial.exists() or partial.stat().st_size < size:
            self.assertIsNone(process.poll(), "ended before it was killed")
            time.sleep(0.002)
        process.kill()
        process.wait()
        self.assertFalse(self.out.exists())

    def partial(self):
        return self.out.with_name(self.out.name + ".partial")

    def continues(self, sizes, command, pattern, key):
        """Killed when its unfinished work has each of the sizes, a tool goes on to the bytes that
        it gives undisturbed; returns what the report of the last run has under `key`."""
        self.done(*command)
        expected = self.out.read_bytes()
        self.assertFalse(self.partial().exists())  # not worth it, after less than ten seconds
        self.out.unlink()
        for size in sizes:
            self.kill_when(size, *command)
        report = self.folder / "report.json"
        result = self.done(*command, "--report", report)
        self.assertRegex(result.stderr, "continuing an interrupted run, which " + pattern)
        self.assertEqual(self.out.read_bytes(), expected)
        self.assertFalse(self.partial().exists())
        return self.load(report)[key]

    def test_a_bake(self):
        bake = ("prt-transfer", self.mesh, "-o", self.out, "--rays", 256, "--bounces", 1)
        sizes = (1_000_000, 2_000_000, 6_000_000)  # twice in the shadows, then in the bounces
        resumed = self.continues(sizes, bake, r"traced \d+% of the vertices", "resumed_vertex_count")
        self.assertGreater(resumed, 10_000)

    def test_matrices(self):
        bake = ("prt-transfer", self.mesh, "-o", self.out, "--mode", "matrix", "--bands", 2, "--rows",
                4, "--brdf", "phong:5", "--rays", 64, "--bounces", 2)
        vertex = 9 * 4 + 4  # visibility; then fields of 16 half floats
        sizes = [34835 * n for n in (vertex // 2, vertex + 16, vertex + 48, vertex + 80)]
        resumed = self.continues(sizes, bake, r"did \d+% of the bounces", "resumed_bounce_share")
        self.assertGreater(resumed, 0.6)

    def test_an_encoding(self):
        transfer = self.folder / "u.transfer.exr"
        self.done("prt-transfer", self.mesh, "-o", transfer, "--unshadowed", "--bands", 8)
        self.out = self.folder / "b.prt.glb"
        encode = ("prt-compress", self.mesh, transfer, "-o", self.out, "--method", "adaptive",
                  "--clusters", 64, "--components", 3)
        resumed = self.continues((100, 600_000), encode, r"encoded with \d of 3 components",
                                 "resumed_iteration_count")
        self.assertGreaterEqual(resumed, 20)  # one level at least, whenever it was killed

    def test_a_reference_picture(self):
        light = self.folder / "light.json"
        self.out = self.folder / "r.exr"
        self.done("prt-light", "--constant", "1,1,1", "-o", light)
        trace = ("prt-render", self.mesh, "-o", self.out, "--light", light, "--reference",
                 "--bounces", 1, "--samples", 16, "--size", "256x256")
        self.continues((500_000,), trace, r"traced \d+% of the picture", "resumed_share")

    def test_other_options_start_anew(self):
        bake = ("prt-transfer", self.mesh, "-o", self.out, "--rays")
        self.kill_when(1_000_000, *bake, 256)
        result = self.done(*bake, 16)
        self.assertNotIn("continuing", result.stderr)
        self.assertFalse(self.partial().exists())

    def test_a_full_disk_takes_the_checkpoint_and_not_the_output(self):
        result = self.done("prt-transfer", self.mesh, "-o", self.out, "--rays", 16, "--bounces", 1,
                           env=EARLY, preexec_fn=limit_file_size(5_000_000))
        self.assertIn("cannot be continued", result.stderr)
        self.assertTrue(self.out.exists())
        self.assertFalse(self.partial().exists())

    def test_the_time_has_to_be_a_number(self):
        self.refused(WRONG_USAGE, "PRTKIT_CHECKPOINT_SECONDS", "prt-transfer", self.mesh, "-o",
                     self.out, env={**EARLY, "PRTKIT_CHECKPOINT_SECONDS": "soon"})


if __name__ == "__main__":
    unittest.main()
