"""One event, models of growing cost: the run-out of a column as high as long, by every rung that can tell it."""
import pathlib
import resource
import sys
import tempfile

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from charts import column_collapse as grains  # noqa: E402
from charts import soil_collapse as soil  # noqa: E402

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


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(build):
    rows = []
    for name, family, run in RUNGS:
        with tempfile.TemporaryDirectory() as folder:
            before = processor_time()
            run_out, parts = run(build / "talus", folder)
            rows.append({"rung": name, "family": family, "run_out": float(run_out), "parts": parts,
                         "processor_seconds": processor_time() - before, "low": BAND[0], "high": BAND[1]})
    return rows


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    axes.axhspan(rows[0]["low"], rows[0]["high"], color="#dddddd", label="experiments (Lube, Lajeunesse)")
    colours = {"block": "#444444", "depth": "#2b8a5a", "continuum": "#1f6fb2", "grains": "#c2571a"}
    for row in rows:
        cost = max(row["processor_seconds"], 1e-3)
        axes.semilogx(cost, row["run_out"], "o", color=colours[row["family"]])
        axes.annotate(row["rung"], (cost, row["run_out"]), textcoords="offset points", xytext=(4, 4), fontsize=7)
    axes.set(xlabel="processor time [s]; closed forms at 1e-3", ylabel="run-out / length of the column", xlim=(5e-4, 2e4))
    axes.legend(fontsize=8)
    return figure
