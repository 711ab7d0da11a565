"""Error against work over resolution and method, for scenes whose exact answer a column of their diagnostics holds."""
import pathlib
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from chart_runs import run_scene  # noqa: E402

TITLE = "Error against work over resolution and method"
PROGRAMS = ["talus"]
SAME = ("scene", "method", "resolution")   # what names a row
REPEATED = {"pairs": 0, "error": 1e-6}     # what any machine finds again, within so much of it
QUICK = {"Sod's tube": (80, 160), "sound wave": (16, 32), "dam break": (100, 200), "strip footing": (4,)}


def sod(formulation):
    return lambda n: ("sod_tube", [f"body[0].particles={n}", f"body[1].particles={n // 8}", f"sph.formulation={formulation}"])


def wave(formulation):
    return lambda n: ("acoustic_wave", [f"body[0].particles={n}", f"sph.formulation={formulation}",
                                        *(["sph.viscosity_alpha=0", "sph.viscosity_beta=0"] if formulation == "standard" else [])])


CASES = [  # scene, method, settings of a resolution, resolutions, the reference
    ("Sod's tube", "Godunov", sod("godunov"), (80, 160, 320, 640), "kinetic energy"),
    ("Sod's tube", "standard", sod("standard"), (80, 160, 320, 640), "kinetic energy"),
    ("sound wave", "Godunov", wave("godunov"), (16, 32, 64, 128), "kinetic energy, half of the first"),
    ("sound wave", "standard, no viscosity", wave("standard"), (16, 32, 64, 128), "kinetic energy, half of the first"),
    ("dam break", "depth-integrated", lambda n: ("dam_break", [f"release[0].particles={n}"]), (100, 200, 400, 800),
     "kinetic energy, (1/5) rho c^5 t/g with c^2 = g H"),
    ("strip footing", "Taylor-SPH", lambda n: ("strip_footing", [f"soil.spacing={1 / n}"]), (4, 8, 16), "load on half a footing"),
]


def measure(build, quick=False):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene, method, settings_of, resolutions, reference in CASES:
            for n in QUICK[scene] if quick else resolutions:
                name, settings = settings_of(n)
                found = run_scene(build / "talus", folder, name, settings)
                row = {"scene": scene, "method": method, "resolution": n, "command": f"talus run runs/{name} " + " ".join(
                    f"--set {setting}" for setting in settings)}
                if "failed" in found:
                    rows.append(row | {"failed": found["failed"]})
                else:
                    rows.append(row | {"pairs": found["pairs"], "particles": found["particles"], "steps": found["steps"],
                                       "seconds": found["seconds"], "error": found["errors"][reference]})
    return rows


def draw(rows, plt):
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    figure, panels = plt.subplots(2, len(scenes), figsize=(3.4 * len(scenes), 6), squeeze=False, layout="constrained", sharey="col")
    for column, scene in enumerate(scenes):
        for colour, method in zip(("#1f6fb2", "#c0392b"), dict.fromkeys(r["method"] for r in rows if r["scene"] == scene)):
            line = [row for row in rows if row["scene"] == scene and row["method"] == method]
            good = [row for row in line if "error" in row]
            for panel, across in zip(panels[:, column], ("pairs", "seconds")):
                panel.loglog([row[across] for row in good], [row["error"] for row in good], "o-", color=colour, label=method)
                for row in line:
                    if "failed" in row:
                        panel.plot(good[-1][across] if good else 1, 1, "x", color=colour)
        for panel, label in zip(panels[:, column], ("pairs evaluated", "seconds of the steps, one rank")):
            panel.set_xlabel(label)
            panel.legend(fontsize=7)
        panels[0, column].set_title(scene)
    for panel in panels[:, 0]:
        panel.set_ylabel("relative error of the reference figure")
    return figure
