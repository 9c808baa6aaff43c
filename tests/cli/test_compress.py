"""prt-compress: methods, signals of any origin, weights, the search, and what cannot be meant."""

import ast
import json
import math
import os
import random
import struct
import unittest
import zipfile

from toolbox import glb as glb_bytes
from toolbox import BAD_INPUT, FAILED, QUAD_OBJ, SOURCE, WRONG_USAGE, ToolTest, read_glb, run


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

    def test_clusters_of_different_size_are_told_by_fewest_most_and_average_vectors(self):
        for method, pattern in (("static", "in 20 clusters of 4 components: "),
                                ("adaptive", "in 20 clusters of {} to {} components, {:.1f} a point: ")):
            result = self.done("prt-compress", "--signal", self.signal, "--report", self.report,
                               "--method", method, "--clusters", 20, "--components", 4)
            report = self.load(self.report)
            counts = [report[f"{least}component_count"] for least in ("least_", "", "mean_")]
            self.assertIn(pattern.format(*counts), result.stderr)
            self.assertEqual(method == "static", counts[0] == counts[1] == counts[2])
            self.assertLessEqual(counts[2], 4 + 1e-9)

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
        self.assertEqual(search["sampled_points"], 1500)
        self.assertIn((report["cluster_count"], report["component_count"]),
                      [(t["cluster_count"], t["component_count"]) for t in search["trials"]])
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

    def decoded(self, path):
        """Rows of the points that a .npz file holds, read without NumPy."""
        arrays = {}
        with zipfile.ZipFile(path) as archive:
            self.assertIsNone(archive.testzip())
            for name in archive.namelist():
                data = archive.read(name)
                length = struct.unpack_from("<H", data, 8)[0]
                header = ast.literal_eval(data[10:10 + length].decode())
                code = {"<u2": "H", "<u4": "I", "<f4": "f"}[header["descr"]]
                count = math.prod(header["shape"])
                arrays[name] = header["shape"], struct.unpack_from(f"<{count}{code}", data,
                                                                   10 + length)
        (points,), clusters = arrays["cluster_of_point.npy"]
        (_, dimension), means = arrays["means.npy"]
        (_, counts), (shape, bases) = arrays["component_counts.npy"], arrays["bases.npy"]
        self.assertEqual(shape, (sum(counts), dimension))
        weights = iter(arrays["weights.npy"][1])
        first_vectors = [sum(counts[:k]) for k in range(len(counts))]
        rows = []
        for k in clusters:
            row = list(means[k * dimension:(k + 1) * dimension])
            for i in range(first_vectors[k], first_vectors[k] + counts[k]):
                weight = next(weights)
                for j in range(dimension):
                    row[j] += weight * bases[i * dimension + j]
            rows.append(row)
        self.assertEqual((len(rows), next(weights, None)), (points, None))
        return rows

    def test_bytes_are_those_of_the_file(self):
        output = self.folder / "x.npz"
        for method in ("vq", "static", "adaptive"):
            report = self.compress("-o", output, "--method", method, "--clusters", 20)
            self.assertEqual(report["bytes"], output.stat().st_size)
            self.assertEqual(report["compression_ratio"], report["signal_bytes"] / report["bytes"])
        for method in ("static", "iterative", "adaptive"):
            report = self.compress("-o", output, "--method", method, "--max-bytes", 20000)
            self.assertEqual(report["bytes"], output.stat().st_size)
            self.assertIn(report["bytes"], [t["bytes"] for t in report["search"]["trials"]])
            self.assertLessEqual(report["bytes"], 20000)

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

    def test_arrays_hold_what_the_report_says(self):
        for size in (1.0, 1e-30, 1e30):
            original = [[size * value for value in row] for row in curved_rows()]
            self.signal = self.write("x.npy", npy(original))
            output = self.folder / "x.npz"
            for method in ("iterative", "adaptive"):
                report = self.compress("-o", output, "--method", method, "--clusters", 20,
                                       "--components", 2, "--iterations", 5)
                errors = [sum(((a - b) / size) ** 2 for a, b in zip(row, found))
                          for row, found in zip(original, self.decoded(output))]
                energy = sum((value / size) ** 2 for row in original for value in row)
                self.assertAlmostEqual(math.sqrt(sum(errors) / energy), report["relative_rmse"],
                                       delta=1e-5 * report["relative_rmse"])
                self.assertAlmostEqual(math.sqrt(max(errors) * len(errors) / energy),
                                       report["relative_max"], delta=1e-5)
                self.assertLess(report["relative_rmse"], 0.2)
        self.assertEqual(report["outputs"][0]["path"], str(output))
        self.refused(WRONG_USAGE, 'found ".glb", expected .npz', "prt-compress", "--signal",
                     self.signal, "-o", self.folder / "x.glb")
        self.refused(FAILED, "exists", "prt-compress", "--signal", self.signal, "-o", output,
                     "--no-clobber")

    def test_arrays_without_numbers_are_whole(self):
        output = self.folder / "x.npz"
        for options in (("--method", "vq", "--clusters", 20), ("--max-error", 1)):
            self.assertEqual(self.compress("-o", output, *options)["component_count"], 0)
            with zipfile.ZipFile(output) as archive:
                self.assertIsNone(archive.testzip())

    def test_weighted_figures_are_of_the_weights(self):
        weights = [100.0] * 6 + [0.01] * 6
        output = self.folder / "x.npz"
        report = self.compress("-o", output, "--max-error", 0.05, "--coefficient-weights",
                               self.write("w.npy", npy([weights])))
        rows = list(zip(curved_rows(), self.decoded(output)))
        error = sum(w * (a - b) ** 2 for row, found in rows
                    for w, a, b in zip(weights, row, found))
        energy = sum(w * a * a for row, _ in rows for w, a in zip(weights, row))
        self.assertAlmostEqual(error, report["weighted_squared_error"], delta=1e-4 * error)
        self.assertAlmostEqual(energy, report["weighted_signal_energy"], delta=1e-4 * energy)
        self.assertAlmostEqual(math.sqrt(error / energy), report["weighted_relative_rmse"],
                               delta=1e-5)
        self.assertLessEqual(report["weighted_relative_rmse"], 0.05)
        self.assertGreater(report["relative_rmse"], 0.05)
        self.assertAlmostEqual(report["iterations"][-1]["errors"][-1],
                               report["weighted_squared_error"], delta=0.1 * error)

    def test_bad_rows_are_named(self):
        rows = curved_rows(300)
        rows[217][3] = float("nan")
        path = self.write("nan.npy", npy(rows))
        self.refused(BAD_INPUT, "nan.npy: row 217, column 3: not a finite number: found nan",
                     "prt-compress", "--signal", path, "--clusters", 4)
        self.refused(BAD_INPUT, "not a .npy file", "prt-compress", "--signal",
                     self.write("y.npy", b"hello, world"))
        self.refused(WRONG_USAGE, "more clusters than points", "prt-compress", "--signal",
                     self.write("one.npy", npy([[1.0, 2.0]])))

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
                ("above 0", "--max-error", 0),
                ("above 0", "--max-error", -1),
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


