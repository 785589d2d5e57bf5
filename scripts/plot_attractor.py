#!/usr/bin/python3
"""Draws the kept states of one task in planes of two of their numbers, as Figure 6 of the source does.

Datasets: /diagram/outcome, state, attractor_period; exponent or lyapunov for the title. Of a map the planes are those of
z1, z2 and z3, of a motion those of displacement and velocity of its first particles, at impacts of time and velocity;
--plane names one. Many states are
drawn as their density, on a logarithmic scale of colours.
"""

import sys
from functools import partial
from itertools import combinations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import diagrams
import figures

COLUMNS = ("state", "attractor_period", "exponents", "lyapunov")
MOST_POINTS = 10000  # more are a density
MOST_PLANES = 3
CELLS = 360  # of a density, each way


def planes_of(result, names, wanted):
    """Pairs of indices."""
    if wanted:
        for name in wanted:
            if name not in names:
                raise figures.FigureError(f"no number {name} in a state, it has {', '.join(names)}")
        return [tuple(names.index(name) for name in wanted)]
    if result.study.is_map:
        pairs = list(combinations(range(min(len(names), 3)), 2))
    elif names[-1] == "time":
        pairs = [(len(names) - 1, i + len(names) // 2) for i in range(len(names) // 2)]
    else:
        pairs = [(i, i + len(names) // 2) for i in range(len(names) // 2)]
    if not pairs:
        raise figures.FigureError("a state has one number, a plane needs two")
    return pairs[:MOST_PLANES]


def draw_plane(axes, x, y):
    """Points, or the density of many; returns its mesh."""
    if len(x) <= MOST_POINTS:
        size = 2 if len(x) > 500 else 4
        axes.plot(x, y, "o", color=figures.BLUE, markersize=size, markeredgewidth=0, rasterized=True)
        return None
    share, *edges = np.histogram2d(x, y, CELLS, [diagrams.limits_of(x), diagrams.limits_of(y)])
    share = np.ma.masked_equal(share.T / len(x), 0)
    norm = LogNorm(share.min(), max(share.max(), 2 * share.min()))
    return axes.pcolormesh(*edges, share, cmap=diagrams.density_map(), norm=norm, rasterized=True)


def exponent_text(value):
    return f"{value:.4f}".replace("-", "\u2212")


def facts(result, task):
    """What the attractor is, in words."""
    columns, parts = result.columns, []
    if result.task_name(task):
        parts.append(result.task_name(task))
    period = columns["attractor_period"][task]
    parts.append(f"period {period}" if period > 0 else result.outcome[task].replace("_", " "))
    if "exponents" in columns:
        parts.append("exponents " + ", ".join(map(exponent_text, columns["exponents"][task])) + " per iterate")
    elif "lyapunov" in columns:
        parts.append(f"exponent {exponent_text(columns['lyapunov'][task])} per iterate")
    return ", ".join(parts)


def choose(result, wanted):
    tasks = len(result.outcome)
    if wanted is None and tasks > 1:
        raise figures.FigureError(f"{tasks} tasks in it, this figure needs --task")
    if not 0 <= (wanted or 0) < tasks:
        raise figures.FigureError(f"no task {wanted}, it has tasks 0 to {tasks - 1}")
    return wanted or 0


def draw(result, options):
    state = result.need("state", " (the study did not ask for iterate.states)")
    task = choose(result, options.task)
    states = state[task][np.isfinite(state[task]).all(axis=1)]
    if len(states) == 0:
        raise figures.FigureError(f"no state of task {task} is finite ({result.outcome[task]})")
    names = result.coordinate_names(states.shape[1])
    planes = planes_of(result, names, options.plane)
    figure, row = plt.subplots(1, len(planes), figsize=(1.2 + 4.3 * max(len(planes), 1.6), 5.1), squeeze=False,
                               constrained_layout=True)  # fmt: skip
    for axes, (i, j) in zip(row[0], planes):
        mesh = draw_plane(axes, states[:, i], states[:, j])
        axes.set(xlabel=diagrams.number_label(names[i]), ylabel=diagrams.number_label(names[j]))
        axes.set(xlim=diagrams.limits_of(states[:, i], room=0.04), ylim=diagrams.limits_of(states[:, j], room=0.04))
        if mesh is not None:
            figure.colorbar(mesh, ax=axes, orientation="horizontal", label="share of the states in a cell", aspect=34)
    figures.put_title(figure, row[0][0], result, 40 * len(planes))
    words = f"{result.subtitle()}\n{len(states)} iterates, {facts(result, task)}"
    row[0][0].set_title("")
    row[0][0].set_title(words, loc="left", color=figures.FAINT)
    return figure


def options_of(parser):
    parser.add_argument("--task", type=int, metavar="K", help="the task whose states are drawn, from 0")
    parser.add_argument("--plane", nargs=2, metavar=("X", "Y"), help="one plane, as z1 z2 or q0 v0")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "attractor", __doc__, options_of, partial(diagrams.Iterates, columns=COLUMNS)))
