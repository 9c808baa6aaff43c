"""prt-transfer --mode matrix, end to end."""

import json
import os
import unittest

from toolbox import BUNNY, QUAD_OBJ, WRONG_USAGE, ToolTest


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
