"""Error against work of the coupling of water and grains, over resolution, volume fraction and steps of the grains."""
import math
import pathlib
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from chart_runs import RUNS, performance_of, run_program  # noqa: E402
from talus_output import read_diagnostics  # noqa: E402

TITLE = "Water and grains: error against work over resolution, volume fraction and steps of the grains"
PROGRAMS = ["talus"]
SAME = ("scene", "method", "knob")
REPEATED = {"pairs": 0, "error": 1e-6}
LIQUID, GLASS, VISCOSITY, GRAVITY, DIAMETER = 1150, 2500, 8.9e-3, 9.81, 1e-3  # of the scenes; SI
BALL = math.pi / 6 * DIAMETER**3
FRACTIONS = {"normalised kernel": [], "kernel": ["coupling.volume_fraction=kernel"]}
# Of the water: spacings in diameters of the bead; particles across the boxes, which they fill.
SPACINGS = {"settling": (6.4, 5.333333333333333, 4.0, 3.2, 2.0), "packed bed": (4, 5, 6, 8), "porous block": (5, 6, 8, 10)}
QUICK = {"settling": (6.4,), "packed bed": (), "porous block": ()}
SETTLED, WATER_STEP = 0.12, 0.25e-3  # of hindered settling: time, a step that the water can take [s]
SUBSTEPS = (1, 3, 10)


def root(growing, low, high):
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if growing(middle) < 0 else (low, middle)
    return low


def di_felice(velocity, fraction):
    """Total force on a grain at a superficial velocity [N]."""
    reynolds = LIQUID * DIAMETER * velocity / VISCOSITY
    chi = 3.7 - 0.65 * math.exp(-(1.5 - math.log10(reynolds))**2 / 2)
    return (0.63 + 4.8 / math.sqrt(reynolds))**2 * LIQUID * math.pi / 8 * DIAMETER**2 * velocity**2 * fraction**-chi / fraction


def ergun(velocity, fraction):
    """Fall of the pressure for each length [Pa/m]."""
    e, d = fraction, DIAMETER
    return (150 * VISCOSITY * (1 - e)**2 / d + 1.75 * LIQUID * (1 - e) * velocity) * velocity / (e**3 * d)


def settling(spacing):
    """Mean velocity of a bead from 0.05 s on: its terminal velocity."""
    def error(table):
        time, height = table["time"][1], table["mean_grain_z"][1]
        first = int((time < 0.05).sum())
        found = (height[first] - height[-1]) / (time[-1] - time[first])
        return found / root(lambda v: di_felice(v, 1) - BALL * (GLASS - LIQUID) * GRAVITY, 1e-6, 1) - 1
    layers = 4 * spacing * DIAMETER
    return ("settling_grain", [f"body[0].spacing={spacing * DIAMETER}", f"body[1].spacing={spacing * DIAMETER}",
                               f"body[1].lower=[0,0,{-layers}]", f"box.lower=[0,0,{-1.25 * layers}]", "run.end_time=0.15"], error)


def packed_bed(along):
    """Ergun's velocity through a bed without ends."""
    side = 11.46684e-3

    def error(table):
        fraction = 1 - table["grain_volume"][1][0] / side**3
        found = table["water_momentum_x"][1][-1] / (LIQUID * side**3)
        return found / root(lambda u: ergun(u, fraction) - LIQUID * 20, 1e-6, 1) - 1
    return "packed_bed", [f"body[0].spacing={side / along}", "run.end_time=0.03"], error


def porous_block(along):
    """Velocity through a block with sharp ends."""
    side, length, solid = 12.0399e-3, 48.1596e-3, 0.3

    def error(table):
        found = table["water_momentum_z"][1][-1] / (LIQUID * side**2 * length)
        return found / root(lambda u: di_felice(u, 1 - solid) - BALL * (GLASS - LIQUID) * GRAVITY, 1e-6, 1) - 1
    return "porous_block", [f"body[0].spacing={side / along}", f"coupling.averaging_length={3 * side / along}", "run.end_time=0.08"], error


