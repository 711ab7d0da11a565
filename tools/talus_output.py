"""Reads what a run of Talus leaves in its output folder: snapshot series and diagnostics.csv."""

import csv
import json
import re
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

# quantity -> names a snapshot may give it
DATASETS = {
    "position": ("Coordinates",),
    "velocity": ("Velocities", "Velocity"),
    "density": ("Densities", "Density"),
    "pressure": ("Pressures", "Pressure"),
    "internal_energy": ("InternalEnergies", "InternalEnergy"),
    "damage": ("Damage", "Damages"),
    "smoothing_length": ("SmoothingLengths", "SmoothingLength"),
    "mass": ("Masses", "Mass"),
    "radius": ("Radius", "Radii"),
    "solid_fraction": ("SolidFraction",),
    "angular_velocity": ("AngularVelocity", "AngularVelocities"),
    "id": ("ParticleIDs",),
    "body": ("BodyIDs",),
    "remnant": ("Remnant",),
    "fragment": ("Fragment",),
}


@dataclass
class Snapshot:
    """One set of particles at one time, SI units; quantities that the file lacks are not in `fields`."""

    path: Path
    time: float
    dimension: int
    run_name: str
    fields: dict = field(default_factory=dict)

    def __contains__(self, name):
        return name in self.fields

    def __getitem__(self, name):
        return self.fields[name]

    @property
    def size(self):
        return len(self["position"])

    @property
    def speed(self):
        return np.linalg.norm(self["velocity"], axis=1)

    def spacing(self):
        """Distance between neighbours [m], from mass and density and at most the smoothing length."""
        spacing = np.full(self.size, np.inf)
        if "mass" in self and "density" in self:
            volume = self["mass"] / np.maximum(self["density"], 1e-300)
            spacing = volume ** (1.0 / self.dimension)
        if "smoothing_length" in self:
            spacing = np.minimum(spacing, 1.4 * self["smoothing_length"])  # what expands stays as large
        if not np.isfinite(spacing).all():
            extent = np.ptp(self["position"][:, : self.dimension], axis=0)
            spacing[:] = (np.prod(extent[extent > 0]) / self.size) ** (1.0 / max(1, (extent > 0).sum()))
        return spacing


def scalar(value):
    """An attribute as a plain number or text."""
    value = np.asarray(value).reshape(-1)[0]
    return value.decode() if isinstance(value, bytes) else value


class UnreadableFile(Exception):
    """A file that is damaged or not what its name says."""


def read_snapshot(path, time=None):
    try:
        return read_open_snapshot(path, time)
    except (OSError, KeyError) as failure:  # h5py's, of a file cut short or overwritten
        raise UnreadableFile(f"{path}: cannot be read as a snapshot ({str(failure).splitlines()[0]})") from failure


def read_open_snapshot(path, time):
    with h5py.File(path, "r") as file:
        header = file["Header"].attrs if "Header" in file else {}
        group = file["PartType0"]
        fields = {}
        for name, candidates in DATASETS.items():
            for candidate in candidates:
                if candidate in group:
                    fields[name] = group[candidate][...]
                    break
        for name in ("position", "velocity"):  # one column in 1D may be stored flat
            if name in fields and fields[name].ndim == 1:
                fields[name] = fields[name][:, None]
        return Snapshot(
            path=Path(path),
            time=float(scalar(header["Time"])) if "Time" in header else float(time or 0),
            dimension=int(scalar(header["Dimension"])) if "Dimension" in header else fields["position"].shape[1],
            run_name=str(scalar(header["RunName"])) if "RunName" in header else "",
            fields=fields,
        )


def snapshot_series(folder):
    """{name of the set: [(path, time or None), ...] in order of time}."""
    folder = Path(folder)
    series = {}
    for listing in sorted(folder.glob("*.hdf.series")):
        entries = json.loads(listing.read_text(encoding="utf-8"))["files"]
        files = [(folder / e["name"], float(e["time"])) for e in entries if (folder / e["name"]).is_file()]
        if files:
            series[listing.name.removesuffix(".hdf.series")] = sorted(files, key=lambda f: f[1])
    if not series:  # no listing: by the numbers in the names
        for path in sorted(folder.glob("*.hdf")):
            if found := re.fullmatch(r"(.+)_(\d+)\.hdf", path.name):
                series.setdefault(found[1], []).append((path, None))
    return series


def read_diagnostics(folder, name="diagnostics.csv"):
    """{name: (unit, values)} from diagnostics.csv or another table of times; empty if there is none. Rows that
    were cut short or written again after a restart are dropped, the last of equal steps kept."""
    path = Path(folder) / name
    if not path.is_file():
        return {}
    with open(path, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#")) if row]
    if not rows:
        return {}
    columns = []
    for title in rows[0]:
        found = re.fullmatch(r"\s*(.*?)\s*(?:\[(.*)\])?\s*", title)
        columns.append((found[1], found[2] or ""))
    values = [to_numbers(row) for row in rows[1:] if len(row) == len(columns)]
    table = np.array(values, dtype=float).reshape(-1, len(columns))
    names = [name for name, _ in columns]
    if "time" in names and len(table):
        _, last = np.unique(table[::-1, names.index("time")], return_index=True)
        table = table[::-1][last]
    return {name: (unit, table[:, i]) for i, (name, unit) in enumerate(columns)}


def read_fragments(folder):
    """(mass fractions of the fragments, the largest first; fully damaged fraction or None) of an analysed run;
    None if there is no fragments.csv or it is empty."""
    path = Path(folder) / "fragments.csv"
    if not path.is_file():
        return None
    with open(path, newline="", encoding="utf-8") as file:
        fractions = np.array([float(row["mass_fraction"]) for row in csv.DictReader(file)])
    if not len(fractions):
        return None
    figures = path.with_name("analysis.json")
    damaged = json.loads(figures.read_text(encoding="utf-8")) if figures.is_file() else {}
    return np.sort(fractions)[::-1], damaged.get("fully_damaged_fraction")


def read_remnants(folder):
    """[(figures of its body from analysis.json, Snapshot's indices of that body), ...], Snapshot of all that is
    bound; ([], None) if the run was not analysed for remnants."""
    figures, particles = Path(folder) / "analysis.json", Path(folder) / "remnants_000000.hdf"
    if not figures.is_file() or not particles.is_file():
        return [], None
    listed = json.loads(figures.read_text(encoding="utf-8")).get("remnants", [])
    snapshot = read_snapshot(particles)
    bodies = []
    for number, remnant in enumerate(listed, 1):
        if body := remnant.get("body"):
            chosen = (snapshot["remnant"] == number) & (snapshot["fragment"] == body["label"])
            bodies.append((body, np.flatnonzero(chosen)))
    return bodies, snapshot


def to_numbers(row):
    def number(text):
        try:
            return float(text)
        except ValueError:
            return np.nan

    return [number(text) for text in row]
