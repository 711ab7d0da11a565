#!/usr/bin/python3
"""Run-out of columns: runs/immersed_collapse/run_out.py OUT ...

Prints, for each output folder, how far the deposit that hangs together reaches beyond the column, over the column's length, how high
it is, and when its front had gone half of the way and nine tenths of it; the same goes to OUT/run_out.json.
"""
import json
import pathlib
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot  # noqa: E402

SOLID = 0.6


def front_and_height(grains, width):
    """Where the deposit is thinner than half a diameter, and its greatest height in strips of two diameters [m]."""
    diameter = 2 * grains["radius"].max()
    strip = 2 * diameter
    counts = np.bincount((np.maximum(grains["position"][:, 0], 0) / strip).astype(int))
    heights = counts * np.pi / 6 * diameter**3 / (SOLID * strip * width)
    thin = np.flatnonzero(heights < 0.5 * diameter)
    end = thin[0] if thin.size else heights.size
    last = heights[end - 1] / max(heights[end - 2], heights[end - 1]) if end > 1 else 1
    return (end - 1 + last) * strip, heights.max()


def main():
    for folder in map(pathlib.Path, sys.argv[1:]):
        rows = []
        for file in sorted(p for p in folder.glob("*_0*.hdf") if "water" not in p.name):
            grains = read_snapshot(file)
            if "radius" not in grains:
                continue
            width = 8 * 2 * grains["radius"].max()
            rows.append((grains.time, *front_and_height(grains, width), np.linalg.norm(grains["velocity"], axis=1).mean()))
        times, fronts, heights, speeds = map(np.array, zip(*rows))
        length, way = fronts[0], fronts[-1] - fronts[0]
        reached = [times[np.argmax(fronts - length >= share * way)] for share in (0.5, 0.9)]
        figures = {"run_out": way / length, "aspect": heights[0] / length, "height": heights[-1] / length,
                   "half_way": reached[0], "nine_tenths": reached[1], "last_mean_speed": speeds[-1]}
        print(folder.name, " ".join(f"{name} {value:.3f}" for name, value in figures.items()))
        (folder / "run_out.json").write_text(json.dumps(figures) + "\n")


if __name__ == "__main__":
    main()
