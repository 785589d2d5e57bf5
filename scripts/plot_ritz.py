#!/usr/bin/python3
"""Draws how Ritz's method converges: its measured errors against the number of trial functions.

Datasets: /orbits/ritz_functions, ritz_error, ritz_error_v, ritz_defect and /sweep. Of every combination of the other
swept parameters a line; thin straight lines are the powers -3, -2 and -1 that errors of displacements, of velocities
and residuals follow. --stalled FILE adds the displacements of a result without constants, which do not converge.
"""

import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

import figures

PANELS = (
    ("ritz_error", "error of displacements", -3),
    ("ritz_error_v", "error of velocities", -2),
    ("ritz_defect", "relative residual of the motion", -1),
)
MARKERS = "osDv^P*X"


class Convergence:
    """What the figure uses of a result."""

    def __init__(self, file):
        if "orbits/ritz_error" not in file:
            raise figures.FigureError("no /orbits/ritz_error in it: not a result of kind orbits with method: ritz")
        group = file["orbits"]
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        self.functions = group["ritz_functions"][()]
        self.values = {name: group[name][()] for name, _, _ in PANELS}
        names = figures.text_of(file["sweep"].attrs.get("parameters", "")).split() if "sweep" in file else []
        self.names = [name for name in names if name not in ("orbit.functions", "orbit.tolerance")]
        self.swept = np.column_stack([np.zeros(len(self.functions)), *(file["sweep"][name][()] for name in self.names)])
        if not (self.functions > 0).any():
            raise figures.FigureError("no approximation was found at any of its points")

    def subtitle(self):
        parts = figures.fixed_parameters(self.study, self.study.word("particles") or "?", self.names)
        return ", ".join(parts + ["all quantities dimensionless"])

    def lines(self):
        """Rows of each line in the order of their functions, and its name."""
        for values in np.unique(self.swept, axis=0):
            rows = np.flatnonzero((self.swept == values).all(axis=1) & (self.functions > 0))
            name = ", ".join(
                rf"$\varepsilon = {value:.4g}$" if "cubic" in key else f"{figures.parameter_symbol(key)} = {value:.4g}"
                for key, value in zip(self.names, values[1:])
            )
            if len(rows) > 0:
                yield rows[np.argsort(self.functions[rows], kind="stable")], name


def draw_power(axes, result, name, power):
    """The power, a bit below the middle of the last values."""
    good = result.functions > 0
    n, y = result.functions[good].astype(float), result.values[name][good]
    anchor = 0.4 * np.median(y[n == n.max()]) / n.max() ** power
    x = np.array([n.min(), n.max()])
    axes.plot(x, anchor * x**power, color=figures.FAINT, linewidth=0.8, linestyle=(0, (5, 3)), zorder=1)
    middle = np.sqrt(x[0] * x[1])
    axes.annotate(f"$N^{{{power}}}$", (middle, anchor * middle**power), xytext=(-8, -14), textcoords="offset points",
                  ha="right", color=figures.FAINT)  # fmt: skip


def frame(axes, label, result):
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(np.unique(result.functions[result.functions > 0]))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.minorticks_off()
    axes.set_xlabel("trial functions $N$")
    axes.set_title(label, loc="left", color=figures.INK)


def stalled_entry(axes, path):
    """The displacements of another result, without constants."""
    if not path:
        return []
    with h5py.File(path) as file:
        other = Convergence(file)
    look = {"color": figures.RED, "linestyle": ":", "linewidth": 1.5}
    for rows, _ in other.lines():
        axes.plot(other.functions[rows], other.values["ritz_error"][rows], marker=".", **look)
    return [Line2D([], [], label="without constants", **look)]


def draw(result, options):
    figure = plt.figure(figsize=(9.6, 4.5), constrained_layout=True)
    cells = figure.add_gridspec(2, len(PANELS), height_ratios=[1, 0.17])
    panels = [figure.add_subplot(cells[0, k]) for k in range(len(PANELS))]
    lines = list(result.lines())
    tints = figures.colour_map()(np.linspace(0, 1, max(2, len(lines))))
    entries = [
        Line2D([], [], color=tints[k], marker=MARKERS[k % len(MARKERS)], label=name or "error")
        for k, (_, name) in enumerate(lines)
    ]
    for axes, (name, label, power) in zip(panels, PANELS):
        frame(axes, label, result)
        draw_power(axes, result, name, power)
        for k, (rows, _) in enumerate(lines):
            axes.plot(result.functions[rows], result.values[name][rows], color=tints[k], linewidth=1.4, markersize=5,
                      marker=MARKERS[k % len(MARKERS)])  # fmt: skip
    entries += stalled_entry(panels[0], options.stalled)
    below = figure.add_subplot(cells[1, :])
    figures.legend_row(below, entries, 6)
    below.text(0, 0, result.subtitle(), va="bottom", color=figures.FAINT, transform=below.transAxes)
    figure.suptitle(result.title, x=0.012, ha="left", weight="bold")
    return figure


def options(parser):
    parser.add_argument("--stalled", metavar="FILE", help="a result with orbit.constants: false, for comparison")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "ritz", __doc__, options, Convergence))
