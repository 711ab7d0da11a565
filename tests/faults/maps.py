"""What depth-integrated scenes over maps do when things go wrong. Usage: running.py."""
import csv
import sys
import unittest

from running import Case, talus

PLANAR = ('PROJCS["MGI / Austria GK {0}",GEOGCS["MGI",DATUM["MGI",SPHEROID["Bessel 1841",6377397.155,299.1528128]],'
          'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
          'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",{1}],PARAMETER["scale_factor",1],'
          'PARAMETER["false_easting",0],PARAMETER["false_northing",-5000000],UNIT["metre",1]]')
WEST, EAST = PLANAR.format("West", "10.3333333333333"), PLANAR.format("East", "16.3333333333333")


def grid(value, columns=41, rows=21, cell=5):
    """An ESRI ASCII raster from (0, 0); `value` of the column and the row from the south."""
    lines = [f"ncols {columns}", f"nrows {rows}", "xllcorner 0", "yllcorner 0", f"cellsize {cell}", "NODATA_value -9999"]
    lines += [" ".join(str(value(column, row)) for column in range(columns)) for row in reversed(range(rows))]
    return "\n".join(lines) + "\n"


def slope(column, _row):
    return 100 - 2 * column


class Maps(Case):
    SCENE = """dimension = 2
[terrain]
file = "slope.asc"
[depth]
form = "bed_fitted"
[friction]
law = "coulomb"
coefficient = 0.1
[[release]]
corners = [20, 30, 50, 30, 50, 60, 20, 60]
depth = 1
spacing = 3
[run]
end_time = 20
[output]
diagnostics = 0.5
"""

    def run_scene(self, terrain=grid(slope), change=("", ""), options=(), **files):
        (self.folder / "slope.asc").write_text(terrain)
        for name, text in files.items():
            (self.folder / name.replace("_", ".", 1)).write_text(text)
        return talus("run", self.scene(self.SCENE.replace(*change)), "--out", self.out, *options)

    def test_a_word_in_a_raster_names_line_and_cell(self):
        done = self.run_scene(terrain=grid(lambda c, r: "rock" if (c, r) == (3, 19) else slope(c, r)))
        self.assert_fails(done, 3, r"slope\.asc: line 8: 'rock' in column 4, row 2 is not a number")

    def test_a_missing_raster_is_named(self):
        done = self.run_scene(change=("slope.asc", "none.asc"))
        self.assert_fails(done, 3, r"none\.asc: cannot be opened")

    def test_a_release_beyond_the_terrain(self):
        done = self.run_scene(change=("20, 30, 50, 30, 50, 60", "-20, 30, 50, 30, 50, 60"))
        self.assert_fails(done, 2, r"reaches beyond the terrain, at \(-")

    def test_a_release_over_a_hole_names_the_cell(self):
        done = self.run_scene(terrain=grid(lambda c, r: -9999 if (c, r) == (7, 9) else slope(c, r)))
        self.assert_fails(done, 2, r"reaches beyond the terrain, at \(3.*column [78], row 1[23]")

    def test_a_flow_that_meets_a_hole_stops_and_names_the_cell(self):
        done = self.run_scene(terrain=grid(lambda c, r: -9999 if c == 25 else slope(c, r)))
        self.assert_fails(done, 1, r"hole of the terrain at \(12.* m, column 2[56], row 1", "last checkpoint")

    def test_a_flow_that_leaves_is_told_with_its_volume(self):
        done = self.run_scene()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"m3 have left the terrain at time .* between \(20")
        with (self.out / "diagnostics.csv").open() as file:
            rows = list(csv.DictReader(file))
        first, last = float(rows[0]["volume [m3]"]), float(rows[-1]["volume [m3]"])
        self.assertGreater(first, last)
        self.assertAlmostEqual(first, last + float(rows[-1]["outflow_volume [m3]"]), delta=1e-9 * first)

    def test_other_coordinate_references_are_refused(self):
        done = self.run_scene(change=("depth = 1", 'depth_raster = "snow.asc"'), slope_prj=WEST, snow_prj=EAST,
                              snow_asc=grid(lambda c, r: 1))
        self.assert_fails(done, 2, r"snow\.asc has another coordinate reference than the terrain .*slope\.asc")

    def test_a_negative_depth_names_the_cell(self):
        done = self.run_scene(change=("depth = 1", 'depth_raster = "snow.asc"'),
                              snow_asc=grid(lambda c, r: -1 if (c, r) == (6, 8) else 1))
        self.assert_fails(done, 2, r"snow\.asc: the depth in column 7, row 13 is -1 m")

    def test_degrees_are_refused(self):
        done = self.run_scene(slope_prj='GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
                                        'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
        self.assert_fails(done, 3, r"slope\.asc: its coordinates are degrees")

    def test_corners_gauges_and_results_that_make_no_sense(self):
        done = self.run_scene(change=("20, 30, 50, 30, 50, 60, 20, 60", "20, 30, 50, 30, 50"))
        self.assert_fails(done, 2, r"corners = .*has 5 numbers; allowed")
        done = self.run_scene(change=("[run]", '[[gauge]]\nname = "hut"\nplace = [500, 5]\n[run]'))
        self.assert_fails(done, 2, r"gauge.*place = .*\(500, 5\) m is not on the terrain")
        done = self.run_scene(change=("[run]", "[results]\nthreshold = -1\n[run]"))
        self.assert_fails(done, 2, r"results\.threshold = -1")

    def test_a_fast_flow_jumps_over_no_hole(self):
        done = self.run_scene(terrain=grid(lambda c, r: -9999 if c == 25 else slope(c, r)),
                              change=("spacing = 3", "spacing = 15\nvelocity = [300, 0]"))
        self.assert_fails(done, 1, r"hole of the terrain at \(12.* m, column 2[56], row 1")

    def test_depths_on_the_cells_of_the_terrain_are_taken(self):
        done = self.run_scene(change=("corners = [20, 30, 50, 30, 50, 60, 20, 60]\ndepth = 1", 'depth_raster = "snow.asc"'),
                              snow_asc=grid(lambda c, r: 2 if 4 <= c < 10 and 6 <= r < 12 else 0), options=("--until", "0.1"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with (self.out / "diagnostics.csv").open() as file:
            volume = float(next(csv.DictReader(file))["volume [m3]"])
        self.assertAlmostEqual(volume, 2 * 30 * 30 * (1 + 0.4**2) ** 0.5, delta=0.1 * volume)  # normal to the slope

    def test_a_release_out_of_the_box(self):
        done = self.run_scene(change=("[terrain]", '[box]\nlower = [0, 0]\nupper = [40, 100]\n'
                                      'boundaries = ["reflecting", "reflecting"]\n[terrain]'))
        self.assert_fails(done, 2, r"release\[0\].*reaches out of the box, at \(4")

    def test_sizes_that_make_too_many_of_something(self):
        done = self.run_scene(change=("spacing = 3", "spacing = 1e-5"))
        self.assert_fails(done, 2, r"release\[0\]\.spacing = 1e-05.*makes 9e\+12 particles; allowed: 2e\+09")
        done = self.run_scene(change=("[run]", "[results]\nlower = [0, 0]\nupper = [100, 100]\ncell = 1e-4\n[run]"))
        self.assert_fails(done, 2, r"results\.cell = .*cells; allowed: 1 to 1e9 in all")
        done = self.run_scene(change=('form = "bed_fitted"', 'form = "bed_fitted"\nlargest_smoothing_length = 1'))
        self.assert_fails(done, 2, r"depth\.largest_smoothing_length = 1 .*3\.9")

    def test_results_of_other_cells_do_not_go_on(self):
        results = "[results]\nlower = [0, 0]\nupper = [200, 100]\ncell = {}\n[run]"
        done = self.run_scene(change=("[run]", results.format(5)), options=("--until", "2"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = self.run_scene(change=("[run]", results.format(10)), options=("--until", "3", "--restart", "latest"))
        self.assert_fails(done, 2, r"holds results of other cells than the scene's \[results\] has")

    def test_a_lake_that_ends_at_the_rim_is_told(self):
        done = self.run_scene(change=("corners = [20, 30, 50, 30, 50, 60, 20, 60]\ndepth = 1",
                                      "corners = [100, 30, 260, 30, 260, 60, 100, 60]\nlevel = 60"),
                              options=("--until", "0.1"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout + done.stderr, r"the water of release\[0\] ends where the terrain does, at \(20")

    def test_gauges_and_rasters_say_when_the_flow_came(self):
        done = self.run_scene(change=("[run]", '[results]\nformat = "ascii"\n[[gauge]]\nname = "hut"\nplace = [120, 45]\n[run]'),
                              options=("--until", "8"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with (self.out / "diagnostics.csv").open() as file:
            rows = [(float(row["time [s]"]), float(row["depth_hut [m]"])) for row in csv.DictReader(file)]
        came = next(time for time, depth in rows if depth > 0.05)
        cells = (self.out / "results" / "arrival_time.asc").read_text().split("\n")[6:]
        on_map = float(cells[20 - 9].split()[24])  # the cell around (122.5, 47.5)
        self.assertGreater(came, 1)
        self.assertAlmostEqual(on_map, came, delta=1)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
