"""The whole pipeline with the real tools: documented commands and reports, the same bytes for any
number of threads, files that other programs accept."""

import base64
import hashlib
import json
import math
import subprocess
import unittest

from toolbox import BIN, BUNNY, SOURCE, WORLD, WRONG_USAGE, ToolTest

BOX = SOURCE / "data/colored_box.obj"
EXAMPLES = SOURCE / "docs/extensions/PRTKIT_precomputed_transfer"
PNG = ("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJg"
       "gg==")  # a pixel
TOOLS = ("prt-import", "prt-light", "prt-transfer", "prt-compress", "prt-render", "prt-view",
         "prt-inspect")


class Pipeline(ToolTest):
    def paths(self):
        return {name: self.folder / f"a.{name}" for name in
                ("glb", "transfer.exr", "prt.glb", "json", "i", "t", "c")}

    def box(self):
        """Paths of the box, baked once for all tests."""
        self.made_once(lambda: self.bake(BOX))
        return self.paths()

    def bake(self, source, *, options=(), edge=0.1, **counts):
        """import → transfer → compress → light; returns the paths."""
        clusters, components = counts.get("clusters", 16), counts.get("components", 4)
        paths = self.paths()
        self.done("prt-import", source, "-o", paths["glb"], "--max-edge", edge, "--crease-angle",
                  30, "--report", paths["i"], *options)
        self.done("prt-transfer", paths["glb"], "-o", paths["transfer.exr"], "--bands", 4,
                  "--rays", 512, "--bounces", counts.get("bounces", 2), "--report", paths["t"],
                  *options)
        self.done("prt-compress", paths["glb"], paths["transfer.exr"], "-o", paths["prt.glb"],
                  "--clusters", clusters, "--components", components, "--method", "static",
                  "--report", paths["c"], *options)
        self.done("prt-light", WORLD / "courtyard.exr", "-o", paths["json"], "--bands", 4,
                  *options)
        return paths

    def test_reports_have_the_documented_keys(self):
        paths = self.box()
        common = {"tool", "version", "options", "inputs", "outputs", "stages", "seconds",
                  "peak_memory_bytes", "threads"}
        transfer, compress = self.load(paths["t"]), self.load(paths["c"])
        imported = self.load(paths["i"])
        for report in (imported, transfer, compress):
            self.assertLessEqual(common, report.keys())
            self.assertGreater(len(report["stages"]), 1)
            self.assertGreater(len(report["inputs"]), 0)
            for entry in report["outputs"]:
                self.assertGreater(entry["bytes"], 0)
        self.assertGreater(imported["vertex_count"], 500)
        self.assertGreater(transfer["rays_cast"], 512 * imported["vertex_count"] / 2)
        self.assertGreater(transfer["rays_per_second"], 0)
        self.assertGreaterEqual(transfer["buried_vertex_count"], 0)
        self.assertEqual(compress["cluster_count"], 16)
        self.assertEqual(compress["component_count"], 4)
        self.assertLess(math.sqrt(compress["squared_error"] / compress["signal_energy"]), 0.1)

    def test_coherence_sends_fewer_triangles_within_its_budget(self):
        paths = self.bake(BUNNY, edge=0.02, clusters=64, bounces=0)
        report, compress = self.folder / "r", ("prt-compress", paths["glb"], paths["transfer.exr"],
                                               "-o", paths["prt.glb"], "--clusters", 64,
                                               "--components", 4, "--report")
        coherent = self.load(paths["c"])
        self.assertEqual(coherent["error_budget"], 0.05)
        self.assertGreater(coherent["overdraw_initial"], coherent["overdraw_reclassified"])
        self.assertGreater(coherent["overdraw_reclassified"], coherent["overdraw_superclustered"])
        self.assertGreaterEqual(coherent["overdraw_superclustered"], 1)
        self.assertLess(coherent["supercluster_count"], 64)
        self.assertLessEqual(coherent["squared_error_reclassified"],
                             1.05 * coherent["squared_error_initial"])
        self.assertLessEqual(coherent["squared_error"],
                             1.01 * coherent["squared_error_reclassified"])
        sizes = {}
        for weights in ("float", "half", "unorm16", "unorm8"):
            self.done(*compress, report, "--no-coherence", "--weights", weights)
            plain = self.load(report)
            self.assertGreater(plain["overdraw_initial"], 1)
            self.assertNotIn("overdraw_reclassified", plain)
            self.assertEqual(plain["weights"], weights)
            sizes[weights] = (plain["bytes"], plain["squared_error"])
        self.assertGreater(sizes["float"][0], sizes["unorm16"][0])
        self.assertGreater(sizes["unorm16"][0], sizes["unorm8"][0])
        self.assertEqual(sizes["half"][0], sizes["unorm16"][0])
        self.assertLessEqual(sizes["float"][1], sizes["unorm8"][1])
        self.assertLess(sizes["half"][1], 1.01 * sizes["float"][1])
        self.refused(WRONG_USAGE, "excludes", *compress, report, "--no-coherence", "--registers", 9)

    def test_same_bytes_for_any_thread_count_and_twice(self):
        digests = []
        for threads in (1, 2, 2):
            paths = self.bake(BOX, options=("--threads", threads))
            digests.append([hashlib.sha256(paths[name].read_bytes()).hexdigest()
                            for name in ("glb", "transfer.exr", "prt.glb", "json")])
        self.assertEqual(digests[0], digests[1])
        self.assertEqual(digests[1], digests[2])

    def test_other_programs_accept_the_files(self):
        paths = self.box()
        for script in ("validate.mjs", "load_three.mjs"):
            result = subprocess.run(
                ["node", SOURCE / "tests/gltf" / script, paths["glb"], paths["prt.glb"]],
                capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("_prt_cluster", result.stdout.lower())

    def test_another_loader_evaluates_the_examples(self):
        result = subprocess.run(["node", SOURCE / "tests/gltf/shade_three.mjs", EXAMPLES],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("example_half.gltf: Uint16Array", result.stdout)

    def test_every_kind_of_file_passes_the_validator(self):
        paths, files = self.box(), sorted(EXAMPLES.glob("*.gltf"))
        self.assertGreater(len(files), 1)
        glossy = self.folder / "glossy.exr"
        self.done("prt-transfer", paths["glb"], "-o", glossy, "--mode", "matrix", "--bands", 3,
                  "--rows", 16, "--rays", 64)
        for name, transfer, *options in (
                ("adaptive", paths["transfer.exr"], "--method", "adaptive", "--components", 4),
                ("unorm8", paths["transfer.exr"], "--components", 4, "--weights", "unorm8"),
                ("half", paths["transfer.exr"], "--components", 4, "--weights", "half"),
                ("adaptive_half", paths["transfer.exr"], "--method", "adaptive", "--components", 4,
                 "--weights", "half"),
                ("vq", paths["transfer.exr"], "--method", "vq"),
                ("glossy", glossy, "--components", 4)):
            files.append(self.folder / f"{name}.glb")
            self.done("prt-compress", paths["glb"], transfer, "-o", files[-1], "--clusters", 8,
                      *options)
        files.append(self.folder / "again.glb")
        self.done("prt-compress", files[-2], glossy, "-o", files[-1], "--clusters", 4)
        for source in self.imperfect_sources():
            files.append(self.folder / f"{source.stem}.glb")
            self.done("prt-import", source, "-o", files[-1])
        result = subprocess.run(["node", SOURCE / "tests/gltf/validate.mjs", *files],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(result.stdout.count(": 0 errors, 0 warnings"), len(files))

    def imperfect_sources(self):
        """Models that import has to mend before the validator takes them."""
        self.write("a.png", base64.b64decode(PNG))
        self.write("a.mtl", "newmtl gr\xfcn\nmap_Kd a.png\n".encode("latin-1"))
        obj = "mtllib a.mtl\nusemtl gr\xfcn\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt nan 0\nvt 0 1\n"
        ply = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty float red\nproperty float green\nproperty float blue\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0 nan 1 1\n1 0 0 2 0 0\n0 1 0 -1 0 0\n3 0 1 2\n")
        return (self.write("no_vt.obj", (obj + "f 1 2 3\n").encode("latin-1")),
                self.write("part_vt.obj", (obj + "f 1/1 2/1 3\n").encode("latin-1")),
                self.write("nan_vt.obj", (obj + "f 1/1 2/2 3/3\n").encode("latin-1")),
                self.write("colours.ply", ply))

    def test_inspect_finds_the_baked_file_valid(self):
        paths = self.box()
        for name in ("glb", "prt.glb", "transfer.exr", "json"):
            result = self.done("prt-inspect", paths[name], "--json")
            self.assertTrue(result.stdout.strip().startswith("{"))
        self.done("prt-inspect", paths["prt.glb"])

    def test_documented_render_commands(self):
        paths = self.box()
        size = ("--size", "64x48")
        png, u, r = (self.folder / name for name in ("a.png", "u.exr", "r.exr"))
        light = ("--light", paths["json"])
        self.done("prt-render", paths["prt.glb"], *light, "-o", png, *size)
        self.done("prt-render", paths["prt.glb"], "--transfer", paths["transfer.exr"], *light, "-o",
                  u, *size)
        self.done("prt-render", paths["glb"], "--reference", "--bounces", 2, *light, "--samples",
                  16, "-o", r, *size)
        self.done("prt-render", paths["prt.glb"], *light, "-o", png, *size, "--draw", "clusters",
                  "--eye", "0,0.5,3", "--target", "0,0.5,0", "--fov", 40)

    def test_light_of_more_bands_than_the_transfer_is_cut_and_of_fewer_padded(self):
        paths = self.box()

        def picture(light):
            out = self.folder / "x.exr"
            self.done("prt-render", paths["prt.glb"], "--light", light, "-o", out, "--size", "32x32")
            return out.read_bytes()

        few, many, padded = (self.folder / name for name in ("few.json", "many.json", "padded.json"))
        for light, bands in ((few, 2), (many, 8)):
            self.done("prt-light", WORLD / "courtyard.exr", "-o", light, "--bands", bands)
        self.assertEqual(picture(many), picture(paths["json"]))
        content = self.load(few)
        for values in content["coefficients"].values():
            values += [0] * 12
        padded.write_text(json.dumps({**content, "band_count": 4}))
        self.assertEqual(picture(few), picture(padded))
        self.assertNotEqual(picture(few), picture(many))


class CommandLine(ToolTest):
    def test_every_tool_has_help_version_and_an_example(self):
        for tool in TOOLS:
            with self.subTest(tool):
                text = self.done(tool, "--help").stdout
                for word in ("--threads", "--report", "--no-clobber", "Example:", tool):
                    self.assertIn(word, text)
                draws = tool in ("prt-transfer", "prt-compress", "prt-render")
                self.assertEqual("--seed" in text, draws)
                self.assertRegex(self.done(tool, "--version").stdout, tool + r" \d+\.\d+\.\d+")

    def test_results_go_to_standard_output_only(self):
        glb, transfer, baked, light, picture = (
            self.folder / name for name in ("a.glb", "a.transfer.exr", "a.prt.glb", "a.json", "a.png"))
        for command in (("prt-import", BOX, "-o", glb), ("prt-light", "--constant", "1,1,1", "-o", light),
                        ("prt-transfer", glb, "-o", transfer, "--rays", 16),
                        ("prt-compress", glb, transfer, "-o", baked, "--clusters", 4),
                        ("prt-render", baked, "--light", light, "-o", picture, "--size", "32x32")):
            self.assertEqual(self.done(*command, "-v", "--progress").stdout, "", command)
        json.loads(self.done("prt-inspect", baked, "--json", "-v", "--progress").stdout)

    def test_quiet_says_nothing(self):
        result = self.done("prt-import", BUNNY, "-o", self.folder / "b.glb", "-q")
        self.assertEqual(result.stdout + result.stderr, "")


class View(ToolTest):
    def test_screenshot_under_a_virtual_display(self):
        glb, transfer, baked = (self.folder / n for n in ("a.glb", "a.transfer.exr", "a.prt.glb"))
        shot = self.folder / "shot.png"
        self.done("prt-import", BOX, "-o", glb, "--max-edge", 0.1)
        self.done("prt-transfer", glb, "-o", transfer, "--rays", 64)
        self.done("prt-compress", glb, transfer, "-o", baked, "--clusters", 8)
        result = subprocess.run(
            ["xvfb-run", "-a", BIN / "prt-view", baked, "--light", WORLD / "city.exr", "--window", "auto",
             "--screenshot", shot, "--report", self.folder / "r"], capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads((self.folder / "r").read_text())
        self.assertEqual(report["window"]["name"], "auto")
        self.assertGreater(report["window"]["strength"], 0)
        self.assertEqual(shot.read_bytes()[:4], b"\x89PNG")
        self.assertGreater(shot.stat().st_size, 5000)


if __name__ == "__main__":
    unittest.main()
