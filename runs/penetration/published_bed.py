#!/usr/bin/python3 -B
"""Files of the benchmark's own bed: runs/penetration/published_bed.py 25KParticles.txt

Writes beside the scene, from rows `radius x y z` [m] behind a line of names: bed.csv and published_ball.csv for
published_bed.toml, and bed.data for liggghts.in.
"""
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
BALL = {"place": (0, 0, 0.06), "radius": 0.01, "velocity": (0, 0, -5), "density": 7200}


def main():
    radius, *place = np.loadtxt(sys.argv[1], skiprows=1, max_rows=25000, unpack=True)
    grains = list(zip(*place, radius))
    (HERE / "bed.csv").write_text("".join(f"{x:.12g},{y:.12g},{z:.12g},{r:.12g}\n" for x, y, z, r in grains))
    ball = ",".join(map(str, (*BALL["place"], BALL["radius"], *BALL["velocity"])))
    (HERE / "published_ball.csv").write_text(ball + "\n")
    count = len(grains) + 1
    atoms = [f"{k} 1 {2 * r:.12g} 2500 {x:.12g} {y:.12g} {z:.12g}" for k, (x, y, z, r) in enumerate(grains, 1)]
    atoms.append(f"{count} 2 {2 * BALL['radius']} {BALL['density']} " + " ".join(map(str, BALL["place"])))
    moving = [f"{k} 0 0 0 0 0 0" for k in range(1, count)]
    moving.append(f"{count} " + " ".join(map(str, BALL["velocity"])) + " 0 0 0")
    lines = ["bed", "", f"{count} atoms", "2 atom types", "-0.05 0.05 xlo xhi", "-0.031 0.031 ylo yhi",
             "-0.0912431 0.3 zlo zhi", "", "Atoms", "", *atoms, "", "Velocities", "", *moving, ""]
    (HERE / "bed.data").write_text("\n".join(lines))


main()
