"""What scenes of water with grains say when they are wrong. Usage: running.py."""
import sys
import unittest

from running import Case, talus

SCENE = """[box]
lower = [0, 0, 0]
upper = [0.02, 0.02, 0.02]
boundaries = ["periodic", "periodic", "periodic"]
[water]
viscosity = 0.001
greatest_speed = 0.1
[[body]]
name = "water"
shape = "domain"
lattice = "cubic"
spacing = 0.0025
[materials.glass]
density = 2500
youngs_modulus = 1e5
poisson_ratio = 0.2
restitution = 0.5
friction = 0.4
[dem]
gravity = [0, 0, 0]
[[grains]]
name = "beads"
material = "glass"
shape = "domain"
radius = 0.0005
spacing = 0.002
[coupling]
drag = "di_felice"
[run]
end_time = 0.001
"""


class Coupling(Case):
    def check(self, changes, *patterns):
        scene = SCENE
        for old, new in changes.items():
            self.assertIn(old, scene)
            scene = scene.replace(old, new)
        done = talus("run", self.scene(scene), "--out", self.out, ranks=2)
        self.assert_fails(done, 2, *patterns)

    def test_an_unknown_drag(self):
        self.check({'"di_felice"': '"di_felici"'}, r"scene\.toml:28: coupling\.drag = .*di_felice")

    def test_stokes_without_viscosity(self):
        self.check({'"di_felice"': '"stokes"', "viscosity = 0.001": "viscosity = 0"},
                   r"coupling\.drag = .*stokes needs water\.viscosity")

    def test_grains_larger_than_what_they_are_spread_over(self):
        self.check({"[coupling]": "[coupling]\naveraging_length = 0.0009"},
                   r"coupling\.averaging_length = .*larger than the averaging length")

    def test_an_averaging_length_beyond_the_kernel(self):
        self.check({"[coupling]": "[coupling]\naveraging_length = 0.01"},
                   r"coupling\.averaging_length = .*allowed: at most 0\.00866")

    def test_denser_than_grains_pack(self):
        self.check({"spacing = 0.002\n": "spacing = 0.00085\n"}, r"grains = .*denser than grains pack")

    def test_more_grains_than_space(self):
        self.check({"spacing = 0.002\n": "spacing = 0.00085\n", "radius = 0.0005": "radius = 0.0006"},
                   r"grains = .*they leave -0\.\d+ of the volume .*denser than grains pack")

    def test_gravity_of_one_only(self):
        self.check({'"periodic", "periodic", "periodic"': '"periodic", "periodic", "open"',
                    "greatest_speed = 0.1": "greatest_speed = 0.1\ngravity = [0, 0, -9.81]"},
                   r"dem\.gravity = .*differs from water\.gravity along z")

    def test_sources_in_water(self):
        self.check({"[coupling]": '[[source]]\nname = "rain"\nmaterial = "glass"\nradius = 0.0005\nshape = "box"\n'
                                  'lower = [0, 0, 0]\nupper = [0.01, 0.01, 0.01]\nrate = 10\nnumber = 5\n[coupling]'},
                   r"source = .*does not go with grains in water")

    def test_coupling_without_grains(self):
        begin, end = SCENE.index("[materials"), SCENE.index("[coupling]")
        done = talus("run", self.scene(SCENE[:begin] + SCENE[end:]), "--out", self.out, ranks=0)
        self.assert_fails(done, 2, r"coupling = .*is for scenes with \[\[grains\]\]")

    def test_a_check_warns_of_grains_too_large_for_mean_equations(self):
        done = talus("check", self.scene(SCENE.replace("radius = 0.0005", "radius = 0.0009")), ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"note: grains of up to 0\.0018 m across .*resolved")

    def test_a_check_warns_of_averages_over_too_little(self):
        done = talus("check", self.scene(SCENE.replace("[coupling]", "[coupling]\naveraging_length = 0.0011")), ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"note: .*averaged over 0\.0011 m.*averaging_length = 0\.00125 keeps below that")
        done = talus("check", self.scene(SCENE.replace("[coupling]", "[coupling]\naveraging_length = 0.00125")), ranks=0)
        self.assertNotRegex(done.stdout, "averaged over")

    def test_a_check_warns_of_water_that_drags_nothing(self):
        done = talus("check", self.scene(SCENE.replace("viscosity = 0.001", "viscosity = 0")), ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"note: the water has no viscosity: it does not drag the grains")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
