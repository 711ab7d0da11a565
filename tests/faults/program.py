"""What the program does when things go wrong: clear messages, agreed exit codes on all ranks, nothing lost. Usage: running.py."""
import json
import re
import signal
import subprocess
import sys
import time
import unittest

from running import ENVIRONMENT, RUNS, SCENE, Case, command, talus

class BadInput(Case):
    def test_every_fault_of_a_scene_is_reported_at_once_with_its_line(self):
        text = (RUNS / "sod_tube" / "scene.toml").read_text()
        text = text.replace("end_time = 0.2", 'end_tme = 0.2').replace('pressure = 1\n', 'pressure = "1 kg"\n')
        path = self.scene(text)
        line = 1 + text[:text.index("end_tme")].count("\n")
        done = talus("run", path, "--out", self.out)
        self.assert_fails(done, 2, rf"scene\.toml:{line}: run\.end_tme", "end_time", r"pressure.*1 kg")
        self.assertFalse(self.out.exists(), "a bad scene must not leave a folder")

    def test_words_not_allowed_are_named_with_those_that_are(self):
        done = talus("check", SCENE, "--quick", "--set", "sph.formulation=godunof")
        self.assert_fails(done, 2, "--set sph.formulation", "godunof", "standard")

    def test_gravity_where_it_cannot_be(self):
        done = talus("check", RUNS / "sod_tube", "--quick", "--set", "gravity.theta=2", "--set", "gravity.order=4")
        self.assert_fails(done, 2, "gravity .*dimension = 3", "gravity .*open", r"gravity\.theta.*0\.95",
                          r"gravity\.order.*3")
        done = talus("check", RUNS / "rotating_sphere", "--quick", "--set", "gravity.direct=true",
                     "--set", "gravity.theta=0.5")
        self.assert_fails(done, 2, r"gravity\.theta")

    def test_soil_and_walls_that_cannot_be(self):
        column = RUNS / "column_collapse"
        strength = "materials.bars.strength."
        for settings, patterns in (
                ((strength + "friction_angle=95 deg", strength + "dilation_angle=-1"),
                 (r"friction_angle.*less than 90 deg", r"dilation_angle.*from 0")),
                ((strength + "friction_angle=30",), (r"friction_angle.*angles in degrees",)),
                ((strength + "dilation_angle=25 deg",), (r"dilation_angle.*above the friction angle",)),
                ((strength + "friction_angle=0",), (r"friction_angle.*bears no shear",)),
                ((strength + "softening_strain=0",), (r"softening_strain",)),
                (("materials.bars.poisson_ratio=0.5",), (r"poisson_ratio",)),
                (("materials.bars.shear_modulus=1e6",), (r"shear_modulus.*leave it out",)),
                ((strength + "kind=mu_i",), (r"friction_static", r"grain_diameter", r"friction_angle")),
                (("body[2].normal=[0,0]",), (r"body\[2\]\.normal.*no direction",)),
                (("body[1].held=true", "body[1].velocity=[1,0]"), (r"held.*does not go with wall", r"velocity.*motion")),
                (("body[1].geostatic={}",), (r"body\[1\]\.geostatic.*does not go with wall",)),
                ((strength + "softening_strain=0.1", strength + "residual_friction_angle=10 deg",
                  strength + "residual_dilation_angle=12 deg"), (r"residual_dilation_angle.*above the friction",)),
                (("sph.contacts=frictionless",), (r"sph\.contacts.*bonded",))):
            options = [option for setting in settings for option in ("--set", setting)]
            self.assert_fails(talus("check", column, "--quick", *options, ranks=0), 2, *patterns)
        text = (column / "scene.toml").read_text()
        done = talus("check", self.scene(text.replace("gravity = ", "# gravity = ")), "--quick", ranks=0)
        self.assert_fails(done, 2, r"body\[0\]\.geostatic.*needs sph\.gravity")

    def test_viscoplastic_soil_that_cannot_be(self):
        band, sand, cut = RUNS / "shear_band", "materials.sand.yield.", RUNS / "vertical_cut"
        for scene, settings, pattern in (
                (band, (sand + "friction_angle=90 deg",), r"friction_angle.*less than 90 deg"),
                (band, (sand + "dilation_angle=29 deg",), r"dilation_angle.*above the friction angle"),
                (band, (sand + "cone=outer",), r"cone = .*compression"),
                (cut, ("soil.strength_change={times=[0,1],values=[1,0]}",), r"strength_change\.values.*not above 0"),
                (cut, ("soil.strength_change={frequency=1}",), r"strength_change\.frequency"),
                (cut, ("materials.clay.yield={kind=\"cam_clay\",slope=1,compression=0.2,swelling=0.1,void_ratio=1,"
                       "preconsolidation=1e5,fluidity=1}",), r"yield\.kind.*strength_change")):
            options = [option for setting in settings for option in ("--set", setting)]
            self.assert_fails(talus("check", scene, "--quick", *options, ranks=0), 2, pattern)

    def test_soil_at_the_start_and_in_large_deformation_that_cannot_be(self):
        column = RUNS / "saturated_column"
        text = (RUNS / "vertical_cut" / "scene.toml").read_text() + """
[initial_stress]
surface = 20
lateral_ratio = 0.5
[materials.light]
density = 1000
youngs_modulus = 1e7
poisson_ratio = 0.3
"""
        for scene, setting, pattern in (
                (self.scene(text), "body[1].material=light", r"initial_stress\.surface.*bodies of one density only"),
                (column, "soil.deformation=large", r"deformation.*small strain only"),
                (RUNS / "vertical_cut", "soil.deformation=huge", r"deformation.*large"),
                (RUNS / "vertical_cut", "soil.smoothing=2", r"smoothing")):
            self.assert_fails(talus("check", scene, "--quick", "--set", setting, ranks=0), 2, pattern)

    def test_soil_goes_on_with_its_own_boundaries_and_grids_only(self):
        options = ["run", RUNS / "vertical_cut", "--quick", "--out", self.out]
        first = talus(*options, "--steps", "3")
        self.assertEqual(first.returncode, 0, first.stdout + first.stderr)
        for setting, pattern in (("boundary[1].name=other", r"boundaries base.*this one has.*other"),
                                 ("boundary[1].kind=fixed", r"boundaries base"),
                                 ("soil.courant=0.5", "time step"),
                                 ("soil.deformation=large", "surface|time step")):
            done = talus(*options, "--steps", "5", "--restart", "latest", "--set", setting)
            self.assert_fails(done, 3, pattern)

    def test_steps_too_long_for_a_tight_face_that_nothing_holds(self):
        free = ["check", RUNS / "saturated_stratum", "--quick", "--set", "boundary[4].kind=traction",
                "--set", "boundary[4].traction=[0,0]", "--set", "boundary[4].name=other"]
        for setting in ("courant=0.75", "smoothing=0.6"):
            done = talus(*free, "--set", "soil." + setting, ranks=0)
            self.assert_fails(done, 2, r"soil\." + setting.replace("=", " = ") + r".*face y_upper at \(.*allowed there: up to")
        done = talus(*free, ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, "courant = 0.6")

    def test_soil_that_blows_up_stops(self):
        for setting, pattern in (("velocity=[2000]", r"particle \d+ moves at more than 10 times"),
                                 ("velocity=[0.1]", r"particle \d+ (returns to its yield surface too fast|.*is not finite)")):
            scene = self.scene("""dimension = 1
[soil]
spacing = 0.5
[materials.a]
density = 2000
youngs_modulus = 1e7
poisson_ratio = 0.2
[materials.a.yield]
kind = "von_mises"
yield_stress = 1e3
fluidity = 1e308
[[body]]
name = "a"
material = "a"
shape = "box"
lower = [0]
upper = [10]
[[boundary]]
name = "top"
kind = "velocity"
face = "x_upper"
""" + setting + """
[run]
end_time = 1
""")
            self.assert_fails(talus("run", scene, "--out", self.out, ranks=2), 1, pattern)

    def test_scenes_that_cannot_run(self):
        wave, tube = RUNS / "acoustic_wave", RUNS / "sod_tube"
        reach = r"scene\.toml:\d+: box\.upper = .*along x, where it is closed, shorter than the interaction radius"
        for command, ranks in (("run", 2), ("check", 0)):
            for scene, setting, *patterns in (
                    (wave, "body[0].particles=3", reach), (wave, "body[0].particles=1", reach),
                    (tube, "body[1].pressure=-1", r"--set body\[1\]\.pressure: .*no sound speed"),
                    (tube, "output.snapshots=1e-12", r"--set output\.snapshots: .*at least [0-9.e-]+ s")):
                options = [command, scene, "--quick", "--set", setting]
                done = talus(*options, *(["--out", self.out] if command == "run" else []), ranks=ranks)
                self.assert_fails(done, 2, *patterns)
                self.assertNotIn("MPI_ABORT", done.stderr)
        self.assertFalse(self.out.exists(), "a scene that cannot run leaves no folder")
        text = (tube / "scene.toml").read_text()
        self.assert_fails(talus("check", self.scene(text[:text.index("[quick]")]), "--quick", ranks=0), 2,
                          r"scene\.toml: quick \(missing")

    def test_a_time_step_of_nothing(self):
        done = talus("run", RUNS / "maclaurin_spheroid", "--quick", "--set", "gravity.constant=1e300", "--out", self.out)
        self.assert_fails(done, 1, r"time step has fallen to .* limited by \w+ at particle \d+")

    def test_missing_files(self):
        self.assert_fails(talus("run", self.folder / "nowhere"), 2, "nowhere")
        done = talus("run", SCENE, "--quick", "--set", "body[0].material=cheese", "--out", self.out)
        self.assert_fails(done, 2, "cheese", "materials/cheese.toml")
        for command in ("hash", "info"):
            done = talus(command, self.folder / "none.h5", ranks=0)
            self.assert_fails(done, 3, "none.h5: no such file")
            self.assertEqual(done.stderr.count("none.h5"), 1)
            self.assert_fails(talus(command, self.folder, ranks=0), 3, "no checkpoint in this folder")
        self.assert_fails(talus("run", SCENE, "--quick", "--restart", "latest", "--out", self.out), 3, "checkpoint")
        self.assertFalse(self.out.exists(), "a run that cannot begin leaves no folder")

    def test_a_shape_file_that_is_not_closed(self):
        scene = (RUNS / "bilobed_impact" / "scene.toml").read_text()
        shape = (RUNS / "bilobed_impact" / "bilobed.obj").read_text()
        (self.folder / "bilobed.obj").write_text(shape[:shape.rindex("f ")])
        line = 1 + scene[:scene.index("file =")].count("\n")
        done = talus("run", self.scene(scene), "--out", self.out)
        self.assert_fails(done, 2, rf"scene\.toml:{line}: body\[0\]\.file",
                          r"bilobed\.obj: is not closed: 3 of 1920 edges are open")

    def test_usage(self):
        self.assert_fails(talus("run", ranks=0), 2, "scene")
        self.assert_fails(talus("run", SCENE, "--walltime", "soon"), 2, "soon")
        for option, values in (("--until", ("3 kg", "-1", "0", "1e", "1e999", "nan", "")),
                               ("--steps", ("-1", "1.5", "many", "99999999999999999999"))):
            for value in values:
                done = talus("run", SCENE, "--quick", option, value, "--out", self.out, ranks=0)
                self.assert_fails(done, 2, f"{option}.*{value}")
                self.assertNotIn("stod", done.stderr)
        self.assert_fails(talus("frob", SCENE), 2, "frob", "allowed: analyse, check, hash, info, run")
        self.assert_fails(talus("chekc", SCENE, ranks=0), 2, "chekc", r"did you mean check\?")
        self.assert_fails(talus("check", "--set", "seed=3", "--set", "dimension=4", SCENE, ranks=0), 2,
                          "--set dimension: dimension = 4")

    def test_output_that_cannot_be_written(self):
        blocker = self.folder / "file"
        blocker.write_text("not a folder")
        self.assert_fails(talus("run", SCENE, "--quick", "--out", blocker / "out"), 3, "file")


    def test_a_checkpoint_of_another_scene(self):
        self.assertEqual(talus("run", RUNS / "sod_tube", "--quick", "--steps", "2", "--out", self.out).returncode, 0)
        before = self.hash(self.out)
        for ranks in (1, 3):
            done = talus("run", RUNS / "wall_shock", "--quick", "--restart", "latest", "--out", self.out, ranks=ranks)
            self.assert_fails(done, 3, r"checkpoint_000000002\.h5: is of a scene of 2 bodies \(gas, gas\), "
                              r"this one has 1 body")
        self.assertEqual(self.hash(self.out), before)

    def test_a_checkpoint_of_the_late_phase_goes_on_with_its_stiffness_alone(self):
        # The first step is 1.3 s: it begins before a change at 1 s and ends after it; with one at 3 s the run stops before it.
        for change, fixed in (("1 s", True), ("3 s", False)):
            soft = ["run", RUNS / "asteroid_collision", "--quick", "--set", f"late_phase.from={change}"]
            out, straight = self.folder / f"stopped {change}", self.folder / f"straight {change}"

            def run(folder, steps, *options):
                done = talus(*soft, "--steps", steps, "--out", folder, *options)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            run(out, 1)
            before = self.hash(out)
            for other, found in (("late_phase.stiffness=0.1", "0.1"), ("late_phase.stiffness=0.02", "0.02")) if fixed else ():
                done = talus(*soft, "--restart", "latest", "--out", out, "--set", other)
                self.assert_fails(done, 3, rf"late_phase\.stiffness = 0\.01, this one has {re.escape(found)}")
            self.assertEqual(self.hash(out), before)
            run(out, 6, "--restart", "latest")
            run(straight, 6)
            self.assertEqual(self.hash(out), self.hash(straight))
        done = talus("check", RUNS / "sod_tube", "--quick", "--set", "late_phase.from=1")
        self.assert_fails(done, 2, r"late_phase \(needs sph\.density", "is an ideal gas")


