"""Figures of results: a function for each, from a result to matplotlib's figure.

    result = ricochet.open("example1.h5")
    figure = ricochet.plot.modes(result)
    ricochet.plot.save(figure, "modes.pdf")

    with ricochet.plot.style(column=True, title=""):    # for a column of a journal
        figure = ricochet.plot.sweep(result, xlim=(0, 0.19))

`figures_of(result)` lists those that can be drawn of a result, `CATALOGUE` all of them. It needs matplotlib.
"""

from ricochet.plot.catalogue import CATALOGUE, Spec, figures_of
from ricochet.plot.columns import columns
from ricochet.plot.grazings.criterion import criterion
from ricochet.plot.grazings.grazing_curve import grazing_curve
from ricochet.plot.grazings.grazing_windows import grazing_windows
from ricochet.plot.orbits.modes import modes
from ricochet.plot.sheet import FigureError, save, style

__all__ = [
    "CATALOGUE",
    "FigureError",
    "Spec",
    "columns",
    "criterion",
    "figures_of",
    "grazing_curve",
    "grazing_windows",
    "modes",
    "save",
    "style",
]
