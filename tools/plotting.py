"""Pictures of a run from its output folder."""

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import EllipseCollection  # noqa: E402
from matplotlib.colors import Normalize  # noqa: E402

from flow_maps import draw_maps  # noqa: E402
from talus_output import (  # noqa: E402
    read_diagnostics, read_fragments, read_remnants, read_snapshot, snapshot_series)

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
QUANTITIES = {  # name -> unit, colours, what to draw
    "damage": ("", "YlOrRd", lambda s: s["damage"]),
    "density": ("kg/m³", "viridis", lambda s: s["density"]),
    "speed": ("m/s", "viridis", lambda s: s.speed),
    "pressure": ("Pa", "viridis", lambda s: s["pressure"]),
}
NEEDS = {"damage": "damage", "density": "density", "speed": "velocity", "pressure": "pressure"}
INK = "#333333"
plt.rcParams.update({
    "font.size": 10, "axes.titlesize": 10, "axes.edgecolor": INK, "axes.linewidth": 0.7,
    "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.4, "savefig.dpi": 150,
})


def scale_for(largest, unit):
    """(factor, unit) that shows `largest` as a number of at most three places before the point."""
    if unit not in ("m", "s", "m/s", "Pa", "J", "J/kg") or not largest > 0 or not np.isfinite(largest):
        return 1, unit
    least = 0.1999 if unit == "s" else 0.0999
    for factor, prefix in PREFIXES:
        if largest >= factor * (0.9999 if factor > 1 else least) and not (unit == "s" and factor > 1):
            return factor, prefix + unit
    return 1, unit


def label(name, unit):
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")


def time_text(time, last):
    factor, unit = scale_for(abs(last), "s")
    return f"t = {time / factor:.4g} {unit}"


def colour_range(values):
    """Robust limits; symmetric about zero where both signs matter."""
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0, 1.0
    low, high = np.percentile(values, [0.5, 99.5])
    if low == high:
        low, high = values.min(), values.max()
    if low < 0 < high and min(-low, high) > 0.02 * max(-low, high):
        high = max(-low, high)
        low = -high
    elif 0 <= low < 0.5 * high:
        low = 0.0
    if high - low <= 1e-9 * max(abs(low), abs(high)):  # one value: show it in the middle
        middle, half = low, max(abs(low), 1e-30) * 0.05
        low, high = middle - half, middle + half
    return low, high


class Cut:
    """What is drawn of a snapshot: two axes and, in 3D, the layer of particles on a plane across the third."""

    def __init__(self, first, plane, at):
        self.normal = "xyz".index(plane) if first.dimension == 3 else None
        axes = [a for a in range(first.dimension) if a != self.normal]
        self.across, self.up = axes
        if self.normal is not None:
            along = first["position"][:, self.normal]
            # a particle's own coordinate, so that the plane goes through a layer and not between two
            self.at = float(np.percentile(along, 50, method="lower")) if at is None else at

    def layer(self, snapshot):
        """Indices of the particles drawn."""
        if self.normal is None:
            return np.arange(snapshot.size)
        distance = np.abs(snapshot["position"][:, self.normal] - self.at)
        # a little over half, so that of a lattice one layer and not none is taken
        return np.flatnonzero(distance < 0.5001 * snapshot.spacing())

    def describe(self):
        if self.normal is None:
            return ""
        factor, unit = scale_for(abs(self.at), "m")
        return f", cut at {'xyz'[self.normal]} = {self.at / factor:.3g} {unit}"


def view(cut, snapshots, layers):
    """Limits (x0, x1, y0, y1) [m] that hold nearly all drawn particles of all snapshots, but reach no
    further than the first one's extent to either side of it: what flies far shall not shrink the rest."""
    limits = []
    for axis in (cut.across, cut.up):
        ends = []
        for s, layer in zip(snapshots, layers):
            along, half = s["position"][layer, axis], 0.5 * np.max(s.spacing()[layer], initial=0)
            if len(along):
                ends.append((np.percentile(along, 0.3) - half, np.percentile(along, 99.7) + half))
        start, end = ends[0]
        low = max(min(e[0] for e in ends), 2 * start - end)
        high = min(max(e[1] for e in ends), 2 * end - start)
        margin = 0.06 * max(high - low, 1e-30)
        limits += [low - margin, high + margin]
    # neither side shorter than a fifth of the other, so that a thin body gets a readable panel
    for a, b in ((0, 2), (2, 0)):
        wanted = (limits[b + 1] - limits[b]) / 5
        lack = wanted - (limits[a + 1] - limits[a])
        if lack > 0:
            limits[a] -= lack / 2
            limits[a + 1] += lack / 2
    return limits


