"""One slender body, models of growing cost: the first period of a clamped rod or plate ten times as long as thick."""
import math
import pathlib
import subprocess
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from ladder_rungs import COLOURS, measured  # noqa: E402

TITLE = "First period of a clamped body, length/thickness = 10, against the cost of its model"
PROGRAMS = ["talus"]
WANTED = 0.02  # error that the arrow is for
LENGTH, THICKNESS, DENSITY, BULK, SHEAR = 0.2, 0.02, 1000.0, 3.25e6, 0.715e6  # those of runs/oscillating_plate
POISSON = (3 * BULK - 2 * SHEAR) / (2 * (3 * BULK + SHEAR))
YOUNG = 2 * SHEAR * (1 + POISSON)


def periods(modulus, gyration2, shear_coefficient):
    """Of a thin beam and of one with shear and rotary inertia (T. C. Huang, J. Appl. Mech. 28 (1961) 579) [s]."""
    unit = 2 * math.pi * LENGTH**2 / math.sqrt(modulus * gyration2 / DENSITY)
    r2 = gyration2 / LENGTH**2
    s2 = r2 * modulus / (shear_coefficient * SHEAR)

    def equation(b):
        root = math.sqrt((r2 - s2) ** 2 + 4 / b**2)
        alpha, beta = b * math.sqrt((root - r2 - s2) / 2), b * math.sqrt((root + r2 + s2) / 2)
        return (2 + (b**2 * (r2 - s2) ** 2 + 2) * math.cosh(alpha) * math.cos(beta)
                - b * (r2 + s2) / math.sqrt(1 - b**2 * r2 * s2) * math.sinh(alpha) * math.sin(beta))
    low, high = 1.0, 3.6
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (low, middle) if equation(low) * equation(middle) <= 0 else (middle, high)
    return unit / 1.8751040687119611**2, unit / low


# Shear coefficients: G. R. Cowper, J. Appl. Mech. 33 (1966) 335, of a round section and of plane strain.
ROUND = periods(YOUNG, THICKNESS**2 / 16, 6 * (1 + POISSON) / (7 + 6 * POISSON))
STRAIN_POISSON = POISSON / (1 - POISSON)
PLATE = periods(2 * SHEAR / (1 - POISSON), THICKNESS**2 / 12,
                10 * (1 + STRAIN_POISSON) / (12 + 11 * STRAIN_POISSON))


def diagnostics(program, scene, folder, settings=()):
    """Columns of diagnostics.csv of a run, by name without unit."""
    out = pathlib.Path(folder) / "out"
    subprocess.run([str(program), "run", str(scene), "--out", str(out), *settings], check=True, capture_output=True,
                   stdin=subprocess.DEVNULL)
    names = (out / "diagnostics.csv").read_text().splitlines()[0].split(",")
    table = np.genfromtxt(out / "diagnostics.csv", delimiter=",", skip_header=1)
    return {name.split(" ")[0]: table[:, k] for k, name in enumerate(names)}


def thin_beam(program, folder):
    return ROUND[0] / ROUND[1] - 1, 1


