"""prt-inspect --hemisphere prints the error analysis of [Sloan03]'s appendix."""

import json
import unittest

from toolbox import QUAD_OBJ, WRONG_USAGE, ToolTest


class HemisphereTest(ToolTest):
    def test_prints_the_published_figures(self):
        table = json.loads(self.done("prt-inspect", "--hemisphere", "--json").stdout)["hemisphere"]
        self.assertAlmostEqual(table["singular_values"]["smallest"] * 1e6, 6.59, delta=0.005)
        worst = {(row["projection"], row["function_count"]): row["worst_squared_error"]
                 for row in table["projections"]}
        self.assertAlmostEqual(worst["zero hemisphere", 25], 0.125, delta=0.0005)
        self.assertIn("zero hemisphere", self.done("prt-inspect", "--hemisphere").stdout)

    def test_is_a_job_of_its_own(self):
        model = self.write("quad.obj", QUAD_OBJ)
        self.refused(WRONG_USAGE, "name one of", "prt-inspect", "--hemisphere", model)
        self.refused(WRONG_USAGE, "name one of", "prt-inspect")


if __name__ == "__main__":
    unittest.main()
