"""tools/bench water: the same tank of water with Talus and with SPH of the Debian package liggghts."""
import json
import math
import re
import shutil
import statistics
import subprocess
import sys

SIDE = 60  # particles along the tank's edges of one metre
HEIGHT = 36
LAYERS = 3  # of walls of particles, which the peer has not
SMOOTHING = math.sqrt(3)  # h over the spacing: 160 partners
GRAVITY, SOUND, ALPHA = 9.81, 20.0, 0.1


def scene():
    d = 1 / SIDE
    wall, top = LAYERS * d, HEIGHT * d
    bodies = [("water", (0, 0, 0), (1, 1, top), f"spacing = {d}\nsurface = {top}\n")]
    slips = 'wall = "free_slip"\n'
    bodies.append(("floor", (-wall, -wall, -wall), (1 + wall, 1 + wall, 0), slips))
    bodies.append(("left", (-wall, -wall, 0), (0, 1 + wall, top), slips))
    bodies.append(("right", (1, -wall, 0), (1 + wall, 1 + wall, top), slips))
    bodies.append(("front", (0, -wall, 0), (1, 0, top), slips))
    bodies.append(("back", (0, 1, 0), (1, 1 + wall, top), slips))
    text = f"""[water]
sound_speed = {SOUND}
gravity = [0, 0, {-GRAVITY}]
artificial_viscosity = {ALPHA}
[run]
end_time = 1
[output]
checkpoints = 0
snapshots = 0
diagnostics = 1
"""
    for name, lower, upper, more in bodies:
        text += f'[[body]]\nname = "{name}"\nshape = "box"\nlattice = "cubic"\nlower = {list(lower)}\nupper = {list(upper)}\n{more}'
    return text


def liggghts_input(steps):
    d = 1 / SIDE
    h = SMOOTHING * d
    return f"""atom_style sph
atom_modify map array
communicate single vel yes
boundary f f f
newton off
units si
processors * * 1
lattice sc {d} origin 0.5 0.5 0.5
region all block 0 1 0 1 0 0.8 units box
create_box 1 all
region water block 0 1 0 1 0 {HEIGHT * d} units box
create_atoms 1 region water
mass 1 {1000 * d**3}
neighbor {0.1 * h} bin
neigh_modify every 1 delay 0 check yes
fix m1 all property/global speedOfSound peratomtype {SOUND}
fix m2 all property/global sl peratomtype {h}
fix m3 all property/global artViscAlpha peratomtype {ALPHA}
fix m4 all property/global artViscBeta peratomtype 0
fix m5 all property/global artViscEta scalar {0.01 * h * h}
pair_style sph/artVisc/tensCorr wendland {h} artVisc
pair_coeff * *
fix density all sph/density/continuity
set group all meso_rho 1000
fix pressure all sph/pressure Tait {1000 * SOUND**2 / 7} 1000 7
fix wx all wall/sph xplane 0 1 {0.4 * d} 1.0
fix wy all wall/sph yplane 0 1 {0.4 * d} 1.0
fix wz all wall/sph zplane 0 NULL {0.4 * d} 1.0
timestep 1e-4
fix integr all nve/sph
fix gravi all gravity {GRAVITY} vector 0.0 0.0 -1.0
set group all sphkernel wendland
thermo_style custom step atoms ke
thermo 1000000
thermo_modify lost ignore norm no
run 1
run {steps}
"""


def run(line, environment, **where):
    done = subprocess.run([str(a) for a in line], capture_output=True, text=True, stdin=subprocess.DEVNULL, env=environment, **where)
    if done.returncode != 0:
        sys.exit(done.stdout[-3000:] + done.stderr)
    return done.stdout


def talus(program, folder, environment, ranks, steps):
    out = folder / "water_out"
    shutil.rmtree(out, ignore_errors=True)
    (folder / "tank.toml").write_text(scene())
    run(["mpirun", "-n", ranks, program, "run", folder / "tank.toml", "--steps", steps, "--out", out], environment)
    result = json.loads((out / "performance.json").read_text())
    phases = result["phase_seconds"]
    return SIDE * SIDE * HEIGHT * result["steps"] / (sum(phases.values()) - phases["output"])


def liggghts(folder, environment, ranks, steps):
    script = folder / "in.water"
    script.write_text(liggghts_input(steps))
    said = run(["mpirun", "-n", ranks, "liggghts", "-in", script], environment, cwd=folder)
    seconds, done, atoms = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", said)[-1]
    return int(atoms) * int(done) / float(seconds)


def compare(program, folder, environment, options):
    found = {}
    for ranks in (1, 2):
        cases = {"talus": lambda ranks=ranks: talus(program, folder, environment, ranks, options.steps),
                 "liggghts": lambda ranks=ranks: liggghts(folder, environment, ranks, max(4, options.steps // 2))}
        rates = {name: [] for name in cases}
        for _ in range(options.rounds):
            for name, case in cases.items():
                rates[name].append(case())
        ratios = [a / b for a, b in zip(rates["talus"], rates["liggghts"])]
        for name, values in rates.items():
            print(f"peer {name} ranks {ranks} water {SIDE * SIDE * HEIGHT} rate {statistics.median(values):.4g} "
                  f"[{min(values):.4g}-{max(values):.4g}] particle-steps/s of water")
        print(f"ratio {statistics.median(ratios):.3g} [{min(ratios):.3g}-{max(ratios):.3g}] on {ranks} rank{'s'[:ranks - 1]}")
        found[f"{ranks} ranks"] = {name: statistics.median(values) for name, values in rates.items()}
        found[f"{ranks} ranks"]["ratio"] = statistics.median(ratios)
    return {"cases": found}
