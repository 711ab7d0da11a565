#!/usr/bin/python3
"""Wave and front of a slide: runs/slide_wave/wave.py OUT

Prints the speed of the grains' front at the height of the still water, over the speed of long waves, and the greatest
height of the wave ahead of the grains, over the depth, beside what a vertical piston of that speed pushes up; how fast the crest travels once it is
free of the grains, beside a solitary wave of its height; the same goes to OUT/wave.json.
"""
import json
import pathlib
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot, snapshot_series  # noqa: E402

GRAVITY, DENSITY = 9.81, 1000.0
FREE = (0.5, 0.8)  # when the wave is ahead of the grains and not yet at the far wall [s]
WIDTH = 4  # of the strips over which heights are means, one beside each half of the other [spacings]


def bore(froude):
    """Height over depth behind a bore ahead of a piston: mass and momentum across the jump."""
    a = np.linspace(0, 5, 50001)
    return np.interp(froude, a * np.sqrt((2 + a) / (2 * (1 + a))), a)


def solitary(froude):
    """Height over depth of a solitary wave whose crest moves as fast as a piston."""
    return froude * (0.5 * froude + np.sqrt(1 + 0.25 * froude**2))


def measure(folder):
    names = [sorted(pathlib.Path(folder).glob(f"{kind}_0*.hdf")) for kind in ("water", "grains")]
    times, fronts, levels, crests, places = [], [], [], [], []
    for water_file, grain_file in zip(*names):
        water, grains = read_snapshot(water_file), read_snapshot(grain_file)
        fluid = water["body"] == 0
        x, z, mass = water["position"][fluid, 0], water["position"][fluid, 2], water["mass"][fluid]
        if not times:
            spacing = 2 * z.min()
            depth = z.max() + 0.5 * spacing
            width = np.unique(np.round(water["position"][fluid, 1], 9)).size * spacing
        grain, radius = grains["position"], grains["radius"].max()
        level = grain[np.abs(grain[:, 2] - depth) < 2 * radius, 0]
        times.append(water.time)
        levels.append(np.sort(level)[-5:].mean() if level.size > 10 else np.nan)
        fronts.append(np.sort(grain[:, 0])[-10:].mean())
        half = 0.5 * WIDTH * spacing
        halves = np.bincount((x / half).astype(int), mass) / (DENSITY * half * width)
        heights, middle = 0.5 * (halves[1:] + halves[:-1]), np.arange(1, halves.size) * half
        ahead = middle > fronts[-1] + half
        crests.append((heights[ahead].max() - depth) / depth if ahead.any() else np.nan)
        places.append(crest_place(middle[ahead], heights[ahead] - depth))
    return depth, *map(np.array, (times, levels, fronts, crests, places))


def crest_place(middle, excess):
    """Mean place of what is higher than half of the crest, near the crest."""
    top = np.argmax(excess)
    near = (excess > 0.5 * excess[top]) & (np.abs(middle - middle[top]) < 0.2)
    return np.average(middle[near], weights=excess[near])


def main():
    depth, times, levels, fronts, crests, places = measure(sys.argv[1])
    speeds = np.gradient(levels, times)
    if "-v" in sys.argv:
        for row in zip(times, levels, speeds, fronts, crests):
            print("t %.3f  level front %.4f m  speed %.3f m/s  toe %.4f m  crest/h0 %.3f" % row)
    froude = np.nanmax(speeds) / np.sqrt(GRAVITY * depth)
    print(f"depth {depth:.4f} m; front at its height: up to {np.nanmax(speeds):.3f} m/s, Froude number {froude:.3f}")
    print(f"wave: {np.nanmax(crests):.3f} of the depth; bore of a piston {bore(froude):.3f}, "
          f"solitary wave {solitary(froude):.3f}")
    free = (times >= FREE[0] - 1e-6) & (times <= FREE[1] + 1e-6)
    if free.sum() > 2:
        speed, height = np.polyfit(times[free], places[free], 1)[0], crests[free].mean()
        print(f"crest from {FREE[0]} to {FREE[1]} s: {height:.3f} of the depth, {speed:.3f} m/s; solitary wave of that height "
              f"{np.sqrt(GRAVITY * depth * (1 + height)):.3f} m/s")
    height = np.nanmax(crests)
    figures = {"froude": froude, "height": height, "height_over_pistons": 2 * height / (bore(froude) + solitary(froude))}
    (pathlib.Path(sys.argv[1]) / "wave.json").write_text(json.dumps(figures) + "\n")


if __name__ == "__main__":
    main()
