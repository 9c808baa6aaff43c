"""Glossy bakes against the path tracer with the same BRDF under the same band-limited light."""

import json
import math
import os
import struct
import unittest
import zlib

from toolbox import BUNNY, WORLD, ToolTest, glb

PICTURE = ("--size", "96x96", "--background", "none", "--antialias", 1)  # pixel centres


def torus_obj():
    """A smooth torus before a wall: shadows, and light from one to the other."""
    rows, columns = 32, 64
    lines = []
    for i in range(rows):
        for j in range(columns):
            a, b = 2 * math.pi * i / rows, 2 * math.pi * j / columns
            r = 1 + 0.4 * math.cos(a)
            lines.append(f"v {r * math.cos(b)} {r * math.sin(b)} {0.4 * math.sin(a)}")
    for i in range(rows):
        for j in range(columns):
            corner = [(i + di) % rows * columns + (j + dj) % columns + 1
                      for di, dj in ((0, 0), (0, 1), (1, 1), (1, 0))]
            lines.append("f " + " ".join(map(str, corner)))
    first = rows * columns + 1
    lines += ["v -2 -2 -0.6", "v 2 -2 -0.6", "v 2 2 -0.6", "v -2 2 -0.6",
              f"f {first} {first + 1} {first + 2} {first + 3}"]
    return "\n".join(lines) + "\n"


def png(pixels):
    """Bytes of a picture of one row of 8-bit RGB."""
    def chunk(name, content):
        return (struct.pack(">I", len(content)) + name + content +
                struct.pack(">I", zlib.crc32(name + content)))
    row = b"\0" + b"".join(map(bytes, pixels))
    header = struct.pack(">IIBBBBB", len(pixels), 1, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(row)) +
            chunk(b"IEND", b""))


def quad_glb(roughness, image=None):
    """A half metallic quad, its roughness times the green of the image where there is one."""
    binary = struct.pack("<12f", -1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1)
    binary += struct.pack("<12f", *[0, 1, 0] * 4) + struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0)
    binary += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    reflection = {"baseColorFactor": [0.8, 0.5, 0.3, 1], "metallicFactor": 0.5,
                  "roughnessFactor": roughness}
    views = [(0, 48), (48, 48), (96, 32), (128, 12)]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "materials": [{"pbrMetallicRoughness": reflection}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
                                    "indices": 3, "material": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [-1, 0, -1], "max": [1, 0, 1]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}]}
    if image:
        views.append((len(binary), len(image)))
        binary += image
        reflection["metallicRoughnessTexture"] = {"index": 0}
        document["textures"] = [{"source": 0}]
        document["images"] = [{"bufferView": 4, "mimeType": "image/png"}]
    document["bufferViews"] = [{"buffer": 0, "byteOffset": offset, "byteLength": length}
                               for offset, length in views]
    document["buffers"] = [{"byteLength": len(binary)}]
    return glb(document, binary)