class Check(Case):
    def test_memory_is_told_by_field_and_model_and_adds_up(self):
        done = talus("check", RUNS / "rubber_rings", "--quick")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        total = int(re.search(r"fields \((\d+) bytes per particle\)", done.stdout).group(1))
        fields = re.findall(r"^ +(\d+) B  (\w+) +([\w ]+?)  +(state|work) ", done.stdout, re.MULTILINE)
        self.assertEqual(sum(int(size) for size, *_ in fields), total)
        self.assertIn(("deviatoric_stress", "strength"), [(name, model) for _, name, model, _ in fields])
        memory = re.search(r"largest rank after a step, without files: ([\d.]+) MB; the program itself ([\d.]+) MB, "
                           r"fields of (\d+) own particles and (\d+) copies ([\d.]+) MB", done.stdout)
        whole, program, own, copies, data = map(float, memory.groups())
        self.assertGreater(copies, 0)
        self.assertGreater(program, 1)
        self.assertGreaterEqual(whole, program)
        self.assertAlmostEqual(data, own * total / 1e6, delta=copies * total / 1e6 + 0.1)


class RunTimeFailures(Case):
    def test_a_value_that_is_not_finite_stops_all_ranks_and_names_the_particle(self):
        # Four times the stable time step: values grow until they overflow.
        done = talus("run", RUNS / "sod_tube", "--quick", "--until", "50", "--out", self.out, "--set", "sph.courant=2")
        self.assert_fails(done, 1, r"step \d+, time .* of particle \d+ in set 'sph' is not finite",
                          r"last checkpoint: .*checkpoint_\d+\.h5", r"state that failed: .*failed/checkpoint_\d+\.h5")
        self.assertEqual(talus("hash", self.out, ranks=0).returncode, 0)
        self.assertEqual(talus("info", next((self.out / "failed").glob("*.h5")), ranks=0).returncode, 0)


