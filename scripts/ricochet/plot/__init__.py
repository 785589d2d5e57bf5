"""Figures of results: a function for each, from a result to matplotlib's figure.

    result = ricochet.open("example1.h5")
    figure = ricochet.plot.modes(result)
    ricochet.plot.save(figure, "modes.pdf")

    with ricochet.plot.style(column=True, title=""):    # for a column of a journal
        figure = ricochet.plot.sweep(result, xlim=(0, 0.19))

`figures_of(result)` lists those that can be drawn of a result, `CATALOGUE` all of them. It needs matplotlib.
"""

from ricochet.plot.branches.branch import branch
from ricochet.plot.branches.curves import curves
from ricochet.plot.branches.frequency_energy import frequency_energy
from ricochet.plot.branches.laws import laws
from ricochet.plot.branches.manifold import manifold
from ricochet.plot.branches.motions import motions
from ricochet.plot.catalogue import CATALOGUE, Spec, figures_of
from ricochet.plot.orbits.modes import modes
from ricochet.plot.sheet import FigureError, save, style

__all__ = [
    "CATALOGUE",
    "FigureError",
    "Spec",
    "branch",
    "curves",
    "figures_of",
    "frequency_energy",
    "laws",
    "manifold",
    "modes",
    "motions",
    "save",
    "style",
]
