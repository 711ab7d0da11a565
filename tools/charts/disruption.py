"""Mass of the largest remnant against the energy of the impact: runs/catastrophic_disruption with impactors of several sizes."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
TITLE = "Broken rock of 100 km radius and 1300 kg/m3 hit at 3 km/s, 45 degrees, 10 000 particles"
PROGRAMS = ["talus"]
RADII = (20, 27, 34, 40, 46, 52, 60)  # of the impactor [km]


def simulate(program, radius, folder):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    out = pathlib.Path(folder) / f"disruption_{radius}"
    subprocess.run(["mpirun", "-n", "2", program, "run", TOP / "runs/catastrophic_disruption", "--out", out,
                    "--set", "body[0].particles=10000", "--set", f"body[1].radius={radius} km"],
                   check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=environment)
    return out


def row_of(radius, out):
    first = next(csv.DictReader((out / "diagnostics.csv").open()))
    remnant = json.loads((out / "analysis.json").read_text())["remnants"][0]
    return {"impactor_radius_km": radius, "energy": float(first["kinetic_energy [J]"]) / float(first["mass [kg]"]),
            "remnant": remnant["mass_fraction"]}


def measure(build):
    with tempfile.TemporaryDirectory() as folder:
        return [row_of(radius, simulate(build / "talus", radius, folder)) for radius in RADII]


def threshold(rows):
    """Q*_RD: the energy that leaves half of the mass in one piece, between the runs on both sides of it [J/kg]."""
    for low, high in zip(rows, rows[1:]):
        if low["remnant"] >= 0.5 > high["remnant"]:
            share = (low["remnant"] - 0.5) / (low["remnant"] - high["remnant"])
            return low["energy"] + share * (high["energy"] - low["energy"])
    raise SystemExit("no run on either side of half of the mass")


def scaling_law(ratio):
    """Largest remnant for Q_R/Q*_RD: Z. M. Leinhardt, S. T. Stewart, Astrophys. J. 745 (2012) 79, eqs 5 and 44."""
    return 1 - ratio / 2 if ratio < 1.8 else 0.1 * (ratio / 1.8) ** -1.5


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.2, 4.2), layout="constrained")
    half = threshold(rows)
    energies = [k * rows[-1]["energy"] / 200 for k in range(201)]
    axes.plot([energy / 1000 for energy in energies], [scaling_law(energy / half) for energy in energies], color="#888888",
              label=f"scaling law of Leinhardt and Stewart, $Q^*_{{RD}}$ = {half / 1000:.0f} kJ/kg")
    axes.plot([row["energy"] / 1000 for row in rows], [row["remnant"] for row in rows], "o", color="#1f6fb2",
              label="friction of damaged rock")
    for row in rows:
        axes.annotate(f"{row['impactor_radius_km']} km", (row["energy"] / 1000, row["remnant"]), fontsize=7,
                      xytext=(5, 5), textcoords="offset points")
    axes.set(xlim=(0, None), ylim=(0, 1.02), xlabel="$Q_R$ [kJ/kg]", ylabel="largest remnant / all mass")
    axes.legend(fontsize=8)
    return figure
