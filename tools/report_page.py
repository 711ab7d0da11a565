"""The page of tools/report: HTML with pictures inside, for a browser without a network."""

import base64
import html
import io
import tempfile
from pathlib import Path

import numpy as np

import plotting
import run_record
from talus_output import read_diagnostics

STYLE = """
body { font: 15px/1.5 sans-serif; color: #222; max-width: 1000px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0; } h2 { font-size: 1.2em; border-bottom: 1px solid #ccc; margin-top: 2em; }
table { border-collapse: collapse; margin: 0.5em 0; } td, th { padding: 0.15em 0.8em 0.15em 0; text-align: left; vertical-align: top; }
th { border-bottom: 1px solid #999; font-weight: 600; } td.number { text-align: right; font-variant-numeric: tabular-nums; }
.wide { overflow-x: auto; } img { max-width: 100%; display: block; margin: 0.6em 0; } pre { background: #f5f5f3; padding: 0.8em; overflow-x: auto; font-size: 12px; }
.done { color: #2e7d32; } .bad { color: #b71c1c; } .note { color: #8a5a00; } summary { cursor: pointer; }
"""
HIDDEN_TABLES = ("diagnostics.csv", "performance.csv")
PALETTE = ["#c0392b", "#4d8fc4", "#e39b2d", "#5a9e5a", "#8a6bb0", "#8c6d4f", "#333333"]
MOST_PANELS = 24  # quantities drawn over time; the rest stays in diagnostics.csv


def image(data, kind, what):
    text = base64.b64encode(data).decode()
    return f'<img alt="{html.escape(what)}" src="data:image/{kind};base64,{text}">'


def figure_image(figure, what):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    plotting.plt.close(figure)
    return image(buffer.getvalue(), "svg+xml", what)


def table(head, rows, numbers=()):
    cells = "".join(f"<th>{html.escape(name)}</th>" for name in head)
    lines = [f"<tr>{cells}</tr>"] if head else []
    for row in rows:
        cells = "".join(f'<td class="number">{html.escape(str(c))}</td>' if i in numbers else f"<td>{html.escape(str(c))}</td>"
                        for i, c in enumerate(row))
        lines.append(f"<tr>{cells}</tr>")
    return f'<div class="wide"><table>{"".join(lines)}</table></div>'


def section(title, *parts):
    parts = [part for part in parts if part]
    return f"<h2>{html.escape(title)}</h2>\n" + "\n".join(parts) + "\n" if parts else ""


def groups_of(diagnostics):
    """Columns that belong into one panel, {title: {name: values}}: energies, vectors by component, the rest alone."""
    groups = {}
    for name, (unit, values) in diagnostics.items():
        if name in ("step", "time") or not np.isfinite(values).any() or (np.nanmin(values) == 0 == np.nanmax(values)):
            continue
        if name.endswith("_energy"):
            title, line = "energies", name.removesuffix("_energy")
        elif name[-2:] in ("_x", "_y", "_z"):
            title, line = name[:-2], name[-1]
        elif name[-3:] in ("_xx", "_yy", "_zz", "_xy", "_yz", "_xz"):
            title, line = name[:-3], name[-2:]
        else:
            title, line = name, name
        groups.setdefault((title, unit), {})[line] = values
    return groups


def histories(diagnostics):
    """(image of panels over time, number of quantities left out)."""
    if "time" not in diagnostics or len(diagnostics["time"][1]) < 2:
        return "", 0
    groups = groups_of(diagnostics)
    shown = list(groups.items())[:MOST_PANELS]
    if not shown:
        return "", 0
    time = diagnostics["time"][1]
    factor, time_unit = plotting.scale_for(np.nanmax(np.abs(time)), "s")
    rows = (len(shown) + 2) // 3
    figure, axes = plotting.plt.subplots(rows, 3, figsize=(11, 2.3 * rows), squeeze=False, layout="constrained")
    for axis in axes.flat[len(shown):]:
        axis.set_visible(False)
    for axis, ((title, unit), lines) in zip(axes.flat, shown):
        largest = max(np.nanmax(np.abs(values)) for values in lines.values())
        value_factor, value_unit = plotting.scale_for(largest, unit)
        for colour, (name, values) in zip(PALETTE * 3, lines.items()):
            axis.plot(time / factor, values / value_factor, color=colour, linewidth=1.1, label=name.replace("_", " "))
        axis.set_title(plotting.label(title, value_unit), fontsize=9)
        axis.tick_params(labelsize=7)
        axis.grid(color="#e6e6e6", linewidth=0.5)
        if len(lines) > 1:
            axis.legend(frameon=False, fontsize=7)
    for axis in axes[max(0, rows - 2):].flat:
        axis.set_xlabel(plotting.label("time", time_unit), fontsize=8)
    return figure_image(figure, "histories"), len(groups) - len(shown)


