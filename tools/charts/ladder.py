"""One event, models of growing cost: the run-out of a column as high as long, by every rung that can tell it."""
import pathlib
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from charts import column_collapse as grains  # noqa: E402
from charts import soil_collapse as soil  # noqa: E402
from ladder_rungs import draw_rungs, measured, point_out_cheapest  # noqa: E402

TITLE = "Run-out of a column, height = length, against the cost of its model"
PROGRAMS = ["talus"]
FRICTION_ANGLE = np.radians(31)
ASPECT = 1
BAND = (float(grains.lube(ASPECT)), float(grains.lajeunesse(ASPECT)))  # of experiments


def sliding_block(program, folder):
    """The centre slides as far as friction takes the energy of its fall, from a square to a wedge of the same area:
    x_end - 1/2 = (1/2 - z_end)/tan phi with x_end = l/3, z_end = 2/(3 l), lengths in those of the column."""
    mu = np.tan(FRICTION_ANGLE)
    half = 1.5 * (0.5 + 0.5 / mu)
    length = half + np.sqrt(half**2 - 2 / mu)
    return length - 1, 1


def continuum(model, spacing):
    def run(program, folder):
        settings = ["--set", f"body[0].spacing={spacing}"]
        found = soil.row_of(model, ASPECT, *soil.simulate(program, model, ASPECT, folder, settings), spacing)
        return found["run_out"], int(soil.AREA / spacing**2)
    return run


def spheres(program, folder):
    out, length = grains.simulate(program, ASPECT, folder)
    found = grains.row_of(ASPECT, out, length)
    return found["run_out"], found["grains"]


DRUCKER_PRAGER, MU_I = soil.MODELS
RUNGS = [  # name, family, run(program, folder) -> (run-out over length, number of parts)
    ("sliding block", "block", sliding_block),
    ("Drucker-Prager, 10 mm", "continuum", continuum(DRUCKER_PRAGER, 0.01)),
    ("Drucker-Prager, 5 mm", "continuum", continuum(DRUCKER_PRAGER, 0.005)),
    ("mu(I), 10 mm", "continuum", continuum(MU_I, 0.01)),
    ("mu(I), 5 mm", "continuum", continuum(MU_I, 0.005)),
    ("spheres, friction 0.5", "grains", spheres),
]


def measure(build):
    return [row | {"low": BAND[0], "high": BAND[1]} for row in measured(RUNGS, build / "talus")]


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    axes.axhspan(rows[0]["low"], rows[0]["high"], color="#dddddd", label="experiments (Lube, Lajeunesse)")
    draw_rungs(axes, rows, lambda row: row["rung"])
    point_out_cheapest(axes, rows, lambda row: row["low"] < row["run_out"] < row["high"], "cheapest within the experiments")
    axes.legend(fontsize=8)
    return figure
