"""Where methods fail: knobs on both sides of the thresholds that theory gives."""
import json
import subprocess

TITLE = "Where methods fail, and where theory says they do"
PROGRAMS = ["test_stability"]
SAME = ("failure", "scene", "value")
REPEATED = {"threshold": 1e-4, "stable": 0}


def measure(build, quick=False):
    """The rows that the tests of stability print, which check the same points."""
    found = subprocess.run([str(build / "tests" / "test_stability")], check=True, capture_output=True, text=True,
                           stdin=subprocess.DEVNULL)
    return [json.loads(line) for line in found.stdout.splitlines() if line.startswith('{"failure"')]


def draw(rows, plt):
    failures = list(dict.fromkeys(row["failure"] for row in rows))
    columns = 4
    lines = -(-len(failures) // columns)
    figure, panels = plt.subplots(lines, columns, figsize=(14, 3 * lines), squeeze=False, layout="constrained")
    for panel in panels.flat[len(failures):]:
        panel.set_visible(False)
    colours = ["#1f6fb2", "#d98e04", "#5a9e5a", "#8a6bb0", "#8c6d4f", "#333333"]
    for panel, failure in zip(panels.flat, failures):
        chosen = [row for row in rows if row["failure"] == failure]
        if failure == "tensile instability":  # the others are what scenes have by default: stable
            chosen = [row for row in chosen if row["scene"].endswith("no dissipation")]
        scenes = list(dict.fromkeys(row["scene"] for row in chosen))
        for number, scene in enumerate(scenes):
            colour = colours[number % len(colours)]
            points = [row for row in chosen if row["scene"] == scene]
            panel.plot([row["value"] for row in points], [row["found"] for row in points], color=colour, linewidth=0.6)
            for stable, marker in ((True, "o"), (False, "x")):
                some = [row for row in points if row["stable"] == stable]
                panel.plot([row["value"] for row in some], [row["found"] for row in some], marker, color=colour,
                           label=scene if stable == points[0]["stable"] else None)
        for threshold in {row["threshold"] for row in chosen if row["threshold"] is not None}:
            panel.axvline(threshold, color="#c0392b", linestyle="--", linewidth=0.8)
        values = [row["found"] for row in chosen]
        if min(values) > 0 and max(values) > 50 * min(values):
            panel.set_yscale("log")
        elif min(values) >= 0 and max(values) > 1e3:
            panel.set_yscale("symlog", linthresh=0.01)
        panel.set(title=failure, xlabel=chosen[0]["knob"], ylabel=chosen[0]["metric"])
        panel.legend(fontsize=6, ncols=1 if len(scenes) < 7 else 2)
    figure.text(0.01, -0.02, "o stable, x unstable; dashed: threshold by theory", fontsize=8)
    return figure
