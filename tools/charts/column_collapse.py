"""Run-out of columns of grains against their aspect ratio: runs/column_collapse_grains at five widths of equal area."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools"))
from talus_output import read_snapshot, snapshot_series  # noqa: E402

TITLE = "Collapse of columns of grains, friction 0.5, rolling friction 0.1"
PROGRAMS = ["talus"]
ASPECTS = (0.5, 1, 2, 4, 8)
DIAMETER = 5e-3  # of the scene [m]
AREA = 400 * DIAMETER**2  # of every column, side on [m2]
LOOSE = 1.35  # height of the lattice over that of the column once it has settled
WIDTH = 21e-3  # of the periodic box [m]


def simulate(program, aspect, folder, settings=()):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    out = pathlib.Path(folder) / f"column_{aspect}"
    length = (AREA / aspect) ** 0.5
    subprocess.run(["mpirun", "--oversubscribe", "-n", "2", program, "run", TOP / "runs/column_collapse_grains", "--out", out,
                    "--set", f"wall[2].point=[{length}, 0, 0]",
                    "--set", f"grains[0].upper=[{length}, {WIDTH}, {LOOSE * aspect * length}]", *settings],
                   check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=environment)
    return out, length


def surface(position, solid_fraction=0.6):
    """Places and heights of the deposit: volume of grains in strips of two diameters as if they lay as densely."""
    strip = 2 * DIAMETER
    counts = np.bincount((position[:, 0] / strip).astype(int))
    heights = counts * np.pi / 6 * DIAMETER**3 / (solid_fraction * strip * WIDTH)
    return (np.arange(len(counts)) + 0.5) * strip, heights


def front(position):
    """Where the deposit that hangs together ends: the first strip with less than half a layer."""
    places, heights = surface(position)
    thin = np.flatnonzero(heights < 0.5 * DIAMETER)
    return places[thin[0]] - DIAMETER if len(thin) else places[-1] + DIAMETER


def row_of(aspect, out, length):
    files = snapshot_series(out)["grains"]
    first, last = (read_snapshot(files[k][0])["position"] for k in (0, -1))
    height = np.quantile(first[:, 2], 0.99) + DIAMETER / 2
    return {"aspect": height / length, "grains": len(first), "length": length, "height": height,
            "run_out": (front(last) - length) / length, "final_height": surface(last)[1].max() / length,
            "still_moving": float(np.abs(np.diff([front(read_snapshot(files[k][0])["position"])
                                                  for k in (-3, -1)]))[0] / length)}


def measure(build):
    with tempfile.TemporaryDirectory() as folder:
        return [row_of(aspect, *simulate(build / "talus", aspect, folder)) for aspect in ASPECTS]


def lube(aspect):
    """G. Lube, H. E. Huppert, R. S. J. Sparks, A. Freundt, Phys. Rev. E 72 (2005) 041301: channels, four materials."""
    return np.where(aspect < 1.8, 1.2 * aspect, 1.9 * aspect ** (2 / 3))


def lajeunesse(aspect):
    """E. Lajeunesse, J. B. Monnier, G. M. Homsy, Phys. Fluids 17 (2005) 103302: glass beads in a channel."""
    return np.where(aspect < 3, 1.8 * aspect, 1.9 * aspect ** (2 / 3))


def staron(aspect):
    """L. Staron, E. J. Hinch, J. Fluid Mech. 545 (2005) 1: discs in a plane, without side walls."""
    return np.where(aspect < 2, 2.5 * aspect, 3.25 * aspect**0.7)


def draw(rows, plt):
    figure, axes = plt.subplots(figsize=(6.2, 4.2), layout="constrained")
    aspect = np.geomspace(0.4, 10, 200)
    axes.loglog(aspect, lube(aspect), color="#888888", label="Lube et al. 2005")
    axes.loglog(aspect, lajeunesse(aspect), "--", color="#888888", label="Lajeunesse et al. 2005")
    axes.loglog(aspect, staron(aspect), ":", color="#888888", label="Staron, Hinch 2005, discs")
    axes.loglog([row["aspect"] for row in rows], [row["run_out"] for row in rows], "o", color="#1f6fb2", label="grains")
    axes.set(xlabel="height / length of the column", ylabel="run-out / length of the column")
    axes.legend(fontsize=8)
    return figure
