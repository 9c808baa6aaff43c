"""An interrupted tool leaves no output and no harm, whatever it was doing."""

import os
import resource
import signal
import subprocess
import time
import unittest

from toolbox import BIN, BUNNY, QUAD_OBJ, ToolTest


SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE)


def no_core_dump():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # SIGQUIT would leave one
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)     # Python ignores it, and children inherit that


class Interrupt(ToolTest):
    def test_interrupted_bake_keeps_the_earlier_output(self):
        mesh = self.folder / "bunny.glb"
        self.done("prt-import", BUNNY, "-o", mesh)
        out = self.write("bunny.transfer.exr", "earlier")
        before = self.listing()
        for delay in (0.05, 0.3, 0.8):
            for number in SIGNALS:
                process = subprocess.Popen(
                    [BIN / "prt-transfer", mesh, "-o", out, "--rays", "20000"],
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=no_core_dump)
                time.sleep(delay)
                self.assertIsNone(process.poll(), "ended before it was interrupted")
                process.send_signal(number)
                self.assertEqual(process.wait(10), -number)
                self.assertEqual(self.listing(), before)

    def test_interruption_in_the_middle_of_writing(self):
        """A large output, and signals from the moment that its temporary file is there: the output
        is the old one or the new one."""
        mesh = self.folder / "sheet.glb"
        command = [BIN / "prt-import", self.write("quad.obj", QUAD_OBJ), "--max-edge", "0.002", "-o"]
        self.done("prt-import", *command[1:], mesh)
        reference = mesh.read_bytes()
        self.assertGreater(len(reference), 20e6)
        out = self.write("out.glb", "earlier")
        names = sorted(p.name for p in self.folder.iterdir())
        interrupted = 0
        for step in range(20):
            process = subprocess.Popen([*command, out], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL, preexec_fn=no_core_dump)
            while process.poll() is None and len(os.listdir(self.folder)) == len(names):
                time.sleep(0.0005)
            time.sleep(0.002 * step)
            number = SIGNALS[step % len(SIGNALS)]
            process.send_signal(number)
            status = process.wait(20)
            self.assertIn(status, (0, -number))
            interrupted += status != 0
            self.assertIn(out.read_bytes(), (b"earlier", reference))
            self.assertEqual(sorted(p.name for p in self.folder.iterdir()), names)
        self.assertGreater(interrupted, 3)


if __name__ == "__main__":
    unittest.main()