def with_vertex_count(transfer, count):
    """Bytes of a transfer file whose header claims that many vertices, and no pixels."""
    header, at = bytearray(transfer[:8]), 8
    while transfer[at]:
        name = transfer[at:transfer.index(b"\0", at)]
        start = transfer.index(b"\0", at + len(name) + 1) + 1
        size = struct.unpack_from("<i", transfer, start)[0]
        value = transfer[start + 4:start + 4 + size]
        if name == b"prtkit_block_vertex_counts":
            value = struct.pack("<i", len(str(count))) + str(count).encode()
        elif name == b"dataWindow":
            value = struct.pack("<4i", 0, 0, 255, (count + 255) // 256 - 1)
        header += transfer[at:start] + struct.pack("<i", len(value)) + value
        at = start + 4 + size
    return bytes(header) + b"\0"


class Model(ToolTest):
    def test_transfer_larger_than_memory_is_refused(self):
        glb, transfer = self.folder / "a.glb", self.folder / "a.transfer.exr"
        self.done("prt-import", self.write("a.obj", QUAD_OBJ), "-o", glb)
        self.done("prt-transfer", glb, "-o", transfer, "--rays", 16, "--bands", 10)
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        count = memory // 400
        transfer.write_bytes(with_vertex_count(transfer.read_bytes(), count))
        os.truncate(transfer, memory)  # sparse: nobody may read it
        for method in ("pca", "iterative"):
            result = run("prt-compress", glb, transfer, "-o", self.folder / "b.glb", "--method",
                         method)
            self.assertEqual(result.returncode, BAD_INPUT)
            self.assertRegex(result.stderr, "transfer too large: found [0-9]+ bytes, expected at "
                                            "most [0-9]+. Take fewer")
        self.assertFalse((self.folder / "b.glb").exists())

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

    def test_half_floats_are_stored_shown_and_drawn(self):
        glb, transfer = self.folder / "a.glb", self.folder / "a.transfer.exr"
        self.done("prt-import", SOURCE / "data/colored_box.obj", "-o", glb, "--max-edge", 0.2)
        self.done("prt-transfer", glb, "-o", transfer, "--rays", 128)
        light, report, difference = (self.folder / n for n in ("l.json", "c.json", "d.json"))
        self.done("prt-light", "--directional", "0,1,1,2,2,2", "-o", light)
        counts = ("--clusters", 8, "--components", 5, "--no-coherence", "--report", report)
        for method in ("iterative", "adaptive"):
            pictures = {}
            for weights in ("float", "half"):
                baked = self.folder / f"{weights}.prt.glb"
                self.done("prt-compress", glb, transfer, "-o", baked, "--method", method,
                          "--weights", weights, *counts)
                self.assertEqual(self.load(report)["weights"], weights)
                shown = json.loads(self.done("prt-inspect", baked, "--json").stdout)
                self.assertEqual(shown["precomputed_transfer"]["weights"], weights)
                for draw in ("single", "clusters"):
                    pictures[weights, draw] = self.folder / f"{weights}_{draw}.exr"
                    self.done("prt-render", baked, "--light", light, "--size", "96x96", "--draw",
                              draw, "-o", pictures[weights, draw])
            for draw in ("single", "clusters"):
                self.done("prt-inspect", "--compare", pictures["half", draw],
                          pictures["float", draw], "--report", difference)
                error = self.load(difference)["result"]["comparison"]["relative_rmse"]
                self.assertGreater(error, 0)
                self.assertLess(error, 1e-3)
        content, binary = read_glb(self.folder / "half.prt.glb")
        header = content["extensions"]["PRTKIT_precomputed_transfer"]["transfers"][0]
        self.assertEqual((header["conventions"], header["weightComponentType"]), (3, 5131))
        primitive = content["meshes"][0]["primitives"][0]["extensions"]
        accessor = content["accessors"][primitive["PRTKIT_precomputed_transfer"]["weights"]]
        self.assertEqual(accessor["componentType"], 5123)
        view = content["bufferViews"][accessor["bufferView"]]
        for bits in (0x7c00, 0xfc00, 0x7e00):
            broken = bytearray(binary)
            struct.pack_into("<H", broken, view.get("byteOffset", 0) + 6, bits)
            self.refused(BAD_INPUT, "weights: found a number that is not finite", "prt-render",
                         self.write("bad.glb", glb_bytes(content, bytes(broken))), "--light",
                         light, "-o", self.folder / "bad.png")
            self.assertEqual(run("prt-inspect", self.folder / "bad.glb").returncode, BAD_INPUT)


if __name__ == "__main__":
    unittest.main()
