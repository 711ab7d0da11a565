"""tools/bench grains: runs/chute, developed, on the same grains with Talus and with the Debian packages lammps and liggghts."""
import json
import re
import shutil
import statistics
import subprocess
import sys

import h5py
import numpy as np

DEVELOP = ["dem.time_step='8e-6 s'", "output.snapshots=0", "output.diagnostics=1", "output.checkpoints=0"]
WARM = 60  # steps before the measured ones
WIDTHS = {1: (0.08, 0.04), 8: (0.16, 0.16)}  # along x and y: the scene's box, and one of eight times the area [m]
HEIGHT = 0.2

# Hertz and Mindlin with history. `granular` has the same law as Talus and LIGGGHTS (its damping is stated by another
# number: sqrt(5) B(0.6) = alpha(0.48113)), `gran/hertz/history` is cheaper: no damping that follows from a restitution.
LAMMPS_STYLES = {
    "lammps": ["pair_style granular",
               "pair_coeff * * hertz/material 1e8 0.48113234 0.3 tangential mindlin NULL 0.90748521 0.5 damping tsuji"],
    "lammps_cheaper": ["pair_style gran/hertz/history 73260073 90497738 1.8e8 1.63e8 0.5 1", "pair_coeff * *"],
}
MOTION = """timestep 3e-6
group bed type 1
group flow type 2
neigh_modify exclude group bed bed
fix pull all gravity 9.81 chute 24
fix hold bed freeze
fix move flow nve/sphere
thermo 1000000
"""


def lammps_input(name, data, skin, steps):
    return "\n".join(["units si", "atom_style sphere", "boundary p p f", "newton off", "comm_modify vel yes",
                      "processors * * 1", f"read_data {data}", *LAMMPS_STYLES[name], f"neighbor {skin} bin",
                      "neigh_modify every 1 delay 0 check yes", MOTION, f"run {WARM}", f"run {steps}", ""])


def liggghts_input(data, skin, steps):
    pairs = "0.6 0.6 0.6 0.6", "0.5 0.5 0.5 0.5"
    return "\n".join(["atom_style granular", "atom_modify map array", "boundary p p f", "newton off",
                      "communicate single vel yes", "units si", "processors * * 1", f"read_data {data}",
                      f"neighbor {skin} bin", "neigh_modify every 1 delay 0 check yes",
                      "fix m1 all property/global youngsModulus peratomtype 1e8 1e8",
                      "fix m2 all property/global poissonsRatio peratomtype 0.3 0.3",
                      f"fix m3 all property/global coefficientRestitution peratomtypepair 2 {pairs[0]}",
                      f"fix m4 all property/global coefficientFriction peratomtypepair 2 {pairs[1]}",
                      "pair_style gran model hertz tangential history", "pair_coeff * *", MOTION, f"run {WARM}",
                      f"run {steps}", ""])


def wider(times):
    """Settings that make the scene so many times as wide."""
    x, y = WIDTHS[times]
    return [f"box.upper=[{x}, {y}, {HEIGHT}]", f"grains[0].upper=[{x}, {y}, 0.0042]", f"grains[1].upper=[{x}, {y}, 0.1037]"]


