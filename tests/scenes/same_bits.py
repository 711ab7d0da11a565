"""Every scene of runs/ gives the same bits on any number of ranks, for any map of cells to ranks, and across a restart
on another number of ranks: `talus hash` of the state after some steps must not change, nor must what the analysis finds
of it, at the end of the run or from its checkpoint, nor the rasters it leaves. The collision of asteroids is followed to the end of its quick
version, and stopped and restarted while its fragments fall together. Each scene.toml goes through one, two, three and five ranks, some of them
before and after the restart; the other quick scenes of a folder run on one and three.

usage: same_bits.py PROGRAM MPIRUN RUNS_FOLDER [SCENE ...]
"""
import itertools
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor

AT_A_TIME = 2  # scenes
STEPS = 14
STOP = 5
STEPS_OF_SCENES = {"silo": (600, 120)}  # filled while it settles, opened, and grains deleted below it
TO_THE_END = {"asteroid_collision": 200}  # scenes that run to their end, and the step where they are stopped
# Numbers of ranks, besides one, with their maps; ranks before and after a restart, with the map before: in turns from scene to scene.
PLANS = [({5: "slabs"}, (2, 3, "scrambled")), ({2: "cheapest"}, (3, 5, "scrambled"))]
PLAN_OF_OTHERS = ({3: "scrambled"}, None)

STEPS_OF_GRAINS = 20  # times as many: theirs are short


class Runner:
    def __init__(self, program, mpirun, folder):
        self.program, self.mpirun, self.folder, self.count = program, mpirun, folder, itertools.count()
        self.environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1",
                                OMP_NUM_THREADS="1")

    def command(self, arguments, ranks):
        line = [self.program] if ranks == 0 else [self.mpirun, "--oversubscribe", "-n", str(ranks), self.program]
        done = subprocess.run(line + [str(a) for a in arguments], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, env=self.environment, timeout=300)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, line + arguments))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
        return done.stdout

    def run(self, scene, steps, ranks, partition, out=None, restart=False):
        """Runs a scene (ranks 0: without mpirun) and returns its output folder."""
        if out is None:
            out = self.folder / f"{scene.parent.name}_{next(self.count)}"
        arguments = ["run", scene, "--quick", "--out", out, "--set", f"run.decomposition={partition}",
                     "--set", "run.rebalance_interval=2", *remnants_asked(scene)]
        arguments += ["--steps", steps] if steps else []
        self.command(arguments + (["--restart", "latest"] if restart else []), ranks)
        return out

    def hash(self, out):
        return self.command(["hash", out], 0).split()[0]

    def analyse(self, scene, out, ranks):
        self.command(["analyse", scene, "--quick", "--out", out, *remnants_asked(scene)], ranks)


def is_analysed(scene):
    return "analysis" in tomllib.loads(scene.read_text())


def name_of(scene):
    return scene.parent.name + ("" if scene.name == "scene.toml" else f"/{scene.name}")


def remnants_asked(scene):
    """Options that make an analysed scene look for remnants."""
    return ["--set", "analysis.remnants=true"] if is_analysed(scene) else []


def steps_and_stop(scene):
    if name_of(scene) in TO_THE_END:
        return None, TO_THE_END[name_of(scene)]
    if name_of(scene) in STEPS_OF_SCENES:
        return STEPS_OF_SCENES[name_of(scene)]
    tables = tomllib.loads(scene.read_text())
    times = STEPS_OF_GRAINS if "dem" in tables and "water" not in tables else 1
    return times * STEPS, times * STOP


def findings(out):
    """What the analysis wrote, but the snapshot of remnants: it holds the scene with the decomposition's name."""
    names = ("analysis.json", "fragments.csv", "distribution.csv")
    return {name: (out / name).read_bytes() for name in names if (out / name).exists()}


def rasters(out):
    """What a depth-integrated run leaves on the map."""
    return {path.name: path.read_bytes() for path in sorted(out.glob("results/*"))}


def missing_data(scene):
    """A file of maps that the scene names and this machine has not, or None."""
    tables = tomllib.loads(scene.read_text())
    releases = tables.get("release", [])
    named = [tables.get("terrain", {}).get("file")] + [r.get(key) for r in releases for key in ("areas", "depth_raster")]
    folders = [scene.parent, *map(pathlib.Path, filter(None, [os.environ.get("TALUS_DATA")]))]
    return next((name for name in filter(None, named) if not any((f / name).exists() for f in folders)), None)


def check(runner, scene, plan):
    name = name_of(scene)
    if missing := missing_data(scene):
        print(f"{name}: skipped, needs {missing} in the folder TALUS_DATA or its own")
        return True
    maps, restart = plan
    steps, stop = steps_and_stop(scene)
    first = runner.run(scene, steps, 0, "metis")
    reference, found_first = runner.hash(first), findings(first)
    wrong = []

    def compare(out, how):
        found = runner.hash(out)
        if found != reference:
            wrong.append(f"{how}: {found}")
        if findings(out) != found_first:
            wrong.append(f"{how}: another analysis")
        if rasters(out) != rasters(first):
            wrong.append(f"{how}: other rasters")

    if bool(found_first) != is_analysed(scene):
        wrong.append("the run ended without its analysis")
    for ranks, partition in maps.items():
        compare(runner.run(scene, steps, ranks, partition), f"{ranks} ranks, {partition}")
    for ranks in (1, 3) if found_first else ():
        for finding in found_first:
            (first / finding).unlink()
        runner.analyse(scene, first, ranks)
        if findings(first) != found_first:
            wrong.append(f"analysed after the run on {ranks} ranks: another analysis")
    if restart:
        before, after, partition = restart
        out = runner.run(scene, stop, before, partition)
        runner.run(scene, steps, after, "metis", out, restart=True)
        compare(out, f"stopped at step {stop} on {before} ranks, restarted on {after}")
    told = [f"{name}: {'same bits, ' + reference if not wrong else 'DIFFERS from ' + reference}"]
    print("\n    ".join(told + wrong), flush=True)
    return not wrong


def main():
    program, mpirun, runs = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    scenes = sorted(runs.glob("*/scene.toml"))
    others = [p for p in sorted(runs.glob("*/*.toml")) if p not in scenes and "quick" in tomllib.loads(p.read_text())]
    plans = [(s, PLANS[k % len(PLANS)]) for k, s in enumerate(scenes)] + [(s, PLAN_OF_OTHERS) for s in others]
    if sys.argv[4:]:
        plans = [(s, plan) for s, plan in plans if s.parent.name in sys.argv[4:]]
    assert plans, "no scenes found"
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(program, mpirun, pathlib.Path(folder))
        with ThreadPoolExecutor(AT_A_TIME) as pool:  # half of the time goes into starting ranks
            results = list(pool.map(lambda planned: check(runner, *planned), plans))
    sys.exit(0 if all(results) else 1)


main()
