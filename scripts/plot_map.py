#!/usr/bin/python3
"""Draws a map of the outcomes over a grid of two parameters, beside it a quantity of the admissible orbits.

Datasets: /orbits/outcome; /orbits/energy, clearance or impulse (the first one) for the second panel; the two
parameters of /sweep, laid out by its attribute `grid` (the last one varies fastest). Where the axes are the
coupling and the period, the curve gamma_c(T) = ((2 pi / T)^2 - 1) / 4 is drawn, equation (13) of [JAP].
"""

import sys

import numpy as np
from matplotlib.patches import Patch

import figures
import grids

QUANTITY = {"energy": "energy", "clearance": "smallest gap", "impulse": "impulse"}


def draw_quantity(figure, axes, grid, result, name):
    """A quantity of the sound orbits, others left grey: what is not admissible is no motion."""
    column = result.need(name).reshape(len(result.outcome), -1)[:, 0]
    values = np.where(result.sound & np.isfinite(column) & (column > 0), column, np.nan)
    label = f"{QUANTITY[name]} of admissible orbits"
    grids.draw_numbers(figure, axes, grid, values, label, "no admissible orbit")
    return Patch(facecolor=grids.EMPTY, label="not admissible (right panel)")


def draw(result, options):
    result.need_sweep(2)
    grid = grids.Grid(result, options.swap)
    count = 1 if options.quantity == "none" else 2
    figure, panels, legend = grids.lay_out(count)
    entries = grids.draw_words(panels[0], grid, result.detailed_outcome(), figures.OUTCOME_LOOK)
    if count == 2:
        entries.append(draw_quantity(figure, panels[1], grid, result, options.quantity))
    for axes in panels:
        grid.frame(axes)
    if count == 2:
        panels[1].set_ylabel("")
        panels[1].tick_params(labelleft=False)
    entries += grids.draw_grazing_curve(panels, grid)
    figures.legend_row(legend, entries, 1 + count)
    figures.put_title(figure, panels[0], result, 60 * count)
    return figure


def options(parser):
    parser.add_argument(
        "--quantity",
        choices=[*QUANTITY, "none"],
        default="energy",
        help="colour of the second panel (default energy), or none for the outcomes alone",
    )
    parser.add_argument(
        "--swap", action="store_true", help="put the last swept parameter on the horizontal axis"
    )


if __name__ == "__main__":
    sys.exit(figures.run(draw, "map", __doc__, options))