def write_data(checkpoint, file, times):
    """The grains of a checkpoint as LAMMPS reads them; type 1 is the bed."""
    with h5py.File(checkpoint) as source:
        grains = source["sets/grains"]
        fields = {name: np.array(grains[name]) for name in ("position", "velocity", "angular_velocity", "radius", "body")}
    place = fields["position"]
    order = np.lexsort((place[:, 0] // 4e-3, place[:, 1] // 4e-3, place[:, 2] // 4e-3))  # as good for them as for us
    with open(file, "w") as out:
        out.write(f"chute\n\n{len(place)} atoms\n2 atom types\n\n")
        out.writelines(f"0 {length} {axis}lo {axis}hi\n" for axis, length in zip("xyz", (*WIDTHS[times], HEIGHT)))
        out.write("\nAtoms\n\n")
        for k, i in enumerate(order):
            out.write(f"{k + 1} {fields['body'][i] + 1} {2 * fields['radius'][i]} 2500 {' '.join(map(repr, place[i].tolist()))}\n")
        out.write("\nVelocities\n\n")
        for k, i in enumerate(order):
            out.write(f"{k + 1} {' '.join(repr(v) for v in [*fields['velocity'][i].tolist(), *fields['angular_velocity'][i].tolist()])}\n")
    return len(place)


def run(line, environment, **where):
    done = subprocess.run([str(a) for a in line], capture_output=True, text=True, stdin=subprocess.DEVNULL, env=environment, **where)
    if done.returncode != 0:
        sys.exit(done.stdout[-3000:] + done.stderr)
    return done.stdout


class Peers:
    def __init__(self, program, scene, folder, environment, options, times):
        self.program, self.scene, self.folder, self.environment, self.steps = program, scene, folder, environment, options.steps
        self.state = folder / f"developed_{times}"
        self.wider = [word for setting in wider(times) for word in ("--set", setting)]
        settings = self.wider + [word for setting in DEVELOP for word in ("--set", setting)]
        self.run_talus(1, ["--steps", options.develop, "--out", self.state, *settings])
        checkpoint = max(self.state.glob("checkpoint_*.h5"))
        self.first_step = int(checkpoint.stem.split("_")[1])
        self.grains = write_data(checkpoint, folder / "chute.data", times)

    def run_talus(self, ranks, arguments):
        return run(["mpirun", "-n", ranks, self.program, "run", self.scene, *arguments], self.environment)

    def talus(self, ranks):
        out = self.folder / "run"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(self.state, out)
        quiet = [*self.wider, "--set", "output.snapshots=0", "--set", "output.diagnostics=1", "--set", "output.checkpoints=0", "--out", out,
                 "--restart", "latest", "--steps"]
        self.run_talus(ranks, [*quiet, self.first_step + WARM])
        self.run_talus(ranks, [*quiet, self.first_step + WARM + self.steps])
        result = json.loads((out / "performance.json").read_text())
        phases = result["phase_seconds"]
        return result["particles"] * result["steps"] / (sum(phases.values()) - phases["output"])

    def peer(self, name, ranks):
        data = self.folder / "chute.data"
        text = liggghts_input(data, 2e-4, self.steps) if name == "liggghts" else lammps_input(name, data, 3e-4, self.steps)
        script = self.folder / f"in.{name}"
        script.write_text(text)
        said = run(["mpirun", "-n", ranks, "liggghts" if name == "liggghts" else "lmp", "-in", script], self.environment,
                   cwd=self.folder)
        loops = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", said)
        seconds, steps, atoms = loops[-1]
        return int(atoms) * int(steps) / float(seconds)


def compare(program, scene, folder, environment, options):
    found = {}
    for times in options.times:
        peers = Peers(program, scene, folder, environment, options, times)
        for ranks in (1, 2):
            found.update(compare_on(ranks, peers, options))
    return {"cases": found}


def compare_on(ranks, peers, options):
    cases = {"talus": lambda: peers.talus(ranks)}
    for name in (*LAMMPS_STYLES, "liggghts"):
        cases[name] = lambda name=name: peers.peer(name, ranks)
    rates = {name: [] for name in cases}
    for _ in range(options.rounds):
        for name, case in cases.items():
            rates[name].append(case())
    medians = {name: statistics.median(values) for name, values in rates.items()}
    for name, rate in medians.items():
        print(f"peer {name} ranks {ranks} grains {peers.grains} rate {rate:.4g}")
    print(f"ratio {medians['talus'] / max(medians['lammps'], medians['liggghts']):.3g}")
    return {f"{name}, {ranks} ranks, {peers.grains} grains": rate for name, rate in medians.items()}
