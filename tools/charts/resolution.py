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
ROUNDS = 3                                 # the least time counts; rounds of all runs, so that a busy moment meets them all alike
ACROSS = 7                                 # scenes side by side


def shock_tube(formulation):
    return lambda n: ("sod_tube", [f"body[0].particles={n}", f"body[1].particles={n // 8}", f"sph.formulation={formulation}"])


def sound(formulation):
    return lambda n: ("acoustic_wave", [f"body[0].particles={n}", f"sph.formulation={formulation}",
                                        *(["sph.viscosity_alpha=0", "sph.viscosity_beta=0"] if formulation == "standard" else [])])


def wall_shock(formulation):
    return lambda n: ("wall_shock", [f"body[0].particles={n}", f"sph.formulation={formulation}"])


def impact(order):
    return lambda n: ("planar_impact", [f"body[0].particles={n}", f"body[1].particles={n}", f"sph.order={order}"])


def vortices(shifting):
    return lambda n: ("taylor_green", [f"body[0].spacing={1 / n}", f"water.shifting={shifting}"])


def between_plates(scene, length):
    return lambda n: (scene, [f"body[0].spacing={1 / n}", f"body[1].lower=[0,{-4 / n}]", f"body[2].upper=[{length},{1 + 4 / n}]"])


def standing_wave(n):
    return "standing_wave", [f"body[0].spacing={0.25 / n}", f"body[1].lower=[0,{-1 / n}]", "run.end_time=0.5"]


def bar(courant):
    return lambda n: ("bar_sudden_load", [f"soil.spacing={1 / n}", f"soil.courant={courant}", "output.diagnostics=0.0001"])


# Scene, method, scene and settings of a resolution, resolutions, those that --quick repeats, the reference.
CASES = [
    ("Sod's tube", "Godunov", shock_tube("godunov"), (80, 160, 320, 640), (80,), "kinetic energy"),
    ("Sod's tube", "standard", shock_tube("standard"), (80, 160, 320, 640), (80,), "kinetic energy"),
    ("sound wave", "Godunov", sound("godunov"), (16, 32, 64, 128), (16,), "kinetic energy, half of the first"),
    ("sound wave", "standard, no viscosity", sound("standard"), (16, 32, 64, 128), (16,), "kinetic energy, half of the first"),
    ("shock at a wall", "Godunov", wall_shock("godunov"), (50, 100, 200, 400), (50,), "kinetic energy, that of the gas not yet shocked"),
    ("shock at a wall", "standard", wall_shock("standard"), (50, 100, 200, 400), (50,), "kinetic energy, that of the gas not yet shocked"),
    ("planar impact", "Godunov, second order", impact(2), (75, 150, 300, 600), (75,), "kinetic energy of what the shocks have not reached"),
    ("planar impact", "first order", impact(1), (75, 150, 300, 600), (75,), "kinetic energy of what the shocks have not reached"),
    ("cold collapse", "standard, self-gravity", lambda n: ("evrard", [f"body[0].particles={n}", "run.end_time=0.61"]), (1000, 4000, 16000), (),
     "potential energy at 0.6"),
    ("Maclaurin spheroid", "Godunov, self-gravity", lambda n: ("maclaurin_spheroid", [f"body[0].particles={n}", "run.end_time=4"]),
     (500, 1000, 2000, 4000), (), "potential energy"),
    ("vortices", "water, shifting 1", vortices(1), (25, 50, 100), (), "kinetic energy, rho U^2 L^2/4 exp(-16 pi^2 nu t/L^2)"),
    ("vortices", "shifting 0", vortices(0), (25, 50, 100), (), "kinetic energy, rho U^2 L^2/4 exp(-16 pi^2 nu t/L^2)"),
    ("flow between plates", "water", between_plates("poiseuille", 0.4), (10, 20, 40), (10,), "kinetic energy, nearly steady"),
    ("flow between plates", "Bingham", between_plates("bingham_channel", 0.3), (15, 20, 30), (), "kinetic energy of the steady flow"),
    ("standing wave", "water", standing_wave, (20, 30, 40, 50), (), "kinetic energy half a period after the start"),
    ("dam break", "depth-integrated", lambda n: ("dam_break", [f"release[0].particles={n}"]), (100, 200, 400, 800), (100,),
     "kinetic energy, (1/5) rho c^5 t/g with c^2 = g H"),
    ("bar, sudden load", "Taylor-SPH, C = 0.9", bar(0.9), (50, 100, 200, 400), (50,), "kinetic energy at 3.3 L/c"),
    ("strip footing", "Taylor-SPH", lambda n: ("strip_footing", [f"soil.spacing={1 / n}"]), (4, 8, 16), (4,), "load on half a footing"),
    ("consolidation", "v-pw", lambda n: ("consolidation", [f"soil.spacing={10 / n}", "run.end_time=9.5"]), (20, 40, 80), (20,),
     "settlement after 9 s"),
]


def measure(build, quick=False):
    rows = {}
    for _ in range(1 if quick else ROUNDS):
        for scene, method, settings_of, resolutions, repeated, reference in CASES:
            for n in repeated if quick else resolutions:
                name, settings = settings_of(n)
                with tempfile.TemporaryDirectory() as folder:
                    found = run_scene(build / "talus", folder, name, settings)
                row = {"scene": scene, "method": method, "resolution": n, "command": f"talus run runs/{name} " + " ".join(
                    f"--set {setting}" for setting in settings)}
                if "failed" in found:
                    row["failed"] = found["failed"]
                else:
                    before = rows.get((scene, method, n), found)
                    row |= {"pairs": found["pairs"], "particles": found["particles"], "steps": found["steps"],
                            "seconds": min(found["seconds"], before["seconds"]), "error": found["errors"][reference],
                            "error_of_the_reference": found["uncertainties"][reference]}
                    row["ns_per_pair"] = 1e9 * row["seconds"] / row["pairs"]
                rows[scene, method, n] = row
    return list(rows.values())


def draw(rows, plt):
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    lines = -(-len(scenes) // ACROSS)
    figure, panels = plt.subplots(2 * lines, ACROSS, figsize=(3.2 * ACROSS, 5.6 * lines), squeeze=False, layout="constrained")
    for panel in panels.flat:
        panel.set_visible(False)
    for place, scene in enumerate(scenes):
        column, line = place % ACROSS, place // ACROSS
        for panel, across, label in zip(panels[2 * line:2 * line + 2, column], ("pairs", "seconds"),
                                        ("pairs evaluated", "seconds of the steps, one rank")):
            panel.set_visible(True)
            for colour, method in zip(("#1f6fb2", "#c0392b"), dict.fromkeys(r["method"] for r in rows if r["scene"] == scene)):
                of_method = [row for row in rows if row["scene"] == scene and row["method"] == method]
                good = [row for row in of_method if "error" in row]
                panel.loglog([row[across] for row in good], [row["error"] for row in good], "o-", color=colour, label=method)
                for row in of_method:
                    if "failed" in row:
                        panel.plot(good[-1][across] if good else 1, 1, "x", color=colour)
            own = max((row.get("error_of_the_reference", 0) for row in rows if row["scene"] == scene), default=0)
            if own > 0:
                panel.axhline(own, color="#888888", linestyle=":", label="error of the reference")
            panel.set_xlabel(label)
            panel.legend(fontsize=7)
        panels[2 * line, column].set_title(scene)
        for panel in panels[2 * line:2 * line + 2, 0]:
            panel.set_ylabel("relative error of the reference figure")
    return figure
