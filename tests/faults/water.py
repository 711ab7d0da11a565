"""What scenes of water say when they are wrong. Usage: running.py."""
import sys
import unittest

from running import Case, talus

SCENE = """dimension = 2
[water]
greatest_speed = 2
gravity = [0, -9.81]
artificial_viscosity = 0.02
[[body]]
name = "water"
shape = "box"
lower = [0, 0]
upper = [0.4, 0.2]
lattice = "cubic"
spacing = 0.02
surface = 0.2
[[body]]
name = "floor"
shape = "box"
lower = [-0.08, -0.08]
upper = [0.48, 0]
lattice = "cubic"
wall = "free_slip"
[run]
end_time = 0.02
"""


class Water(Case):
    def check(self, old, new, *patterns):
        self.assertIn(old, SCENE)
        done = talus("run", self.scene(SCENE.replace(old, new, 1)), "--out", self.out)
        self.assert_fails(done, 2, *patterns)
        self.assertFalse(self.out.exists())

    def test_no_speed(self):
        self.check("greatest_speed = 2\n", "", r"scene\.toml:2: water\.greatest_speed")

    def test_a_negative_viscosity(self):
        self.check("[water]", "[water]\nviscosity = -1", r"scene\.toml:3: water\.viscosity = -1")

    def test_mud(self):
        mud = "artificial_viscosity = 0.02\n[water.rheology]\n"
        self.check("artificial_viscosity = 0.02\n", mud + "consistency = 0\n", r"water\.rheology.*both 0")
        self.check("artificial_viscosity = 0.02\n", "viscosity = 1\n" + mud + "consistency = 1\n", r"water\.viscosity = .*water\.rheology")

    def test_what_is_recorded(self):
        self.check("surface = 0.2\n", "surface = 0.2\nrecord_force = true\n", r"scene\.toml:14: body\[0\]\.record_force .*of walls")

    def test_open_ends(self):
        outlet = '[[body]]\nname = "outlet"\nshape = "box"\nlower = [0.4, 0]\nupper = [0.48, 0.2]\nlattice = "cubic"\nsurface = 0.2\n'
        thin = outlet.replace("0.48", "0.44")
        self.check("[run]", thin + 'outflow = { direction = "+x" }\n[run]', r"body\[2\]\.outflow.* 0\.04 m deep .*0\.08 m")
        behind = outlet.replace("[0.4, 0]", "[0.5, 0]").replace("0.48", "0.58")
        done = talus("run", self.scene(SCENE.replace("[run]", behind + 'outflow = { direction = "+x" }\n[run]')), "--out", self.out,
                     "--steps", 1)
        self.assertRegex(done.stdout + done.stderr, r"no water at the face of 'outlet'")

    def test_an_inflow_into_a_full_tank(self):
        inlet = '[[body]]\nname = "inlet"\nshape = "box"\nlower = [-0.08, 0]\nupper = [0, 0.2]\nlattice = "cubic"\n' \
                'inflow = { direction = "+x", speed = 2 }\n'
        wall = '[[body]]\nname = "{}"\nshape = "box"\nlower = [{}]\nupper = [{}]\nlattice = "cubic"\nwall = "free_slip"\n'
        full = inlet + wall.format("right", "0.4, 0", "0.48, 0.2") + wall.format("lid", "-0.08, 0.2", "0.48, 0.28")
        scene = self.scene(SCENE.replace("[run]", full + "[run]").replace("end_time = 0.02", "end_time = 1"))
        self.assert_fails(talus("run", scene, "--out", self.out), 1, r"'inlet' pushes water into a region that is full")

    def test_an_unknown_key(self):
        self.check("artificial_viscosity", "artificial_viscocity", r"artificial_viscocity")

    def test_an_exponent_that_is_not_whole(self):
        self.check("[water]", "[water]\nexponent = 6.5", r"scene\.toml:3: water\.exponent = 6\.5")

    def test_one_dimension(self):
        self.check("dimension = 2", "dimension = 1", r"scene\.toml:1: dimension = 1")

    def test_walls_alone(self):
        self.check('surface = 0.2\n', 'wall = "no_slip"\n', r"all bodies are walls")

    def test_a_wall_of_other_spacing(self):
        self.check('wall = "free_slip"', 'spacing = 0.04\nwall = "free_slip"', r"body\[1\]\.spacing = .*within a tenth")
        begin, second, end = (SCENE.index(word) for word in ("[[body]]", '[[body]]\nname = "floor"', "[run]"))
        turned = SCENE[:begin] + SCENE[second:end] + SCENE[begin:second] + SCENE[end:]
        scene = self.scene(turned.replace('wall = "free_slip"', 'spacing = 0.04\nwall = "free_slip"'))
        self.assert_fails(talus("check", scene), 2, r"body\[0\]\.spacing = .*within a tenth")

    def test_a_density_of_a_body(self):
        self.check("surface = 0.2", "density = 1100", r"body\[0\]\.density = .*water\.density")

    def test_a_wall_with_a_velocity(self):
        self.check('wall = "free_slip"', 'velocity = [1, 0]\nwall = "free_slip"', r"body\[1\]\.velocity = .*\[body\.motion\]")

    def test_two_of_a_name(self):
        self.check('"floor"', '"water"', r"body\[1\]\.name = .*another of the name 'water'")

    def test_a_box_shorter_than_the_kernel(self):
        self.check("[water]", '[box]\nboundaries = ["open", "periodic"]\nlower = [-1, 0]\nupper = [1, 0.05]\n[water]',
                   r"box.* along y")

    def test_water_that_flies_apart(self):
        scene = self.scene(SCENE.replace("surface = 0.2\n", "velocity = [1e200, 0]\n"))
        self.assert_fails(talus("run", scene, "--out", self.out), 1, r"(of|at) particle \d+")

    def test_cores_of_walls(self):
        self.check("[water]", "[water]\nwall_core = 0.9", r"water\.wall_core = 0\.9 .*three dimensions; allowed: 0")
        self.check("[water]", "[water]\nwall_core = 1.2", r"water\.wall_core = 1\.2")

    def test_notes(self):
        # a step grows sound 1.0152 times by itself (tests/stability/water.cpp), a hundred 4.5 times
        for damping, note in (("density_diffusion = 0", r"note: sound in still water grows 4\.5 times in a hundred steps"),
                              ("density_diffusion = 0\nartificial_viscosity = 0.02", None), ("viscosity = 500", None), ("", None)):
            done = talus("check", self.scene(SCENE.replace("artificial_viscosity = 0.02", damping)), ranks=0)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            if note:
                self.assertRegex(done.stdout, note + r".*water\.density_diffusion = 0\.1 damps it")
            else:
                self.assertNotRegex(done.stdout, r"note: (sound|body 'floor')")
        done = talus("check", self.scene(SCENE.replace("[-0.08, -0.08]", "[-0.08, -0.02]")), ranks=0)
        self.assertRegex(done.stdout, r"note: body 'floor' is a wall 0\.02 m thick")
        open_box = '[box]\nboundaries = ["open", "open"]\nlower = [-0.1, -0.1]\nupper = [0.5, 1]\n'
        gauges = '[[gauge]]\nname = "near"\nplace = [0.2, 0.1]\n[[gauge]]\nname = "far"\nplace = [2, 0.1]\n'
        done = talus("check", self.scene(SCENE.replace("[water]", open_box + "[water]") + gauges), ranks=0)
        self.assertRegex(done.stdout, r"note: gauge 'far' is outside the box along x, which is open there")
        self.assertNotRegex(done.stdout, r"gauge 'near'")

    def test_a_restart_with_other_bodies(self):
        done = talus("run", self.scene(SCENE), "--out", self.out, "--steps", 2)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        other = self.scene(SCENE.replace('"floor"', '"ground"'))
        self.assert_fails(talus("run", other, "--out", self.out, "--restart", "latest"), 3, r"floor \(wall\).*ground \(wall\)")


