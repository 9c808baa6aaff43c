"""Baked models against the path tracer under the same band-limited light, and the two ways of
drawing against each other."""

import json
import math
import unittest

from toolbox import BUNNY, SOURCE, WORLD, ToolTest

PICTURE = ("--background", "none", "--antialias", 1)  # pixel centres, on both sides


class Quality(ToolTest):
    def setUp(self):
        super().setUp()
        self.mesh, self.transfer, self.baked, self.light, self.reference = (
            self.folder / name for name in
            ("a.glb", "a.transfer.exr", "a.prt.glb", "a.json", "reference.exr"))

    def bring(self, source, environment, size, *import_options):
        """Model and light, of 5 bands."""
        self.picture = ("--size", size, *PICTURE)
        self.done("prt-import", source, "-o", self.mesh, *import_options)
        self.done("prt-light", environment, "-o", self.light, "--bands", 5)

    def bake(self, bounces):
        """The transfer of 5 bands and the picture to compare with."""
        self.done("prt-transfer", self.mesh, "-o", self.transfer, "--bands", 5, "--rays", 2048,
                  "--bounces", bounces)
        self.done("prt-render", self.mesh, "--reference", "--bounces", bounces, "--light",
                  self.light, "--samples", 256, "-o", self.reference,
                  "--report", self.folder / "r.json", *self.picture)
        self.noise = self.load(self.folder / "r.json")["relative_standard_error"]

    def draw(self, name, model, *options):
        path = self.folder / name
        self.done("prt-render", model, "--light", self.light, "-o", path, *self.picture, *options)
        return path

    def comparison(self, image, reference):
        result = self.done("prt-inspect", "--compare", image, reference, "--json")
        figures = json.loads(result.stdout)["comparison"]
        self.assertGreater(figures["pixel_count"], 20000)
        return figures

    def error(self, image):
        """Relative RMSE against the reference, whose noise is known and independent of what the bake
        got wrong."""
        figures = self.comparison(image, self.reference)
        return math.sqrt(max(0, figures["relative_rmse"] ** 2 - self.noise ** 2)), figures

    def test_bunny_against_the_path_tracer(self):
        self.bring(BUNNY, WORLD / "sunset.exr", "384x384", "--base-color", "0.7,0.7,0.7")
        self.bake(bounces=2)
        self.done("prt-compress", self.mesh, self.transfer, "-o", self.baked, "--clusters", 256,
                  "--components", 8, "--method", "static")
        uncompressed = self.draw("u.exr", self.mesh, "--transfer", self.transfer)
        compressed = self.draw("c.exr", self.baked)
        clusters = self.draw("k.exr", self.baked, "--draw", "clusters")
        self.assertLess(self.noise, 0.02)
        for path, limit in ((uncompressed, 0.02), (compressed, 0.03)):
            error, figures = self.error(path)
            print(f"{path.name}: {figures['relative_rmse']}, noise {self.noise}, error {error}")
            self.assertLess(figures["relative_rmse"], limit)  # noise included
        ways = self.comparison(clusters, compressed)
        print("two ways of drawing:", ways["difference"]["max"])
        self.assertLess(ways["difference"]["max"], 1 / 255)

    def test_bounces_in_the_coloured_box(self):
        self.bring(SOURCE / "data/colored_box.obj", WORLD / "courtyard.exr", "256x256",
                   "--max-edge", 0.04)
        for bounces in (0, 1, 2, 10):
            with self.subTest(bounces=bounces):
                self.bake(bounces)
                uncompressed = self.draw("u.exr", self.mesh, "--transfer", self.transfer)
                error, figures = self.error(uncompressed)
                print(f"{bounces} bounces: {figures['relative_rmse']}, noise {self.noise}, "
                      f"bias {figures['relative_bias']}")
                self.assertLess(self.noise, 0.05)  # that much leaves the error known to 0.4%
                self.assertLess(error, 0.015)
                self.assertLess(abs(figures["relative_bias"]), 0.005)


if __name__ == "__main__":
    unittest.main()