class GlossyQuality(ToolTest):
    def prepare(self, brdf):
        self.brdf = brdf
        self.mesh, self.light, self.reference = (
            self.folder / name for name in ("a.glb", "a.json", "reference.exr"))
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"))
        self.done("prt-import", self.write("torus.obj", torus_obj()), "-o", self.mesh,
                  "--max-edge", 0.15, "--base-color", "0.7,0.7,0.7")
        self.done("prt-light", WORLD / "sunset.exr", "-o", self.light, "--bands", 5)
        self.done("prt-render", self.mesh, "--reference", "--bounces", 1, "--brdf", brdf, "--light",
                  self.light, "--samples", 128, "-o", self.reference,
                  "--report", self.folder / "r.json", *PICTURE)
        self.noise = self.load(self.folder / "r.json")["relative_standard_error"]

    def draw(self, name, model, *options):
        path = self.folder / name
        self.done("prt-render", model, "--light", self.light, "-o", path, *PICTURE, *options)
        return path

    def bake(self, rows, *options, rays=512, bounces=1):
        """The picture of an uncompressed bake, and its transfer file."""
        transfer = self.folder / f"{rows}.transfer.exr"
        self.done("prt-transfer", self.mesh, "-o", transfer, "--mode", "matrix", "--rows", rows,
                  "--brdf", self.brdf, "--bounces", bounces, "--rays", rays, *options,
                  env=self.environment)
        return self.draw(f"{rows}.exr", self.mesh, "--transfer", transfer), transfer

    def difference(self, image, reference, least_count=3000):
        """Relative RMSE."""
        result = self.done("prt-inspect", "--compare", image, reference, "--json")
        figures = json.loads(result.stdout)["comparison"]
        self.assertGreater(figures["pixel_count"], least_count)
        return figures["relative_rmse"]

    def error(self, image):
        """Relative RMSE against the path tracer, whose noise is known and independent."""
        square = self.difference(image, self.reference) ** 2 - self.noise ** 2
        return math.sqrt(max(square, 0.0))

    def test_phong_by_rows_projections_and_compressed(self):
        self.prepare("phong:10")
        zero = self.error(self.bake(25, "--projection", "zero-hemisphere")[0])
        optimal = {rows: self.error(self.bake(rows)[0]) for rows in (16, 24)}
        uncompressed, transfer = self.bake(25)
        optimal[25] = self.error(uncompressed)
        baked = self.folder / "a.prt.glb"
        self.done("prt-compress", self.mesh, transfer, "-o", baked, "--clusters", 64,
                  "--components", 8, "--method", "static")
        compression = self.difference(self.draw("c.exr", baked), uncompressed)
        print(f"{optimal}, zero-hemisphere {zero}, compressed {compression}, noise {self.noise}")
        self.assertLess(optimal[25], 0.025)
        self.assertLess(optimal[24], zero)
        self.assertLess(optimal[16], 1.1 * zero)
        self.assertLess(compression, 0.01)

    def test_ward(self):
        self.prepare("ward:0.1,0.4")
        error = self.error(self.bake(25)[0])
        print(f"ward {error}, noise {self.noise}")
        self.assertLess(error, 0.035)

    def test_compressed_bunny(self):
        """256 clusters of 8 vectors, with few rays."""
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"))
        self.mesh, self.light, self.brdf = self.folder / "a.glb", self.folder / "a.json", "phong:10"
        self.done("prt-import", BUNNY, "-o", self.mesh, "--base-color", "0.7,0.7,0.7")
        self.done("prt-light", WORLD / "sunset.exr", "-o", self.light, "--bands", 5)
        uncompressed, transfer = self.bake(25, rays=64, bounces=0)
        baked = self.folder / "a.prt.glb"
        self.done("prt-compress", self.mesh, transfer, "-o", baked, "--clusters", 256,
                  "--components", 8)
        compression = self.difference(self.draw("c.exr", baked), uncompressed, 2500)
        print(f"bunny compressed {compression}")
        self.assertLess(compression, 0.03)

    def test_reference_reads_roughness_textures(self):
        light = self.folder / "a.json"
        self.done("prt-light", WORLD / "sunset.exr", "-o", light, "--bands", 5)
        pictures = {}
        for name, model in (("texture", quad_glb(0.8, png([(0, 128, 255)]))),
                            ("factor", quad_glb(0.8 * 128 / 255)), ("other", quad_glb(0.8))):
            pictures[name] = self.folder / f"{name}.exr"
            self.done("prt-render", self.write(f"{name}.glb", model), "--reference", "--bounces", 0,
                      "--brdf", "from-material", "--samples", 64, "--light", light, "--eye",
                      "1.5,1,1.5", "--target", "0,0,0", "-o", pictures[name], *PICTURE)
        self.assertLess(self.difference(pictures["texture"], pictures["factor"], 1000), 1e-3)
        self.assertGreater(self.difference(pictures["other"], pictures["factor"], 1000), 0.05)


if __name__ == "__main__":
    unittest.main()
