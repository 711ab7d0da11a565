"""What scenes of grains do when things go wrong. Usage: running.py."""
import csv
import re
import sys
import unittest

import h5py
import numpy

from running import RUNS, Case, talus


class Grains(Case):
    SOFT = """[materials.jelly]
density = 2500
youngs_modulus = 1e4
poisson_ratio = 0.3
restitution = 0.9
friction = 0.1
[[grains]]
material = "jelly"
file = "grains.csv"
[[wall]]
name = "crate"
kind = "container"
material = "jelly"
lower = [0, 0, 0]
upper = [1, 1, 1]
[run]
end_time = 0.1
"""

    def run_grains(self, rows):
        (self.folder / "grains.csv").write_text("# x, y, z, radius, velocity\n" + rows)
        return talus("run", self.scene(self.SOFT), "--out", self.out)

    def test_a_grain_that_leaves_through_a_wall_stops_the_run(self):
        done = self.run_grains("0.5,0.5,0.5,0.01,0,0,0\n0.2,0.5,0.98,0.01,0,0,50\n")
        self.assert_fails(done, 1, r"grain 1 at \(0\.2, 0\.5, 1\..*\) m has left through wall 'crate'", "last checkpoint")

    SOURCE = """[[source]]
name = "rain"
material = "jelly"
radius = 0.05
shape = "box"
lower = [0.4, 0.4, 0.4]
upper = [0.6, 0.6, 0.6]
rate = 1e5
interval = 5
[[sink]]
name = "hole"
shape = "plane"
point = [0, 0, 0.45]
normal = [0, 0, 1]
begin = 0.01
"""

    def rows_of(self, out):
        with (out / "diagnostics.csv").open() as file:
            return [{name.split(" [")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]

    def test_a_full_source_is_noted_once_and_restarts_go_on_with_its_ledger(self):
        (self.folder / "grains.csv").write_text("0.1,0.1,0.1,0.05\n")
        scene = self.scene(self.SOFT + self.SOURCE)
        straight = self.folder / "straight"
        done = talus("run", scene, "--steps", "120", "--out", straight)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(len(re.findall("note: step 6: source 'rain' is full at 0\\.068.* s: \\d+ of the grains due found no place "
                                        "in 20 tries", done.stdout)), 1, done.stdout)
        last = self.rows_of(straight)[-1]
        self.assertGreater(last["missed_rain"], 0)
        self.assertEqual(last["grains"], 1 + last["inserted_rain"] - last["deleted_hole"])
        for steps, options in [(7, []), (120, ["--restart", "latest"])]:
            done = talus("run", scene, "--steps", steps, "--out", self.out, *options, ranks=3)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(self.hash(self.out), self.hash(straight))
        self.assertEqual(self.rows_of(self.out)[-1], last)
        # Another scene's ledger cannot be right.
        other = self.scene(self.SOFT + self.SOURCE.replace('"hole"', '"exit"'), "other.toml")
        if last["deleted_hole"]:
            done = talus("run", other, "--steps", "130", "--out", self.out, "--restart", "latest")
            self.assert_fails(done, 1, r"the checkpoint holds \d+ grains.*come to \d+")

    def test_bad_keys_of_sources_are_named(self):
        (self.folder / "grains.csv").write_text("0.1,0.1,0.1,0.05\n")
        text = self.SOFT + self.SOURCE.replace("rate = 1e5", "rte = 1e5").replace('"plane"', '"disk"')
        done = talus("check", self.scene(text))
        self.assert_fails(done, 2, r"source\[0\]\.rate", r"source\[0\]\.rte", r"sink\[0\]\.shape = .*disk")

    def test_overlapping_grains_are_refused_with_their_depth(self):
        done = self.run_grains("0.5,0.5,0.5,0.01\n0.51,0.5,0.5,0.01\n")
        self.assert_fails(done, 2, r"scene\.toml:7: grains.*overlap at the start, by up to 1 of the smaller radius; allowed: 0\.2")

    def test_a_checkpoint_of_other_walls_is_refused(self):
        done = self.run_grains("0.5,0.5,0.5,0.01\n")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        more = 'name = "floor"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = "jelly"\n'
        for text in (self.SOFT.replace('"crate"', '"box"'), self.SOFT.replace("[run]", f"[[wall]]\n{more}[run]"),
                     self.SOFT.replace('"container"', '"block"').replace("upper = [1, 1, 1]", "upper = [0.1, 1, 1]")):
            done = talus("run", self.scene(text), "--out", self.out, "--restart", "latest")
            self.assert_fails(done, 3, r"is of a scene with the walls crate \(container\), this one has the walls")

    def diagnostics(self, out):
        with open(out / "diagnostics.csv", newline="", encoding="utf-8") as file:
            rows = [{name.split(" ")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        return rows[0], rows[-1]

    def test_what_a_collision_hands_over_goes_on_as_grains(self):
        done = talus("run", RUNS / "asteroid_collision", "--quick", "--out", self.out, "--set", "hand_off.to=grains",
                     "--set", "hand_off.at=20 s", "--set", "hand_off.link=all", "--set", "hand_off.linking_length=0.8")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        scene = self.scene("""[materials.rubble]
density = 2700
restitution = 0.3
friction = 0.6
[dem]
law = "linear"
stiffness = 1e16
overlaps = "shrink"
[gravity]
direct = true
interval = 10
[[grains]]
material = "rubble"
file = "out/grains.h5"
[run]
end_time = "20 s"
""")
        on = self.folder / "on"
        done = talus("run", scene, "--out", on)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"\d+ grains that overlapped were made smaller")
        handed = self.sums(self.out / "grains.h5")
        for row in self.diagnostics(on):
            for name, (value, size) in handed.items():
                self.assertAlmostEqual(row[name], value, delta=1e-11 * size, msg=name)
        self.assertGreater(abs(handed["angular_momentum_z"][0]), 0.01 * handed["angular_momentum_z"][1])

    def sums(self, file):
        """{name: (sum, sum of sizes)} over the grains of a file."""
        with h5py.File(file) as opened:
            grains = {name: values[...] for name, values in opened["sets/grains"].items()}
        mass, radius = grains["mass"][:, None], grains["radius"][:, None]
        parts = {"momentum": mass * grains["velocity"]}
        parts["angular_momentum"] = (numpy.cross(grains["position"], parts["momentum"])
                                     + 0.4 * mass * radius**2 * grains["angular_velocity"])
        found = {"mass": (mass.sum(), mass.sum())}
        for name, values in parts.items():
            size = numpy.linalg.norm(values, axis=1).sum()
            found |= {f"{name}_{axis}": (values[:, a].sum(), size) for a, axis in enumerate("xyz")}
        return found

    def test_a_list_of_grains_names_its_bad_line(self):
        done = self.run_grains("0.5,0.5,0.5,0.01\n0.5,0.5,0.5\n")
        self.assert_fails(done, 2, r"grains\.csv:3: not a row x,y,z,radius")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
