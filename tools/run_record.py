"""What a run says about itself: log, scene, figures, and how it compares with the references of its scene."""

import csv
import json
import math
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import h5py

from talus_output import UnreadableFile, read_diagnostics, scalar


@dataclass
class Comparison:
    """A figure of the run beside its reference; `found` is None if the run did not get so far."""

    name: str
    found: float | None
    value: float
    uncertainty: float
    unit: str
    source: str

    @property
    def deviation(self):
        """Share of the reference; of nothing where that is zero."""
        return None if self.found is None or self.value == 0 else self.found / self.value - 1


def newest_checkpoint(out):
    """Path of the last checkpoint, or None."""
    return max(Path(out).glob("checkpoint_*.h5"), default=None)


def read_state(out):
    """(scene as understood, version, step, time) of the newest checkpoint; Nones if there is none."""
    path = newest_checkpoint(out)
    if path is None:
        return None, None, None, None
    try:
        with h5py.File(path, "r") as file:
            scene = bytes(file["resolved_scene"][()]).decode()
            state = file["state"].attrs
            return scene, str(scalar(state["version"])), int(scalar(state["step"])), float(scalar(state["time"]))
    except (OSError, KeyError) as failure:
        raise UnreadableFile(f"{path}: cannot be read as a checkpoint ({failure})") from failure


def read_json(path):
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def read_log(out):
    """(times and texts of the log's lines, warnings among them, how the run ended)."""
    lines = (Path(out) / "log.txt").read_text(encoding="utf-8", errors="replace").splitlines()
    texts = [re.sub(r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d ", "", line) for line in lines]
    warnings = list(dict.fromkeys(text.removeprefix("note: ") for text in texts if text.startswith("note: ")))
    if (Path(out) / "failed").is_dir():
        return lines, warnings, "failed"
    ends = [text for text in texts if re.match(r"step \d+, time .* after|stopped early|nothing left", text)]
    stopped = [text for text in texts if text.startswith("stopped early")]
    begun = max((i for i, text in enumerate(texts) if "bytes per particle in fields" in text), default=0)
    if not any(text in ends for text in texts[begun:]):
        return lines, warnings, "not ended"
    return lines, warnings, "stopped early" if any(text in stopped for text in texts[begun:]) else "done"


def at_time(table, name, time):
    """(value, unit) of a column at a time, between rows in proportion; the last row's without a time."""
    if name not in table:
        return None, ""
    unit, values = table[name]
    if not len(values):
        return None, unit
    if time is None:
        return float(values[-1]), unit
    times = table["time"][1]
    if not times[0] <= time <= times[-1] * (1 + 1e-12):
        return None, unit
    later = min(int((times < time).sum()), len(times) - 1)
    earlier = max(later - 1, 0)
    step = times[later] - times[earlier]
    share = (time - times[earlier]) / step if step > 0 else 1
    return float(values[earlier] + share * (values[later] - values[earlier])), unit


def inside(data, path):
    """data["a"]["b"][0] for "a.b.0"; None if there is no such thing."""
    for key in path.split("."):
        if isinstance(data, list) and key.isdigit() and int(key) < len(data):
            data = data[int(key)]
        elif isinstance(data, dict) and key in data:
            data = data[key]
        else:
            return None
    return float(data) if isinstance(data, (int, float)) else None


def compare(out, scene_text):
    """The references of the scene beside what the run found."""
    found = []
    for reference in tomllib.loads(scene_text or "").get("reference", []):
        file = reference["file"]
        if file.endswith(".json"):
            times = read_diagnostics(out).get("time", ("", ()))[1]
            reached = "time" not in reference or (len(times) > 0 and times[-1] >= reference["time"])
            value, unit = inside(read_json(Path(out) / file), reference["figure"]) if reached else None, ""
        else:
            value, unit = at_time(read_diagnostics(out, file), reference["figure"], reference.get("time"))
        found.append(Comparison(reference["name"], value, reference["value"], reference["uncertainty"], unit,
                                reference["source"]))
    return found


def conservation(table):
    """[(what, greatest change over the run relative to a scale, what the scale is)] of the diagnostics."""
    rows = []

    def change(name, scale, words):
        values = table[name][1]
        if len(values) > 1 and scale > 0:
            rows.append((name.replace("_", " "), float(max(abs(values - values[0]))) / scale, words))

    if "mass" in table and len(table["mass"][1]) and table["mass"][1][0]:
        change("mass", abs(table["mass"][1][0]), "of the first value")
    if "total_energy" in table and len(table["total_energy"][1]):
        parts = [abs(v).max() for n, (u, v) in table.items() if n.endswith("_energy") and len(v)]
        change("total_energy", max(parts, default=0), "of the largest energy")
    if "mass" in table and "greatest_speed" in table and len(table["mass"][1]):
        scale = float(table["mass"][1].max() * table["greatest_speed"][1].max())
        for axis in "xyz":
            if f"momentum_{axis}" in table:
                change(f"momentum_{axis}", scale, "of mass times the greatest speed")
    return [row for row in rows if math.isfinite(row[1])]


def read_rows(path, limit):
    """(header, first rows) of a CSV file, as text."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#")) if row]
    return (rows[0], rows[1:limit + 1], max(len(rows) - 1 - limit, 0)) if rows else ([], [], 0)
