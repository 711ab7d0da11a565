#!/usr/bin/python3
"""Growth of the seeded wave: runs/suspension_rayleigh_taylor/growth.py OUT [BEGIN END]

Fits a straight line to the logarithm of the water's velocity in the mode sin(k x) exp(-k |y|) between two times [s] and prints
its slope beside theory: S. Chandrasekhar, Hydrodynamic and Hydromagnetic Stability (1961), section 94, eq. 113, of two fluids of
one kinematic viscosity, and the approximation sqrt(A g k + nu^2 k^4) - nu k^2. The slope goes to OUT/growth.json.
"""
import json
import pathlib
import sys

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot  # noqa: E402

GRAVITY, LIQUID, GLASS, FRACTION, VISCOSITY, LENGTH = 9.81, 1150.0, 2500.0, 0.2, 0.2, 0.024
BEGIN, END = 0.14, 0.34


def exact(atwood, k, nu):
    product = (1 - atwood**2) / 4
    drive = GRAVITY * atwood / (k**3 * nu**2)
    roots = np.roots([1, 4 * product, 2 * (1 - 6 * product), -4 * (1 - 3 * product), 1 - 4 * product - drive])
    y = max(root.real for root in roots if abs(root.imag) < 1e-9)
    return (y * y - 1) * nu * k * k


def main():
    begin, end = map(float, sys.argv[2:4]) if len(sys.argv) > 3 else (BEGIN, END)
    k, mixture = 2 * np.pi / LENGTH, LIQUID + FRACTION * (GLASS - LIQUID)
    atwood, nu = (mixture - LIQUID) / (mixture + LIQUID), 2 * VISCOSITY / (mixture + LIQUID)
    times, logs = [], []
    for file in sorted(pathlib.Path(sys.argv[1]).glob("water_0*.hdf")):
        water = read_snapshot(file)
        if not begin <= water.time <= end:
            continue
        x, y = water["position"][:, 0], water["position"][:, 1]
        mode = np.sin(k * x) * np.exp(-k * np.abs(y))
        mass = water["mass"]
        times.append(water.time)
        logs.append(np.log(np.sum(mass * mode * water["velocity"][:, 1]) / np.sum(mass * mode**2)))
    rate, theory = np.polyfit(times, logs, 1)[0], exact(atwood, k, nu)
    approximate = np.sqrt(atwood * GRAVITY * k + nu**2 * k**4) - nu * k**2
    print(f"growth rate {rate:.3f} /s from {times[0]:.3f} to {times[-1]:.3f} s")
    print(f"theory {theory:.3f} /s ({rate / theory - 1:+.1%}), its approximation {approximate:.3f} /s "
          f"({rate / approximate - 1:+.1%})")
    (pathlib.Path(sys.argv[1]) / "growth.json").write_text(json.dumps({"rate": rate}) + "\n")


if __name__ == "__main__":
    main()
