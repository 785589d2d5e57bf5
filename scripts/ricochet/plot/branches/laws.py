"""Mode shapes under Hertz's law beside those under the impact law: displacements at t = 0 against the particle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.branches import family
from ricochet.plot.catalogue import CATALOGUE, figure
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.words import assignment, obstacles
from ricochet.result import Result
from ricochet.sweep import Array

_GAMMA = "model.gamma"
_RIGID: dict[str, Any] = {"linestyle": "-", "marker": "o", "markersize": 4, "linewidth": 1.2}
_SOFT: dict[str, Any] = {"linestyle": (0, (4, 1.6)), "linewidth": 1.6}


def _unfit(result: Result) -> str:
    """Why the shapes of a branch cannot be compared; "" if they can."""
    reason = family.none_begins(result)
    if not reason and family.followed(result) != _GAMMA:
        reason = f"a branch along {family.followed(result)}, this figure needs one along {_GAMMA}"
    return reason


@figure(
    "branch",
    shows="mode shapes under Hertz's law beside those under the impact law",
    columns=("branch/point/q",),
    reason=_unfit,
    natural=lambda result: False,
    options={
        "impacts": "the branch of the same chain with rigid floors (needed)",
        "curves": "how many couplings are compared; default: 4",
    },
)
def laws(result: Result, *, impacts: str = "", curves: int = 4) -> Figure:
    """Shapes at couplings that both branches have, evenly picked, and their differences; between neighbouring points
    they are interpolated linearly."""
    if not impacts:
        raise FigureError(result.path, "figure laws needs a second result, of the chain with rigid floors: --impacts")
    soft = _shapes(result)
    with Result(impacts) as other:
        hard = _rigid_shapes(other, soft.q.shape[1], result.path)
    couplings = _common(result, soft, hard, impacts, curves)
    sheet = Sheet(result, 8.6, 6.6, rows=2, heights=(3, 2))
    upper = sheet.panel(0, ylabel="displacement $q$ at $t = 0$")
    lower = sheet.panel(1, sharex=upper, ylabel="Hertz minus impact law", xlabel="particle")
    sheet.legend([Line2D([], [], color=look.INK, **_RIGID, label="impact law")])
    sheet.legend([Line2D([], [], color=look.INK, **_SOFT, label="Hertz's law")])
    for gamma, colour in zip(couplings, look.colour_map()(np.linspace(0, 1, len(couplings)))):
        rigid, compliant = hard.at(gamma), soft.at(gamma)
        upper.plot(rigid, color=colour, **_RIGID)
        upper.plot(compliant, color=colour, **_SOFT)
        lower.plot(compliant - rigid, color=colour, linewidth=1.5)
        sheet.legend([Line2D([], [], color=colour, linewidth=2, label=assignment(result, _GAMMA, gamma, 4))])
    _draw_floors(sheet, upper)
    lower.axhline(0, color=look.FAINT, linewidth=0.6, zorder=1)
    lower.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12))
    lower.set_xlim(-0.6, soft.q.shape[1] - 0.4)
    upper.tick_params(labelbottom=False)
    return sheet.finish(about="mode shapes under Hertz's law and under the impact law", varied=[_GAMMA])


@dataclass
class _Shapes:
    """The shapes of a branch: couplings in increasing order [point], displacements there [point, particle]."""

    gamma: Array
    q: Array

    def at(self, gamma: float) -> Array:
        return np.array([np.interp(gamma, self.gamma, displacements) for displacements in self.q.T])


def _shapes(result: Result) -> _Shapes:
    """Those of the admissible motions."""
    points = result["branch/point"]
    points = points.where(family.is_sound(points))
    if not len(points):
        raise FigureError(result.path, "no motion of it is admissible")
    order = np.argsort(points["parameter"], kind="stable")
    return _Shapes(points["parameter"][order], points["q"][order])


def _rigid_shapes(other: Result, particles: int, path: str) -> _Shapes:
    reason = CATALOGUE["laws"].missing(other)
    if reason:
        raise FigureError(other.path, reason)
    shapes = _shapes(other)
    if shapes.q.shape[1] != particles:
        raise FigureError(path, f"{particles} particles, but {shapes.q.shape[1]} in {other.path}")
    return shapes


def _common(result: Result, soft: _Shapes, hard: _Shapes, impacts: str, curves: int) -> list[float]:
    """Couplings that both branches have, evenly picked."""
    low, high = max(soft.gamma[0], hard.gamma[0]), min(soft.gamma[-1], hard.gamma[-1])
    if not low < high:
        raise FigureError(result.path, f"no couplings in common with {impacts}")
    return [float(gamma) for gamma in np.linspace(low, high, max(curves, 1))]


def _draw_floors(sheet: Sheet, axes: Axes) -> None:
    """The floor of every particle, which soft contacts pass."""
    floors = obstacles(sheet.result)["floor"]
    look_of_floor = {"color": look.FAINT, "linewidth": 1.0, "linestyle": ":"}
    for first, last in scale.equal_runs(floors):
        axes.hlines(floors[first], first - 0.5, last + 0.5, zorder=1, **look_of_floor)
        sheet.legend([Line2D([], [], label="floor", **look_of_floor)])
