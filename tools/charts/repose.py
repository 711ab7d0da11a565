"""Slope of a heap against friction, with and without resistance to rolling: runs/heap."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot, snapshot_series  # noqa: E402

TITLE = "A tube of grains drawn up from a rough disc"
PROGRAMS = ["talus"]
FRICTION = (0.1, 0.2, 0.3, 0.5, 0.8)
ROLLING = (0.0, 0.05, 0.2)
DISC = 0.060  # radius [m]
DIAMETER = 0.005  # [m]
SECTORS = 8


def simulate(program, friction, rolling, folder):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    out = pathlib.Path(folder) / f"heap_{friction}_{rolling}"
    subprocess.run([program, "run", TOP / "runs/heap", "--out", out, "--set", f"materials.glass.friction={friction}",
                    "--set", f"materials.glass.rolling_friction={rolling}"],
                   check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=environment)
    return out


def profile(position):
    """Distance from the axis and height of the surface: the highest grain of each sector of each ring, their mean."""
    distance, angle = np.hypot(position[:, 0], position[:, 1]), np.arctan2(position[:, 1], position[:, 0])
    sector = np.floor((angle / (2 * np.pi) + 0.5) * SECTORS).astype(int) % SECTORS
    found = []
    for inner in np.arange(2 * DIAMETER, 0.9 * DISC, DIAMETER):
        tops = [position[(distance >= inner) & (distance < inner + DIAMETER) & (sector == s), 2] for s in range(SECTORS)]
        found.append((inner + DIAMETER / 2, np.mean([top.max() if len(top) else 0.0 for top in tops])))
    return np.array(found)


def row_of(friction, rolling, out):
    last = read_snapshot(snapshot_series(out)["grains"][-1][0])
    position = np.asarray(last["position"])
    on_disc = position[:, 2] > 0
    surface = profile(position[on_disc])
    slope = np.polyfit(surface[:, 0], surface[:, 1], 1)[0]
    return {"friction": friction, "rolling_friction": rolling, "angle": round(float(np.degrees(np.arctan(-slope))), 2),
            "kept": int(np.count_nonzero(on_disc & (np.asarray(last["body"]) == 1)))}


def measure(build):
    with tempfile.TemporaryDirectory() as folder:
        return [row_of(friction, rolling, simulate(build / "talus", friction, rolling, folder))
                for rolling in ROLLING for friction in FRICTION]


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(5.6, 4), layout="constrained")
    for rolling, colour in zip(ROLLING, ("#888888", "#1f6fb2", "#c44e2b")):
        mine = [row for row in rows if row["rolling_friction"] == rolling]
        label = f"rolling friction {rolling}" if rolling else "rolls freely"
        axes.plot([row["friction"] for row in mine], [row["angle"] for row in mine], "o-", color=colour, label=label)
    axes.set(xlim=(0, None), ylim=(0, None), xlabel="friction between grains", ylabel="slope of the heap [degrees]")
    axes.legend(fontsize=8)
    return figure
