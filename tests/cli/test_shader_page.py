"""shaders/README.md names all that the shaders ask of a program, and nothing else."""

import re
import unittest

from toolbox import SOURCE

FOLDER = SOURCE / "shaders"


def section(title):
    return (FOLDER / "README.md").read_text().split(f"## {title}\n")[1].split("\n## ")[0]


def named(title, column):
    """Names in backquotes in a column of a section's table, with the row's first cell."""
    names = {}
    for row in re.findall(r"^\| (.*) \|$", section(title), re.MULTILINE)[2:]:
        cells = row.split(" | ")
        names.update({name: cells[0] for name in re.findall(r"`(\w+)`", cells[column])})
    return names


class ShaderPage(unittest.TestCase):
    def setUp(self):
        files = [path for path in FOLDER.iterdir() if path.suffix != ".md"]
        self.assertGreater(len(files), 20)
        self.code = "\n".join(re.sub("//.*", "", path.read_text()) for path in files)

    def test_has_every_uniform(self):
        used = set()
        for names in re.findall(r"^uniform \w+ ([^;]*);", self.code, re.MULTILINE):
            used.update(re.findall(r"\bu_\w+", names))
        self.assertEqual(used, set(re.findall(r"\bu_\w+", self.code)))
        self.assertEqual(used, set(named("Uniforms", 0)))

    def test_has_every_attribute_at_its_location(self):
        declared = re.findall(r"layout\(location = (\d+)\) in \w+ (\w+);", self.code)
        self.assertEqual({name for _, name in declared}, set(re.findall(r"\ba_\w+", self.code)))
        page = named("Attributes", 1)
        self.assertEqual(page.pop("a_weights_0"), "2 + j")  # WEIGHT_INPUTS declares it
        self.assertEqual({name: place for place, name in declared}, page)

    def test_has_every_macro_that_the_program_defines(self):
        made_here = set(re.findall(r"#define (\w+)", self.code)) - {"FOR_EACH_WEIGHT"}
        used = set(re.findall(r"\b[A-Z][A-Z_]+\b", self.code)) - made_here
        self.assertEqual(used, set(named("Macros", 0)))


if __name__ == "__main__":
    unittest.main()
