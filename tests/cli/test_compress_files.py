"""prt-compress: what the files hold that it writes, of signals and of models."""

import ast
import json
import math
import os
import struct
import unittest
import zipfile

from signals import SignalTest, curved_rows, npy
from toolbox import glb as glb_bytes
from toolbox import (BAD_INPUT, FAILED, QUAD_OBJ, SOURCE, WRONG_USAGE, ToolTest, read_glb,
                     run)


class Arrays(SignalTest):
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
        for options in (("--method", "vq", "--clusters", 20), ("--max-error", 0.99)):
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
        self.assertGreater(report["relative_rmse"], 1.05 * report["weighted_relative_rmse"])
        self.assertAlmostEqual(report["iterations"][-1]["errors"][-1],
                               report["weighted_squared_error"], delta=0.1 * error)



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