class EarlyStops(Case):
    def expected(self, steps):
        out = self.folder / "straight"
        self.assertEqual(talus("run", SCENE, "--quick", "--steps", steps, "--out", out).returncode, 0)
        return self.hash(out)

    def restart_and_compare(self, steps):
        done = talus("run", SCENE, "--quick", "--steps", steps, "--out", self.out, "--restart", "latest", ranks=3)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(self.hash(self.out), self.expected(steps))

    def stopped_step(self, output):
        return int(re.search(r"stopped early: .*\(step (\d+)", output).group(1))

    def start(self, *options):
        process = subprocess.Popen(command(["run", SCENE, "--quick", "--out", self.out, *options], 2), text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                   env=ENVIRONMENT)
        deadline = time.time() + 60
        while not list(self.out.glob("checkpoint_*.h5")) and time.time() < deadline:
            time.sleep(0.05)
        return process

    def test_signal(self):
        process = self.start()
        process.send_signal(signal.SIGUSR1)
        output, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 75, output)
        self.restart_and_compare(self.stopped_step(output) + 5)

    def test_stop_file(self):
        process = self.start()
        (self.out / "stop").touch()
        output, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 75, output)
        self.assertIn("file 'stop'", output)
        self.assertFalse((self.out / "stop").exists(), "an obeyed stop file is removed")

    def test_wall_time(self):
        done = talus("run", SCENE, "--quick", "--out", self.out, "--walltime", "2", "--until", "1 s")
        self.assertEqual(done.returncode, 75, done.stdout + done.stderr)
        self.assertIn("wall time", done.stdout)
        self.assertEqual(talus("hash", self.out, ranks=0).returncode, 0)


