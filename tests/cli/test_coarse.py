"""Meshes that are too coarse for transfer at vertices: prt-transfer says so and what helps."""

import re
import unittest

from toolbox import SOURCE, ToolTest


class CoarseMeshes(ToolTest):
    def bake(self, *options):
        """What prt-transfer says of the coloured box, and its report."""
        glb, report = self.folder / "a.glb", self.folder / "t.json"
        self.done("prt-import", SOURCE / "data/colored_box.obj", "-o", glb, *options)
        result = self.done("prt-transfer", glb, "-o", self.folder / "a.transfer.exr", "--rays", 64,
                           "--report", report)
        return result.stderr, self.load(report)

    def test_the_length_that_the_warning_gives_is_short_enough(self):
        said, report = self.bake()
        self.assertEqual(len(report["meshes"]), 3)
        worst = max(report["meshes"], key=lambda mesh: mesh["interpolation_error"])
        self.assertGreater(worst["interpolation_error"], 0.2)
        self.assertIn(f"too coarse for transfer at vertices: 3 of 3 meshes; between the vertices of "
                      f"{worst['name']} irradiance is off by "
                      f"{100 * worst['interpolation_error']:.0f}%", said)
        length = re.search(r"prt-import --max-edge ([0-9.]+)\n", said)[1]
        said, report = self.bake("--max-edge", length)
        self.assertNotIn("coarse", said)
        for mesh in report["meshes"]:
            self.assertLess(mesh["interpolation_error"], 0.1)
        self.assertIn("interpolation", [stage["name"] for stage in report["stages"]])


if __name__ == "__main__":
    unittest.main()
