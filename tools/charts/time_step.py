"""Error against the time step over the factor of the time step, up to the wall where waves grow."""
import pathlib
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from chart_runs import run_scene  # noqa: E402

TITLE = "A sound wave of 64 particles: error against the factor of the time step"
PROGRAMS = ["talus"]
SAME = ("formulation", "courant")
REPEATED = {"steps": 0, "error": 1e-6}
FACTORS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2)
QUICK = (0.5, 1.2)
METHODS = {"standard": ["sph.viscosity_alpha=0", "sph.viscosity_beta=0"], "godunov": []}


def measure(build, quick=False):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for formulation, settings in METHODS.items():
            for courant in QUICK if quick else FACTORS:
                found = run_scene(build / "talus", folder, "acoustic_wave", [
                    "body[0].particles=64", f"sph.formulation={formulation}", f"sph.courant={courant}", *settings], until=10.2)
                row = {"formulation": formulation, "courant": courant}
                rows.append(row | ({"failed": found["failed"]} if "failed" in found else {
                    "steps": found["steps"], "pairs": found["pairs"], "error": found["errors"]["kinetic energy, half of the first"]}))
    return rows


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.5, 4), layout="constrained")
    for colour, formulation in zip(("#c0392b", "#1f6fb2"), METHODS):
        line = [row for row in rows if row["formulation"] == formulation]
        good = [row for row in line if row.get("error", 1) < 1]
        axes.loglog([row["courant"] for row in good], [row["error"] for row in good], "o-", color=colour, label=formulation)
        bad = [row["courant"] for row in line if row.get("error", 1) >= 1]
        axes.plot(bad, [1] * len(bad), "x", color=colour, markersize=7)
        if bad and good:
            axes.axvspan(good[-1]["courant"], bad[0], color=colour, alpha=0.12, linewidth=0)
    axes.set(xlabel="factor C of the time step, dt = C h/c", ylabel="relative error of the kinetic energy at 1.125 periods",
             title="crosses: the wave blows up within ten periods; shaded: where the wall lies")
    axes.legend()
    return figure
