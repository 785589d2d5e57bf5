"""Figures of results: a function for each, from a result to matplotlib's figure.

    result = ricochet.open("example1.h5")
    figure = ricochet.plot.modes(result)
    ricochet.plot.save(figure, "modes.pdf")

    with ricochet.plot.style(column=True, title="", xlim=(0, 0.19)):    # for a column of a journal
        figure = ricochet.plot.sweep(result)

`figures_of(result)` lists those that can be drawn of a result, `CATALOGUE` all of them. It needs matplotlib.
"""

from ricochet.plot.branches.branch import branch
from ricochet.plot.branches.curves import curves
from ricochet.plot.branches.frequency_energy import frequency_energy
from ricochet.plot.branches.laws import laws
from ricochet.plot.branches.manifold import manifold
from ricochet.plot.branches.motions import motions
from ricochet.plot.catalogue import CATALOGUE, Spec, figures_of
from ricochet.plot.columns import columns
from ricochet.plot.diagrams.attractor import attractor
from ricochet.plot.diagrams.basin import basin
from ricochet.plot.diagrams.diagram import diagram, scaled
from ricochet.plot.diagrams.periods import periods
from ricochet.plot.diagrams.windows import window_table, windows
from ricochet.plot.grazings.criterion import criterion
from ricochet.plot.grazings.grazing_curve import grazing_curve
from ricochet.plot.grazings.grazing_windows import grazing_windows
from ricochet.plot.orbits.approach import approach
from ricochet.plot.orbits.maps import map  # noqa: A004
from ricochet.plot.orbits.modes import modes
from ricochet.plot.orbits.multipliers import multipliers
from ricochet.plot.orbits.ritz import ritz
from ricochet.plot.orbits.stability import stability
from ricochet.plot.orbits.sweep import sweep
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
    "approach",
    "attractor",
    "basin",
    "branch",
    "columns",
    "criterion",
    "curves",
    "diagram",
    "figures_of",
    "frequency_energy",
    "grazing_curve",
    "grazing_windows",
    "laws",
    "lyapunov",
    "lyapunov_history",
    "manifold",
    "map",
    "modes",
    "motions",
    "multipliers",
    "periods",
    "phase",
    "ritz",
    "save",
    "scaled",
    "spacetime",
    "stability",
    "style",
    "sweep",
    "trajectory",
    "window_table",
    "windows",
]
