"""The first resonance of a chain over period and coupling: where its highest mode has the period of the orbits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ricochet.plot.grid import Grid
from ricochet.result import Result
from ricochet.sweep import Array

_NONLINEAR = ("model.quadratic", "model.cubic", "model.link_quadratic", "model.link_cubic")
_LINE = {"color": "black", "linewidth": 1.2, "linestyle": (0, (6, 2))}


def largest_eigenvalue(particles: int, ends: str) -> float:
    """Of the coupling matrix of a chain with unit springs: 4 sin^2(kappa / 2) at its largest wave number."""
    halves = {  # kappa / 2
        "periodic": np.pi * (particles // 2) / particles,
        "fixed": np.pi * particles / (2 * (particles + 1)),
        "free": np.pi * (particles - 1) / (2 * particles),
    }
    return float(4 * np.sin(halves[ends]) ** 2)


def gamma_c(result: Result, periods: Array) -> Array | None:
    """The couplings at which the highest mode has these periods [periods], NaN where they are not positive. None if
    the result is not of a linear chain of equal particles, or its modes do not depend on the coupling. Of an even ring
    of unit mass and stiffness it is [JAP] (13)."""
    values = result.parameters
    if values["model.type"] != "chain" or any(np.any(values[key] != 0) for key in _NONLINEAR):
        return None
    mass, stiffness = (np.unique(values[key]) for key in ("model.mass", "model.stiffness"))
    eigenvalue = largest_eigenvalue(values["model.particles"], values["model.ends"])
    if len(mass) > 1 or len(stiffness) > 1 or eigenvalue == 0:
        return None
    coupling = (mass * (2 * np.pi / periods) ** 2 - stiffness) / eigenvalue
    return np.where(coupling > 0, coupling, np.nan)


def draw(panels: Sequence[Axes], grid: Grid) -> list[Artist]:
    """The curve, where the axes are its two variables; its entry of the legend."""
    if {grid.x_name, grid.y_name} != {"model.gamma", "orbit.period"}:
        return []
    across = grid.x_name == "orbit.period"
    borders = grid.edges()[0 if across else 1]
    periods = np.linspace(borders[0], borders[-1], 400)
    coupling = gamma_c(grid.result, periods)
    if coupling is None or not np.isfinite(coupling).any():
        return []
    curve = (periods, coupling) if across else (coupling, periods)
    for axes in panels:
        axes.plot(*curve, color="white", linewidth=2.8, zorder=3)
        axes.plot(*curve, zorder=3.5, **_LINE)
    return [Line2D([], [], label=r"$\gamma_c$: the highest mode of this chain has the period $T$", **_LINE)]
