#!/usr/bin/python3
"""Draws a map of the periods of attractors over a grid of two parameters.

Datasets: /diagram/outcome, attractor_period; the two parameters of /sweep, laid out by its attribute `grid`. Periods up
to 16 have colours of their own, from dark to light, odd and even ones in two hues; longer ones share one. Dark grey is no
period up to the limit of the study: chaos, or a longer period; white has diverged or failed. Numbers stand in the
largest regions of their periods.

Where lambda of the example map is on an axis, lines mark 1/4 and 2/3, between which windows are separated by chaos as
d -> 0: beyond 2/3 there is chaos, below 1/4 windows overlap.
"""

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

COLUMNS = ("attractor_period",)
MOST = 16  # periods with colours of their own
LONGER, CHAOS, NOTHING = "#d9a7c7", "#3a3a3a", "#ffffff"
BORDERS = {1 / 4: "1/4", 2 / 3: "2/3"}  # of regimes, in lambda
SAMPLES = 250  # of the map, each way, among which a number looks for its place
ROOM = 5  # samples from a number to the end of its region, at least


def colours():
    """Of periods 1 to MOST: dark to light, in two hues that alternate, so that neighbours differ."""
    cold, warm = plt.get_cmap("YlGnBu_r"), plt.get_cmap("YlOrBr_r")
    step = np.linspace(0.08, 0.88, MOST // 2)
    return [(cold if k % 2 else warm)(step[k // 2]) for k in range(MOST)]


def categories(result):
    """1 to MOST are periods, then longer ones, none, and no attractor."""
    period = result.need("attractor_period")
    kinds = np.where(period == 0, MOST + 2, np.minimum(period, MOST + 1))
    return np.where(np.isin(result.outcome, ("periodic", "aperiodic")), kinds, MOST + 3)


def place_of(mask):
    """The cell farthest from the outside of a region, and how far it is: layers are taken away until none is left."""
    depth, place = 0, None
    while mask.any():
        rows, columns = np.nonzero(mask)
        middle = len(rows) // 2
        depth, place = depth + 1, (rows[middle], columns[middle])
        inner = np.zeros_like(mask)
        inner[1:-1, 1:-1] = mask[1:-1, 1:-1] & mask[2:, 1:-1] & mask[:-2, 1:-1] & mask[1:-1, 2:] & mask[1:-1, :-2]
        mask = inner
    return depth, place


def put_numbers(axes, grid, cells):
    """The period in the largest part of its region."""
    rows, columns = (np.linspace(0, n - 1, min(n, SAMPLES)).astype(int) for n in cells.shape)
    sample = cells[np.ix_(rows, columns)]
    for period, face in enumerate(colours(), 1):
        depth, place = place_of(sample == period)
        if depth > ROOM:
            dark = np.dot(face[:3], (0.3, 0.59, 0.11)) < 0.55
            at = grid.x[columns[place[1]]], grid.y[rows[place[0]]]
            axes.text(*at, str(period), color="white" if dark else figures.INK, ha="center", va="center", size=9.5)


def draw_borders(axes, grid):
    """The borders of the regimes; returns their entry of the legend."""
    vertical, horizontal = grid.x_name == "model.lambda", grid.y_name == "model.lambda"
    if not vertical and not horizontal:
        return []
    for value, words in BORDERS.items():
        look = {"color": "white", "linewidth": 1.4, "linestyle": (0, (5, 3)), "zorder": 3}
        (axes.axvline if vertical else axes.axhline)(value, **look)
        transform = axes.get_xaxis_transform() if vertical else axes.get_yaxis_transform()
        (x, y), shift = ((value, 0.985), (4, 0)) if vertical else ((0.985, value), (0, 4))
        axes.annotate(words, (x, y), shift, xycoords=transform, textcoords="offset points", color="white", size=9,
                      ha="left" if vertical else "right", va="top" if vertical else "bottom")  # fmt: skip
    return [Line2D([], [], color=figures.FAINT, linestyle=(0, (5, 3)), label=r"$\lambda = 1/4$, $2/3$")]


def entries_of(present):
    names = [f"{k}" for k in range(1, MOST + 1)] + [f"more than {MOST}", "none: chaos", "diverged"]
    faces = [*colours(), LONGER, CHAOS, NOTHING]
    return [
        Patch(facecolor=face, edgecolor=figures.FAINT, linewidth=0.4, label=name)
        for k, (name, face) in enumerate(zip(names, faces), 1)
        if k in present
    ]


def draw(result, options):
    result.need_sweep(2)
    grid, kinds = grids.Grid(result, options.swap), categories(result)
    figure = plt.figure(figsize=(8.8, 8.6), constrained_layout=True)
    cells = figure.add_gridspec(2, 1, height_ratios=[1, 0.1])
    axes, shown = figure.add_subplot(cells[0]), grid.matrix(kinds)
    palette = ListedColormap([*colours(), LONGER, CHAOS, NOTHING])
    axes.pcolormesh(*grid.edges(), shown, cmap=palette, norm=Normalize(0.5, MOST + 3.5), rasterized=True)
    grid.frame(axes)
    put_numbers(axes, grid, shown)
    entries = entries_of(set(np.unique(kinds).tolist()))
    entries += draw_borders(axes, grid)
    figures.legend_row(figure.add_subplot(cells[1]), entries, 7, title="period of the attractor", alignment="left")
    figures.put_title(figure, axes, result, 90)
    return figure


def options_of(parser):
    parser.add_argument("--swap", action="store_true", help="put the last swept parameter on the horizontal axis")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "periods", __doc__, options_of, partial(diagrams.Iterates, columns=COLUMNS)))
