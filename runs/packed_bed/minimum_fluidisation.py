"""Velocity at which Ergun's drag bears beads in packings of a fluid fraction of 0.42, the least that fluidises them: the scene with other
fluids, beads and a fall of the pressure that is their weight less buoyancy, beside Ergun's law.

usage: minimum_fluidisation.py PROGRAM
"""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile

SCENE = pathlib.Path(__file__).parent
FLUID_FRACTION, GRAVITY, PER_EDGE = 0.42, 9.81, 12  # spacings of beads along an edge of the box
# Diameter [m], density of beads, of the fluid [kg/m3], viscosity [Pa s], greatest speed [m/s], time until the flow is steady [s].
CASES = {"3 mm, 1390 kg/m3, water": (3e-3, 1390, 1000, 1e-3, 0.2, 0.15), "1 mm, 2500 kg/m3, air": (1e-3, 2500, 1.2, 1.8e-5, 5, 0.01),
         "0.5 mm, 2500 kg/m3, air": (0.5e-3, 2500, 1.2, 1.8e-5, 5, 0.01)}


def ergun(diameter, density, viscosity, fall):
    """Superficial velocity at which Ergun's law has this fall of the pressure [Pa/m]."""
    solid, cube = 1 - FLUID_FRACTION, FLUID_FRACTION**3
    linear, square = 150 * viscosity * solid**2 / (cube * diameter**2), 1.75 * density * solid / (cube * diameter)
    return (math.sqrt(linear**2 + 4 * square * fall) - linear) / (2 * square)


def found(program, out, diameter, bead_density, density, viscosity, greatest_speed, end):
    spacing = (math.pi / 6 / (1 - FLUID_FRACTION)) ** (1 / 3) * diameter
    edge = PER_EDGE * spacing
    drive = (1 - FLUID_FRACTION) * (bead_density - density) * GRAVITY / density
    step = min(end / 500, 0.2 * edge / 5 / (10 * greatest_speed))
    settings = [f"box.upper=[{edge},{edge},{edge}]", f"water.density={density}", f"water.viscosity={viscosity}",
                f"water.greatest_speed={greatest_speed}", f"water.gravity=[{drive},0,0]", f"body[0].spacing={edge / 5}",
                f"grains[0].radius={diameter / 2}", f"grains[0].spacing={spacing}", f"materials.glass.density={bead_density}",
                f"dem.time_step={step}", f"run.end_time={end}", f"output.diagnostics={end / 4}"]
    line = [program, "run", SCENE, "--out", out] + [word for setting in settings for word in ("--set", setting)]
    subprocess.run([str(word) for word in line], check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    last = list(csv.DictReader((out / "diagnostics.csv").open()))[-1]
    return float(last["water_momentum_x [kg m s-1]"]) / (density * edge**3)


with tempfile.TemporaryDirectory() as folder:
    for case, (name, values) in enumerate(CASES.items()):
        velocity = found(sys.argv[1], pathlib.Path(folder) / str(case), *values)
        diameter, bead_density, density, viscosity = values[:4]
        law = ergun(diameter, density, viscosity, (1 - FLUID_FRACTION) * (bead_density - density) * GRAVITY)
        print(f"{name}: {velocity:.5g} m/s, Ergun {law:.5g} m/s, {100 * (velocity / law - 1):+.2f} %")