RIGID = """
[dem]
law = "linear"
stiffness = 1e4
[materials.wood]
density = 500
restitution = 0.5
friction = 0.3
[[wall]]
point = [0, 0]
normal = [0, 1]
material = "wood"
[[body]]
name = "block"
shape = "box"
lower = [0.1, 0.3]
upper = [0.3, 0.5]
lattice = "cubic"
wall = "no_slip"
[body.rigid]
material = "wood"
"""


def twin(lower, upper):
    """A second block of wood."""
    return f"""[[body]]
name = "twin"
shape = "box"
lower = {lower}
upper = {upper}
lattice = "cubic"
wall = "no_slip"
rigid = {{ material = "wood" }}
"""


class RigidBodies(Case):
    def check(self, old, new, *patterns, code=2):
        self.assertIn(old, RIGID)
        done = talus("check", self.scene(SCENE + RIGID.replace(old, new, 1)), ranks=0)
        self.assert_fails(done, code, *patterns)

    def test_a_body_in_a_wall(self):
        self.check("lower = [0.1, 0.3]", "lower = [0.1, -0.06]", r"body 'block' overlaps body 'floor'")

    def test_a_body_in_another(self):
        self.check("[[wall]]", twin("[0.2, 0.3]", "[0.4, 0.5]") + "[[wall]]", r"body 'block' overlaps body 'twin'")

    def test_a_body_in_a_surface(self):
        self.check("point = [0, 0]", "point = [0, 0.305]", r"rigid body 'block' overlaps 'wall\[0\]' at the start, by 0\.5")

    def test_no_density(self):
        rigid = '[body.rigid]\nmaterial = "wood"'
        self.check(rigid, "rigid = { density = 0 }", r"body\[2\]\.rigid\.density = 0")
        self.check(rigid, "rigid = { mass = -5 }", r"body\[2\]\.rigid\.mass = -5")
        self.check(rigid, "rigid = {}", r"body\[2\]\.rigid\.density")

    def test_a_thin_body(self):
        self.check("upper = [0.3, 0.5]", "upper = [0.3, 0.34]", r"body 'block' is 0\.04 m thick.*0\.08 m")

    def test_water_that_moves_freely(self):
        self.check('wall = "no_slip"\n', "", r"body\[2\]\.rigid")

    def test_a_motion(self):
        self.check("[body.rigid]", "motion = { velocity = [1, 0] }\n[body.rigid]", r"body\[2\]\.motion")

    def test_recorded_twice(self):
        self.check("[body.rigid]", "record_force = true\n[body.rigid]", r"body\[2\]\.record_force")

    def test_a_restart_with_another_body(self):
        done = talus("run", self.scene(SCENE + RIGID), "--out", self.out, "--steps", 1)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        other = self.scene(SCENE + RIGID + twin("[0.1, 0.7]", "[0.3, 0.9]"))
        self.assert_fails(talus("run", other, "--out", self.out, "--restart", "latest"), 3, r"block \(rigid body\).*twin \(rigid body\)")

    def test_reflecting_boundaries(self):
        self.check("[dem]", '[box]\nboundaries = ["reflecting", "open"]\nlower = [-1, -1]\nupper = [1, 1]\n[dem]', r"box\.boundaries.*rigid")

    def test_a_body_that_leaves(self):
        bounded = SCENE.replace("[water]", "[box]\nlower = [-1, -1]\nupper = [1, 1]\n[water]", 1)
        scene = self.scene(bounded + RIGID + "velocity = [9, 0]\n")
        done = talus("run", scene, "--out", self.out, "--set", "run.end_time=0.2")
        self.assert_fails(done, 1, r"rigid body 'block' has left the box along x")

    def test_notes(self):
        done = talus("check", self.scene(SCENE + RIGID.replace("upper = [0.3, 0.5]", "upper = [0.2, 0.4]")), ranks=0)
        self.assertRegex(done.stdout, r"note: rigid body 'block' is 5 particles across")
        self.assertRegex(done.stdout, r"rigid body 'block': 5 kg, 25 particles, 5 across, 16 contact spheres")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
