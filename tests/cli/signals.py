"""Signals of no model, as prt-compress --signal takes them."""

import math
import random
import struct

from toolbox import ToolTest


def npy_header(row_count, dimension):
    text = ("{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d), }" %
            (row_count, dimension))
    text += " " * (-(11 + len(text)) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode()


def npy(rows):
    """Bytes of a .npy file of float32."""
    values = [value for row in rows for value in row]
    return npy_header(len(rows), len(rows[0])) + struct.pack(f"<{len(values)}f", *values)


def curved_rows(count=1500, dimension=12):
    """Points of a curved surface in space."""
    numbers = random.Random(5)
    rows = []
    for _ in range(count):
        u, v = numbers.random(), numbers.random()
        rows.append([math.sin((1 + i % 5) * u + i) * math.cos((1 + i % 3) * v)
                     for i in range(dimension)])
    return rows


class SignalTest(ToolTest):
    """A test with a signal, `self.signal`, and a place for the report of its compression."""

    def setUp(self):
        super().setUp()
        self.signal = self.write("x.npy", npy(curved_rows()))
        self.report = self.folder / "c.json"

    def compress(self, *options):
        self.done("prt-compress", "--signal", self.signal, "--report", self.report, *options)
        return self.load(self.report)