def bonded_row(count):
    """Beads on bonds of the rod's section, `count` bonds long, that sags under its weight and swings."""
    def rung(program, folder):
        spacing = LENGTH / count
        full = 1.5 * DENSITY * THICKNESS**2 / spacing**2  # of a bead with the mass of its piece of the rod
        gravity = 0.5  # 1/500 of the length at rest

        def grains(name, first, last, density, more=""):
            return f"""[[grains]]
name = "{name}"
material = "{name}"
shape = "box"
radius = {spacing / 2}
lower = [{(first - 0.5) * spacing}, {-spacing / 2}, {-spacing / 2}]
upper = [{(last + 0.5) * spacing}, {spacing / 2}, {spacing / 2}]
spacing = {spacing}
{more}
[materials.{name}]
density = {density}
youngs_modulus = {YOUNG}
poisson_ratio = {POISSON}
restitution = 0.9
friction = 0.5
"""
        pairs = [["clamp", "rod"], ["rod"], ["rod", "tip"]]
        bonds = "".join(f"""[[bond]]
grains = {pair}
radius_factor = {THICKNESS / spacing}
youngs_modulus = {YOUNG}
poisson_ratio = {POISSON}
""" for pair in pairs).replace("'", '"')
        text = (f"[dem]\ngravity = [0, 0, -{gravity}]\n" + grains("clamp", 0, 0, full, "held = true")
                + grains("rod", 1, count - 1, full) + grains("tip", count, count, full / 2) + bonds
                + f"[run]\nend_time = {4.5 * ROUND[0]}\n[output]\ndiagnostics = {ROUND[0] / 100}\n")
        scene = pathlib.Path(folder) / "rod.toml"
        scene.write_text(text)
        found = diagnostics(program, scene, folder)
        time, height = found["time"], found["potential_energy"]
        height = height - (height.max() + height.min()) / 2
        falls = [k for k in range(1, len(time)) if height[k - 1] > 0 >= height[k]]
        crossings = [time[k - 1] + (time[k] - time[k - 1]) * height[k - 1] / (height[k - 1] - height[k]) for k in falls]
        return (crossings[-1] - crossings[0]) / (len(crossings) - 1) / ROUND[1] - 1, count
    return rung


def rock(rows):
    """runs/oscillating_plate: half a period between two times of least kinetic energy."""
    def rung(program, folder):
        spacing = THICKNESS / rows
        settings = ["--until", "0.45", "--set", f"body[0].spacing={spacing}", "--set", f"body[1].spacing={spacing}"]
        found = diagnostics(program, TOP / "runs" / "oscillating_plate", folder, settings)
        time, energy = found["time"], found["kinetic_energy"]
        turns = [k for k in range(3, len(time) - 3) if energy[k] == energy[k - 3:k + 4].min() and energy[k] < 0.2 * energy.max()]

        def turn(k):
            a, b, _ = np.polyfit(time[k - 3:k + 4] - time[k], energy[k - 3:k + 4], 2)
            return time[k] - b / (2 * a)
        return 2 * (turn(turns[1]) - turn(turns[0])) / PLATE[1] - 1, 10 * rows**2
    return rung


RUNGS = [("thin beam, closed form", "block", thin_beam)]
RUNGS += [(f"row of {count} bonds", "grains", bonded_row(count)) for count in (3, 5, 7, 10)]  # a bond is no wider than its grains
RUNGS += [(f"SPH, {rows} rows", "continuum", rock(rows)) for rows in (3, 4, 6, 8, 12)]


def measure(build):
    rows = measured(RUNGS, build / "talus")
    for row in rows:
        row["error"] = row.pop("run_out")
    return rows


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    cost = {row["rung"]: max(row["processor_seconds"], 1e-3) for row in rows}
    for row in rows:
        axes.loglog(cost[row["rung"]], abs(row["error"]), "o", color=COLOURS[row["family"]])
        axes.annotate(row["rung"], (cost[row["rung"]], abs(row["error"])), textcoords="offset points", xytext=(4, 4),
                      fontsize=7)
    cheapest = min((row for row in rows if abs(row["error"]) < WANTED), key=lambda row: cost[row["rung"]])
    swings = min((row for row in rows if row["family"] != "block" and abs(row["error"]) < WANTED),
                 key=lambda row: cost[row["rung"]])
    for row, label in ((cheapest, "cheapest"), (swings, "cheapest that moves")):
        axes.annotate(f"{label} below {WANTED:.0%}", (cost[row["rung"]], abs(row["error"])), textcoords="offset points",
                      xytext=(30, -62), fontsize=7, arrowprops={"arrowstyle": "->", "color": "#c0392b"})
    axes.axhline(WANTED, color="#c0392b", linestyle="--", linewidth=0.8)
    axes.set(xlabel="processor time [s]; the closed form at 1e-3",
             ylabel="error of the period against Timoshenko's beam", xlim=(5e-4, 2e3), ylim=(2e-4, 2))
    return figure
