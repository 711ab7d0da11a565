#!/usr/bin/python3
"""Compares the gauges of a run with what was measured, as a table in Markdown.

usage: compare.py RUN_FOLDER [OBSERVATIONS.csv]

OBSERVATIONS is malpasset/observations.csv in the folder TALUS_DATA unless it is given. A flood has arrived at a gauge once it is
0.1 m deep there.
"""

import csv
import math
import os
import sys

ARRIVED = 0.1  # m


def observations(path):
    with open(path) as file:
        rows = csv.reader(line for line in file if line.strip() and not line.startswith("#"))
        for kind, name, _, _, level, _, arrival in rows:
            yield kind, name, float(level) if level else None, float(arrival) if arrival else None


def columns(path):
    with open(path) as file:
        rows = list(csv.reader(file))
    names = [name.split(" ")[0] for name in rows[0]]
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(names)}


def arrival(run, name):
    """First time with more than ARRIVED, None if the flood never came."""
    return next((t for t, depth in zip(run["time"], run[f"depth_{name}"]) if depth > ARRIVED), None)


def root_mean_square(values):
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else math.nan


def text(value):
    return "-" if value is None else f"{value:.1f}"


def main():
    folder = sys.argv[1]
    default = os.path.join(os.environ.get("TALUS_DATA", "."), "malpasset", "observations.csv")
    measured = list(observations(sys.argv[2] if len(sys.argv) > 2 else default))
    run = columns(os.path.join(folder, "diagnostics.csv"))
    print("| gauge | level measured [m] | computed | arrival measured [s] | computed |\n|---|---|---|---|---|")
    levels, arrivals, came = {"police": [], "model": []}, [], {}
    for kind, name, level, time in measured:
        came[name] = arrival(run, name)
        computed = max(run[f"level_{name}"]) if came[name] is not None else None
        print(f"| {name} | {text(level)} | {text(computed)} | {text(time)} | {text(came[name])} |")
        if level is not None and computed is not None:
            levels[kind].append(computed - level)
        if time is not None and came[name] is not None:
            arrivals.append(came[name] - time)
    for kind, differences in levels.items():
        count = sum(1 for k, _, level, _ in measured if k == kind and level is not None)
        print(f"\nlevels, {kind}: root mean square {root_mean_square(differences):.2f} m, mean "
              f"{sum(differences) / max(1, len(differences)):.2f} m, {len(differences)} of {count} gauges wet")
    print(f"\narrival, model: root mean square {root_mean_square(arrivals):.0f} s, {len(arrivals)} gauges")
    for name, lag in (("B", 1140), ("C", 1320)):
        if came["A"] is not None and came[name] is not None:
            print(f"\ntransformers A to {name}: {came[name] - came['A']:.0f} s (measured {lag} s)")


if __name__ == "__main__":
    main()
