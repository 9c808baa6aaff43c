"""An interrupted tool leaves no output and no harm, whatever it was doing."""

import signal
import subprocess
import time
import unittest

from toolbox import BIN, BUNNY, ToolTest


class Interrupt(ToolTest):
    def test_interrupted_bake_keeps_the_earlier_output(self):
        mesh = self.folder / "bunny.glb"
        self.done("prt-import", BUNNY, "-o", mesh)
        out = self.write("bunny.transfer.exr", "earlier")
        before = self.listing()
        for delay in (0.05, 0.3, 0.8):
            for number in (signal.SIGINT, signal.SIGTERM):
                process = subprocess.Popen(
                    [BIN / "prt-transfer", mesh, "-o", out, "--rays", "20000"],
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(delay)
                self.assertIsNone(process.poll(), "ended before it was interrupted")
                process.send_signal(number)
                self.assertEqual(process.wait(10), -number)
                self.assertEqual(self.listing(), before)

    def test_interruption_in_the_middle_of_writing(self):
        """Signals at every moment of a short run: the output is the old one or the new one."""
        mesh = self.folder / "bunny.glb"
        self.done("prt-import", BUNNY, "-o", mesh)
        reference = mesh.read_bytes()
        interrupted = 0
        start = time.time()
        self.done("prt-import", BUNNY, "-o", self.folder / "timed.glb")
        length = time.time() - start
        (self.folder / "timed.glb").unlink()
        out = self.write("out.glb", "earlier")
        for step in range(20):
            process = subprocess.Popen([BIN / "prt-import", BUNNY, "-o", out],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(length * step / 19)
            process.terminate()
            interrupted += process.wait(20) != 0
            self.assertIn(out.read_bytes(), (b"earlier", reference))
            self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                             ["bunny.glb", "out.glb"])
        self.assertGreater(interrupted, 3)


if __name__ == "__main__":
    unittest.main()
