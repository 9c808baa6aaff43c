"""Which files a tool reads and writes in one run, and the values of options: asked before the
work."""

import os
import subprocess
import unittest

from toolbox import BAD_INPUT, BIN, FAILED, QUAD_OBJ, WRONG_USAGE, ToolTest


class Paths(ToolTest):
    def setUp(self):
        super().setUp()
        self.source = self.write("quad.obj", QUAD_OBJ)
        self.quad = self.folder / "quad.glb"
        self.light = self.folder / "light.json"
        self.made_once(lambda: self.done("prt-import", self.source, "-o", self.quad))

    def test_every_tool_names_a_missing_input(self):
        none, out = self.folder / "none.glb", self.folder / "out"
        for tool, *arguments in (("prt-import", none, "-o", f"{out}.glb"),
                                 ("prt-transfer", none, "-o", f"{out}.exr"),
                                 ("prt-compress", none, none, "-o", f"{out}.glb"),
                                 ("prt-render", none, "-o", f"{out}.png"),
                                 ("prt-light", none, "-o", f"{out}.json"),
                                 ("prt-inspect", none)):
            with self.subTest(tool):
                self.refused(BAD_INPUT, r"none\.glb: no such file", tool, *arguments)
        self.refused(BAD_INPUT, "not a regular file", "prt-inspect", self.folder)

    def test_outputs_that_are_no_regular_files(self):
        (self.folder / "folder.glb").mkdir()
        os.mkfifo(self.folder / "fifo.glb")
        (self.folder / "null.glb").symlink_to("/dev/null")
        for name in ("folder", "fifo", "null"):
            self.refused(FAILED, "not a regular file", "prt-import", self.source, "-o",
                         self.folder / f"{name}.glb")

    def test_a_link_to_a_file_stays_a_link(self):
        (self.folder / "inner").mkdir()
        target = self.write("inner/target.glb", "earlier")
        link = self.folder / "link.glb"
        link.symlink_to("inner/target.glb")
        self.done("prt-import", self.source, "-o", link)
        self.assertTrue(link.is_symlink())
        self.assertEqual(target.read_bytes(), self.quad.read_bytes())

    def test_output_and_report_are_no_input(self):
        for other in (self.quad, self.folder / "." / "quad.glb"):
            self.refused(WRONG_USAGE, "an input", "prt-transfer", self.quad, "-o",
                         self.folder / "x.exr", "--report", other)
        out = self.folder / "x.exr"
        self.refused(WRONG_USAGE, "an output", "prt-transfer", self.quad, "-o", out, "--report",
                     out)
        image = self.write("map.json", "not read")
        self.refused(WRONG_USAGE, "an input", "prt-light", image, "-o", image)
        self.refused(FAILED, "Create .*missing first", "prt-transfer", self.quad, "-o", out, "--report",
                     self.folder / "missing" / "r.json")
        self.done("prt-import", self.quad, "-o", self.quad)

    def test_extensions_that_the_tool_does_not_write(self):
        for tool, source in (("prt-import", self.source), ("prt-transfer", self.quad),
                             ("prt-render", self.quad), ("prt-light", self.source)):
            self.refused(WRONG_USAGE, "kind of file", tool, source, "-o", self.folder / "x.txt")

    def test_lost_results_are_a_failure(self):
        for arguments in ((self.quad,), ("--help",)):
            with open("/dev/full", "w") as full:
                status = subprocess.run([BIN / "prt-inspect", *arguments], stdout=full,
                                        stderr=subprocess.DEVNULL).returncode
            self.assertEqual(status, FAILED)

    def test_all_analytic_lights_are_added(self):
        def energy(*lights):
            self.done("prt-light", *lights, "-o", self.light, "--report", self.folder / "r")
            return self.load(self.folder / "r")["energy"]
        one = ("--constant", "1,1,1")
        self.assertAlmostEqual(energy(*one, *one), 4 * energy(*one), 3)
        disk = ("--disk", "0,1,0,20,1,1,1")
        self.assertAlmostEqual(energy(*disk, *disk) / energy(*disk), 4, 3)

    def test_counts_and_signs_of_values(self):
        out = ("-o", self.folder / "x.glb")
        self.refused(WRONG_USAGE, "count", "prt-import", self.source, *out, "--base-color", "1,1")
        self.refused(WRONG_USAGE, "expected 3 values", "prt-render", self.quad, "-o", self.folder / "x.png",
                     "--eye", "1,2")
        self.refused(WRONG_USAGE, "out of range", "prt-import", self.source, *out,
                     "--max-input-bytes", -1)


if __name__ == "__main__":
    unittest.main()
