"""Options: values out of range, and options that would do nothing, are wrong usage; what the common
ones say."""

import json
import os
import unittest

from toolbox import BAD_INPUT, FAILED, QUAD_OBJ, WORLD, WRONG_USAGE, ToolTest


class Options(ToolTest):
    def setUp(self):
        super().setUp()
        self.source = self.write("quad.obj", QUAD_OBJ)
        self.quad = self.folder / "quad.glb"
        self.made_once(lambda: self.done("prt-import", self.source, "-o", self.quad))

    def wrong(self, pattern, tool, *arguments):
        """A usage error, which starts with the tool's name."""
        result = self.refused(WRONG_USAGE, pattern, tool, *arguments)
        self.assertTrue(result.stderr.startswith(f"{tool}: "), result.stderr)

    def test_options_of_the_reference_need_it_and_those_of_real_time_exclude_it(self):
        render = ("prt-render", self.quad, "-o", self.folder / "a.png")
        for option in (("--samples", 4), ("--bounces", 1), ("--seed", 2), ("--light-mode", "full"),
                       ("--noise-output", self.folder / "n.exr")):
            self.wrong(f"{option[0]} requires --reference", *render, *option)
        for option in (("--transfer", self.quad), ("--draw", "single"), ("--show", "clusters")):
            self.wrong(f"{option[0]}.*excludes|excludes.*{option[0]}", *render, *option,
                       "--reference")

    def test_tools_that_draw_no_random_numbers_take_no_seed(self):
        self.wrong("not understood: --seed", "prt-import", self.source, "-o",
                   self.folder / "a.glb", "--seed", 1)
        self.wrong("not understood: --seed", "prt-light", "--constant", "1,1,1", "-o",
                   self.folder / "a.json", "--seed", 1)

    def test_damping_shapes_the_light_of_the_model_and_not_the_background(self):
        sky = WORLD / "sunrise.exr"
        render = ("prt-render", self.quad, "--reference", "--samples", 4, "--size", "16x16",
                  "--report", self.folder / "r")

        def window(*options):
            """The report's window, the picture, and what the tool said."""
            result = self.done(*render, "-o", self.folder / "a.exr", *options)
            report = json.loads((self.folder / "r").read_text())["window"]
            return report, (self.folder / "a.exr").read_bytes(), result.stderr

        away = ("--light", sky, "--eye", "0,0,9", "--target", "0,0,20")  # sees the map alone
        plain, behind, said = window(*away, "--window", "none")
        self.assertEqual((plain["name"], plain["strength"], said), ("none", 0, ""))
        self.assertLess(plain["minimum_over_mean"], -2)
        self.assertGreater(plain["negative_fraction"], 0.4)
        usual, same, said = window(*away)
        self.assertEqual((usual, same), (plain, behind))
        self.assertRegex(said, "rings.*negative over 47%.*--window auto")
        damped, same, said = window(*away, "--window", "auto")
        self.assertEqual((damped["name"], said), ("auto", ""))
        self.assertAlmostEqual(damped["minimum_over_mean"], -0.05, 3)
        self.assertEqual(same, behind)
        lit = ("--light", sky, "--window")
        self.assertNotEqual(window(*lit, "auto")[1], window(*lit, "none")[1])

        light = self.folder / "sky.json"
        self.done("prt-light", sky, "-o", light)
        self.assertEqual(window("--light", light, "--window", "auto")[0], damped)
        self.done("prt-light", sky, "-o", light, "--window", "auto", "--report", self.folder / "r")
        self.assertEqual(json.loads((self.folder / "r").read_text())["window"], damped)
        self.assertEqual(window()[2], "")  # prtkit's own lamp
        self.assertEqual(window("--light", sky, "--light-mode", "full")[2], "")
        self.wrong("--window.*full", *render, "-o", self.folder / "b.exr", "--light", sky,
                   "--light-mode", "full", "--window", "auto")

    def test_options_of_the_viewer_need_what_they_are_for(self):
        self.wrong("--transfer requires model", "prt-view", "--transfer", self.quad)
        self.wrong("--frames requires --screenshot", "prt-view", self.quad, "--frames", 3)

    def test_the_noise_of_the_reference_is_what_inspect_takes(self):
        picture, noise = self.folder / "a.exr", self.folder / "noise.exr"
        self.done("prt-render", self.quad, "-o", picture, "--reference", "--samples", 16, "--size",
                  "32x32", "--antialias", 1, "--background", "none", "--noise-output", noise,
                  "--report", self.folder / "r")
        result = self.done("prt-inspect", "--compare", picture, picture, "--noise", noise, "--json")
        measured = json.loads(result.stdout)["comparison"]["noise_relative_rmse"]
        told = self.load(self.folder / "r")["relative_standard_error"]
        self.assertGreater(told, 0)
        self.assertAlmostEqual(measured / told, 1, 4)

    def test_options_of_transfer(self):
        transfer = ("prt-transfer", self.quad, "-o", self.folder / "a.transfer.exr", "--rays", 16)
        self.wrong("--channels", *transfer, "--channels", 2)
        self.wrong("--bounce-rays", *transfer, "--bounces", 1, "--bounce-rays", 16385)
        self.wrong("requires --bounces", *transfer, "--bounce-rays", 16)
        self.wrong("excludes", *transfer, "--unshadowed")
        self.done(*transfer, "--bounces", 1, "--bounce-rays", 16384, "--channels", 1)

    def test_options_of_glossy_transfer(self):
        matrix = ("prt-transfer", self.quad, "-o", self.folder / "a.transfer.exr", "--mode", "matrix")
        self.wrong("--rows: .*found 23, expected n²", *matrix, "--rows", 23)
        self.wrong("--rows", *matrix, "--rows", 1000)
        self.wrong("--bands above 8", *matrix, "--bands", 9)
        for brdf in ("phong", "phong:0.5", "ward:1,2,3", "ggx:0", "gold"):
            self.wrong(f"--brdf: not a BRDF: found {brdf}, expected .*lambert", *matrix, "--brdf", brdf)
            self.wrong("--brdf: not a BRDF", "prt-render", self.quad, "-o", self.folder / "a.png",
                       "--reference", "--brdf", brdf)

    def test_lights_near_the_model(self):
        render = ("prt-render", self.quad, "-o", self.folder / "a.png")
        point, sphere = "0,1,0,1,1,1", "0,1,0,0.1,1,1,1"
        self.wrong("--point-light: wrong count", *render, "--point-light", point, "--point-light",
                   "0,1,0")
        self.wrong("--point-light", *render, "--point-light", "0,1,0,1,1")
        self.wrong("--point-light: .*finite", *render, "--point-light", "0,1,0,1,1,nan")
        self.wrong("--sphere-light: .*radius", *render, "--sphere-light", "0,1,0,-1,1,1,1")
        self.wrong("--light-grid", *render, "--sphere-light", sphere, "--light-grid", 0)

    def test_a_folder_for_plots_is_made_when_there_are_plots(self):
        light, plots = self.folder / "l.json", self.folder / "plots"
        self.done("prt-light", "--constant", "1,1,1", "-o", light)
        for file, found in ((light, "a file of kind light"), (self.quad, "a model alone")):
            result = self.refused(BAD_INPUT, f"{file}: holds no compressed transfer: found {found}",
                                  "prt-inspect", file, "--plots", plots)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        result = self.refused(BAD_INPUT, "no such file", "prt-inspect", self.folder / "none.glb",
                              "--plots", plots)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertFalse(plots.exists())
        self.refused(FAILED, "no folder", "prt-inspect", self.quad, "--plots", self.source)
        self.refused(FAILED, "no folder", "prt-inspect", self.quad, "--plots", f"{self.source}/")
        self.refused(FAILED, "Create .*missing first", "prt-inspect", self.quad, "--plots",
                     self.folder / "missing" / "plots")
        transfer, baked = self.folder / "t.transfer.exr", self.folder / "quad.prt.glb"
        self.done("prt-transfer", self.quad, "-o", transfer, "--rays", 16)
        self.done("prt-compress", self.quad, transfer, "-o", baked, "--method", "vq", "--clusters",
                  1)
        for name in ("plots", "slash/", "slash/"):  # made, made, and there already
            result = self.done("prt-inspect", baked, "--plots", f"{self.folder}/{name}")
            self.assertIn("these plots are left out", result.stderr)
            self.assertTrue((self.folder / name / "clusters.png").exists(), name)

    def test_a_model_is_no_transfer(self):
        self.refused(BAD_INPUT, "not a readable OpenEXR file", "prt-render", self.quad, "-o",
                     self.folder / "a.png", "--transfer", self.quad)

    def test_numbers_that_are_not_finite(self):
        for value in ("nan", "inf", "-nan", "1e40", "1e400"):
            self.wrong("--max-edge", "prt-import", self.source, "-o", self.folder / "a.glb",
                       "--max-edge", value)
        self.wrong("--base-color", "prt-import", self.source, "-o", self.folder / "a.glb",
                   "--base-color", "nan,1,1")
        self.wrong("finite", "prt-light", "--constant", "nan,1,1", "-o", self.folder / "a.json")

    def test_numbers_out_of_range(self):
        out = ("-o", self.folder / "a.glb")
        for value in ("-1", "18446744073709551616"):
            self.wrong("--seed: out of range", "prt-transfer", self.source, *out, "--seed", value)
        self.wrong("--max-edge: expected a number from 0 up, found -1", "prt-import", self.source,
                   *out, "--max-edge", -1)
        self.wrong("--unit: expected a number above 0, found 0", "prt-import", self.source, *out,
                   "--unit", 0)
        self.wrong("--fov", "prt-render", self.quad, "-o", self.folder / "a.png", "--fov", 0)
        for size in ("0x5", "100x20000", "100000x5", "7"):
            self.wrong("WIDTHxHEIGHT, each from 1 to 16384", "prt-render", self.quad, "-o",
                       self.folder / "a.png", "--size", size)

    def test_numbers_that_are_none_or_too_few(self):
        glb, png, light = (self.folder / name for name in ("a.glb", "a.png", "a.json"))
        compress = ("prt-compress", self.quad, self.quad, "-o", glb)
        self.wrong("--max-error: expected a number, found 2%", *compress, "--max-error", "2%")
        self.wrong("--max-bytes: expected a whole number, found 2M", *compress, "--max-bytes", "2M")
        self.wrong("--threads: expected a whole number from 0 to 1024, found 1.5", *compress,
                   "--threads", 1.5)
        self.wrong("--method: expected one of iterative, .*, found kmeans", *compress, "--method",
                   "kmeans")
        constant = ("prt-light", "--constant", "1,1,1", "-o", light)
        self.wrong("--rotate: wrong count: found 90, expected 3 values", *constant, "--rotate", 90)
        self.wrong("--rotate: expected a number from -36000 to 36000, found x", *constant,
                   "--rotate", "90,0,x")
        self.wrong("--constant: expected numbers R,G,B, found 1,1,x", "prt-light", "--constant",
                   "1,1,x", "-o", light)
        render = ("prt-render", self.quad, "-o", png)
        self.wrong("--eye: wrong count: found 90, expected 3 values", *render, "--eye", 90)
        self.wrong("--eye: expected numbers X,Y,Z, found 1,2,z", *render, "--eye", "1,2,z")
        self.wrong("--point-light: expected numbers X,Y,Z,R,G,B, found 0,1,0,1,1,x", *render,
                   "--point-light", "0,1,0,1,1,x")

    def test_empty_values(self):
        self.wrong("--output: empty", "prt-import", self.source, "-o", "")
        self.wrong("input: empty", "prt-import", "", "-o", self.folder / "a.glb")
        self.wrong("--report: empty", "prt-import", self.source, "-o", self.folder / "a.glb",
                   "--report", "")

    def test_missing_arguments(self):
        self.wrong("input is required", "prt-import")
        self.wrong("--help says more", "prt-light", "--no-such-option")

    def test_a_raw_mesh_is_to_be_imported_first(self):
        for tool, out in (("prt-transfer", "a.exr"), ("prt-render", "a.png")):
            self.refused(BAD_INPUT, r"quad\.obj: not a glTF file.*prt-import", tool, self.source,
                         "-o", self.folder / out)

    def test_verbose_version_names_what_the_tool_stands_on(self):
        for tool, pattern in (("prt-transfer", r"(?s)Embree: 3\.\d+.*BLAS: \w+"),
                              ("prt-compress", r"BLAS: \w+"),
                              ("prt-render", r"(?s)Embree: 3\.\d+.*OpenGL: \d")):
            self.assertRegex(self.done(tool, "--version", "-v").stdout, pattern)
            self.assertEqual(len(self.done(tool, "--version").stdout.splitlines()), 1)

    def test_a_missing_folder_for_temporary_files_is_no_matter(self):
        self.done("prt-transfer", "--version", env=os.environ | {"TMPDIR": "/missing"})


if __name__ == "__main__":
    unittest.main()