def draw_fields(snapshots, set_name, title, cut, folder):
    snapshots = sorted({id(s): s for s in snapshots}.values(), key=lambda s: s.time)
    layers = [cut.layer(s) for s in snapshots]
    x0, x1, y0, y1 = view(cut, snapshots, layers)
    factor, unit = scale_for(max(abs(v) for v in (x0, x1, y0, y1)), "m")
    aspect = (y1 - y0) / (x1 - x0)
    columns = len(snapshots)
    wide = aspect < 0.6  # wide panels are stacked, tall ones set side by side
    rows, columns = (columns, 1) if wide else (1, columns)
    panel = 6.5 if wide else 3.6
    size = (columns * panel + 1.6, rows * (min(0.93 * panel * aspect, 7) + 0.45) + 0.6)

    names = [n for n in ("damage", "speed", "pressure") if NEEDS[n] in snapshots[0]]
    if "damage" not in names and "density" in snapshots[0]:
        names.insert(0, "density")
    pictures = []
    for name in names:
        si_unit, colours, values_of = QUANTITIES[name]
        values = [values_of(s)[layer] for s, layer in zip(snapshots, layers)]
        low, high = (0, 1) if name == "damage" else colour_range(np.concatenate(values))
        value_factor, value_unit = scale_for(max(abs(low), abs(high)), si_unit)
        if low < 0 < high:
            colours = "RdBu_r"
        norm = Normalize(low / value_factor, high / value_factor)
        figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, sharex=True, sharey=True,
                                    layout="constrained")
        for axis, s, layer, value in zip(axes.flat, snapshots, layers, values):
            order = np.argsort(np.abs(value), kind="stable")  # the strongest on top
            drawn = layer[order]
            # a square lattice is just covered, and no dot is so small that it fades
            diameter = np.maximum(1.42 * s.spacing()[drawn], 1.6 * (x1 - x0) / (150 * panel)) / factor
            dots = EllipseCollection(
                diameter, diameter, np.zeros(len(drawn)), units="xy", linewidths=0, cmap=colours, norm=norm,
                offsets=s["position"][drawn][:, [cut.across, cut.up]] / factor, offset_transform=axis.transData)
            dots.set_array(value[order] / value_factor)
            axis.add_collection(dots)
            axis.set(xlim=(x0 / factor, x1 / factor), ylim=(y0 / factor, y1 / factor), aspect="equal",
                     title=time_text(s.time, snapshots[-1].time), facecolor="#dcdcda")
        for axis in axes[-1]:
            axis.set_xlabel(label("xyz"[cut.across], unit))
        for axis in axes[:, 0]:
            axis.set_ylabel(label("xyz"[cut.up], unit))
        outside = np.concatenate(values) / value_factor
        extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[
            bool((outside < norm.vmin).any()), bool((outside > norm.vmax).any())]
        figure.colorbar(dots, ax=axes, label=label(name, value_unit), extend=extend, aspect=30 if wide else 20,
                        shrink=0.9, pad=0.02)
        figure.suptitle(f"{title}: {name} of {set_name}{cut.describe()}", fontsize=11)
        pictures.append(save(figure, folder / f"{set_name}_{name}.png"))
    return pictures