def hindered(substeps):
    """Slip of beads at even spacing."""

    def error(table):
        mass = [table[f"{what}_mass"][1][-1] for what in ("water", "grain")]
        momentum = [table[f"{what}_momentum_z"][1][-1] for what in ("water", "grain")]
        wanted = root(lambda u: di_felice(u, 0.8) - BALL * (GLASS - LIQUID) * GRAVITY, 1e-6, 1) / 0.8
        return (momentum[0] / mass[0] - momentum[1] / mass[1]) / wanted - 1
    return "hindered_settling", [f"dem.time_step={WATER_STEP / substeps}", "materials.glass.youngs_modulus=1e3", f"run.end_time={SETTLED}"], error


CASES = {"settling": settling, "packed bed": packed_bed, "porous block": porous_block}


def one(build, folder, case):
    scene, settings, error_of = case
    out = pathlib.Path(folder) / f"run_{len(list(pathlib.Path(folder).iterdir()))}"
    line = ["run", RUNS / scene, "--out", out]
    for setting in settings:
        line += ["--set", setting]
    done = run_program(line, build / "talus")
    row = {"command": f"talus run runs/{scene} " + " ".join(f"--set {setting}" for setting in settings)}
    if done.returncode != 0:
        return row | {"failed": (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[0]}
    performance = performance_of(out)
    phases = performance["phase_seconds"]
    return row | {"error": float(error_of(read_diagnostics(out))), "pairs": performance["pairs"],
                  "exchange_pairs": performance["exchange_pairs"], "steps": performance["steps"], "seconds": performance["seconds"],
                  "seconds_of_exchange": phases["exchange"], "seconds_of_grains": phases["grains"]}


def measure(build, quick=False):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scene, case in CASES.items():
            for method, more in FRACTIONS.items():
                for knob in (QUICK if quick else SPACINGS)[scene]:
                    name, settings, error_of = case(knob)
                    rows.append({"scene": scene, "method": method, "knob": knob} | one(build, folder, (name, settings + more, error_of)))
        for substeps in () if quick else SUBSTEPS:
            rows.append({"scene": "hindered settling", "method": "steps of grains", "knob": substeps} | one(build, folder, hindered(substeps)))
    return rows


def draw(rows, plt):
    figure, panels = plt.subplots(1, 4, figsize=(14, 3.8), layout="constrained")
    labels = {"settling": lambda k: f"{k:.2g} d", "packed bed": lambda k: f"{11.46684 / k:.2g} d",
              "porous block": lambda k: f"{12.0399 / k:.2g} d", "hindered settling": lambda k: f"{k} steps"}
    for panel, scene in zip(panels, labels):
        for colour, method in zip(("#1f6fb2", "#d98e04"), dict.fromkeys(r["method"] for r in rows if r["scene"] == scene)):
            line = [row for row in rows if row["scene"] == scene and row["method"] == method]
            good = [row for row in line if "error" in row]
            work = (lambda row: SETTLED / WATER_STEP * row["knob"]) if scene == "hindered settling" else (lambda row: row["pairs"])
            panel.loglog([work(row) for row in good], [abs(row["error"]) for row in good], "o-" if method != "kernel" else "s--",
                         color=colour, label=method)
            for row in line:
                if "failed" in row:
                    panel.plot(work(good[-1]) if good else 1, 1, "x", color=colour)
            for row in good if method == line[0]["method"] and method != "kernel" else []:
                panel.annotate(labels[scene](row["knob"]), (work(row), abs(row["error"])), fontsize=7, xytext=(4, 4),
                               textcoords="offset points")
        panel.set(title=scene, xlabel="steps of the grains" if scene == "hindered settling" else "pairs weighed, of water and with grains")
        panel.legend(fontsize=7, loc="lower left")
    panels[1].set_ylim(1e-15, 1e-3)
    panels[2].set_ylim(1e-2, 0.3)
    panels[3].set_ylim(1e-5, 1e-2)
    panels[0].set_ylabel("relative error of the velocity")
    return figure
