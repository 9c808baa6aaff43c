"""prt-compress: methods, signals of any origin, weights, the search, and what cannot be meant."""

import math
import random
import struct
import unittest

from toolbox import BAD_INPUT, FAILED, SOURCE, WRONG_USAGE, ToolTest, run


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


class Signal(ToolTest):
    def setUp(self):
        super().setUp()
        self.signal = self.write("x.npy", npy(curved_rows()))
        self.report = self.folder / "c.json"

    def compress(self, *options):
        self.done("prt-compress", "--signal", self.signal, "--report", self.report, *options)
        return self.load(self.report)

    def test_each_method_is_better_than_the_one_before(self):
        counts = ("--clusters", 20, "--components", 2, "--iterations", 10)
        errors = [self.compress("--method", method, *counts)["squared_error"]
                  for method in ("static", "iterative", "adaptive")]
        vq = self.compress("--method", "vq", "--clusters", 20)
        pca = self.compress("--method", "pca", "--components", 2)
        self.assertGreater(min(vq["gflops"], pca["gflops"]), 0)
        self.assertEqual((vq["component_count"], pca["cluster_count"]), (0, 1))
        self.assertLess(errors[0], min(vq["squared_error"], pca["squared_error"]))
        self.assertLess(errors[1], 0.9 * errors[0])
        self.assertLess(errors[2], errors[1])

    def test_report_tells_the_error_after_each_iteration(self):
        report = self.compress("--clusters", 20, "--components", 2, "--iterations", 5)
        self.assertEqual([level["component_count"] for level in report["iterations"]], [0, 1, 2])
        errors = [error for level in report["iterations"] for error in level["errors"]]
        self.assertEqual(len(errors), report["iteration_count"])
        for before, after in zip(errors, errors[1:]):
            self.assertLessEqual(after, before * (1 + 1e-5))
        self.assertGreater(report["gflops"], 0)
        self.assertGreater(report["seconds"], 0)
        self.assertLess(report["bytes"], report["signal_bytes"])

    def test_search_keeps_to_its_bound(self):
        self.assertLessEqual(self.compress("--max-error", 0.05)["relative_rmse"], 0.05)
        report = self.compress("--max-error", 0.1, "--norm", "max")
        mean_energy = report["signal_energy"] / report["point_count"]
        self.assertLessEqual(math.sqrt(report["max_point_error"] / mean_energy), 0.1)
        self.assertLessEqual(self.compress("--max-bytes", 10000)["bytes"], 10000)
        self.refused(FAILED, "no encoding is as small", "prt-compress", "--signal", self.signal,
                     "--max-bytes", 10)

    def test_coefficient_weights_move_the_error(self):
        weights = self.write("w.npy", npy([[100.0] * 6 + [0.01] * 6]))
        counts = ("--clusters", 10, "--components", 2)
        plain, weighted = self.compress(*counts), self.compress(*counts, "--coefficient-weights",
                                                                weights)
        self.assertGreater(weighted["squared_error"], 1.01 * plain["squared_error"])
        bad = self.write("bad.npy", npy([[1.0] * 11 + [0.0]]))
        self.refused(BAD_INPUT, "coefficient 11: not a weight", "prt-compress", "--signal",
                     self.signal, "--coefficient-weights", bad)

    def test_result_larger_than_the_signal_is_warned_of(self):
        result = self.done("prt-compress", "--signal", self.signal, "--clusters", 1000,
                           "--components", 12, "--iterations", 1)
        self.assertIn("larger than the signal", result.stderr)

    def test_bad_rows_are_named(self):
        rows = curved_rows(300)
        rows[217][3] = float("nan")
        path = self.write("nan.npy", npy(rows))
        self.refused(BAD_INPUT, "point 217, coefficient 3: the signal is not finite",
                     "prt-compress", "--signal", path, "--clusters", 4)
        self.refused(BAD_INPUT, "not a .npy file", "prt-compress", "--signal",
                     self.write("y.npy", b"hello, world"))
        self.refused(WRONG_USAGE, "more clusters than points", "prt-compress", "--signal",
                     self.write("one.npy", npy([[1.0, 2.0]])))

    def test_signal_larger_than_memory_is_refused(self):
        path = self.write("big.npy", npy_header(90000000, 600))
        with path.open("r+b") as file:
            file.truncate(path.stat().st_size + 90000000 * 2400)
        result = run("prt-compress", "--signal", path)  # sparse: nobody may read it
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertRegex(result.stderr, "too large: found 90000000 × 600 values, 216000000000 bytes")


class Contradictions(ToolTest):
    def test_what_cannot_be_meant_together_is_wrong_usage(self):
        signal = self.write("x.npy", npy(curved_rows(50)))
        for pattern, *options in (
                ("vq has no components", "--method", "vq", "--components", 8),
                ("pca has one cluster", "--method", "pca", "--clusters", 5),
                ("pca has no iterations", "--method", "pca", "--iterations", 5),
                ("for --method adaptive", "--max-components", 4),
                ("choose clusters and components", "--max-error", 0.1, "--clusters", 5),
                ("choose clusters and components", "--max-bytes", 1000, "--components", 5),
                ("leaves nothing to choose", "--max-error", 0.1, "--method", "vq"),
                ("--max-error", "--max-error", 0.1, "--max-bytes", 1000),
                ("--norm requires --max-error", "--norm", "max"),
                ("needs a model", "--point-weights", "area"),
                ("excludes", "--no-coherence"),
                ("excludes", "--error-budget", 0.1),
                ("excludes", "--registers", 64),
                ("excludes", "--weights", "float"),
                ("without a model", "-o", self.folder / "a.glb")):
            with self.subTest(options):
                self.refused(WRONG_USAGE, pattern, "prt-compress", "--signal", signal, *options)
        self.refused(WRONG_USAGE, "are needed", "prt-compress", "a.glb", "a.transfer.exr")


class Model(ToolTest):
    def test_all_methods_and_weights_reach_the_file(self):
        glb, transfer = self.folder / "a.glb", self.folder / "a.transfer.exr"
        self.done("prt-import", SOURCE / "data/colored_box.obj", "-o", glb, "--max-edge", 0.1)
        self.done("prt-transfer", glb, "-o", transfer, "--rays", 128)
        for method in ("vq", "pca", "static", "iterative", "adaptive"):
            for options in ((), ("--point-weights", "area")):
                count = () if method == "pca" else ("--clusters", 12)
                baked = self.folder / f"{method}{len(options)}.prt.glb"
                self.done("prt-compress", glb, transfer, "-o", baked, "--method", method, *count,
                          *options)
                self.done("prt-inspect", baked)
        report = self.folder / "c.json"
        for weights in ("auto", "float"):
            self.done("prt-compress", glb, transfer, "-o", self.folder / f"{weights}.glb",
                      "--max-bytes", 60000, "--weights", weights, "--report", report)
            self.assertLessEqual(self.load(report)["bytes"], 60000)
        self.done("prt-compress", glb, transfer, "-o", self.folder / "b.glb", "--max-error", 0.05,
                  "--report", report)
        self.assertLessEqual(self.load(report)["relative_rmse"], 0.05)


if __name__ == "__main__":
    unittest.main()
