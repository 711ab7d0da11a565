"""Run-out of five columns of about 700 grains, by the program, against what is published.

Channels hold grains back at their side walls: G. Lube et al., Phys. Rev. E 72 (2005) 041301, 1.2 a and 1.9 a^(2/3) for an
aspect ratio a. Discs without side walls run farther: L. Staron, E. J. Hinch, J. Fluid Mech. 545 (2005) 1, 2.5 a and
3.25 a^0.7 above 2. A periodic slice of spheres must lie between the two, grow in proportion to a below 2 and by a power of
2/3 to 0.7 above. The place of a front is known to a diameter, 5 to 11 % of the columns' lengths: exponents to 0.1.
"""
import math
import pathlib
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools" / "charts"))
import column_collapse  # noqa: E402

PROGRAM = sys.argv[1]
AREA = 150  # of a column, in squares of a diameter; the chart has 400


def exponent(low, high):
    return math.log(high["run_out"] / low["run_out"]) / math.log(high["aspect"] / low["aspect"])


class ColumnCollapse(unittest.TestCase):
    def test_run_out(self):
        column_collapse.AREA = AREA * column_collapse.DIAMETER**2
        with tempfile.TemporaryDirectory() as folder:
            rows = [column_collapse.row_of(aspect, *column_collapse.simulate(PROGRAM, aspect, folder))
                    for aspect in column_collapse.ASPECTS]
        for row in rows:
            with self.subTest(aspect=row["aspect"]):
                self.assertGreater(row["run_out"], column_collapse.lube(row["aspect"]))
                self.assertLess(row["run_out"], column_collapse.staron(row["aspect"]))
                self.assertEqual(row["still_moving"], 0)
        self.assertAlmostEqual(exponent(rows[0], rows[1]), 1, delta=0.1)
        self.assertAlmostEqual(exponent(rows[2], rows[4]), 0.7, delta=0.1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