def draw_profiles(snapshots, set_name, title, folder):
    rows = [(n, u, f) for n, u, f in (
        ("density", "kg/m³", lambda s: s["density"]), ("velocity", "m/s", lambda s: s["velocity"][:, 0]),
        ("pressure", "Pa", lambda s: s["pressure"]), ("damage", "", lambda s: s["damage"])) if n in snapshots[0]]
    if not rows:
        return []
    positions = [s["position"][:, 0] for s in snapshots]
    factor, unit = scale_for(max(np.abs(p).max() for p in positions), "m")
    figure, axes = plt.subplots(len(rows), 1, figsize=(7, 1.9 * len(rows) + 0.8), sharex=True, squeeze=False,
                                layout="constrained")
    colours = ["#9a9a9a", "#4d8fc4", "#c0392b"][-len(snapshots):]
    for axis, (name, si_unit, values_of) in zip(axes[:, 0], rows):
        values = [values_of(s) for s in snapshots]
        value_factor, value_unit = scale_for(max(np.abs(v).max() for v in values), si_unit)
        for s, x, v, colour in zip(snapshots, positions, values, colours):
            order = np.argsort(x)
            axis.plot(x[order] / factor, v[order] / value_factor, ".-", color=colour, markersize=3, linewidth=0.6,
                      label=time_text(s.time, snapshots[-1].time))
        axis.set_ylabel(label(name, value_unit))
        axis.grid(color="#e6e6e6", linewidth=0.5)
        axis.ticklabel_format(useOffset=False)
    axes[0, 0].legend(frameon=False, ncols=len(snapshots), loc="lower left", bbox_to_anchor=(0, 1))
    axes[-1, 0].set_xlabel(label("x", unit))
    figure.suptitle(f"{title}: profiles of {set_name}", fontsize=11)
    return [save(figure, folder / f"{set_name}_profiles.png")]


def draw_energies(diagnostics, title, folder):
    energies = {n: v for n, (u, v) in diagnostics.items() if n.endswith("_energy") and u in ("J", "")
                and np.isfinite(v).any()}
    if "time" not in diagnostics or not energies or len(diagnostics["time"][1]) < 2:
        return []
    time = diagnostics["time"][1]
    time_factor, time_unit = scale_for(np.nanmax(np.abs(time)), "s")
    factor, unit = scale_for(max(np.nanmax(np.abs(v)) for v in energies.values()), "J")
    total = energies.get("total_energy")
    rows = 1 if total is None else 2
    figure, axes = plt.subplots(rows, 1, figsize=(7, 3.4 + 2 * (rows - 1)), sharex=True, squeeze=False,
                                height_ratios=[3, 1.6][:rows], layout="constrained")
    palette = iter(["#c0392b", "#4d8fc4", "#e39b2d", "#5a9e5a", "#8a6bb0", "#8c6d4f"] * 3)
    for name, values in energies.items():
        style = {"color": "black", "linestyle": "--"} if name == "total_energy" else {"color": next(palette)}
        axes[0, 0].plot(time / time_factor, values / factor, label=name.removesuffix("_energy").replace("_", " "),
                        **style)
    axes[0, 0].set_ylabel(label("energy", unit))
    axes[0, 0].legend(frameon=False, ncols=len(energies), loc="lower left", bbox_to_anchor=(0, 1))
    if total is not None:
        parts = [abs(v[0]) for n, v in energies.items() if n != "total_energy" and np.isfinite(v[0])]
        reference = abs(total[0]) or max(parts, default=0) or np.nanmax(np.abs(total)) or 1
        axes[1, 0].plot(time / time_factor, (total - total[0]) / reference, color="black", linewidth=1)
        axes[1, 0].set_ylabel("drift of the total\n(relative)")
        axes[1, 0].ticklabel_format(axis="y", style="sci", scilimits=(-2, 2))
    for axis in axes[:, 0]:
        axis.grid(color="#e6e6e6", linewidth=0.5)
    axes[-1, 0].set_xlabel(label("time", time_unit))
    figure.suptitle(f"{title}: energies", fontsize=11)
    return [save(figure, folder / "energies.png")]


def draw_fragments(found, title, folder):
    """How many fragments are at least as heavy as a fraction of the whole."""
    if found is None:
        return []
    fractions, damaged = found
    figure, axis = plt.subplots(figsize=(6, 4.2), layout="constrained")
    axis.loglog(fractions, np.arange(1, len(fractions) + 1), "o-", color="#c0392b", markersize=3.5, linewidth=0.8)
    axis.set(xlabel="mass of the fragment / mass of the whole", ylabel="number of fragments at least as heavy",
             xlim=(min(0.5 * fractions[-1], 1e-3), 1))
    axis.grid(color="#e6e6e6", linewidth=0.5)
    note = f"largest {fractions[0]:.3f}, {len(fractions)} fragments, together {fractions.sum():.3f}"
    if damaged is not None:
        note += f"; fully damaged {damaged:.3f}"
    axis.set_title(note, loc="left", fontsize=9)
    figure.suptitle(f"{title}: fragments", fontsize=11)
    return [save(figure, folder / "fragments.png")]


