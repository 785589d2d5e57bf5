"""The first resonance of orbits over period and coupling: where the highest mode that they excite has their period."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ricochet.plot.grid import Grid
from ricochet.plot.pattern import hitting
from ricochet.result import Result
from ricochet.sweep import Array

_NONLINEAR = ("model.quadratic", "model.cubic", "model.link_quadratic", "model.link_cubic")
_LINE = {"color": "black", "linewidth": 1.2, "linestyle": (0, (6, 2))}
_EXCITED = 1e-6  # what the impacts give a mode over what they would if all were at its largest displacement


def wave_numbers(particles: int, ends: str) -> Array:
    """Of the modes of a chain, falling; 4 sin^2(kappa / 2) is the eigenvalue of the coupling matrix with unit springs."""
    if ends == "fixed":
        return np.pi * np.arange(particles, 0, -1) / (particles + 1)
    if ends == "free":
        return np.pi * np.arange(particles - 1, -1, -1) / particles
    return 2 * np.pi * np.arange(particles // 2, -1, -1) / particles


def _shape(wave_number: float, ends: str, places: Array) -> Array:
    """A mode at some particles; of a ring both modes of the wave number as one complex."""
    if ends == "periodic":
        return np.asarray(np.exp(1j * wave_number * places))
    return np.asarray(np.sin(wave_number * (places + 1)) if ends == "fixed" else np.cos(wave_number * (places + 0.5)))


def _highest_excited(result: Result) -> float | None:
    """The largest wave number of a mode that the impacts excite once in a period: a symmetric pattern leaves out modes
    of the other symmetry, which are no resonances of its orbits. None if there is none."""
    start, half = hitting(result)
    places, signs = np.array([*start, *half]), np.repeat([1.0, -1.0], [len(start), len(half)])
    impulses = result["orbits"]["impulse"]
    weights = impulses[np.isfinite(impulses).all(axis=1) & (impulses != 0).any(axis=1)] * signs
    ends = result.parameters["model.ends"]
    for wave_number in wave_numbers(result.parameters["model.particles"], ends):
        pushes = np.abs(weights @ _shape(wave_number, ends, places)) / np.abs(weights).sum(axis=1)
        if len(pushes) and np.median(pushes) > _EXCITED:
            return float(wave_number)
    return None


def gamma_c(result: Result, periods: Array) -> Array | None:
    """The couplings at which the highest mode that the impacts excite has these periods [periods], NaN where they are
    not positive. None if the result is not of a linear chain of equal particles, or that mode does not depend on the
    coupling. With one impact in an even ring of unit mass and stiffness it is [JAP] (13)."""
    values = result.parameters
    if values["model.type"] != "chain" or any(np.any(values[key] != 0) for key in _NONLINEAR):
        return None
    mass, stiffness = (np.unique(values[key]) for key in ("model.mass", "model.stiffness"))
    wave_number = _highest_excited(result)
    if len(mass) > 1 or len(stiffness) > 1 or not wave_number:
        return None
    coupling = (mass * (2 * np.pi / periods) ** 2 - stiffness) / (4 * np.sin(wave_number / 2) ** 2)
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
    return [Line2D([], [], label=r"$\gamma_c$: the highest mode that the impacts excite has the period $T$", **_LINE)]
