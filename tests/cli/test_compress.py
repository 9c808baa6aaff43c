"""prt-compress: methods, signals of any origin, weights, the search, and what cannot be meant."""

import math
import random
import struct
import unittest

from signals import SignalTest, curved_rows, npy, npy_header
from toolbox import BAD_INPUT, FAILED, WRONG_USAGE, ToolTest, run


class Signal(SignalTest):
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

    def test_clusters_of_different_size_are_told_by_fewest_most_and_average_vectors(self):
        # With four each, adaptive clusters of this signal end with four each as well.
        for method, pattern in (("static", "in 20 clusters of 3 components: "),
                                ("adaptive",
                                 "in 20 clusters of {} to {} components, {:.1f} a point: ")):
            result = self.done("prt-compress", "--signal", self.signal, "--report", self.report,
                               "--method", method, "--clusters", 20, "--components", 3)
            report = self.load(self.report)
            counts = [report[f"{least}component_count"] for least in ("least_", "", "mean_")]
            self.assertIn(pattern.format(*counts), result.stderr)
            self.assertEqual(method == "static", counts[0] == counts[1] == counts[2])
            self.assertLessEqual(counts[2], 3 + 1e-9)

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
        report = self.compress("--max-error", 0.05)
        self.assertLessEqual(report["relative_rmse"], 0.05)
        search = report["search"]
        self.assertLessEqual(search["flops_cost"], 3)
        self.assertGreater(report["search_cost"], 1)
        self.assertEqual(report["stored_numbers"],
                         1500 * report["component_count"] + 12 * report["cluster_count"] *
                         (1 + report["component_count"]))
        self.assertEqual(search["sampled_points"], 375)
        self.assertIn((report["cluster_count"], report["component_count"]),
                      [(t["cluster_count"], t["component_count"]) for t in search["trials"]])
        report = self.compress("--max-error", 0.1, "--norm", "max")
        mean_energy = report["signal_energy"] / report["point_count"]
        self.assertLessEqual(math.sqrt(report["max_point_error"] / mean_energy), 0.1)
        self.assertLessEqual(self.compress("--max-bytes", 10000)["bytes"], 10000)
        self.refused(FAILED, "no encoding is as small", "prt-compress", "--signal", self.signal,
                     "--max-bytes", 10)

    def test_search_of_a_few_points_finds_the_exact_encoding(self):
        for count in (1, 5, 64):
            numbers = random.Random(count)
            self.signal.write_bytes(npy([[numbers.gauss(0, 1) for _ in range(12)]
                                         for _ in range(count)]))
            exact = self.compress("--method", "pca", "--components", 12)["bytes"]
            for bound in ((0.1, "rmse"), (0.1, "max"), (1e-6, "rmse")):
                report = self.compress("--max-error", bound[0], "--norm", bound[1])
                self.assertLessEqual(report["relative_" + bound[1]], bound[0])
                self.assertLessEqual(report["bytes"], exact)

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

    def test_search_of_vector_quantisation_chooses_clusters_alone(self):
        few = self.compress("--method", "vq", "--max-bytes", 8000)
        self.assertLessEqual(few["bytes"], 8000)
        self.assertGreater(few["bytes"], 7000)
        report = self.compress("--method", "vq", "--max-error", few["relative_rmse"] / 2)
        self.assertLessEqual(report["relative_rmse"], few["relative_rmse"] / 2)
        self.assertEqual((few["component_count"], report["component_count"]), (0, 0))
        self.assertLess(few["cluster_count"], report["cluster_count"])

    def test_no_more_bytes_are_taken_than_are_of_use(self):
        for method in ("static", "iterative", "adaptive"):
            result = self.done("prt-compress", "--signal", self.signal, "--report", self.report,
                               "--max-bytes", 100000000, "--method", method)
            self.assertRegex(result.stderr, "--max-bytes is more than any use: [0-9]+ bytes hold")
            report = self.load(self.report)
            self.assertLess(report["bytes"], 1.2 * report["signal_bytes"])
            self.assertLess(report["relative_rmse"], 1e-3)
        result = self.done("prt-compress", "--signal", self.signal, "--max-bytes", 20000)
        self.assertNotIn("--max-bytes", result.stderr)

    def test_a_list_of_numbers_has_a_point_each(self):
        header = npy_header(1500, 1).replace(b"(1500, 1)", b"(1500,)  ")
        values = [row[0] for row in curved_rows()]
        self.signal.write_bytes(header + struct.pack("<1500f", *values))
        report = self.compress("--method", "vq", "--clusters", 20)
        self.assertEqual((report["point_count"], report["dimension"]), (1500, 1))

    def test_bad_rows_are_named(self):
        rows = curved_rows(300)
        rows[217][3] = float("nan")
        path = self.write("nan.npy", npy(rows))
        self.refused(BAD_INPUT, "nan.npy: row 217, column 3: not a finite number: found nan",
                     "prt-compress", "--signal", path, "--clusters", 4)
        self.refused(BAD_INPUT, "not a .npy file", "prt-compress", "--signal",
                     self.write("y.npy", b"hello, world"))
        self.refused(WRONG_USAGE, "more clusters than points", "prt-compress", "--clusters", 256,
                     "--signal", self.write("one.npy", npy([[1.0, 2.0]])))

    def test_signal_larger_than_memory_is_refused(self):
        path = self.write("big.npy", npy_header(90000000, 600))
        with path.open("r+b") as file:
            file.truncate(path.stat().st_size + 90000000 * 2400)
        for method in ("vq", "pca", "static", "iterative", "adaptive"):
            # Sparse: nobody may read it.
            result = run("prt-compress", "--signal", path, "--method", method)
            self.assertEqual(result.returncode, BAD_INPUT)
            self.assertRegex(result.stderr,
                             "too large: found 90000000 × 600 values, 216000000000 bytes")


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
                ("are not for --method pca", "--max-bytes", 1000, "--method", "pca"),
                ("--max-error", "--max-error", 0.1, "--max-bytes", 1000),
                ("--norm requires --max-error", "--norm", "max"),
                ("--max-error has to be above 0", "--max-error", 0),
                ("--max-error has to be above 0", "--max-error", -1),
                ("--max-bytes has to be above 0", "--max-bytes", 0),
                ("not a finite number", "--max-error", "nan"),
                ("needs a model", "--point-weights", "area"),
                ("excludes", "--no-coherence"),
                ("excludes", "--error-budget", 0.1),
                ("excludes", "--registers", 64),
                ("excludes", "--weights", "float"),
                ("without a model", self.folder / "a.glb")):
            with self.subTest(options):
                self.refused(WRONG_USAGE, pattern, "prt-compress", "--signal", signal, *options)
        self.refused(WRONG_USAGE, "are needed", "prt-compress", "a.glb", "a.transfer.exr")
        self.refused(WRONG_USAGE, "a.transfer.exr is no model. Name the model first",
                     "prt-compress", "a.transfer.exr", "a.glb", "-o", self.folder / "b.glb")


if __name__ == "__main__":
    unittest.main()
