"""What prt-compress takes beside the program: encoding, searching within an error, and within bytes
that hold thousands of clusters, at most 1.5 times the signal."""

import array
import os
import random
import struct
import subprocess
import unittest

from toolbox import BIN, DONE, ToolTest

POINTS, COEFFICIENTS, BLOCK = 100_000, 300, 1_000
SIGNAL_BYTES = 4 * POINTS * COEFFICIENTS


def peak_bytes(tool, *arguments):
    """The largest resident set of a tool that has to succeed."""
    process = subprocess.Popen([str(BIN / tool), *map(str, arguments)], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == DONE, arguments
    return 1024 * usage.ru_maxrss


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers need memory of their own")
class Memory(ToolTest):
    @classmethod
    def setUpClass(cls):
        cls.program = peak_bytes("prt-compress", "--version")

    def write_signal(self):
        """120 MB of rows that all differ, block by block, so that this process stays small."""
        path = self.folder / "x.npy"
        header = (f"{{'descr': '<f4', 'fortran_order': False, "
                  f"'shape': ({POINTS}, {COEFFICIENTS}), }}").ljust(117) + "\n"
        draw = random.Random(1).gauss
        block = array.array("f", (draw(0, 1 / (1 + i)) for _ in range(BLOCK)
                                  for i in range(COEFFICIENTS)))
        with open(path, "wb") as file:
            file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode())
            for _ in range(POINTS // BLOCK):
                block[::COEFFICIENTS] = array.array("f", (x + 0.01 for x in block[::COEFFICIENTS]))
                file.write(block.tobytes())
        return path

    def test_encoding_and_search_take_one_and_a_half_signals(self):
        signal = self.write_signal()
        for options in (("--clusters", 64, "--components", 6, "--iterations", 3),
                        ("--max-error", 0.4, "--iterations", 3),
                        ("--max-bytes", 4_000_000, "--method", "vq", "--iterations", 1)):
            with self.subTest(options=options):
                peak = peak_bytes("prt-compress", "--signal", signal, *options, "-q", "-o",
                                  self.folder / "x.npz")
                self.assertGreater(peak - self.program, SIGNAL_BYTES)
                self.assertLess(peak - self.program, 1.5 * SIGNAL_BYTES)


if __name__ == "__main__":
    unittest.main()
