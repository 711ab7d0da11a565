"""Cost of a grain and step against the ratio of sizes, and against the gap up to which pairs are listed."""
import json
import os
import pathlib
import resource
import subprocess
import tempfile

import numpy as np

TITLE = "Settled grains in a periodic box, Hertz's and Mindlin's law, one rank"
PROGRAMS = ["talus"]
GRAINS = 8000
RATIOS = (1, 2, 5, 10, 20)
SKINS = (0.05, 0.1, 0.2, 0.3, 0.5, 1.0)  # of the smallest radius
ROUNDS = 2
SMALLEST = 1e-3  # radius [m]
FILLED = 0.3     # of the volume, before the grains fall
WARM, STEPS = 40, 840
STEP = 2e-5      # [s]; a quarter of what waves take to cross the smallest grain
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
SCENE = """[box]
boundaries = ["periodic", "periodic", "open"]
lower = [0, 0, 0]
upper = [{width}, {width}, {height}]
[materials.glass]
density = 2500
youngs_modulus = 1e7
poisson_ratio = 0.3
restitution = 0.2
friction = 0.5
[dem]
gravity = [0.3, 0, -2]
time_step = {step}
skin = {skin}
[[grains]]
material = "glass"
file = "grains.csv"
[[wall]]
name = "floor"
material = "glass"
point = [0, 0, 0]
normal = [0, 0, 1]
[run]
end_time = 10
[output]
snapshots = 0
diagnostics = 1
checkpoints = 0
"""


class Cells:
    """Placed spheres up to a radius, to find those near a place; the box is periodic along x and y."""

    def __init__(self, radius, width):
        self.count = max(1, int(width / (2 * radius)))
        self.size, self.radius, self.cells = width / self.count, radius, {}

    def near(self, place, radius):
        reach = int(np.ceil((radius + self.radius) / self.size))
        at = [int(x // self.size) for x in place]
        steps = range(-reach, reach + 1)
        columns = {((at[0] + dx) % self.count, (at[1] + dy) % self.count) for dx in steps for dy in steps}
        return [i for x, y in columns for dz in steps for i in self.cells.get((x, y, at[2] + dz), ())]

    def add(self, place, number):
        at = tuple(int(x // self.size) for x in place)
        self.cells.setdefault((at[0] % self.count, at[1] % self.count, at[2]), []).append(number)


def grains(ratio):
    """Spheres of radii with as much volume in each interval, put one after the other, the largest first, where there is room."""
    random = np.random.default_rng(1)
    shares = random.random(GRAINS)
    radii = np.sort(SMALLEST / np.sqrt(1 - shares * (1 - 1 / ratio**2)))[::-1]
    width = max(np.cbrt(4 / 3 * np.pi * np.sum(radii**3) / FILLED), 4.6 * radii[0])
    height = 4 / 3 * np.pi * np.sum(radii**3) / FILLED / width**2
    levels, places = {}, np.empty((GRAINS, 3))
    for number, radius in enumerate(radii):
        level = int(np.log2(radii[0] / radius))
        own = levels.setdefault(level, Cells(radii[0] / 2**level, width))
        while True:
            place = random.random(3) * [width, width, height] + [0, 0, radius]
            near = [i for cells in levels.values() for i in cells.near(place, radius)]
            apart = places[near] - place
            apart[:, :2] -= width * np.round(apart[:, :2] / width)
            if np.all(np.sum(apart**2, axis=1) > (radii[near] + radius)**2):
                break
        places[number] = place
        own.add(place, number)
    return np.column_stack([places, radii]), width, height + 2 * radii[0]


class Case:
    def __init__(self, program, folder, ratio):
        self.program, self.folder, self.ratio = program, pathlib.Path(folder) / str(ratio), ratio
        self.folder.mkdir()
        rows, width, height = grains(ratio)
        np.savetxt(self.folder / "grains.csv", rows, delimiter=",")
        (self.folder / "scene.toml").write_text(SCENE.format(width=width, height=height, step=STEP, skin=0.3 * SMALLEST))
        self.settled = 4000 + int(2 * np.sqrt(2 * height / 2) / STEP)  # steps
        self.run(self.settled)

    def run(self, steps, *options):
        """What performance.json says, and the processor time [s]."""
        line = [self.program, "run", self.folder / "scene.toml", "--out", self.folder / "out", "--steps", steps, *options]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([str(a) for a in line], check=True, capture_output=True, stdin=subprocess.DEVNULL, env=ENVIRONMENT)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        return json.loads((self.folder / "out" / "performance.json").read_text()), spent

    def measured(self, skin):
        """Goes on from where the grains have settled: STEPS and WARM steps more, whose difference counts; the least of the rounds."""
        best = None
        for _ in range(ROUNDS):
            subprocess.run(["rm", "-rf", self.folder / "kept"], check=True)
            subprocess.run(["cp", "-r", self.folder / "out", self.folder / "kept"], check=True)
            option = ["--restart", "latest", "--set", f"dem.skin={skin * SMALLEST}"]
            first = self.run(self.settled + WARM, *option)[1]
            found, second = self.run(self.settled + WARM + STEPS, *option)
            ns = (second - first) / (STEPS - WARM) / found["particles"] * 1e9
            phases = found["phase_seconds"]
            row = {"ratio": self.ratio, "skin": skin, "ns": ns, "ns_for_lists": ns * phases["decompose"] / sum(phases.values()),
                   "contacts": found["pairs"] / found["steps"] / found["particles"], "steps_per_list": found["steps"] / found["lists"]}
            best = row if best is None or row["ns"] < best["ns"] else best
            subprocess.run(["rm", "-rf", self.folder / "out"], check=True)
            (self.folder / "kept").rename(self.folder / "out")
        return best


def measure(build):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for ratio in RATIOS:
            case = Case(build / "talus", folder, ratio)
            rows += [case.measured(skin) for skin in (SKINS if ratio in (1, 20) else (0.3,))]
    return rows


def draw(rows, plt):
    from matplotlib.ticker import FuncFormatter, NullFormatter
    figure, (sizes, skins) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
    usual = [row for row in rows if row["skin"] == 0.3]
    sizes.plot([row["ratio"] for row in usual], [row["ns"] for row in usual], "o-", color="#1f6fb2", label="all")
    sizes.plot([row["ratio"] for row in usual], [row["ns_for_lists"] for row in usual], "s--", color="#c0392b", label="lists")
    sizes.plot([row["ratio"] for row in usual], [row["ns"] / (row["contacts"] + 1) for row in usual], "^:", color="#777777",
               label="all, over contacts a grain + 1")
    for ratio, colour in ((1, "#1f6fb2"), (20, "#d98e04")):
        line = [row for row in rows if row["ratio"] == ratio]
        skins.plot([row["skin"] for row in line], [row["ns"] for row in line], "o-", color=colour, label=f"1:{ratio}")
    for axes in (sizes, skins):
        axes.set(xscale="log", ylim=(0, None), ylabel="processor time, ns a grain and step")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.legend(fontsize=7)
    sizes.set(xlabel="largest over smallest radius, mixed by volume", title=f"{GRAINS} grains, skin of 0.3 of the smallest radius")
    sizes.set_xticks(RATIOS)
    skins.set(xlabel="skin over the smallest radius", title="Against the skin")
    skins.set_xticks(SKINS)
    return figure
