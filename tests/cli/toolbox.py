"""What the end-to-end tests share: running tools, scratch folders, small files made by hand."""

import json
import os
import pathlib
import resource
import shutil
import struct
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("PRTKIT_BIN", SOURCE / "build/bin"))
BUNNY = pathlib.Path("/usr/share/glmark2/models/bunny.obj")
WORLD = pathlib.Path("/usr/share/blender/datafiles/studiolights/world")

DONE, FAILED, WRONG_USAGE, BAD_INPUT = 0, 1, 2, 3


def run(tool, *arguments, **keywords):
    """Runs build/bin/TOOL and returns the finished process with text output."""
    command = [str(BIN / tool), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=600,
                          **keywords)


def limit_file_size(limit):
    """For preexec_fn: writing past `limit` bytes fails, as on a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))


class ToolTest(unittest.TestCase):
    """A test with a scratch folder, `self.folder`, that must be left without surprises."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="prtkit-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def made_once(self, make):
        """Calls make(), which fills the scratch folder, for the first test of the class; the others
        get copies of its files."""
        made = type(self)
        if "files" not in vars(made):
            make()
            made.files = {path.name: content for path, content in self.listing().items()
                          if content is not None}
        for name, content in made.files.items():
            self.write(name, content)

    def done(self, tool, *arguments, **keywords):
        """Runs a tool that has to succeed."""
        result = run(tool, *arguments, **keywords)
        self.assertEqual(result.returncode, DONE, f"{tool} {arguments}\n{result.stderr}")
        return result

    def refused(self, status, pattern, tool, *arguments, **keywords):
        """Runs a tool that has to fail with `status` and a message matching `pattern`, leaving the
        scratch folder as it was."""
        before = self.listing()
        result = run(tool, *arguments, **keywords)
        self.assertEqual(result.returncode, status, f"{tool} {arguments}\n{result.stderr}")
        self.assertRegex(result.stderr, pattern)
        self.assertEqual(self.listing(), before)
        return result

    def listing(self):
        """Everything in the scratch folder: files with their bytes, folders with None."""
        return {p: p.read_bytes() if p.is_file() else None for p in sorted(self.folder.rglob("*"))}

    def write(self, name, content):
        path = self.folder / name
        if isinstance(content, str):
            content = content.encode()
        path.write_bytes(content)
        return path

    def load(self, path):
        return json.loads(pathlib.Path(path).read_text())


QUAD_OBJ = "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3\nf 1 3 4\n"


def glb(document, binary=b""):
    """Bytes of a .glb with the given JSON object and binary chunk."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def read_glb(path):
    """The inverse: JSON object and binary chunk."""
    content = path.read_bytes()
    length = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20:20 + length]), content[28 + length:]


def triangle_gltf():
    """A correct one-triangle glTF as (JSON object, binary chunk), to be broken by tests."""
    positions = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 0, -1)
    normals = struct.pack("<9f", *[0, 1, 0] * 3)
    indices = struct.pack("<3H", 0, 1, 2)
    binary = positions + normals + indices
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 0, "byteOffset": 72, "byteLength": 6},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, -1], "max": [1, 0, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
    }
    return document, binary
