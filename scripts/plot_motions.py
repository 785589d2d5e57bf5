#!/usr/bin/python3
"""Draws single motions of a branch: displacements over a period, and the orbit in the plane of two displacements.

Datasets: /branch/point_history_q (of studies with branch.samples), point_energy, point_period, point_outcome. Points are
counted from 0 within their task; by default a few that are admissible. Dots are the first states, where motions with
impacts hit. Masses are counted from 1 in the labels, as the source does.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import figures
from motions import Motions, symbol

DEFAULT_POINTS = 3
MOST_CURVES = 12  # particles that are drawn


def chosen(result, options):
    """Rows of the points."""
    task = result.check_task(options.task)
    rows = result.rows("point", task)
    if not options.points:
        sound = result.admissible(task)
        return sound[np.unique(np.linspace(0, len(sound) - 1, DEFAULT_POINTS).astype(int))]
    for point in options.points:
        if not 0 <= point < len(rows):
            raise figures.FigureError(f"no point {point} of task {task}, it has points 0 to {len(rows) - 1}")
    return rows[options.points]


def name_of(result, row):
    columns = result.columns
    words = f"energy {columns['point_energy'][row]:.4g}, period {columns['point_period'][row]:.4g}"
    outcome = columns["point_outcome"][row]
    return words if outcome == "admissible" else f"{words}, {outcome}"


def colours(count):
    if count <= len(figures.CYCLE):
        return figures.CYCLE[:count]
    return list(figures.colour_map()(np.linspace(0, 1, count)))


def draw_history(axes, result, row, particles):
    time = np.linspace(0, 1, result.q.shape[1])
    for particle, colour in zip(particles, colours(len(particles))):
        axes.plot(time, result.q[row, :, particle], color=colour, linewidth=1.5, label=symbol(f"q{particle}"))
    axes.axhline(0, color="#c4c4c4", linewidth=0.7, zorder=0)
    axes.set_ylabel("displacement")
    axes.set_title(name_of(result, row), loc="left", color=figures.INK)


def draw_orbit(axes, result, row, pair):
    x, y = (result.component(name)[row] for name in pair)
    axes.plot(x, y, color=figures.BLUE, linewidth=1.5)
    axes.plot(x[:1], y[:1], "o", color=figures.RED, markersize=5)
    axes.set_ylabel(symbol(pair[1]))


def draw(result, options):
    rows, n = chosen(result, options), result.q.shape[2]
    particles = np.unique(np.linspace(0, n - 1, min(n, MOST_CURVES)).astype(int))
    figure = plt.figure(figsize=(8.6, 1.4 + 2.3 * len(rows)), constrained_layout=True)
    cells = figure.add_gridspec(len(rows) + 1, 2, width_ratios=[1.7, 1], height_ratios=[1] * len(rows) + [0.1])
    for k, row in enumerate(rows):
        left, right = figure.add_subplot(cells[k, 0]), figure.add_subplot(cells[k, 1])
        draw_history(left, result, row, particles)
        draw_orbit(right, result, row, options.plane)
    left.set_xlabel("time over the period")
    right.set_xlabel(symbol(options.plane[0]))
    figures.legend_row(figure.add_subplot(cells[-1, :]), left.get_legend_handles_labels()[0], MOST_CURVES)
    task = result.task_name(options.task)
    figure.suptitle("\n".join([result.title, task] if task else [result.title]), x=0.012, ha="left", weight="bold")
    return figure


def options(parser):
    parser.add_argument("--task", type=int, default=0, metavar="K", help="which task, from 0; default: 0")
    parser.add_argument("--points", type=int, nargs="+", metavar="K", help="which of its points, from 0")
    parser.add_argument(
        "--plane", nargs=2, default=["q0", "q1"], metavar="A", help="two components, as q0 or v1; default: q0 q1"
    )


if __name__ == "__main__":
    sys.exit(figures.run(draw, "motions", __doc__, options, Motions))
