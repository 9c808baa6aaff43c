"""Glossy transfer, baked, compressed and drawn with the real tools."""

import json
import os
import unittest

from toolbox import SOURCE, WRONG_USAGE, ToolTest

BOX = SOURCE / "data/colored_box.obj"


class GlossyRender(ToolTest):
    def bake(self):
        environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"))
        glb, self.transfer, self.model = (
            self.folder / name for name in ("a.glb", "a.transfer.exr", "a.prt.glb"))
        self.done("prt-import", BOX, "-o", glb, "--max-edge", 0.1, "--crease-angle", 30)
        self.done("prt-transfer", glb, "-o", self.transfer, "--mode", "matrix", "--bands", 4,
                  "--rows", 24, "--brdf", "phong:10", "--rays", 64, env=environment)
        self.done("prt-compress", glb, self.transfer, "-o", self.model, "--clusters", 16,
                  "--components", 8, "--method", "static")

    def render(self, name, *options):
        picture, report = self.folder / name, self.folder / "r"
        self.done("prt-render", self.model, "-o", picture, "--size", "128x128", "--antialias", 1,
                  "--background", "none", "--report", report, *options)
        return picture, self.load(report)

    def difference(self, a, b):
        result = self.done("prt-inspect", "--compare", a, b, "--json")
        return json.loads(result.stdout)["comparison"]["relative_rmse"]

    def test_every_way_shows_the_same(self):
        self.bake()
        one, report = self.render("one.exr", "--passes", "one")
        self.assertEqual(report["pass_count"], 1)
        three, report = self.render("three.exr", "--passes", "per-channel", "--draw", "clusters",
                                    "--view-basis", "map")
        self.assertEqual(report["pass_count"], 3)
        self.assertLess(self.difference(one, three), 1e-3)
        summed, _ = self.render("summed.exr", "--sums", "every-frame")
        self.assertLess(self.difference(one, summed), 1e-5)
        exact, _ = self.render("exact.exr", "--transfer", self.transfer)
        self.assertLess(self.difference(exact, one), 0.1)
        shown = json.loads(self.done("prt-inspect", self.model, "--json").stdout)
        self.assertEqual(shown["findings"], [])
        lamp = ("--sphere-light", "0,2,2,0.3,30,30,30", "--point-light", "2,0,1,4,3,2")
        blended, _ = self.render("grid.exr", *lamp)
        exact, _ = self.render("exact.exr", *lamp, "--light-grid", 8, "--transfer", self.transfer)
        middle, _ = self.render("middle.exr", *lamp, "--light-grid", 1)
        self.assertLess(2 * self.difference(blended, exact), self.difference(middle, exact))

    def test_wrong_usage(self):
        model, picture = self.write("a.glb", "never read"), self.folder / "p.png"
        self.refused(WRONG_USAGE, "positive radius", "prt-render", model, "-o", picture,
                     "--sphere-light", "0,1,0,0,1,1,1")
        self.refused(WRONG_USAGE, "excludes", "prt-render", model, "-o", picture,
                     "--reference", "--point-light", "0,1,0,1,1,1")
        self.refused(WRONG_USAGE, "no effect", "prt-render", model, "-o", picture,
                     "--draw", "clusters", "--sums", "kept")
        self.refused(WRONG_USAGE, "--passes", "prt-render", model, "-o", picture, "--passes", "2")


if __name__ == "__main__":
    unittest.main()
