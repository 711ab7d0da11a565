"""Error of the gravity tree against its interactions and time, for orders, opening angles and opening rules."""
import os
import subprocess

TITLE = "Self-gravity of 20 000 particles in a sphere against the direct sum"
PROGRAMS = ["gravity_bench"]
PARTICLES = 20000
COLUMNS = ("order", "bits", "opening", "parameter", "rms", "greatest", "drift", "points", "softened", "nodes",
           "ns_per_interaction", "ns_per_particle")
COLOURS = {1: "#c0392b", 2: "#d98e04", 3: "#1f6fb2"}
MULTIPOLES = {1: "mass", 2: "quadrupole", 3: "octupole"}
DEFAULT = {"order": 3, "bits": 32, "opening": "geometric", "parameter": 0.65}


def measure(build):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    text = subprocess.run([build / "gravity_bench", str(PARTICLES), "sphere"], check=True, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, env=environment).stdout
    rows = []
    for line in text.splitlines()[2:]:
        row = dict(zip(COLUMNS, line.split(), strict=True))
        rows.append({name: value if name == "opening" else int(value) if name in ("order", "bits") else float(value)
                     for name, value in row.items()})
    return rows


def interactions(row):
    return row["points"] + row["softened"] + row["nodes"]


def chosen(rows, **wanted):
    found = [row for row in rows if all(row[name] == value for name, value in wanted.items())]
    return sorted(found, key=interactions)


def draw_lines(axes, rows, across, up):
    for opening, style, marker in (("geometric", "-", "o"), ("relative", "--", "s")):
        for order, colour in COLOURS.items():
            for bits, face in ((32, colour), (64, "none")):
                line = chosen(rows, order=order, opening=opening, bits=bits)
                label = f"{MULTIPOLES[order]}, {opening}" if bits == 32 else None
                axes.plot([across(row) for row in line], [up(row) for row in line], style if bits == 32 else ":",
                          color=colour, marker=marker, markerfacecolor=face, markeredgewidth=0.8, label=label,
                          linewidth=1.2 if bits == 32 else 0.6)
    for row in chosen(rows, **DEFAULT):
        axes.plot(across(row), up(row), "o", markersize=11, markerfacecolor="none", color="#333333")


def draw(rows, plt):
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
    figure, (error, cost, worth) = plt.subplots(1, 3, figsize=(13, 4.3), layout="constrained")
    draw_lines(error, rows, interactions, lambda row: row["rms"])
    draw_lines(cost, rows, interactions, lambda row: row["ns_per_interaction"])
    draw_lines(worth, rows, lambda row: row["ns_per_particle"] / 1000, lambda row: row["rms"])
    for axes in (error, cost, worth):
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    for order in COLOURS:
        for row in chosen(rows, order=order, bits=32, opening="geometric"):
            if row["parameter"] in (0.4, 0.9) or row["parameter"] == DEFAULT["parameter"]:
                error.annotate(f"$\\theta$ = {row['parameter']:g}", (interactions(row), row["rms"]), fontsize=7,
                               xytext=(6, 3), textcoords="offset points", color=COLOURS[order])
    error.set(yscale="log", xlabel="interactions per particle", ylabel="rms error / mean acceleration",
              title="Error against interactions")
    cost.set(ylim=(0, None), xlabel="interactions per particle", ylabel="ns per interaction",
             title="Cost of one interaction")
    worth.set(yscale="log", xlabel="µs per particle, one core", ylabel="rms error / mean acceleration",
              title="Error against time")
    error.legend(fontsize=7, title="filled: single precision, hollow: double\nring: the default", title_fontsize=7)
    return figure
