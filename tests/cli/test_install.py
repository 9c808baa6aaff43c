"""What `cmake --install` makes works by itself."""

import subprocess
import unittest

from toolbox import BIN, FAILED, SOURCE, ToolTest

EXAMPLE = SOURCE / "docs/extensions/PRTKIT_precomputed_transfer/example.gltf"


class Install(ToolTest):
    def test_installed_tools_draw_with_installed_shaders(self):
        prefix = self.folder / "prefix"
        subprocess.run(["cmake", "--install", BIN.parent, "--prefix", prefix], check=True,
                       capture_output=True)
        tools = prefix / "bin"
        self.assertEqual(sorted(path.name for path in tools.iterdir()),
                         sorted(path.stem for path in (SOURCE / "tools").glob("prt-*.cpp")))
        draw = (tools / "prt-render", EXAMPLE, "-o", self.folder / "a.png", "--size", "32x32")
        self.done(*draw)
        library = prefix / "lib/prtkit/prtkit_openimageio.so"
        library.rename(prefix / "elsewhere.so")
        self.refused(FAILED, "OpenImageIO cannot be loaded: found prtkit_openimageio.so: ", *draw)
        (prefix / "elsewhere.so").rename(library)
        shader = prefix / "share/prtkit/shaders/composite.frag"
        shader.unlink()
        self.refused(FAILED, f"{shader}.*no such shader", *draw)

    def test_tools_start_without_openimageio_and_the_libraries_that_it_brings(self):
        for tool in sorted(BIN.glob("prt-*")):
            libraries = subprocess.run(["ldd", tool], check=True, capture_output=True, text=True)
            self.assertIn("libc.so", libraries.stdout)
            self.assertNotIn("libOpenImageIO", libraries.stdout, tool)


if __name__ == "__main__":
    unittest.main()
