"""Every file is hostile until checked: a clear message, the documented exit status, no output left
behind, earlier output untouched."""

import base64
import json
import struct
import unittest

from toolbox import (BAD_INPUT, FAILED, QUAD_OBJ, WRONG_USAGE, ToolTest, glb, limit_file_size,
                     read_glb, run, triangle_gltf)


class BadMesh(ToolTest):
    def refuse_import(self, name, content, pattern, status=BAD_INPUT):
        source = self.write(name, content)
        self.write("out.glb", "earlier output")
        self.refused(status, pattern, "prt-import", source, "-o", self.folder / "out.glb")

    def test_missing_file(self):
        self.refused(BAD_INPUT, "no-such.obj.*no such file", "prt-import",
                     self.folder / "no-such.obj", "-o", self.folder / "out.glb")

    def test_folder_instead_of_file(self):
        self.refused(BAD_INPUT, "not a regular file", "prt-import", self.folder, "-o",
                     self.folder / "out.glb")

    def test_obj_index_past_the_end(self):
        self.refuse_import("a.obj", QUAD_OBJ + "f 1 2 9\n", r"a\.obj.*9")

    def test_obj_negative_index_past_the_start(self):
        self.refuse_import("a.obj", QUAD_OBJ + "f -1 -2 -9\n", r"a\.obj.*-9")

    def test_empty_mesh(self):
        self.refuse_import("a.obj", "# nothing\n", r"a\.obj")

    def test_ply_with_four_billion_vertices(self):
        header = ("ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\n"
                  "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                  "property list uchar int vertex_indices\nend_header\n")
        self.refuse_import("a.ply", header + "\0" * 64, r"a\.ply.*4294967295")

    def test_wrong_magic(self):
        self.refuse_import("a.ply", "not a ply", r"a\.ply")
        self.refuse_import("a.glb", "not a glb file, really", r"a\.glb")
        self.refuse_import("a.stl", "neither", r"a\.stl")
        self.refuse_import("a.off", "neither", r"a\.off")

    def test_unknown_extension(self):
        self.refuse_import("a.xyz", "1 2 3", r"a\.xyz")

    def test_truncated_glb(self):
        whole = glb(*triangle_gltf())
        for length in (0, 3, 11, 15, 40, len(whole) - 4):
            self.refuse_import("a.glb", whole[:length], r"a\.glb")

    def test_all_vertices_not_finite(self):
        self.refuse_import("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", r"a\.obj")

    def test_nan_vertex_is_skipped_and_counted(self):
        source = self.write("a.obj", QUAD_OBJ + "v nan 0 0\nf 1 2 5\n")
        result = self.done("prt-import", source, "-o", self.folder / "out.glb", "--report",
                           self.folder / "r.json")
        self.assertRegex(result.stderr, "finite")
        report = self.load(self.folder / "r.json")
        self.assertEqual(report["triangle_count"], 2)


class BadGltf(ToolTest):
    def refuse(self, document, binary, pattern):
        source = self.write("a.glb", glb(document, binary))
        for tool, out in (("prt-import", "out.glb"), ("prt-transfer", "out.transfer.exr")):
            self.refused(BAD_INPUT, pattern, tool, source, "-o", self.folder / out)

    def test_the_unbroken_file_is_accepted(self):
        source = self.write("a.glb", glb(*triangle_gltf()))
        self.done("prt-import", source, "-o", self.folder / "out.glb")

    def test_transparency_is_ignored_with_a_warning(self):
        document, binary = triangle_gltf()
        document["materials"] = [{}, {"alphaMode": "MASK"}]
        document["meshes"][0]["primitives"][0]["material"] = 1
        source, transfer = self.write("a.glb", glb(document, binary)), self.folder / "a.exr"
        self.done("prt-import", source, "-o", self.folder / "out.glb")
        result = self.done("prt-transfer", self.folder / "out.glb", "-o", transfer)
        self.assertRegex(result.stderr, "material 1: alphaMode MASK ignored")
        self.assertNotIn("material 0", result.stderr)

    def test_accessor_past_its_buffer_view(self):
        document, binary = triangle_gltf()
        document["accessors"][0]["count"] = 4
        self.refuse(document, binary, "accessor")
        document["accessors"][0]["count"] = 2**61
        self.refuse(document, binary, "accessor")

    def test_buffer_view_past_its_buffer(self):
        document, binary = triangle_gltf()
        document["bufferViews"][0]["byteOffset"] = 2**63
        self.refuse(document, binary, "(?i)buffer ?view")

    def test_buffer_longer_than_the_file(self):
        document, binary = triangle_gltf()
        document["buffers"][0]["byteLength"] = 2**40
        self.refuse(document, binary, "buffer")

    def test_image_view_past_its_buffer(self):
        document, binary = triangle_gltf()
        document["bufferViews"].append({"buffer": 0, "byteOffset": 70, "byteLength": 1000})
        document["images"] = [{"bufferView": 3, "mimeType": "image/png"}]
        document["textures"] = [{"source": 0}]
        document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        document["meshes"][0]["primitives"][0]["material"] = 0
        self.refuse(document, binary, "(?i)buffer ?view|image")

    def test_index_past_the_vertices(self):
        document, binary = triangle_gltf()
        self.refuse(document, binary[:72] + struct.pack("<3H", 0, 1, 7), "7")

    def test_node_cycle(self):
        document, binary = triangle_gltf()
        document["nodes"] = [{"mesh": 0, "children": [1]}, {"children": [0]}]
        self.refuse(document, binary, "node")

    def test_references_to_nothing(self):
        for where, pattern in (("mesh", "mesh"), ("children", "node")):
            document, binary = triangle_gltf()
            document["nodes"][0][where] = 99 if where == "mesh" else [99]
            self.refuse(document, binary, pattern)

    def test_uris_may_not_leave_the_folder(self):
        self.write("secret.bin", b"\0" * 78)
        (self.folder / "inner").mkdir()
        absolute = str(self.folder / "secret.bin")
        for uri in ("../secret.bin", "%2e%2e/secret.bin", absolute, "file://" + absolute,
                    "http://localhost/secret.bin", "x/../../secret.bin"):
            document, _ = triangle_gltf()
            document["buffers"][0]["uri"] = uri
            source = self.folder / "inner" / "a.gltf"
            source.write_text(json.dumps(document))
            self.refused(BAD_INPUT, "inside the file|URI", "prt-import", source, "-o",
                         self.folder / "out.glb")

    def test_data_uri_is_read_and_a_short_one_refused(self):
        document, binary = triangle_gltf()
        prefix = "data:application/octet-stream;base64,"
        document["buffers"][0]["uri"] = prefix + base64.b64encode(binary).decode()
        source = self.write("a.gltf", json.dumps(document))
        self.done("prt-import", source, "-o", self.folder / "out.glb")
        document["buffers"][0]["uri"] = prefix + base64.b64encode(binary[:9]).decode()
        source = self.write("a.gltf", json.dumps(document))
        self.refused(BAD_INPUT, "buffer", "prt-import", source, "-o", self.folder / "out.glb")


class BadBake(ToolTest):
    """Tools further down the pipeline, on a quad."""

    def setUp(self):
        super().setUp()
        self.quad = self.folder / "quad.glb"
        self.transfer = self.folder / "quad.transfer.exr"
        self.baked = self.folder / "quad.prt.glb"
        self.made_once(self.make_files)

    def make_files(self):
        source = self.write("quad.obj", QUAD_OBJ)
        self.done("prt-import", source, "-o", self.quad)
        self.done("prt-transfer", self.quad, "-o", self.transfer, "--bands", 2, "--rays", 64)

    def compress(self, *more):
        return ("prt-compress", self.quad, self.transfer, "-o", self.baked, *more)

    def test_transfer_of_another_mesh(self):
        source = self.write("other.obj", QUAD_OBJ.replace("v 1 0 0", "v 2 0 0"))
        other = self.folder / "other.glb"
        self.done("prt-import", source, "-o", other)
        self.refused(BAD_INPUT, "(?i)mesh", "prt-compress", other, self.transfer, "-o",
                     self.baked, "--clusters", 1)

    def test_transfer_of_the_same_mesh_in_another_colour(self):
        self.done(*self.compress("--clusters", 1, "--components", 1))
        red = self.folder / "red.glb"
        self.done("prt-import", self.folder / "quad.obj", "-o", red, "--base-color", "1,0,0")
        self.refused(BAD_INPUT, "colours", "prt-compress", red, self.transfer, "-o",
                     self.folder / "red.prt.glb", "--clusters", 1)
        document, binary = read_glb(self.baked)
        document["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]
        document["meshes"][0]["primitives"][0]["material"] = 0
        painted = self.write("painted.prt.glb", glb(document, binary))
        drawn = self.done("prt-render", painted, "-o", self.folder / "a.png", "--size", "32x32")
        self.assertIn("baked for other geometry or colours", drawn.stderr)
        shown = json.loads(self.done("prt-inspect", painted, "--json").stdout)
        self.assertRegex(str(shown["findings"]), "warning.*colours")

    def test_report_of_a_model_that_is_not_valid(self):
        self.done(*self.compress("--clusters", 1, "--components", 1))
        document, binary = read_glb(self.baked)
        document["extensions"]["PRTKIT_precomputed_transfer"]["transfers"][0]["clusterCount"] = 0
        bad, report = self.write("bad.prt.glb", glb(document, binary)), self.folder / "report.json"
        result = run("prt-inspect", bad, "--json", "--report", report)
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertRegex(result.stderr, "bad.*not valid")
        self.assertEqual(self.load(report)["result"], json.loads(result.stdout))
        self.assertRegex(str(self.load(report)["result"]["findings"]), "clusterCount")

    def test_cluster_counts(self):
        self.refused(WRONG_USAGE, "clusters", *self.compress("--clusters", 0))
        self.refused(WRONG_USAGE, "clusters", *self.compress("--clusters", -3))
        self.refused(WRONG_USAGE, "more clusters than points: found 5, expected at most 4",
                     *self.compress("--clusters", 5, "--components", 1))

    def test_truncated_transfer(self):
        whole = self.transfer.read_bytes()
        for length in (0, 3, 60, len(whole) // 2, len(whole) - 8):
            self.transfer.write_bytes(whole[:length])
            self.refused(BAD_INPUT, r"quad\.transfer\.exr", *self.compress("--clusters", 2))

    def test_image_instead_of_transfer(self):
        self.refused(BAD_INPUT, r"quad\.obj", "prt-compress", self.quad, self.folder / "quad.obj",
                     "-o", self.baked)

    def test_light_files(self):
        self.done(*self.compress("--clusters", 2, "--components", 1))
        for content in ("", "{", "[]", '{"prtkit_light": 1}', "[" * 100000,
                        '{"prtkit_light": 1, "band_count": 1000000000}'):
            light = self.write("light.json", content)
            self.refused(BAD_INPUT, r"light\.json", "prt-render", self.baked, "--light", light,
                         "-o", self.folder / "a.png")

    def test_environment_that_is_no_image(self):
        source = self.write("env.exr", "\x76\x2f\x31\x01garbage")
        self.refused(BAD_INPUT, r"env\.exr", "prt-light", source, "-o", self.folder / "l.json")

    def test_wrong_usage(self):
        self.refused(WRONG_USAGE, ".", "prt-transfer", self.quad)
        self.refused(WRONG_USAGE, ".", "prt-transfer", self.quad, "-o", self.folder / "x.exr",
                     "--bands", "five")
        self.refused(WRONG_USAGE, ".", "prt-transfer", self.quad, "-o", self.folder / "x.exr",
                     "--no-such-option")
        self.refused(WRONG_USAGE, ".", "prt-transfer", self.quad, "-o", self.folder / "x.exr",
                     "--bands", 0)
        self.refused(WRONG_USAGE, ".", "prt-transfer", self.quad, "-o", self.folder / "x.exr",
                     "--rays", 0)


class BadOutput(ToolTest):
    """Full disk, missing folder, existing output."""

    def setUp(self):
        super().setUp()
        source = self.folder / "quad.obj"
        self.quad = self.folder / "quad.glb"
        self.transfer = self.folder / "quad.transfer.exr"
        self.light = self.folder / "light.json"
        self.baked = self.folder / "quad.prt.glb"
        self.made_once(self.make_files)
        self.commands = {
            ".glb": ("prt-import", source, "--max-edge", 0.05),
            ".transfer.exr": ("prt-transfer", self.quad, "--bands", 5, "--rays", 64),
            ".prt.glb": ("prt-compress", self.quad, self.transfer, "--clusters", 4),
            ".png": ("prt-render", self.baked, "--light", self.light, "--size", "256x256"),
            ".exr": ("prt-render", self.baked, "--light", self.light, "--size", "256x256"),
            ".json": ("prt-light", "--constant", "1,1,1"),
        }

    def make_files(self):
        source = self.write("quad.obj", QUAD_OBJ)
        self.done("prt-import", source, "-o", self.quad, "--max-edge", 0.05)
        self.done("prt-transfer", self.quad, "-o", self.transfer, "--bands", 5, "--rays", 64)
        self.done("prt-light", "--constant", "1,1,1", "-o", self.light)
        self.done("prt-compress", self.quad, self.transfer, "-o", self.baked, "--clusters", 4)

    def test_full_disk(self):
        for extension, command in self.commands.items():
            with self.subTest(extension):
                out = self.write("out" + extension, "earlier")
                self.refused(FAILED, "out", *command, "-o", out, preexec_fn=limit_file_size(200))

    def test_full_disk_for_the_second_output(self):
        picture, noise = self.folder / "p.png", self.folder / "noise.exr"
        self.refused(FAILED, "noise.exr", "prt-render", self.quad, "--reference", "--samples", 4,
                     "--size", "64x64", "-o", picture, "--noise-output", noise,
                     preexec_fn=limit_file_size(4000))

    def test_missing_folder(self):
        for extension, command in self.commands.items():
            with self.subTest(extension):
                out = self.folder / "missing" / ("out" + extension)
                self.refused(FAILED, "missing", *command, "-o", out)

    def test_no_clobber(self):
        for extension, command in self.commands.items():
            with self.subTest(extension):
                out = self.write("out" + extension, "earlier")
                self.refused(FAILED, "exists", *command, "-o", out, "--no-clobber")


if __name__ == "__main__":
    unittest.main()
