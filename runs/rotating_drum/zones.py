#!/usr/bin/python3 -B
"""Grains of each kind in two quarters of the drum against time: runs/rotating_drum/zones.py OUT [STARTED_AT]

Zone 1 is x > 0, z > 0, zone 2 is x < 0, z < 0, of the centres of grains. Prints rows `time M1_zone_1 M2_zone_1 M1_zone_2
M2_zone_2`, time counted from where the drum begins to turn (STARTED_AT, default 0.4 s); or, for a list of places with rows
`radius x y z`, one row for it.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import numpy as np  # noqa: E402
from talus_output import read_snapshot, snapshot_series  # noqa: E402


def counts(place, small):
    x, z = place[:, 0], place[:, 2]
    return [int(np.sum(zone & kind)) for zone in ((x > 0) & (z > 0), (x < 0) & (z < 0)) for kind in (small, ~small)]


def main():
    out = pathlib.Path(sys.argv[1])
    begin = float(sys.argv[2]) if len(sys.argv) > 2 else 0.4
    print("time [s], M1 and M2 in zone 1, M1 and M2 in zone 2")
    if out.is_file():
        radius, *place = np.loadtxt(out, skiprows=1, usecols=range(4), unpack=True)
        print("start", *counts(np.column_stack(place), radius < 1.5e-3))
        return
    for path, time in snapshot_series(out)["grains"]:
        grains = read_snapshot(path, time)
        print(f"{grains.time - begin:.3f}", *counts(grains["position"], grains["body"] == 1))


main()
