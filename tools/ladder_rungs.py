"""What the charts of one event by models of growing cost have in common."""

import resource
import tempfile

COLOURS = {"block": "#444444", "depth": "#2b8a5a", "continuum": "#1f6fb2", "grains": "#c2571a"}


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measured(rungs, program):
    """Rows of rungs (name, family, run(program, folder) -> (run-out over length, number of parts))."""
    rows = []
    for name, family, run in rungs:
        with tempfile.TemporaryDirectory() as folder:
            before = processor_time()
            run_out, parts = run(program, folder)
            rows.append({"rung": name, "family": family, "run_out": float(run_out), "parts": parts,
                         "processor_seconds": processor_time() - before})
    return rows


def draw_rungs(axes, rows, label_of, place_of=lambda row: (4, 4)):
    for row in rows:
        cost = max(row["processor_seconds"], 1e-3)
        axes.semilogx(cost, row["run_out"], "o", color=COLOURS[row["family"]])
        axes.annotate(label_of(row), (cost, row["run_out"]), textcoords="offset points", xytext=place_of(row), fontsize=7)
    axes.set(xlabel="processor time [s]; closed forms at 1e-3", ylabel="run-out / length of the column", xlim=(5e-4, 2e4))


def point_out_cheapest(axes, rows, serves, label, place=(14, -34)):
    """An arrow at the row of least cost for which serves(row)."""
    row = min((row for row in rows if serves(row)), key=lambda row: row["processor_seconds"])
    axes.annotate(label, (max(row["processor_seconds"], 1e-3), row["run_out"]), textcoords="offset points", xytext=place,
                  fontsize=7, arrowprops={"arrowstyle": "->", "color": "#c0392b"})
