#!/usr/bin/python3 -B
"""Height of the ball's centre above the floor against time: runs/penetration/depth.py OUT [BEGIN]

Rows `time height velocity`, time counted from when the ball is where the benchmark has it begin (BEGIN, default 0.1 s).
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import numpy as np  # noqa: E402
from talus_output import read_snapshot, snapshot_series  # noqa: E402

FLOOR = -0.0902431  # [m]


def main():
    begin = float(sys.argv[2]) if len(sys.argv) > 2 else 0.1
    print("time [s], height of the ball's centre above the floor [m], its vertical velocity [m/s], top of the bed above the floor [m]")
    for path, time in snapshot_series(sys.argv[1])["grains"]:
        grains = read_snapshot(path, time)
        ball = np.argmax(grains["body"])
        bed = np.delete(grains["position"][:, 2], ball)
        print(f"{grains.time - begin:.4f} {grains['position'][ball, 2] - FLOOR:.6f} {grains['velocity'][ball, 2]:.4f} "
              f"{np.quantile(bed, 0.999) - FLOOR:.4f}")


main()
