#!/usr/bin/python3
"""Draws basins of attraction over a grid of two numbers of the start: which attractor each start comes to.

Datasets: /basin/outcome, attractor, end, impacts, found_period, found_tasks; the two parameters of /sweep. The states in which the
tasks of an attractor have ended, one for each iterate of its cycle, are marked: filled where they lie in the plane of the
starts, within 1e-3 of their largest number, open where the plane only has their projection. White has no attractor.
"""

import re
import sys
from functools import partial

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import diagrams
import figures
import grids

COLUMNS = ("attractor", "end", "found_period", "found_tasks", "impacts")
FACES = ["#7fb2d9", "#f3c178", "#8fd0b5", "#e3b9d0", "#c9c9c9", "#bfe0f4"]  # of the attractors, as INKS lighter
INKS = [figures.BLUE, "#a85f00", "#006b4e", "#a0457a", "#4d4d4d", "#2a7fb0"]
MOST = len(FACES)  # attractors with colours of their own, those with the most starts
NOTHING, OTHERS = "#ffffff", "#5a5a5a"
IN_PLANE = 1e-3
MOST_STATES = 64  # marked, of one attractor
SAME_STATE = 1e-4


class Basins(diagrams.Iterates):
    kind = "basin"


def choose(result):
    """Indices of the attractors with colours of their own, by falling size of their basins."""
    sizes = result.need("found_tasks")
    return [int(k) for k in np.argsort(-sizes, kind="stable")[:MOST]]


def index_of(result, name, size):
    """Which number of the state a swept parameter is."""
    found = re.fullmatch(r"(iterate\.start|start\.([qv]))(?:\[(\d+)\])?", name)
    if not found:
        return None
    return int(found[3] or 0) + (size // 2 if found[2] == "v" else 0)


def fixed_start(result, size):
    """The numbers of the start that are not swept."""
    words = result.study.items("start") or [result.study.word("start") or "0"]
    words = words * size if len(words) == 1 else words
    return np.array([float(word) if re.fullmatch(r"[-+.\deE]+", word) else np.nan for word in words[:size]])


def states_of(result, attractor):
    """The different states in which its tasks have ended; none of more than MOST_STATES."""
    ends = result.columns["end"][result.columns["attractor"] == attractor]
    scale = np.abs(ends).max() or 1.0
    _, first = np.unique(np.round(ends / (SAME_STATE * scale)), axis=0, return_index=True)
    states = []
    for end in ends[first]:  # of two that rounding has parted one is dropped
        if not any(np.abs(end - known).max() < 2 * SAME_STATE * scale for known in states):
            states.append(end)
        if len(states) > MOST_STATES:
            return np.empty((0, ends.shape[1]))
    return np.array(states)


def draw_states(axes, grid, result, chosen):
    """Marks; returns which looks are there."""
    size, seen = result.columns["end"].shape[1], set()
    i, j = (index_of(result, name, size) for name in (grid.x_name, grid.y_name))
    rest = [k for k in range(size) if k not in (i, j)]
    if i is None or j is None or not (result.study.is_map or not rest):
        return seen
    start = fixed_start(result, size)
    for attractor, ink in zip(chosen, INKS):
        for state in states_of(result, attractor):
            inside = all(abs(state[k] - start[k]) <= IN_PLANE * np.abs(state).max() for k in rest)
            axes.plot(state[i], state[j], "o", markersize=6, color=ink, markeredgecolor="white" if inside else ink,
                      markerfacecolor=ink if inside else "white", markeredgewidth=1.4, zorder=4)  # fmt: skip
            seen.add(inside)
    return seen


def name_of(result, attractor):
    period = int(result.columns["found_period"][attractor])
    if period == 0:
        return "no period: chaos"
    impacts = round(period * np.mean(result.columns["impacts"][result.columns["attractor"] == attractor]))
    return f"period {period}, {impacts or 'no'} impact{'s' if impacts != 1 else ''}"


def entries_of(result, chosen, seen):
    tasks, period = len(result.outcome), result.columns["found_period"]
    entries = []
    for k, attractor in enumerate(chosen):
        share = f"{100 * result.columns['found_tasks'][attractor] / tasks:.3g} %"
        entries.append(Patch(facecolor=FACES[k], edgecolor=INKS[k], linewidth=0.8, label=f"{name_of(result, attractor)} ({share})"))
    if len(period) > MOST:
        entries.append(Patch(facecolor=OTHERS, label=f"{len(period) - MOST} other attractors"))
    if (result.columns["attractor"] < 0).any():
        entries.append(Patch(facecolor=NOTHING, edgecolor=figures.FAINT, linewidth=0.4, label="none"))
    look = {"marker": "o", "linestyle": "", "color": figures.INK, "markersize": 6}
    if True in seen:
        entries.append(Line2D([], [], label="states of an attractor", **look))
    if False in seen:
        entries.append(Line2D([], [], markerfacecolor="white", label="states of an attractor, beside the plane", **look))
    return entries


def draw(result, options):
    result.need_sweep(2)
    grid, chosen = grids.Grid(result, options.swap), choose(result)
    attractor = result.need("attractor")
    colour = np.full(len(attractor), MOST)  # others
    for k, which in enumerate(chosen):
        colour[attractor == which] = k
    colour[attractor < 0] = MOST + 1
    figure = plt.figure(figsize=(7.8, 8.0), constrained_layout=True)
    cells = figure.add_gridspec(2, 1, height_ratios=[1, 0.1])
    axes = figure.add_subplot(cells[0])
    palette = ListedColormap([*FACES, OTHERS, NOTHING])
    axes.pcolormesh(*grid.edges(), grid.matrix(colour), cmap=palette, norm=Normalize(-0.5, MOST + 1.5), rasterized=True)
    grid.frame(axes)
    limits = axes.get_xlim(), axes.get_ylim()
    seen = draw_states(axes, grid, result, chosen)
    axes.set(xlim=limits[0], ylim=limits[1])
    figures.legend_row(figure.add_subplot(cells[1]), entries_of(result, chosen, seen), 2)
    figures.put_title(figure, axes, result, 78)
    return figure


def options_of(parser):
    parser.add_argument("--swap", action="store_true", help="put the last swept parameter on the horizontal axis")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "basin", __doc__, options_of, partial(Basins, columns=COLUMNS)))