class Restarts(Case):
    def files(self):
        return {path.name: path.read_bytes() for path in self.out.iterdir() if path.name != "log.txt"}

    def test_one_with_nothing_left_to_do_changes_nothing(self):
        for steps in (0, 4):  # no step at all, and some
            done = talus("run", RUNS / "sod_tube", "--quick", "--steps", steps, "--out", self.out)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            before = self.files()
            self.assertTrue([name for name in before if name.endswith(".hdf")])
            done = talus("run", RUNS / "sod_tube", "--quick", "--steps", steps, "--out", self.out,
                         "--restart", "latest", ranks=3)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("nothing left to do", done.stdout)
            self.assertEqual(before.keys(), self.files().keys())
            for name, content in self.files().items():
                self.assertTrue(content == before[name], name + " has changed")

    def test_bodies_that_settled_do_not_settle_again(self):
        def run(out, steps, *options):
            done = talus("run", RUNS / "asteroid_collision", "--quick", "--steps", steps, "--out", out, "--set",
                         "settle.imbalance=0.2", *options)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            return done.stdout.count("' settled in ")
        straight = self.folder / "straight"
        self.assertEqual(run(straight, 6), 2)
        self.assertEqual(run(self.out, 3), 2)
        self.assertEqual(run(self.out, 6, "--restart", "latest"), 0)
        self.assertEqual(self.hash(self.out), self.hash(straight))

    def test_settling_cannot_be_over_before_it_may_be_quiet(self):
        options = [RUNS / "asteroid_collision", "--quick", "--set", "settle.longest=10 s"]
        self.assert_fails(talus("check", *options), 2, r"settle\.longest.*body 'first' must be quiet for \d")

    def test_settling_that_is_stopped_keeps_what_was_there(self):
        options = ["run", RUNS / "asteroid_collision", "--quick", "--steps", "2", "--out", self.out]
        self.assertEqual(talus(*options).returncode, 0)
        before = self.hash(self.out)
        done = talus(*options, "--set", "settle.imbalance=0.2", "--walltime", "0")
        self.assert_fails(done, 1, "settling body 'first': stopped early: .*wall time")
        self.assertEqual(self.hash(self.out), before)

    def test_one_past_the_time_hands_over_at_once(self):
        options = ["run", RUNS / "asteroid_collision", "--quick", "--out", self.out, "--set", "hand_off.to=grains"]
        done = talus(*options, "--steps", "3")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        grains = self.out / "grains.h5"
        self.assertFalse(grains.exists(), "before its time")
        hashes = set()
        for ranks in (1, 3):
            done = talus(*options, "--restart", "latest", "--set", "hand_off.at=1e-3", ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertRegex(done.stdout, r"handed over: (\d+) particles became \d+ grains")
            hashes.add(self.hash(grains))
            grains.unlink()
        self.assertEqual(len(hashes), 1)
        done = talus(*options, "--set", "hand_off.at=1e-3", "--until", "1e9")
        self.assertRegex(done.stdout, r"note: the run ends at hand_off\.at = 0\.001 s, before --until 1000000000")
        done = talus(*options, "--set", "hand_off.at=1 d")
        self.assert_fails(done, 2, "hand_off.at = .*after the end of the run")


class DamagedCheckpoints(Case):
    def test_a_flipped_byte_is_refused_and_the_previous_checkpoint_offered(self):
        for steps, options in [(3, []), (6, ["--restart", "latest"])]:
            done = talus("run", SCENE, "--quick", "--steps", steps, "--out", self.out, *options)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        newest = max(self.out.glob("checkpoint_*.h5"))
        content = bytearray(newest.read_bytes())
        content[len(content) // 2] ^= 1
        self.assertEqual(talus("info", self.out, ranks=0).returncode, 0)
        newest.write_bytes(content)
        self.assert_fails(talus("info", self.out, ranks=0), 3, re.escape(newest.name), "DAMAGED")
        done = talus("run", SCENE, "--quick", "--steps", "8", "--out", self.out, "--restart", "latest")
        self.assert_fails(done, 3, newest.name, r"checkpoint_000000003\.h5")

    def test_an_earlier_run_is_kept(self):
        for out in (self.out, f"{self.out}/", f"{self.folder}/./out//"):
            done = talus("run", RUNS / "sod_tube", "--quick", "--steps", "2", "--out", out, ranks=0)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for aside in ("out.1", "out.2"):
            self.assertEqual(self.hash(self.out), self.hash(self.folder / aside))

    def test_neither_the_working_folder_nor_the_scene_is_moved(self):
        scene = self.scene((RUNS / "sod_tube" / "scene.toml").read_text())
        options = ["run", scene, "--quick", "--steps", "1", "--out"]
        first = talus(*options, ".", ranks=0, cwd=self.folder)
        self.assertEqual(first.returncode, 0, first.stdout + first.stderr)
        before = self.hash(self.folder)
        self.assert_fails(talus(*options, ".", cwd=self.folder), 3, "is the working folder", "name another --out")
        self.assert_fails(talus(*options, self.folder, ranks=0), 3, "the scene", "name another --out")
        self.assertEqual(self.hash(self.folder), before)


class PerformanceTable(Case):
    def rows(self):
        lines = (self.out / "performance.csv").read_text().splitlines()
        names = [name.split(" [")[0] for name in lines[0].split(",")]
        return [dict(zip(names, map(float, line.split(",")))) for line in lines[1:]]

    def run_to(self, step, *options):
        done = talus("run", SCENE, "--quick", "--steps", step, "--out", self.out, "--set", "output.diagnostics=1e-9",
                     "--set", "run.rebalance_interval=4", *options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return json.loads((self.out / "performance.json").read_text())

    def test_its_rows_add_up_and_go_on_after_a_restart(self):
        total = self.run_to(9)
        rows = self.rows()
        self.assertEqual([row["step"] for row in rows], list(range(1, 10)))
        for phase, seconds in total["phase_seconds"].items():
            if phase != "output":  # the last rows are still to be written
                self.assertAlmostEqual(sum(row[phase.replace(" ", "_")] for row in rows), seconds, delta=1e-5 * seconds)
        self.assertEqual(rows[-1]["copies_of_a_rank"], total["copies_of_a_rank"])
        self.assertGreater(rows[-1]["copies_of_a_rank"], 0)
        for row in rows:
            self.assertEqual(row["ranks"], 2)
            self.assertGreater(row["halo_bytes"], 100 * row["copies_of_a_rank"])
            self.assertGreaterEqual(row["imbalance_of_time"], 1)
            self.assertTrue(1 <= row["imbalance"] < 1.1, row["imbalance"])  # what a run may have
        self.run_to(12, "--restart", "latest")
        self.assertEqual(self.rows()[:9], rows)
        self.assertEqual([row["step"] for row in self.rows()], list(range(1, 13)))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
