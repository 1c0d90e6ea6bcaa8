"""Draws a wave that crosses the interface, for a run of configs/wave_bar.toml:

    python3 make_wave_pictures.py RUN_FOLDER OUT.png

Three moments stand one above the other: before the interface, in the overlap, after it. Discs have
their true radii. The colour is the velocity along x, with one scale for the whole picture.
Needs Debian's python3-h5py, python3-matplotlib and python3-numpy."""

import pathlib
import sys
import tomllib

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

MM = 1e3  # from m
COLOURS = "RdBu_r"
EDGE = dict(edgecolors="0.45", linewidths=0.2)


class Run:
    """The case of a run and the frames of its first coupling."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        with open(self.folder / "case.toml", "rb") as file:
            case = tomllib.load(file)
        coupling = case["couplings"][0]
        kind = {case["participants"][name]["kind"]: name for name in coupling["between"]}
        self.particles, self.mesh = kind["dem"], kind["fem"]
        start = case["participants"][self.mesh]["mesh"]["origin"][0]
        self.overlap = np.array([start, start + coupling["width"]])  # m
        ends = case["case"].get("periodic", {})
        self.period = np.array([np.ptp(ends[axis]) if axis in ends else 0.0 for axis in "xy"])  # m

    def steps(self):
        """Steps of which both bodies have a frame."""
        def of(name):
            return {int(p.stem.rsplit("_", 1)[1])
                    for p in (self.folder / "frames").glob(f"{name}_*.h5")}
        return sorted(of(self.particles) & of(self.mesh))

    def frame(self, name, step):
        return h5py.File(self.folder / "frames" / f"{name}_{step:09d}.h5", "r")

    def wave_position(self, step):
        """Where the kinetic energy is along x, m; nan at rest. Masses are blended: nothing counts
        twice in the overlap."""
        x, energy = [], []
        for name, grid in ((self.particles, "particles"), (self.mesh, "mesh")):
            with self.frame(name, step) as f:
                x.append(f[grid]["position"][:, 0])
                energy.append(f[grid]["mass"][:] * (f[grid]["velocity"][:] ** 2).sum(axis=1))
        x, energy = np.concatenate(x), np.concatenate(energy)
        return np.sum(x * energy) / energy.sum() if energy.sum() > 0 else np.nan

    def moments(self):
        """Steps in which the wave is before, in and after the overlap."""
        steps = np.array(self.steps())
        x = np.array([self.wave_position(step) for step in steps])
        centre = self.overlap.mean()
        with self.frame(self.particles, steps[0]) as f:
            left = f["particles/position"][:, 0].min()
        with self.frame(self.mesh, steps[0]) as f:
            right = f["mesh/position"][:, 0].max()
        way = 0.5 * min(centre - left, right - centre)
        return [steps[np.nanargmin(np.abs(x - target))]
                for target in (centre - way, centre, centre + way)]

    def discs(self, step):
        """-> centres and diameters in mm, velocity along x in mm/s, time in s"""
        with self.frame(self.particles, step) as f:
            p = f["particles"]
            return (p["position"][:, :2] * MM, 2 * p["radius"][:] * MM, p["velocity"][:, 0] * MM,
                    f["time"][0])

    def quads(self, step):
        """-> corners in mm, mean velocity of the corners along x in mm/s"""
        with self.frame(self.mesh, step) as f:
            m = f["mesh"]
            cells = m["cells"][:]
            corners = m["position"][:, :2][cells]
            velocity = m["velocity"][:, 0][cells].mean(axis=1)
        # An element across the end of a period has corners at both ends of the mesh.
        for axis in np.flatnonzero(self.period):
            way = corners[:, :, axis] - corners[:, :1, axis]
            corners[:, :, axis] -= self.period[axis] * np.round(way / self.period[axis])
        return corners * MM, velocity * MM


def draw(axes, run, discs, quads, norm):
    """Draws one moment. -> what a colour bar needs"""
    corners, velocity = quads
    elements = axes.add_collection(PolyCollection(corners, array=velocity, norm=norm, cmap=COLOURS,
                                                  **EDGE))
    centres, diameters, velocity, time = discs
    axes.add_collection(EllipseCollection(diameters, diameters, np.zeros_like(diameters),
                                          units="xy", offsets=centres, array=velocity,
                                          offset_transform=axes.transData, norm=norm, cmap=COLOURS,
                                          **EDGE))
    # In the overlap the elements show through the discs as outlines.
    start, end = run.overlap * MM
    middle = corners[:, :, 0].mean(axis=1)
    axes.add_collection(PolyCollection(corners[(middle > start) & (middle < end)], facecolors="none",
                                       edgecolors="0.1", linewidths=0.25))
    for x in (start, end):
        axes.axvline(x, color="black", linewidth=1.1, linestyle=(0, (4, 2.5)))
    low = np.minimum(corners.min(axis=(0, 1)), (centres - diameters[:, None] / 2).min(axis=0))
    high = np.maximum(corners.max(axis=(0, 1)), (centres + diameters[:, None] / 2).max(axis=0))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), ylabel="y / mm")
    axes.yaxis.set_major_locator(matplotlib.ticker.MultipleLocator(10))
    axes.set_aspect("equal")
    axes.set_title(f"t = {time * 1e6:.1f} µs", loc="left", fontsize=10)
    return elements


def picture(run, out):
    moments = [(run.discs(step), run.quads(step)) for step in run.moments()]
    fastest = max(max(np.abs(discs[2]).max(), np.abs(quads[1]).max()) for discs, quads in moments)
    norm = matplotlib.colors.Normalize(-fastest, fastest)

    figure, rows = plt.subplots(3, 1, figsize=(10, 6.7), sharex=True, layout="constrained")
    for axes, (discs, quads) in zip(rows, moments):
        colours = draw(axes, run, discs, quads, norm)
    rows[-1].set_xlabel("x / mm")

    # What the parts are, above the first row.
    above = dict(transform=rows[0].get_xaxis_transform(), y=1.04, ha="center", va="bottom",
                 fontsize=9, color="0.25")
    (start, end), (left, right) = run.overlap * MM, rows[0].get_xlim()
    rows[0].text((left + start) / 2, s="discrete elements", **above)
    rows[0].text((start + end) / 2, s="overlap", **above)
    rows[0].text((end + right) / 2, s="finite elements", **above)
    bar = figure.colorbar(colours, ax=rows, shrink=0.8, aspect=32, pad=0.015)
    bar.set_label("velocity along x / (mm/s)")
    figure.savefig(out, dpi=160)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    picture(Run(sys.argv[1]), sys.argv[2])
