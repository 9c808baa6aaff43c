"""prt-transfer --mode matrix, end to end."""

import json
import math
import os
import struct
import unittest

from toolbox import BUNNY, QUAD_OBJ, WRONG_USAGE, ToolTest, glb


def anisotropic_quads(tangents):
    """A quad for each list of four tangents, or None, each of a nameless material of its own."""
    positions = struct.pack("<12f", -1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1)
    chunks = [positions, struct.pack("<12f", *[0, 1, 0] * 4), struct.pack("<6H", 0, 1, 2, 0, 2, 3)]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                  "min": [-1, 0, -1], "max": [1, 0, 1]},
                 {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
                 {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]
    primitives, materials = [], []
    for values in tangents:
        attributes = {"POSITION": 0, "NORMAL": 1}
        if values:
            attributes["TANGENT"] = len(accessors)
            accessors.append({"bufferView": len(chunks), "componentType": 5126, "count": 4,
                              "type": "VEC4"})
            chunks.append(b"".join(struct.pack("<4f", *tangent) for tangent in values))
        primitives.append({"attributes": attributes, "indices": 2, "material": len(materials)})
        materials.append({"pbrMetallicRoughness": {"roughnessFactor": 0.2},
                          "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.3}}})
    views, binary = [], b""
    for chunk in chunks:
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(chunk)})
        binary += chunk
    return glb({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_anisotropy"],
                "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": primitives}], "materials": materials,
                "accessors": accessors, "bufferViews": views,
                "buffers": [{"byteLength": len(binary)}]}, binary)


class GlossyTest(ToolTest):
    def setUp(self):
        super().setUp()
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"))
        self.model = self.folder / "model.glb"
        self.output = self.folder / "out.transfer.exr"

    def bake(self, *arguments):
        self.done("prt-transfer", self.model, "-o", self.output, "--mode", "matrix", *arguments,
                  env=self.environment)
        result = self.done("prt-inspect", self.output, "--json")
        return json.loads(result.stdout)["transfer"]

    def test_bunny_with_24_rows(self):
        self.done("prt-import", BUNNY, "-o", self.model)
        transfer = self.bake("--rows", 24, "--brdf", "phong:10", "--rays", 64)
        self.assertEqual(transfer["row_count"], 24)
        self.assertEqual(transfer["dimension"], 24 * 25)
        self.assertEqual(transfer["brdf"], "phong:10")
        self.assertEqual(len(list((self.folder / "cache/prtkit/brdf").iterdir())), 1)
        first = self.output.read_bytes()
        self.bake("--rows", 24, "--brdf", "phong:10", "--rays", 64, "--threads", 1)
        self.assertEqual(self.output.read_bytes(), first)

    def test_bounces(self):
        self.done("prt-import", BUNNY, "-o", self.model)
        report = self.folder / "report.json"
        transfer = self.bake("--rows", 24, "--bands", 5, "--brdf", "phong:10", "--rays", 64,
                             "--bounces", 2, "--report", report)
        self.assertEqual(transfer["bounce_count"], 2)
        figures = json.loads(report.read_text())
        # Two fields of half floats, and nothing left of them.
        self.assertEqual(figures["scratch_bytes"],
                         2 * 2 * 24 * 25 * figures["vertex_count"])
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["cache", "model.glb", "out.transfer.exr", "report.json"])

    def test_materials_of_the_file(self):
        self.done("prt-import", self.write("quad.obj", QUAD_OBJ), "-o", self.model)
        transfer = self.bake("--bands", 4, "--rows", 9)
        self.assertEqual(transfer["brdf"], "from-material")
        self.assertEqual((transfer["band_count"], transfer["row_count"]), (4, 9))

    def test_warnings_name_materials_and_count_missing_tangents(self):
        good, bad = (1, 0, 0, 1), (math.nan, 0, 0, 1)
        self.model.write_bytes(anisotropic_quads([None, [good] * 4, [good, bad, good, (0, 0, 0, 1)]]))
        report = self.folder / "report.json"
        result = self.done("prt-transfer", self.model, "-o", self.output, "--mode", "matrix",
                           "--bands", 3, "--rows", 9, "--unshadowed", "--report", report,
                           "--progress", env=self.environment)
        self.assertRegex(result.stderr, "1 of 3 primitives are anisotropic and have no TANGENT")
        self.assertRegex(result.stderr, "2 of 4 tangents are zero or not finite")
        for i in range(3):
            self.assertRegex(result.stderr, f"material {i}: too sharp for 3 and 3 bands")
        self.assertRegex(result.stderr, "brdf: 100%")
        figures = self.load(report)
        stages = {stage["name"]: stage["seconds"] for stage in figures["stages"]}
        self.assertGreater(stages["brdf"], 0)
        self.assertEqual([surface["name"] for surface in figures["surfaces"]],
                         ["material 0", "material 1", "material 2"])

    def test_only_what_a_picture_loses_is_worth_a_warning(self):
        self.done("prt-import", self.write("quad.obj", QUAD_OBJ), "-o", self.model)
        def warnings(brdf):
            result = self.done("prt-transfer", self.model, "-o", self.output, "--mode", "matrix",
                               "--brdf", brdf, "--unshadowed", env=self.environment)
            return result.stderr
        self.assertNotRegex(warnings("ward:0.1,0.4"), "too sharp")
        self.assertRegex(warnings("ggx:0.03"), "too sharp.*% of that to unlimited light")

    def test_wrong_usage(self):
        self.done("prt-import", self.write("quad.obj", QUAD_OBJ), "-o", self.model)
        bake = ("prt-transfer", self.model, "-o", self.output)
        self.refused(WRONG_USAGE, "--rows needs --mode matrix", *bake, "--rows", 24)
        self.refused(WRONG_USAGE, "--brdf needs --mode matrix", *bake, "--brdf", "phong:10")
        self.refused(WRONG_USAGE, "--projection needs", *bake, "--projection", "least-squares")
        matrix = (*bake, "--mode", "matrix")
        self.refused(WRONG_USAGE, "n² - 1", *matrix, "--rows", 23)
        self.refused(WRONG_USAGE, "--rows.*3", *matrix, "--rows", 1)
        self.refused(WRONG_USAGE, "not a BRDF", *matrix, "--brdf", "ggx:2")
        self.refused(WRONG_USAGE, "--bands above 8", *matrix, "--bands", 9)
        self.refused(WRONG_USAGE, "at most 8192", *matrix, "--bands", 8, "--rows", 144)
        self.refused(WRONG_USAGE, "0 to 16384", *matrix, "--bounces", 1, "--bounce-rays", 20000)


if __name__ == "__main__":
    unittest.main()
