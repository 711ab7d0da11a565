#!/usr/bin/python3
"""tools/plot on synthetic output of 1D, 2D and 3D runs. `plot.py --keep FOLDER` leaves it for looking at."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

PLOT = Path(__file__).resolve().parents[2] / "tools" / "plot"
KEEP = None


def write_snapshot(path, dimension, time, fields):
    with h5py.File(path, "w") as file:
        header = file.create_group("Header")
        header.attrs.update({"Time": time, "Dimension": dimension, "Step": 7, "RunName": path.parent.name})
        group = file.create_group("PartType0")
        for name, values in fields.items():
            group.create_dataset(name, data=values)


def write_series(folder, set_name, dimension, moments):
    """moments: [(time, {dataset: values}), ...]"""
    files = []
    for number, (time, fields) in enumerate(moments):
        name = f"{set_name}_{number:06d}.hdf"
        write_snapshot(folder / name, dimension, time, fields)
        files.append({"name": name, "time": time})
    (folder / f"{set_name}.hdf.series").write_text(json.dumps({"file-series-version": "1.0", "files": files}))


def ball(dimension, radius, spacing):
    """Points of a lattice within a ball, padded to three columns."""
    n = int(radius / spacing) + 1
    line = (np.arange(-n, n) + 0.5) * spacing  # no layer at zero: the cut has to find one
    grid = np.stack(np.meshgrid(*[line] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension)
    grid = grid[np.linalg.norm(grid, axis=1) < radius]
    return np.pad(grid, ((0, 0), (0, 3 - dimension)))


def impact(dimension, time, spacing=2e-3, radius=0.03):
    """A ball that is cracked and pushed apart from its top."""
    x = ball(dimension, radius, spacing)
    up = dimension - 1
    depth = (radius - x[:, up]) / radius
    push = np.exp(-2 * depth) * (time > 0)
    direction = x / np.maximum(np.linalg.norm(x, axis=1), spacing)[:, None]
    velocity = direction * (150 * push)[:, None]
    mass = 2700 * spacing**dimension
    return {
        "Coordinates": x + velocity * time, "Velocities": velocity,
        "Densities": np.full(len(x), 2700.0), "Masses": np.full(len(x), mass),
        "Pressures": 3e9 * np.sin(6 * depth) * push, "Damage": np.clip(1.4 * push, 0, 1),
        "SmoothingLengths": np.full(len(x), spacing), "InternalEnergies": 1e4 * push,
        "ParticleIDs": np.arange(len(x), dtype=np.uint64), "BodyIDs": np.zeros(len(x), np.uint8),
    }


def tube(time, count=400):
    x = (np.arange(count) + 0.5) / count - 0.5
    right = 1 / (1 + np.exp((x - 1.7 * time) / 0.01))
    zeros = np.zeros((count, 2))
    return {
        "Coordinates": np.hstack([x[:, None], zeros]),
        "Velocities": np.hstack([0.9 * right[:, None] * (time > 0), zeros]),
        "Densities": 0.125 + 0.875 * right, "Pressures": 0.1 + 0.9 * right,
        "SmoothingLengths": np.full(count, 1 / count), "Masses": np.full(count, 1 / count),
    }


def write_diagnostics(folder, columns, rows):
    lines = [",".join(columns)] + [",".join(f"{v:.17g}" for v in row) for row in rows]
    (folder / "diagnostics.csv").write_text("\n".join(lines) + "\n")


class Plot(unittest.TestCase):
    def setUp(self):
        if KEEP:
            self.folder = KEEP / self._testMethodName.removeprefix("test_")
            self.folder.mkdir(parents=True, exist_ok=True)
        else:
            scratch = tempfile.TemporaryDirectory()
            self.addCleanup(scratch.cleanup)
            self.folder = Path(scratch.name) / self._testMethodName.removeprefix("test_")
            self.folder.mkdir()

    def plot(self, *options, code=0, error=""):
        done = subprocess.run([PLOT, self.folder, *options], capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        pictures = [Path(line) for line in done.stdout.splitlines()]
        for picture in pictures:
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            self.assertGreater(picture.stat().st_size, 5000)
        self.assertNotIn("Traceback", done.stderr)
        if error:
            self.assertRegex(done.stderr, error)
        return {p.name for p in pictures}

    def test_ball_3d(self):
        write_series(self.folder, "rock", 3, [(t, impact(3, t)) for t in (0, 2e-5, 6e-5, 1e-4)])
        time = np.linspace(0, 1e-4, 50)
        kinetic = 300 * np.exp(-time / 3e-5)
        write_diagnostics(
            self.folder,
            ["step", "time [s]", "kinetic_energy [J]", "internal_energy [J]", "total_energy [J]", "note"],
            np.stack([np.arange(50), time, kinetic, 300 - kinetic, 300 + 1e-9 * time, 0 * time], axis=1))
        self.assertEqual(self.plot(), {"rock_damage.png", "rock_speed.png", "rock_pressure.png", "energies.png"})
        self.assertEqual(len(self.plot("--plane", "z", "--to", str(self.folder / "other"))), 4)

    def test_disc_2d(self):
        write_series(self.folder, "rock", 2, [(t, impact(2, t, 1e-3)) for t in (0, 1e-4)])
        fluid = impact(2, 1e-4, 1.5e-3)
        for absent in ("Damage", "Masses", "SmoothingLengths"):
            del fluid[absent]
        write_series(self.folder, "water", 2, [(1e-4, fluid)])
        self.assertEqual(self.plot(), {"rock_damage.png", "rock_speed.png", "rock_pressure.png",
                                       "water_density.png", "water_speed.png", "water_pressure.png"})

    def test_strip_2d(self):
        x = np.stack(np.meshgrid(np.arange(400) * 5.0, np.arange(12) * 5.0, [0.0], indexing="ij"), -1)
        x = x.reshape(-1, 3)
        moments = [(t, {"Coordinates": x, "Velocities": 0.1 * t * x, "Densities": np.full(len(x), 1000.0),
                        "SmoothingLengths": np.full(len(x), 6.0), "Masses": np.full(len(x), 25e3)})
                   for t in (0.0, 30.0, 60.0)]
        write_series(self.folder, "water", 2, moments)
        self.assertEqual(self.plot(), {"water_density.png", "water_speed.png"})

    def test_tube_1d(self):
        write_series(self.folder, "gas", 1, [(t, tube(t)) for t in (0, 0.1, 0.2)])
        (self.folder / "gas.hdf.series").unlink()  # found by the files' names then
        write_diagnostics(self.folder, ["time [s]", "kinetic_energy [J]"], [[0, 1], [0.1, 2], [0.05, 1.4]])
        self.assertEqual(self.plot(), {"gas_profiles.png", "energies.png"})

    def test_fragments(self):
        (self.folder / "fragments.csv").write_text(
            "rank,label,mass [kg],mass_fraction\n1,0,0.09,0.3\n2,17,0.006,0.02\n3,5,0.006,0.02\n")
        self.assertEqual(self.plot(), {"fragments.png"})
        (self.folder / "analysis.json").write_text('{"fully_damaged_fraction": 0.6}')
        self.assertEqual(self.plot(), {"fragments.png"})

    def test_remnants(self):
        x = ball(3, 3e4, 3e3) * (1.5, 1, 0.7)
        fields = {"Coordinates": np.vstack([x + 1e6, x[:5] * 9]), "Velocities": np.zeros((len(x) + 5, 3))}
        fields["Damage"] = np.linspace(0, 1, len(x) + 5)
        fields["Remnant"] = np.repeat(np.uint8([1, 2]), [len(x), 5])
        fields["Fragment"] = np.repeat(np.uint64([17, 3]), [len(x), 5])
        write_series(self.folder, "remnants", 3, [(9.0, fields)])
        body = {"label": 17, "centre": [1e6] * 3, "axes": np.eye(3).tolist(), "extents": [9e4, 6e4, 4.2e4],
                "semi_axes": [4.5e4, 3e4, 2.1e4], "period": 2e4, "b_over_a": 0.667, "c_over_a": 0.467,
                "mass_fraction": 0.7}
        single = dict(body, label=3, period=None)
        figures = {"remnants": [{"body": body}, {"body": single}]}
        (self.folder / "analysis.json").write_text(json.dumps(figures))
        self.assertEqual(self.plot(), {"remnant_1.png"})  # too few particles are no picture

    def test_no_fragments(self):
        (self.folder / "fragments.csv").write_text("rank,label,mass [kg],mass_fraction\n")
        self.plot(code=1)

    def test_damaged_snapshots_are_named(self):
        write_series(self.folder, "gas", 1, [(t, tube(t)) for t in (0, 0.1)])
        last = self.folder / "gas_000001.hdf"
        content = last.read_bytes()
        for damaged in (content[: len(content) // 2], b"", b"no snapshot"):
            last.write_bytes(damaged)
            self.plot(code=1, error=r"^tools/plot: .*gas_000001\.hdf: cannot be read as a snapshot \(.*\)\n$")

    def test_empty_folder_is_an_error(self):
        self.plot(code=1)


if __name__ == "__main__":
    if "--keep" in sys.argv:
        where = sys.argv.index("--keep")
        KEEP = Path(sys.argv[where + 1]).resolve()
        del sys.argv[where : where + 2]
    unittest.main()
