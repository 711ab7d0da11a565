"""Run-out of columns of soil against their aspect ratio: runs/column_collapse at five widths of equal area."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from charts.column_collapse import lajeunesse, lube  # noqa: E402
from talus_output import read_snapshot, snapshot_series  # noqa: E402

TITLE = "Collapse of columns of soil in a plane, 800 particles"
PROGRAMS = ["talus"]
ASPECTS = (0.5, 1, 2, 4, 8)
AREA = 0.02  # of every column [m2]
SPACING = 0.005  # of the quick scene [m]
MODELS = {
    "Drucker-Prager, 31 deg": 'materials.bars.strength={kind="drucker_prager",friction_angle="31 deg"}',
    "mu(I), 0.38 to 0.64": 'materials.bars.strength={kind="mu_i",friction_static=0.382,friction_limit=0.644,'
                           'inertial_number=0.279,grain_diameter=0.53e-3,grain_density=2650}',
}


def simulate(program, model, aspect, folder, settings=()):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    out = pathlib.Path(folder) / f"{len(os.listdir(folder))}"
    length = (AREA / aspect) ** 0.5
    height = aspect * length
    subprocess.run([program, "run", TOP / "runs/column_collapse", "--quick", "--out", out,
                    "--set", MODELS[model], "--set", f"body[0].upper=[{length}, {height}]",
                    "--set", "body[1].upper=[1.2, 0]", "--set", f"body[2].upper=[0, {height + 0.02}]",
                    "--set", f"run.end_time={4 * (height / 9.81) ** 0.5}", *settings],
                   check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=environment)
    return out, length, height


def front(snapshot, spacing):
    """Where the deposit that hangs together ends: the first strip of two spacings with less than 3/4 of a layer."""
    x = snapshot["position"][snapshot["body"] == 0][:, 0]
    strip = 2 * spacing
    heights = np.bincount(np.maximum(0, x / strip).astype(int)) * spacing**2 / strip
    thin = np.flatnonzero(heights < 0.75 * spacing)
    return strip * (thin[0] if len(thin) else len(heights))


def row_of(model, aspect, out, length, height, spacing=SPACING):
    (files,) = snapshot_series(out).values()
    last, before = (read_snapshot(files[k][0]) for k in (-1, -2))
    top = last["position"][last["body"] == 0][:, 1].max() + spacing / 2
    return {"model": model, "aspect": aspect, "length": length, "height": height,
            "run_out": (front(last, spacing) - length) / length, "final_height": top / length,
            "still_moving": (front(last, spacing) - front(before, spacing)) / length}


def measure(build):
    with tempfile.TemporaryDirectory() as folder:
        return [row_of(model, aspect, *simulate(build / "talus", model, aspect, folder))
                for model in MODELS for aspect in ASPECTS]


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.2, 4.2), layout="constrained")
    aspect = np.geomspace(0.4, 10, 200)
    axes.loglog(aspect, lube(aspect), color="#888888", label="Lube et al. 2005")
    axes.loglog(aspect, lajeunesse(aspect), "--", color="#888888", label="Lajeunesse et al. 2005")
    for model, marker, colour in zip(MODELS, "os", ("#1f6fb2", "#c2571a")):
        mine = [row for row in rows if row["model"] == model]
        axes.loglog([row["aspect"] for row in mine], [row["run_out"] for row in mine], marker, color=colour, label=model)
    axes.set(xlabel="height / length of the column", ylabel="run-out / length of the column")
    axes.legend(fontsize=8)
    return figure
