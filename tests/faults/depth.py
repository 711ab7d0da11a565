"""What depth-integrated scenes say when they are wrong. Usage: running.py."""
import sys
import unittest

from running import Case, talus

SCENE = """dimension = 1
[terrain]
dip = "30 deg"
[depth]
form = "bed_fitted"
[friction]
law = "coulomb"
angle = "20 deg"
[[release]]
shape = "box"
lower = [-4]
upper = [0]
depth = 1
particles = 40
[run]
end_time = 1
"""


class Depth(Case):
    def check(self, old, new, *patterns):
        self.assertIn(old, SCENE)
        done = talus("run", self.scene(SCENE.replace(old, new)), "--out", self.out, ranks=0)
        self.assert_fails(done, 2, *patterns)
        self.assertFalse(self.out.exists())

    def test_a_negative_depth(self):
        self.check("depth = 1", "depth = -1", r"scene\.toml:13: release\[0\]\.depth = -1 .*more than 0")

    def test_depth_and_level(self):
        self.check("depth = 1", "depth = 1\nlevel = 2", r"scene\.toml:14: release\[0\]\.level = 2 .*not both")

    def test_a_friction_angle_of_a_wall(self):
        self.check('angle = "20 deg"', 'angle = "90 deg"', r"scene\.toml:8: friction\.angle = .*allowed: below 90")

    def test_an_unknown_law(self):
        self.check('"coulomb"', '"columb"', r"scene\.toml:7: friction\.law = .*coulomb")

    def test_a_key_of_another_law(self):
        self.check('angle = "20 deg"', 'angle = "20 deg"\nturbulence = 500', r"friction\.turbulence")

    def test_an_internal_angle_below_that_of_the_bed(self):
        self.check('form = "bed_fitted"', 'form = "bed_fitted"\ninternal_friction_angle = "15 deg"',
                   r"depth\.internal_friction_angle = .*from the bed's angle of friction, 20 degrees")

    def test_three_dimensions(self):
        self.check("dimension = 1", "dimension = 3", r"scene\.toml:1: dimension = 3")

    def test_two_phases_need_a_solid_fraction(self):
        self.check('[friction]', '[two_phase]\nsettling_velocity = 1\n[friction]', r"release\[0\]\.solid_fraction")

    def test_two_phases_refuse_what_is_not_known_of_them(self):
        fraction = "depth = 1\nsolid_fraction = 0.5"
        scene = SCENE.replace("depth = 1", fraction).replace(
            '[friction]', 'internal_friction_angle = "30 deg"\n[two_phase]\nsettling_velocity = 1\n[friction]')
        done = talus("run", self.scene(scene), "--out", self.out, ranks=0)
        self.assert_fails(done, 2, r"depth\.internal_friction_angle = .*not available together with \[two_phase\]")

    def test_a_lake_at_rest_holds_no_solid(self):
        scene = SCENE.replace("depth = 1", "level = 1\nsolid_fraction = 0.5").replace('"bed_fitted"', '"cartesian"')
        scene = scene.replace("[friction]", "[two_phase]\nsettling_velocity = 1\n[friction]")
        self.assert_fails(talus("run", self.scene(scene), "--out", self.out, ranks=0), 2,
                          r"release\[0\]\.level = 1 .*holds no solid; allowed: solid_fraction = 0")
        done = talus("check", self.scene(scene), "--set", "depth.balance=false", ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_columns_that_merge_refuse_what_is_not_known_of_them(self):
        self.check('[friction]', 'merging_distance = 0.1\n[pore_pressure]\nconsolidation = 1\n[friction]',
                   r"depth\.merging_distance = 0\.1 .*not available together with \[pore_pressure\]")

    def test_columns_that_would_merge_at_the_start(self):
        self.check('[friction]', 'merging_distance = 0.1\n[friction]',
                   r"depth\.merging_distance = 0\.1 .*would merge .*0\.1 m apart; allowed: less")

    def test_solid_that_floats(self):
        self.check('[friction]', '[two_phase]\nsolid_density = 900\nsettling_velocity = 1\n[friction]',
                   r"two_phase\.solid_density = 900 .*below that of the water")

    def test_the_cheapest_model_is_named(self):
        slide = 'dimension = 1\n[terrain]\ndip = "30 deg"\n'
        self.assertTrue(SCENE.startswith(slide))
        thin, pores = SCENE.replace("depth = 1", "depth = 0.1"), "[pore_pressure]\nconsolidation = {}\n[run]"
        cases = {SCENE: "a continuum in a plane .* as deep as long",
                 thin: r"a sliding block.*accelerated by 1\.81\d m/s2",
                 thin.replace("[run]", pores.format(10)): r"no \[pore_pressure\]: it drains within",
                 thin.replace("[run]", pores.format(0.01)): "this one: pore pressure drains in 0.4"}
        for scene, words in cases.items():
            done = talus("check", self.scene(scene), ranks=0)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertRegex(done.stdout, "cheapest model that serves: " + words)

    def test_no_release(self):
        done = talus("run", self.scene(SCENE[:SCENE.index("[[release]]")] + "[run]\nend_time = 1\n"), "--out", self.out,
                     ranks=0)
        self.assert_fails(done, 2, r"at least one \[\[release\]\]")

    def test_a_level_below_the_ground(self):
        self.check("depth = 1", "level = -50", r"release\[0\]\.level = -50 .*has no particles")

    def test_a_flow_that_blows_up_names_a_particle(self):
        scene = self.scene(SCENE.replace("depth = 1", "depth = 1\nvelocity = [1e200]"))
        done = talus("run", scene, "--out", self.out)
        self.assert_fails(done, 1, r"particle \d+")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
