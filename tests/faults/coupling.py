"""What scenes of water with grains say when they are wrong. Usage: running.py."""
import re
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

    def test_one_fault_is_all_that_is_told(self):
        """What was not read because of it is not told."""
        for changes, line, fault in (
                ({"[dem]": "[dem]\ntime_step = -1"}, 20, r"dem\.time_step = -1 .*more than 0"),
                ({"viscosity = 0.001\n": "", "[[body]]": "[water.rheology]\nyield_stress = 1\nconsistency = 0.1\n[[body]]"}, 7,
                 r"water\.rheology = a table .*does not go with grains")):
            scene = SCENE
            for old, new in changes.items():
                scene = scene.replace(old, new, 1)
            done = talus("check", self.scene(scene), ranks=0)
            self.assert_fails(done, 2, rf"^\S*scene\.toml:{line}: {fault}")
            self.assertEqual(len((done.stdout + done.stderr).splitlines()), 1, done.stdout + done.stderr)

    def test_stokes_without_viscosity(self):
        self.check({'"di_felice"': '"stokes"', "viscosity = 0.001": "viscosity = 0"},
                   r"coupling\.drag = .*stokes needs water\.viscosity")

    def test_history_without_viscosity(self):
        self.check({"[coupling]": "[coupling]\nbasset = true", "viscosity = 0.001": "viscosity = 0"},
                   r"scene\.toml:28: coupling\.basset = true.*needs water\.viscosity")

    def test_history_that_is_not_one(self):
        self.check({"[coupling]": '[coupling]\nbasset = "yes"'}, r"scene\.toml:28: coupling\.basset = .*allowed: true")
        for memory in ("0", "-1", "nan", '"1 m"'):
            self.check({"[coupling]": f"[coupling]\nbasset = true\nbasset_memory = {memory}"},
                       r"scene\.toml:29: coupling\.basset_memory = ")
        self.check({"[coupling]": "[coupling]\nbasset_memory = 1"}, r"scene\.toml:28: coupling\.basset_memory")

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

    def test_a_check_warns_of_sound_in_the_steps_that_are_taken(self):
        # Of 1.67 ms for the sound in this bed, 1.66 and 1 ms are taken, of 1.73 ms in water alone. Sound grows by some
        # (omega dt)^4/4 a step: the logarithms of 4.3 and 1.2 differ by about 1.66^4 = 7.6 (physics/water/sound_waves.hpp).
        scene = SCENE.replace("viscosity = 0.001", "viscosity = 1e-6\ndensity_diffusion = 0").replace("1e5", "1e3")
        for step, growth in (("0.00083", "4.3"), ("0.001", "1.2")):
            done = talus("check", self.scene(scene.replace("[dem]", f"[dem]\ntime_step = {step}")), ranks=0)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn(f"sound in still water grows {growth} times in a hundred steps", done.stdout)

    def test_a_check_and_a_run_warn_of_water_within_cores_of_walls(self):
        wall = '[[body]]\nname = "floor"\nwall = "no_slip"\nshape = "box"\nlower = [0, 0, -0.01]\n' \
               'upper = [0.02, 0.02, 0]\nlattice = "cubic"\nspacing = 0.0025\n'
        scene = SCENE.replace("[materials", wall + "[materials").replace('"periodic"]', '"open"]').replace(
            "lower = [0, 0, 0]", "lower = [0, 0, -0.02]", 1).replace(
            'shape = "domain"\nlattice', 'shape = "box"\nlower = [0, 0, 0]\nupper = [0.02, 0.02, 0.02]\nlattice').replace(
            'shape = "domain"\nradius', 'shape = "box"\nlower = [0, 0, 0]\nupper = [0.02, 0.02, 0.02]\nradius')
        note = r"note: \d+ particles of water begin nearer to a wall's particles than 0\.00225 m, the nearest at 0\.00"
        for command, ranks in (("check", 0), ("run", 2)):
            arguments = ("--out", self.out) if command == "run" else ()
            done = talus(command, self.scene(scene), *arguments, ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertNotRegex(done.stdout + done.stderr, "particles of water begin nearer")
            close = self.scene(scene.replace('name = "water"', 'name = "water"\njitter = 0.3'))
            done = talus(command, close, *arguments, ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertRegex(done.stdout + done.stderr, note)

    def test_a_check_warns_of_water_that_drags_nothing(self):
        done = talus("check", self.scene(SCENE.replace("viscosity = 0.001", "viscosity = 0")), ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"note: the water has no viscosity: it does not drag the grains")


class Memories(Case):
    """A checkpoint with memories of the slip goes on with the kernel that made them."""

    def go_on(self, steps, *settings, out=None, restart=True, ranks=0):
        scene = SCENE.replace("[coupling]", "[coupling]\nbasset = true").replace(
            "[dem]\ngravity = [0, 0, 0]", "[dem]\ngravity = [0, 0, -1]").replace("end_time = 0.001", "end_time = 0.01")
        options = [word for setting in settings for word in ("--set", setting)]
        return talus("run", self.scene(scene), "--out", out or self.out, "--steps", steps, *(["--restart", "latest"] if restart else []),
                     *options, ranks=ranks)

    def goes_on(self, *arguments, **more):
        done = self.go_on(*arguments, **more)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def kernel(self):
        """Its shortest and longest times in the newest checkpoint [s]."""
        info = talus("info", self.out, ranks=0).stdout
        return [float(re.search(rf"basset\.{name} = (\S+)", info).group(1)) for name in ("shortest", "longest")]

    def test_a_longer_run_goes_on_with_them(self):
        """With the bits of a run that was to be as long from its start and remembers as long."""
        self.goes_on(3, restart=False)
        note = self.goes_on(5, "run.end_time=0.1", ranks=2)
        self.assertRegex(note, r"note: Basset's force goes on .* last for 0\.01 s .*, and the run for 0\.1 s")
        straight = self.folder / "straight"
        self.goes_on(5, "run.end_time=0.1", "coupling.basset_memory=0.01", out=straight, restart=False)
        self.assertEqual(self.hash(self.out), self.hash(straight))

    def test_other_steps_and_memories(self):
        self.goes_on(2, "dem.time_step=2e-5", restart=False)
        self.assertEqual(self.kernel(), [2e-5, 0.01])
        self.goes_on(3, "dem.time_step=3e-5", ranks=2)
        self.assertEqual(self.kernel(), [2e-5, 0.01])
        for setting, fault in (
                ("dem.time_step=1e-5", r"dem\.time_step = 1e-05 .*coupling\.basset in the checkpoint; allowed: at least 2e-05 s"),
                ("materials.glass.youngs_modulus=10", r"dem\.time_step .*above the next step of the water in the checkpoint; allowed: at most 0\.0016"),
                ("coupling.basset_memory=0.02", r"coupling\.basset_memory = 0\.02 .*last for 0\.01 s; allowed: that"),
                ("coupling.basset=false", r"coupling\.basset = false .*allowed: true")):
            self.assert_fails(self.go_on(4, setting), 2, fault)
        self.goes_on(4, "coupling.basset_memory=0.01", "dem.time_step=2e-5")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
