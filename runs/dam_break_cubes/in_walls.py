#!/usr/bin/python3
"""Water inside of walls and cubes: runs/dam_break_cubes/in_walls.py OUT

Prints, of all snapshots, how many particles of water are behind the faces of the tank and of the cubes, how deep, and how near others come
to the tank's faces; and the cubes' speeds at two times. To look often: tools/run runs/dam_break_cubes --set output.snapshots=0.01
"""
import csv
import pathlib
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot  # noqa: E402

LOWER, UPPER, RIM = np.array([0, 0, 0]), np.array([1.6, 0.4, np.inf]), 0.6  # of the tank [m]
SPACING, HALF, CUBES = 0.02, 0.08, {6: "left", 7: "right", 8: "upper"}      # [m], [m], by body
TIMES = (0.45, 0.75)                                                        # of speeds [s]


def places(snapshot, body):
    """In order of ids."""
    chosen = snapshot["body"] == body
    return snapshot["position"][chosen][np.argsort(snapshot["id"][chosen])]


def seen_from(begin, now, points):
    """Points as the body sees them that was at `begin` and is at `now`: W. Kabsch, Acta Cryst. A32 (1976) 922."""
    left, _, right = np.linalg.svd((begin - begin.mean(0)).T @ (now - now.mean(0)))
    turn = left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right))]) @ right
    return (points - now.mean(0)) @ turn.T


def depths_in_cubes(first, now):
    """Of the water below the faces of the cubes, of each particle the greatest [m]; `first`: the snapshot of time 0."""
    water = places(now, 0)
    return np.max([HALF - abs(seen_from(places(first, b), places(now, b), water)).max(1) for b in CUBES], 0)


def main():
    out = pathlib.Path(sys.argv[1])
    files = sorted(out.glob("water_0*.hdf"))
    first = read_snapshot(files[0])
    found = {"tank": (0, -np.inf), "cubes": (0, -np.inf)}  # most at a time, greatest depth [m]
    for file in files:
        snapshot = read_snapshot(file)
        water = places(snapshot, 0)
        behind = np.maximum(LOWER - water, water - UPPER).max(1)[water[:, 2] < RIM]
        for name, depth in (("tank", behind), ("cubes", depths_in_cubes(first, snapshot))):
            count, deepest = found[name]
            found[name] = max(count, int((depth > 0).sum())), max(deepest, depth.max())
    for name, (count, deepest) in found.items():
        print(f"{name}: at most {count} of {len(places(first, 0))} particles inside, "
              f"{'deepest' if deepest > 0 else 'nearest'} {1000 * abs(deepest):.2f} mm, {abs(deepest) / SPACING:.2f} spacings, "
              f"{'behind' if deepest > 0 else 'before'} a face, of {len(files)} snapshots")
    with open(out / "diagnostics.csv") as table:
        rows = list(csv.DictReader(line for line in table if not line.startswith("#")))
    times = np.array([float(row["time [s]"]) for row in rows])
    for time in TIMES:
        row = rows[int(abs(times - time).argmin())]
        speeds = [np.hypot.reduce([float(row[f"{name} cube_velocity_{axis} [m s-1]"]) for axis in "xyz"]) for name in CUBES.values()]
        print(f"at {float(row['time [s]']):.3f} s: " + ", ".join(f"{name} {speed:.2f} m/s" for name, speed in zip(CUBES.values(), speeds)))


if __name__ == "__main__":
    main()
