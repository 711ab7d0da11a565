"""Error against pairs over the kernel and its width, standard SPH."""
import pathlib
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from chart_runs import run_scene  # noqa: E402

TITLE = "A sound wave in the plane, standard SPH: kernels and numbers of partners"
PROGRAMS = ["talus"]
SAME = ("kernel", "eta")
REPEATED = {"pairs": 0, "error": 1e-6}
KERNELS = ("cubic_spline", "wendland_c2", "wendland_c4", "wendland_c6")
WIDTHS = (1.0, 1.2, 1.5, 1.8, 2.2, 2.7)
QUICK = (1.2,)
PLANE = ["dimension=2", 'box.boundaries=["periodic","periodic"]', "box.lower=[0,0]", "box.upper=[1,0.5]",
         "body[0].velocity_field={kind=\"sine\", amplitude=[1e-5,0], wave_vector=[6.283185307179586,0]}",
         "body[0].particles=2048", "reference[0].value=6.25e-12", "sph.formulation=standard", "sph.viscosity_alpha=0",
         "sph.viscosity_beta=0", "sph.smoothing_length=constant", "sph.courant=0.2"]


def measure(build, quick=False):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for kernel in KERNELS:
            for eta in QUICK if quick else WIDTHS:
                found = run_scene(build / "talus", folder, "acoustic_wave", [*PLANE, f"sph.kernel={kernel}", f"sph.eta={eta}"])
                row = {"kernel": kernel, "eta": eta}
                rows.append(row | ({"failed": found["failed"]} if "failed" in found else {
                    "partners": round(found["pairs"] / found["steps"] / found["particles"], 2), "pairs": found["pairs"],
                    "steps": found["steps"], "seconds": found["seconds"],
                    "error": found["errors"]["kinetic energy, half of the first"]}))
    return rows


def draw(rows, plt):
    figure, (partners, pairs) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for colour, kernel in zip(("#c0392b", "#1f6fb2", "#5a9e5a", "#d98e04"), KERNELS):
        line = [row for row in rows if row["kernel"] == kernel and "error" in row]
        for panel, across in ((partners, "partners"), (pairs, "pairs")):
            panel.loglog([row[across] for row in line], [row["error"] for row in line], "o-", color=colour,
                         label=kernel.replace("_", " "))
    partners.set(xlabel="partners of a particle", ylabel="relative error of the kinetic energy at 1.125 periods")
    pairs.set(xlabel="pairs evaluated")
    partners.legend(fontsize=7)
    return figure
