#!/usr/bin/python3
"""Fronts of water and grains: runs/dam_break_bed/fronts.py OUT [WATER_OUT DRY_OUT]

Prints the fronts of the water and of the grains against time, of the run and of those of the water alone and the grains alone, and by how much
the energy of all grew or fell; OUT/fronts.json has when each front had gone 60 mm.
"""
import json
import pathlib
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot  # noqa: E402

GRAVITY, LENGTH, WAY = 9.81, 0.060, 0.060
FOREMOST = 8  # particles or grains whose mean is the front: one row across


def series(folder, grains):
    """Times, fronts and energies (kinetic and of gravity) of one phase."""
    rows = []
    for file in sorted(pathlib.Path(folder).glob("*_0*.hdf")):
        if ("water" in file.name) == grains and "snapshot" not in file.name:
            continue
        found = read_snapshot(file)
        if grains != ("radius" in found):
            continue
        moves = found["body"] == 0 if not grains else np.ones(found.size, bool)
        x, v, m = found["position"][moves], found["velocity"][moves], found["mass"][moves]
        energy = np.sum(m * (0.5 * np.sum(v * v, axis=1) + GRAVITY * x[:, 2]))
        rows.append((found.time, np.sort(x[:, 0])[-FOREMOST:].mean(), energy))
    return map(np.array, zip(*rows))


def main():
    folders = sys.argv[1:]
    cases = [("water", folders[0], False), ("grains", folders[0], True)]
    if len(folders) > 2:
        cases += [("water alone", folders[1], False), ("grains alone", folders[2], True)]
    figures, total = {}, 0
    for name, folder, grains in cases:
        times, fronts, energies = series(folder, grains)
        if folder == folders[0]:
            total = total + energies
        gone = fronts - LENGTH >= WAY
        figures[name] = float(np.interp(WAY, fronts - LENGTH, times)) if gone.any() else None
        print(f"{name:13}", " ".join(f"{t:.2f}:{x * 1e3:.0f}" for t, x in zip(times[::2], fronts[::2])), "s:mm")
    for name, time in figures.items():
        print(f"{name}: {WAY * 1e3:.0f} mm " + ("not gone" if time is None else f"gone after {time:.3f} s"))
    print(f"energy of both: {total[-1] / total[0]:.3f} of the first at the end, greatest rise between snapshots "
          f"{max(np.diff(total)) / total[0]:.1e}")
    (pathlib.Path(folders[0]) / "fronts.json").write_text(json.dumps(figures) + "\n")


if __name__ == "__main__":
    main()