def times(performance, log):
    """Where time went, and how evenly work was spread over the run."""
    phases = {name: seconds for name, seconds in performance.get("phase_seconds", {}).items() if seconds > 0}
    if not phases:
        return ""
    with_balance = "time" in log and performance.get("ranks", 1) > 1 and len(log["time"][1]) > 1
    figure, axes = plotting.plt.subplots(1, 2 if with_balance else 1, figsize=(11 if with_balance else 6, 2.8), squeeze=False,
                                         layout="constrained")
    names = list(phases)[::-1]
    axes[0, 0].barh(names, [phases[name] for name in names], color="#4d8fc4")
    axes[0, 0].set_xlabel("seconds of a rank")
    if with_balance:
        for name, colour in (("imbalance", "#4d8fc4"), ("imbalance_of_time", "#c0392b")):
            axes[0, 1].plot(log["time"][1], log[name][1], color=colour, label=name.replace("_", " "))
        axes[0, 1].set(xlabel="time [s]", ylabel="largest over mean", ylim=(0.95, None))
        axes[0, 1].legend(frameon=False)
    return figure_image(figure, "time per phase")


def head_of(out, state, performance, ending):
    _, version, step, time = state
    rows = [("version", version), ("step", step), ("time", f"{time:.6g} s" if time is not None else None)]
    if performance:
        updates = performance["steps"] * performance["particles"]
        rows += [("particles", f"{performance['particles']:,}"), ("ranks", performance["ranks"]),
                 ("time of the last start", f"{performance['seconds']:.3g} s, {performance['steps']:,} steps, "
                  f"{updates / max(performance['seconds'], 1e-9):.3g} particle-steps/s"),
                 ("peak memory of all ranks", f"{performance['peak_memory_bytes'] / 2**20:.0f} MiB")]
    kind = "done" if ending == "done" else "bad"
    return f'<p class="{kind}">The run is {html.escape(ending)}.</p>' + table((), [row for row in rows if row[1] is not None])


def comparisons(out, scene_text):
    rows = []
    for c in run_record.compare(out, scene_text):
        found = "not reached" if c.found is None else f"{c.found:.5g}"
        off = "" if c.deviation is None else f"{100 * c.deviation:+.2f} %"
        own = f"± {c.uncertainty:.3g}" if c.uncertainty else ""
        rows.append((c.name, found, f"{c.value:.5g}", own, c.unit, off, c.source))
    return table(("figure", "found", "reference", "its own error", "unit", "off by", "source"), rows, (1, 2, 3, 5)) if rows else ""


def page_of(out):
    """The whole page."""
    out = Path(out)
    state = run_record.read_state(out)
    lines, warnings, ending = run_record.read_log(out)
    diagnostics = read_diagnostics(out)
    performance = run_record.read_json(out / "performance.json")
    with tempfile.TemporaryDirectory() as folder:
        pictures = [image(path.read_bytes(), "png", path.stem) for path in plotting.draw_all(out, to=Path(folder))
                    if path.stem != "energies"]
    over_time, left_out = histories(diagnostics)
    changes = [(name, f"{size:.2e}", scale) for name, size, scale in run_record.conservation(diagnostics)]
    tables = []
    for path in sorted(out.glob("*.csv")):
        if path.name in HIDDEN_TABLES:
            continue
        head, rows, more = run_record.read_rows(path, 12)
        note = f"<p>and {more} rows more</p>" if more else ""
        tables.append(f"<h3>{html.escape(path.name)}</h3>{table(head, rows, range(len(head)))}{note}")
    title = next((line.split(" = ", 1)[1].strip('"') for line in (state[0] or "").splitlines() if line.startswith("title = ")), out.name)
    notes = "".join(f'<li class="note">{html.escape(warning)}</li>' for warning in warnings)
    body = [
        f"<h1>{html.escape(title)}</h1>", head_of(out, state, performance, ending),
        section("Warnings", f"<ul>{notes}</ul>" if notes else ""),
        section("Against references", comparisons(out, state[0])),
        section("How far totals changed", table(("total", "greatest change", "relative to"), changes, (1,)) if changes else ""),
        section("Pictures", *pictures),
        section("Over time", over_time, f"<p>{left_out} more in diagnostics.csv</p>" if left_out else ""),
        section("Where time went", times(performance, read_diagnostics(out, "performance.csv"))),
        section("Tables", *tables),
        section("Scene as understood", f"<details><summary>show</summary><pre>{html.escape(state[0])}</pre></details>" if state[0] else ""),
        section("Log", f"<details><summary>show</summary><pre>{html.escape(chr(10).join(lines))}</pre></details>")]
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f"<title>{html.escape(title)}</title><style>{STYLE}</style></head>\n<body>\n" + "\n".join(body) + "</body></html>\n")
