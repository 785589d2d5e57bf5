"""Figures of results: a function for each, from a result to matplotlib's figure.

    result = ricochet.open("example1.h5")
    figure = ricochet.plot.modes(result)
    ricochet.plot.save(figure, "modes.pdf")

    with ricochet.plot.style(column=True, title=""):    # for a column of a journal
        figure = ricochet.plot.sweep(result, xlim=(0, 0.19))

`figures_of(result)` lists those that can be drawn of a result, `CATALOGUE` all of them. It needs matplotlib.
"""

from ricochet.plot.catalogue import CATALOGUE, Spec, figures_of
from ricochet.plot.orbits.modes import modes
from ricochet.plot.sheet import FigureError, save, style
from ricochet.plot.trajectories.animation import animation
from ricochet.plot.trajectories.lyapunov import lyapunov, lyapunov_history
from ricochet.plot.trajectories.phase import phase
from ricochet.plot.trajectories.spacetime import spacetime
from ricochet.plot.trajectories.trajectory import trajectory

__all__ = [
    "CATALOGUE",
    "FigureError",
    "Spec",
    "animation",
    "figures_of",
    "lyapunov",
    "lyapunov_history",
    "modes",
    "phase",
    "save",
    "spacetime",
    "style",
    "trajectory",
]
