"""Error of the solid fraction on particles of water over their number: particle counting and kernels, against the exact mean."""
import itertools
import math
import pathlib
import random
import sys
import tempfile

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from chart_runs import performance_of, run_program  # noqa: E402
from talus_output import read_snapshot  # noqa: E402

TITLE = "Solid fraction of grains in a box, averaged over one averaging length R, on water ever finer"
PROGRAMS = ["talus"]
SAME = ("water", "method", "spacing")
REPEATED = {"pairs": 0, "error": 1e-6, "particles": 0}
LENGTH, RADIUS, SOLID, STEPS = 4.0, 0.1, 0.2, 4   # of the box, of the grains, share that they fill; averaging length 1
SPACINGS = (2 / 3, 0.5, 0.4, 1 / 3, 0.25, 0.2)
QUICK = (2 / 3,)
METHODS = {"particle counting": None, "kernel": ["coupling.volume_fraction=kernel"],
           "normalised kernel, no images": ["coupling.mirror=false"], "normalised kernel": []}
SCENE = """title = "Grains in a box"
[box]
lower = [-5, -5, -5]
upper = [9, 9, 9]
[water]
viscosity = 1e-3
greatest_speed = 1
[[body]]
name = "water"
shape = "box"
lower = [0, 0, 0]
upper = [4, 4, 4]
[materials.glass]
density = 2500
youngs_modulus = 1e5
poisson_ratio = 0.2
restitution = 0.5
friction = 0.4
[dem]
time_step = 1e-4
[[wall]]
name = "box"
kind = "container"
material = "glass"
lower = [0, 0, 0]
upper = [4, 4, 4]
[[grains]]
name = "grains"
material = "glass"
held = true
file = "grains.csv"
[coupling]
averaging_length = 1
[run]
end_time = 1
[output]
snapshots = 1
"""


def scattered():
    """Centres of spheres put at random places, one after another, where there is room."""
    draw, wanted = random.Random(1), round(SOLID * LENGTH**3 / (4 / 3 * math.pi * RADIUS**3))
    cells, places = {}, []
    while len(places) < wanted:
        place = tuple(RADIUS + (LENGTH - 2 * RADIUS) * draw.random() for _ in range(3))
        cell = tuple(int(x / (2 * RADIUS)) for x in place)
        near = itertools.chain.from_iterable(cells.get(tuple(c + d for c, d in zip(cell, step)), ())
                                             for step in itertools.product((-1, 0, 1), repeat=3))
        if all(math.dist(place, other) >= 2 * RADIUS for other in near):
            cells.setdefault(cell, []).append(place)
            places.append(place)
    return np.array(places)


def with_images(places, reach):
    """The places and their images in the walls that are nearer than `reach`."""
    for axis in range(3):
        low, high = places[places[:, axis] < reach].copy(), places[places[:, axis] > LENGTH - reach].copy()
        low[:, axis] *= -1
        high[:, axis] = 2 * LENGTH - high[:, axis]
        places = np.concatenate([places, low, high])
    return places


def weight_of_ball(distances):
    """Integral of Wendland's function of radius 1 over a grain at a distance."""
    s = (np.arange(4000) + 0.5) / 4000
    weight = 21 / (2 * math.pi) * (1 - s)**4 * (1 + 4 * s)
    table = np.linspace(0, 1 + RADIUS, 1101)
    cosine = np.clip((s**2 + table[1:, None]**2 - RADIUS**2) / (2 * s * table[1:, None]), -1, 1)
    values = (2 * math.pi * s**2 * weight * (1 - cosine)).sum(axis=1) / len(s)
    values = np.concatenate([[(4 * math.pi * s**2 * weight * (s < RADIUS)).sum() / len(s)], values])
    return np.interp(distances, table, values, right=0.0)


def for_chunks(points, places, use):
    """use(distances) for some points at a time."""
    return np.concatenate([use(np.linalg.norm(part[:, None, :] - places[None, :, :], axis=2))
                           for part in np.array_split(points, max(1, len(points) // 100))])


def exact_fraction(points, grains):
    return for_chunks(points, with_images(grains, 1 + RADIUS), lambda r: weight_of_ball(r).sum(axis=1))


def counted(points, volumes, grains):
    """Each grain's volume in the particle of water that is nearest to its centre."""
    nearest = for_chunks(grains, points, lambda r: r.argmin(axis=1))
    return np.bincount(nearest, minlength=len(points)) * (4 / 3 * math.pi * RADIUS**3) / volumes


def measure(build, quick=False):
    grains, rows = scattered(), []
    volume = len(grains) * 4 / 3 * math.pi * RADIUS**3
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "scene.toml"
        scene.write_text(SCENE)
        np.savetxt(scene.with_name("grains.csv"), np.column_stack([grains, np.full(len(grains), RADIUS)]), fmt="%.17g", delimiter=",")
        for water, spacing in itertools.product(("glass",) if quick else ("cubic", "glass"), QUICK if quick else SPACINGS):
            exact = None
            for number, (method, settings) in enumerate(METHODS.items()):
                row = {"water": water, "method": method, "spacing": spacing}
                if settings is not None or exact is None:
                    out = pathlib.Path(folder) / f"{water}_{spacing}_{number}"
                    line = ["run", scene, "--out", out, "--steps", STEPS, "--set", f"body[0].lattice={water}", "--set",
                            f"body[0].spacing={spacing}", "--set", f"water.smoothing={max(1.2, 0.51 / spacing)}"]
                    for setting in settings or []:
                        line += ["--set", setting]
                    done = run_program(line, build / "talus")
                    if done.returncode != 0:
                        rows.append(row | {"failed": done.stderr.strip().splitlines()[0]})
                        continue
                    state, performance = read_snapshot(out / "water_000000.hdf"), performance_of(out)
                    points, solid = state["position"], state["solid_fraction"]
                    volumes = state["mass"] / state["density"]
                    if exact is None:
                        exact = exact_fraction(points, grains)
                if settings is None:
                    row |= {"pairs": len(grains), "particles": len(points)}
                    solid = counted(points, volumes, grains)
                else:
                    row |= {"pairs": performance["exchange_pairs"] // STEPS, "particles": len(points),
                            "ns_per_pair": performance["phase_seconds"]["exchange"] / performance["exchange_pairs"] * 1e9}
                rows.append(row | {"error": math.sqrt(np.mean((solid - exact)**2)) / (volume / LENGTH**3),
                                   "greatest": float(solid.max()), "volume": abs(float(solid @ volumes) / volume - 1)})
    return rows


def draw(rows, plt):
    figure, panels = plt.subplots(2, 2, figsize=(9, 7), layout="constrained", sharex=True, sharey="row")
    for column, (water, title) in enumerate((("cubic", "water on a lattice"), ("glass", "water without order"))):
        for colour, method in zip(("#c0392b", "#d98e04", "#5a9e5a", "#1f6fb2"), METHODS):
            line = [row for row in rows if row["water"] == water and row["method"] == method and "error" in row]
            for panel, figure_of in zip(panels[:, column], ("error", "volume")):
                panel.loglog([row["particles"] for row in line], [max(row[figure_of], 1e-16) for row in line], "o-", color=colour,
                             label=method)
        panels[0, column].set_title(title)
        panels[1, column].set_xlabel("particles of water in the box of (4 R)³")
    panels[0, 0].set_ylabel("rms error of the fraction over its mean")
    panels[1, 0].set_ylabel("error of the grains' volume")
    panels[0, 0].legend(fontsize=7)
    return figure
