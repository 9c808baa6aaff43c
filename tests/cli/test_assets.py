"""Makefile.assets as a user's own project includes it."""

import pathlib
import subprocess
import unittest

from toolbox import BIN, QUAD_OBJ, SOURCE, WRONG_USAGE, ToolTest


class Assets(ToolTest):
    def make(self, *arguments):
        result = subprocess.run(
            ["make", "-C", self.folder, f"BIN={BIN}", "PREVIEW_SIZE=64x64", *arguments],
            capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return [pathlib.Path(line.split()[0]).name for line in result.stdout.splitlines()
                if line.startswith(f"{BIN}/prt-")]

    def setUp(self):
        super().setUp()
        self.write("quad.obj", QUAD_OBJ)
        self.configure("--bounces 0")

    def configure(self, transfer):
        self.write("Makefile", "ASSETS := quad sheet\nOUT := out\n"
                   "quad.source := quad.obj\nquad.import := --max-edge 0.2\n"
                   "quad.compress := --clusters 4 --components 2\n"
                   f"quad.transfer := --rays 64 {transfer}\n"
                   "sheet.source := quad.obj\nsheet.import := --max-edge 0.3\n"
                   "sheet.transfer := --rays 32\nsheet.compress := --clusters 3\n"
                   f"include {SOURCE}/Makefile.assets\n")

    def test_bakes_once_and_again_only_what_changed(self):
        self.assertEqual(len(self.make("-j2")), 10)
        for name in ("quad", "sheet"):
            self.assertTrue((self.folder / f"out/{name}.prt.glb").exists())
            self.assertTrue((self.folder / f"out/{name}.png").exists())
        self.assertEqual(self.make(), [])
        self.configure("--bounces 1")
        self.assertEqual(self.make(), ["prt-transfer", "prt-compress", "prt-render"])
        (self.folder / "out/sheet.glb").touch()
        self.assertEqual(self.make(), ["prt-transfer", "prt-compress", "prt-render"])
        self.write("out/sheet.transfer.exr.partial", "of an interrupted bake")
        self.make("clean")
        self.assertEqual(list((self.folder / "out").iterdir()), [])

    def test_names_the_assets_that_there_are_when_asked_for_another(self):
        result = subprocess.run(["make", "-f", SOURCE / "Makefile.assets", "wrongname", "-n"],
                                capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, WRONG_USAGE, result.stderr)
        self.assertIn("no asset wrongname: there are bunny colored_box two_polygons.",
                      result.stderr)
        other = subprocess.run(["make", "-C", self.folder, "wrongname"], capture_output=True,
                               text=True, timeout=60)
        self.assertNotIn("no asset", other.stderr)  # a project has targets of its own


if __name__ == "__main__":
    unittest.main()