def draw_remnants(bodies, snapshot, title, folder):
    """The largest connected piece of each remnant from three sides: what is nearer hides what is behind."""
    pictures = []
    for number, (body, chosen) in enumerate(bodies, 1):
        if len(chosen) < 10:
            continue
        axes = np.array(body["axes"])
        x = (snapshot["position"][chosen] - body["centre"]) @ axes.T
        extents = np.array(body["extents"])
        factor, unit = scale_for(extents[0] / 2, "m")
        spacing = (np.prod(body["semi_axes"]) * 4 * np.pi / 3 / len(chosen)) ** (1 / 3)
        damage = snapshot["damage"][chosen] if "damage" in snapshot else np.zeros(len(chosen))
        varied = np.ptp(damage) > 0.01
        half = 0.55 * np.maximum(extents, 2 * np.array(body["semi_axes"])) / factor
        height = max(half[1], half[0] / 3)
        figure, panels = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained",
                                      width_ratios=half[[0, 0, 1]])
        for axis, (across, up, depth) in zip(panels, ((0, 1, 2), (0, 2, 1), (1, 2, 0))):
            order = np.argsort(x[:, depth] * (-1 if depth == 1 else 1), kind="stable")
            shade = np.linspace(0.3, 1, len(order))[:, None]  # far ones are dark
            colours = plt.get_cmap("YlOrRd")(damage[order]) if varied else np.full((len(order), 4), 0.9)
            colours[:, :3] *= shade
            colours[:, 3] = 1
            axis.add_collection(EllipseCollection(
                *[np.full(len(order), 1.3 * spacing / factor)] * 2, np.zeros(len(order)), units="xy", linewidths=0,
                facecolors=colours, offsets=x[order][:, [across, up]] / factor, offset_transform=axis.transData))
            angle = np.linspace(0, 2 * np.pi, 200)
            semi = np.array(body["semi_axes"]) / factor
            axis.plot(semi[across] * np.cos(angle), semi[up] * np.sin(angle), color=INK, linewidth=0.8,
                      linestyle="--")
            axis.set(xlim=(-half[across], half[across]), ylim=(-height, height), aspect="equal",
                     xlabel=label("abc"[across], unit), ylabel=label("abc"[up], unit))
        period = f", period {body['period'] / 3600:.3g} h" if body["period"] else ""
        figure.suptitle(
            f"{title}: body of remnant {number} along its principal axes\n{len(chosen)} particles, "
            f"{body['mass_fraction']:.3f} of the mass, b/a {body['b_over_a']:.3f}, c/a {body['c_over_a']:.3f}{period}"
            + ("; colour: damage" if varied else "") + "; far ones darker; dashed: ellipsoid of equal inertia",
            fontsize=10)
        pictures.append(save(figure, folder / f"remnant_{number}.png"))
    return pictures


def save(figure, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    plt.close(figure)
    return path


def draw_all(out, plane="y", at=None, to=None):
    """Draws everything that `out` allows and returns the pictures' paths."""
    folder = to or out / "pictures"
    title = out.resolve().name
    pictures = []
    for set_name, files in snapshot_series(out).items():
        if set_name == "remnants":  # drawn in their own frame
            continue
        chosen = sorted({0, len(files) // 2, len(files) - 1})
        snapshots = [read_snapshot(*files[i]) for i in chosen]
        snapshots = [s for s in snapshots if s.size]
        if not snapshots:
            continue
        title = snapshots[0].run_name or title
        if snapshots[0].dimension == 1:
            pictures += draw_profiles(snapshots, set_name, title, folder)
        else:
            pictures += draw_fields(snapshots, set_name, title, Cut(snapshots[0], plane, at), folder)
    pictures += draw_maps(out, title, folder, save)
    pictures += draw_energies(read_diagnostics(out), title, folder)
    pictures += draw_fragments(read_fragments(out), title, folder)
    return pictures + draw_remnants(*read_remnants(out), title, folder)
