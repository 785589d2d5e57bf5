#!/usr/bin/python3
"""Draws a map of stability over a grid of two parameters, beside it the largest multiplier of the unstable orbits.

Datasets: /orbits/stable and /orbits/multiplier_max (a study with orbit.stable or orbit.multipliers); /orbits/outcome,
by which orbits that are not admissible are left out unless --all asks for them; the two parameters of /sweep, laid
out by its attribute `grid` (the last one varies fastest). Where the axes are the coupling and the period, the curve
gamma_c(T) = ((2 pi / T)^2 - 1) / 4 is drawn, equation (13) of [JAP].
"""

import sys

import numpy as np
from matplotlib.patches import Patch

import figures
import grids

LEFT_OUT = "not admissible"
LOOKS = {**figures.STABILITY_LOOK, LEFT_OUT: ("#ededed", "", ".")}


def draw_modulus(figure, axes, grid, result, shown):
    """The largest modulus where it is above 1 and the orbit unstable."""
    largest = result.need("multiplier_max")
    unstable = shown & (result.need_stable() == "unstable") & np.isfinite(largest)
    label = "largest modulus of a multiplier, unstable orbits"
    grids.draw_numbers(figure, axes, grid, np.where(unstable, largest, np.nan), label, "no unstable orbit")
    return Patch(facecolor=grids.EMPTY, label="no unstable orbit (right panel)")


def draw(result, options):
    result.need_sweep(2)
    grid = grids.Grid(result, options.swap)
    shown = result.sound | options.all
    figure, panels, legend = grids.lay_out(2)
    entries = grids.draw_words(panels[0], grid, np.where(shown, result.need_stable(), LEFT_OUT), LOOKS)
    entries.append(draw_modulus(figure, panels[1], grid, result, shown))
    for axes in panels:
        grid.frame(axes)
    panels[1].set_ylabel("")
    panels[1].tick_params(labelleft=False)
    entries += grids.draw_grazing_curve(panels, grid)
    figures.legend_row(legend, entries, 3)
    figures.put_title(figure, panels[0], result, 120)
    return figure


def options(parser):
    parser.add_argument("--all", action="store_true", help="colour orbits that are not admissible too")
    parser.add_argument(
        "--swap", action="store_true", help="put the last swept parameter on the horizontal axis"
    )


if __name__ == "__main__":
    sys.exit(figures.run(draw, "stability", __doc__, options))
