#!/usr/bin/python3 -B
"""runs/rubble_pile/spin_up.py PILE [--to FOLDER] [--steps N] [--set KEY=VALUE ...]

Turns the pile that a run of runs/rubble_pile left in PILE faster by a twentieth of the spin at which a sphere of its mass and
density loses grains from its equator, lets it go on (spin_up.toml), and again, until a tenth of its mass has left it or N times
(30). A row each goes to FOLDER/spin_up.csv, a picture of them to FOLDER/spin_up.png; FOLDER: PILE_spun.
"""
import argparse
import csv
import math
import os
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
import numpy as np  # noqa: E402
from talus_output import read_snapshot, snapshot_series  # noqa: E402

G = 6.67430e-11
SHED = 0.1       # share of the mass at which it is over
INCREMENT = 0.05  # of the critical spin of the first pile
GAP = 0.1        # of the mean radius: grains that are closer hang together


def last_grains(folder):
    return read_snapshot(*snapshot_series(folder)["grains"][-1])


def largest_piece(grains):
    """Mask of the grains of the largest heap."""
    x, r = grains["position"], grains["radius"]
    apart = np.linalg.norm(x[:, None] - x[None], axis=2)
    near = apart < r[:, None] + r[None] + GAP * r.mean()
    label = np.full(len(r), -1)
    for first in range(len(r)):
        front = [first] if label[first] < 0 else []
        while front:
            i = front.pop()
            if label[i] >= 0:
                continue
            label[i] = first
            front.extend(np.flatnonzero(near[i] & (label < 0)))
    mass = np.bincount(label, weights=grains["mass"])
    return label == mass.argmax()


def describe(grains):
    """What a row of spin_up.csv says."""
    piece = largest_piece(grains)
    m, r = grains["mass"][piece], grains["radius"][piece]
    mass = m.sum()
    x = grains["position"][piece] - m @ grains["position"][piece] / mass
    v = grains["velocity"][piece] - m @ grains["velocity"][piece] / mass
    own = 0.4 * m * r * r
    second = (x * m[:, None]).T @ x + np.eye(3) * own.sum() / 2  # of mass, about the centre
    inertia = np.eye(3) * np.trace(second) - second
    turning = (m[:, None] * np.cross(x, v)).sum(0) + (own[:, None] * grains["angular_velocity"][piece]).sum(0)
    spin = np.linalg.norm(np.linalg.solve(inertia, turning))
    axes = np.sqrt(5 * np.sort(np.linalg.eigvalsh(second))[::-1] / mass)  # of the ellipsoid of equal inertia
    density = mass / (4 / 3 * math.pi * axes.prod())
    return {"mass_left": mass / grains["mass"].sum(), "angular_momentum": np.linalg.norm(turning), "spin": spin,
            "period_h": 2 * math.pi / spin / 3600, "density": density, "a": axes[0], "b_over_a": axes[1] / axes[0],
            "c_over_a": axes[2] / axes[0], "spin_squared": spin**2 / (math.pi * G * density),
            "of_critical": spin / math.sqrt(4 / 3 * math.pi * G * density)}


def run(folder, before, spin, options):
    program = os.environ.get("TALUS", TOP / "build" / "release" / "talus")
    command = [program, "run", TOP / "runs" / "rubble_pile" / "spin_up.toml", "--out", folder,
               "--set", f"grains[0].file={before.resolve()}", "--set", f"grains[0].spin=[0, 0, {spin}]"]
    command += [word for option in options for word in ("--set", option)]
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout}")


def maclaurin(c_over_a):
    """spin^2/(pi G rho) of the fluid spheroid of this axis ratio."""
    e = math.sqrt(1 - c_over_a**2)
    return 2 * c_over_a / e**3 * (3 - 2 * e * e) * math.asin(e) - 6 / e**2 * (1 - e * e)


def draw(rows, first, file):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, (shape, left, views) = plt.subplots(1, 3, figsize=(12, 3.6))
    spin2 = [row["spin_squared"] for row in rows]
    shape.plot(spin2, [row["c_over_a"] for row in rows], "o-", ms=4, label="pile, c/a")
    shape.plot(spin2, [row["b_over_a"] for row in rows], "s-", ms=4, label="pile, b/a")
    ratios = np.linspace(0.3, 0.999, 200)
    shape.plot([maclaurin(ratio) for ratio in ratios], ratios, "k--", lw=1, label="fluid spheroid, c/a")
    shape.axvline(4 / 3, color="grey", lw=1)
    shape.text(4 / 3, 0.35, " sphere's equator\n weightless", fontsize=7)
    shape.set(xlabel=r"$\omega^2/\pi G\rho$", ylabel="axis ratio", xlim=(0, 1.75), ylim=(0.3, 1.02))
    shape.legend(fontsize=7, loc="lower left")
    turning = [row["angular_momentum"] / 1e12 for row in rows]
    left.plot(turning, [row["of_critical"] for row in rows], "o-", ms=4, label=r"$\omega/\omega_c$")
    left.plot(turning, [1 - row["mass_left"] for row in rows], "s-", ms=4, label="share of mass shed")
    left.set(xlabel=r"angular momentum of the pile [$10^{12}$ kg m$^2$/s]", ylim=(0, 1.1))
    left.legend(fontsize=7)
    for grains, shift in ((first[0], -1), (first[1], 1)):
        piece = largest_piece(grains)
        x = grains["position"][piece] - np.median(grains["position"][piece], axis=0)
        for place, radius in sorted(zip(x, grains["radius"][piece]), key=lambda one: one[0][1]):
            views.add_patch(plt.Circle((place[0] + shift * 900, place[2]), radius, fc="tan", ec="k", lw=0.2))
    views.set(xlim=(-2000, 2000), ylim=(-1200, 1200), aspect="equal", title="before and after, from the side [m]")
    figure.tight_layout()
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("pile", type=pathlib.Path)
    parser.add_argument("--to", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=30)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    folder = options.to or options.pile.with_name(options.pile.name + "_spun")
    folder.mkdir(parents=True, exist_ok=True)
    first = last_grains(options.pile)
    rows, before = [describe(first)], options.pile
    increment = INCREMENT * math.sqrt(4 / 3 * math.pi * G * rows[0]["density"])
    print(", ".join(rows[0]))
    while len(rows) <= options.steps and rows[-1]["mass_left"] > 1 - SHED:
        after = folder / f"{len(rows):02}"
        run(after, before, increment, options.set)
        before = after
        rows.append(describe(last_grains(after)))
        print(", ".join(f"{value:.4g}" for value in rows[-1].values()), flush=True)
    with open(folder / "spin_up.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(rows)
    draw(rows, (first, last_grains(before)), folder / "spin_up.png")
    print(folder / "spin_up.png")


if __name__ == "__main__":
    main()
