#!/usr/bin/python3
"""Draws the invariant manifold of a nonlinear mode: the surface that the motions of a family sweep in the space of three
of their displacements and velocities.

Datasets: /branch/point_history_q, point_history_v (of studies with branch.samples), point_energy, point_outcome,
point_segment. The colour is the energy; dark lines are single motions. Only admissible motions are drawn; each segment
of the branch is a surface of its own. Masses are counted from 1 in the labels, as the source does.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize

import figures
from motions import Motions, symbol

LINES = 9  # single motions
VIEW = {"elev": 22, "azim": -58}


def draw_segment(axes, values, energy, norm):
    """A surface; the first and the last column of an impact differ in velocity, and are not joined."""
    colours = figures.colour_map()(norm(np.repeat(energy[:, None], values[0].shape[1], axis=1)))
    if len(energy) > 1:
        axes.plot_surface(*values, facecolors=colours, rstride=1, cstride=1, linewidth=0, antialiased=False, shade=False,
                          alpha=0.72)  # fmt: skip
    for k in np.unique(np.linspace(0, len(energy) - 1, LINES).astype(int)):
        axes.plot(*(value[k] for value in values), color=figures.INK, linewidth=0.7, alpha=0.8)


def draw(result, options):
    rows = result.admissible(result.check_task(options.task))
    energy = result.columns["point_energy"]
    rows = rows[energy[rows] <= options.energy_high] if options.energy_high else rows
    if len(rows) == 0:
        raise figures.FigureError(f"no admissible motion of task {options.task} up to that energy")
    components = [result.component(name) for name in options.axes]
    norm = Normalize(energy[rows].min(), energy[rows].max())
    figure = plt.figure(figsize=(8.4, 6.8), constrained_layout=True)
    axes = figure.add_subplot(projection="3d", computed_zorder=False)
    of_point = result.columns["point_segment"]
    for segment in np.unique(of_point[rows]):
        part = rows[of_point[rows] == segment]
        draw_segment(axes, [values[part] for values in components], energy[part], norm)
    for put, name in zip((axes.set_xlabel, axes.set_ylabel, axes.set_zlabel), options.axes):
        put(symbol(name), labelpad=8)
    axes.view_init(**VIEW)
    axes.set_box_aspect(None, zoom=1.05)
    figure.colorbar(plt.cm.ScalarMappable(norm, figures.colour_map()), ax=axes, label="energy", shrink=0.6, pad=0.06)
    figures.put_title(figure, axes, result, 84)
    return figure


def options(parser):
    parser.add_argument("--task", type=int, default=0, metavar="K", help="which task, from 0; default: 0")
    parser.add_argument(
        "--axes", nargs=3, default=["q0", "v0", "q1"], metavar="A", help="three components, as q0 or v1; default: q0 v0 q1"
    )
    parser.add_argument("--energy-high", type=float, metavar="E", help="largest energy; default: that of all motions")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "manifold", __doc__, options, Motions))
