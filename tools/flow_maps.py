"""Maps of a depth-integrated run: rasters of OUT/results over the shaded ground."""

import sys

sys.dont_write_bytecode = True
import numpy as np
import matplotlib.pyplot as plt
from matplotlib.colors import LightSource
from PIL import Image

NOTHING = -9999
SCALE, PLACE = 33550, 33922  # GeoTIFF's tags: size of a cell, and where the first corner lies
MAPS = (("greatest_depth", "greatest depth [m]", "Blues"), ("greatest_speed", "greatest speed [m/s]", "viridis"),
        ("last_depth", "depth at the end [m]", "YlOrBr"))


class Map:
    """Values of a raster, rows from the south, NaN where there are none; (left, right, bottom, top) [m]."""

    def __init__(self, path):
        if path.suffix == ".asc":
            with open(path) as file:
                head = dict((key.lower(), float(value)) for key, value in (file.readline().split() for _ in range(5)))
                if "dx" in head:
                    head["dy"] = float(file.readline().split()[1])
                file.readline()
                values = np.loadtxt(file)
            size = head.get("cellsize", head.get("dx")), head.get("cellsize", head.get("dy"))
            left, bottom = head["xllcorner"], head["yllcorner"]
        else:
            image = Image.open(path)
            values, size = np.array(image, dtype=float), image.tag_v2[SCALE][:2]
            left, top = image.tag_v2[PLACE][3:5]
            bottom = top - size[1] * values.shape[0]
        self.values = np.where(values == NOTHING, np.nan, values)[::-1]
        self.cell = size
        self.extent = (left, left + size[0] * values.shape[1], bottom, bottom + size[1] * values.shape[0])


def find(results, name):
    return next((path for path in (results / f"{name}.tif", results / f"{name}.asc") if path.exists()), None)


def window(flow, margin=0.15):
    """Limits of the axes around what the flow has met."""
    rows, columns = np.nonzero(np.isfinite(flow.values))
    left, _, bottom, _ = flow.extent
    x = left + flow.cell[0] * np.array([columns.min(), columns.max() + 1])
    y = bottom + flow.cell[1] * np.array([rows.min(), rows.max() + 1])
    room = margin * max(np.ptp(x), np.ptp(y))
    return (x[0] - room, x[1] + room), (y[0] - room, y[1] + room)


def draw_maps(out, title, folder, save):
    """Draws greatest depth and speed and the last depth over the ground; returns the pictures' paths."""
    results = out / "results"
    found = [(find(results, name), label, colours) for name, label, colours in MAPS]
    ground = find(results, "ground")
    if ground is None or any(path is None for path, _, _ in found):
        return []
    maps = [Map(path) for path, _, _ in found]
    if not np.isfinite(maps[0].values).any():
        return []
    ground = Map(ground)
    elevation = np.where(np.isfinite(ground.values), ground.values, np.nanmin(ground.values))
    shade = LightSource(315, 45).hillshade(elevation[::-1], dx=ground.cell[0], dy=ground.cell[1])[::-1]
    limits = window(maps[0])
    is_wide = np.ptp(limits[0]) > 1.4 * np.ptp(limits[1])
    shape, size = ((len(maps), 1), (9, 3.6 * len(maps))) if is_wide else ((1, len(maps)), (5 * len(maps), 5.5))
    figure, axes = plt.subplots(*shape, figsize=size, layout="constrained")
    for panel, one, (_, label, colours) in zip(axes, maps, found):
        panel.imshow(shade, cmap="gray", origin="lower", extent=ground.extent, vmin=-0.3, vmax=1.2)
        top = np.nanpercentile(one.values, 99)
        drawn = panel.imshow(one.values, cmap=colours, origin="lower", extent=one.extent, alpha=0.85, vmin=0, vmax=top)
        levels = np.linspace(np.nanmin(elevation), np.nanmax(elevation), 40)
        panel.contour(elevation, levels=levels, origin="lower", extent=ground.extent, colors="k", linewidths=0.3, alpha=0.5)
        figure.colorbar(drawn, ax=panel, shrink=0.7, label=label, extend="max")
        panel.set(xlim=limits[0], ylim=limits[1], aspect="equal", xlabel="x [m]", ylabel="y [m]")
        panel.ticklabel_format(useOffset=False, style="plain")
        panel.tick_params(axis="x", rotation=30)
    figure.suptitle(title)
    return [save(figure, folder / "maps.png")]
