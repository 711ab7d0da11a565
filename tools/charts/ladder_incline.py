"""One event on an incline, models of growing cost: a column as high as long slumps down 15 degrees and stops, by every rung that can
tell it. Gravity is tilted instead of the ground."""
import os
import pathlib
import subprocess
import sys

import h5py
import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from charts import column_collapse as grains  # noqa: E402
from charts import soil_collapse as soil  # noqa: E402
from ladder_rungs import draw_rungs, measured, point_out_cheapest  # noqa: E402
from talus_output import snapshot_series  # noqa: E402

TITLE = "Run-out of a column, height = length, down 15 degrees, against the cost of its model"
PROGRAMS = ["talus"]
SLOPE, FRICTION_ANGLE = np.radians(15), np.radians(31)
ASPECT = 1
LOWER = (0.25, 0.5)  # heights over lengths of the columns that tell how deep a depth-integrated flow may be
GRAVITY = (9.81 * np.sin(SLOPE), -9.81 * np.cos(SLOPE))


def sliding_block(_program, _folder):
    """The centre slides as far as friction takes the energy of its fall, from a square to a wedge of the same area, lengths along the
    slope in those of the column: x_end - 1/2 = (1/2 - z_end)/(tan phi - tan theta) with x_end = l/3, z_end = 2/(3 l)."""
    net = np.tan(FRICTION_ANGLE) - np.tan(SLOPE)
    half = 1.5 * (0.5 + 0.5 / net)
    return half + np.sqrt(half**2 - 2 / net) - 1, 1


def depth_integrated(columns, *settings, aspect=ASPECT):
    """Along the normal of the bed; x of the program is in plan."""
    def run(program, folder):
        length = (soil.AREA / aspect) ** 0.5
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        out = pathlib.Path(folder) / "depth"
        plan = length * np.cos(SLOPE)
        subprocess.run([program, "run", TOP / "runs/inclined_dam_break", "--out", out, "--set",
                        f'release=[{{shape="box", lower=[0], upper=[{plan}], depth={aspect * length}, particles={columns}}}]',
                        "--set", f"box={{boundaries=[\"reflecting\"], lower=[0], upper=[{20 * plan}]}}",
                        "--set", f"terrain.dip={SLOPE}", "--set", f"friction.angle={FRICTION_ANGLE}",
                        "--set", "run.end_time=3", "--set", "output.diagnostics=0.1", *settings],
                       check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=environment)
        (files,) = snapshot_series(out).values()
        with h5py.File(files[-1][0], "r") as file:
            depth = file["PartType0/Depth"][...]
            x = file["PartType0/Coordinates"][...].reshape(len(depth), -1)[:, 0]
        # Where it is as thick as the front of the others: 3/4 of a layer of 5 mm.
        return float(x[depth > 0.75 * soil.SPACING].max() / plan - 1), columns
    return run


def continuum(model, spacing, aspect=ASPECT):
    def run(program, folder):
        settings = ["--set", f"body[0].spacing={spacing}", "--set", f"sph.gravity=[{GRAVITY[0]}, {GRAVITY[1]}]",
                    "--set", "run.end_time=1.2"]
        found = soil.row_of(model, aspect, *soil.simulate(program, model, aspect, folder, settings), spacing)
        return found["run_out"], int(soil.AREA / spacing**2)
    return run


def spheres(program, folder):
    # On a smooth floor: with the scene's rolling friction of 0.1, less than tan 15 deg, they would roll away.
    out, length = grains.simulate(program, ASPECT, folder, ["--set", f"dem.gravity=[{GRAVITY[0]}, 0, {GRAVITY[1]}]",
                                                            "--set", "materials.sand.rolling_friction=0.4"])
    found = grains.row_of(ASPECT, out, length)
    return found["run_out"], found["grains"]


PRESSURE = ["--set", 'pore_pressure={consolidation=1e-6, ratio=0}']
EARTH = ["--set", f"depth.internal_friction_angle={FRICTION_ANGLE}"]
DRUCKER_PRAGER, MU_I = soil.MODELS
REFERENCE = "Drucker-Prager, 5 mm"  # the law of the depth-integrated rungs, without their assumption
RUNGS = [  # of the chart: name, family, run(program, folder) -> (run-out over length, number of parts)
    ("sliding block", "block", sliding_block),
    ("depth-integrated", "depth", depth_integrated(200)),
    ("with earth pressure", "depth", depth_integrated(200, *EARTH)),
    ("with pore pressure (0 at the start)", "depth", depth_integrated(200, *PRESSURE)),
    ("Drucker-Prager, 10 mm", "continuum", continuum(DRUCKER_PRAGER, 0.01)),
    ("Drucker-Prager, 5 mm", "continuum", continuum(DRUCKER_PRAGER, 0.005)),
    ("mu(I), 5 mm", "continuum", continuum(MU_I, 0.005)),
    ("spheres, rolling friction 0.4", "grains", spheres),
]
RUNGS_OF_LOWER = [(f"{name}, height / length {aspect}", "lower", run) for aspect in LOWER
                  for name, run in (("depth-integrated", depth_integrated(200, aspect=aspect)),
                                    ("Drucker-Prager, 5 mm", continuum(DRUCKER_PRAGER, 0.005, aspect)))]


def measure(build):
    return measured(RUNGS + RUNGS_OF_LOWER, build / "talus")


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    rows = [row for row in rows if row["family"] != "lower"]
    reference = next(row["run_out"] for row in rows if row["rung"] == REFERENCE)
    axes.axhline(reference, color="#dddddd", linewidth=4, zorder=0)
    draw_rungs(axes, rows, lambda row: f"{row['rung']}: {row['run_out'] / reference - 1:+.0%}",
               lambda row: (4, -10) if "pore" in row["rung"] else (-95, 4) if "10 mm" in row["rung"] else (4, 4))
    near = 0.1
    point_out_cheapest(axes, rows, lambda row: row["rung"] != REFERENCE and abs(row["run_out"] / reference - 1) < near,
                       f"cheapest within {near:.0%} of it", (-90, 40))
    return figure
