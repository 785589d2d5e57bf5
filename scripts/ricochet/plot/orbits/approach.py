"""The way of a family of orbits to the linear mode in which it ends."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import outcomes
from ricochet.plot.pattern import pattern
from ricochet.plot.sheet import Sheet, is_narrow
from ricochet.plot.words import assignment, parameter_symbol
from ricochet.result import Result
from ricochet.sweep import Array

_FEWEST = 3  # orbits beside the limit
_CLOSE = 0.2  # of the largest distance: half of the orbits are closer where the figure is drawn unasked


class _Approach:
    """The limit, a grazing orbit, and the admissible ones in the order of their distance from it, farthest first."""

    def __init__(self, result: Result):
        orbits, name = result["orbits"], result.swept[0]
        limits, at = _limits(result), result.sweep.values[name]
        limit = limits[0]
        impulse = np.abs(orbits["impulse"]).max(axis=1)
        distance = np.abs(at - at[limit])
        sound = outcomes.sound(result) & np.isfinite(orbits["q"]).all(axis=1) & np.isfinite(impulse)
        rows = np.flatnonzero((distance > 0) & sound)
        rows = rows[np.argsort(-distance[rows], kind="stable")]
        self.q, self.impulse, self.distance = orbits["q"][rows], impulse[rows], distance[rows]
        self.limit, self.limit_at = orbits["q"][limit], float(at[limit])
        self.gap = np.abs(self.q - self.limit).max(axis=1)
        self.one_sided = bool((at[rows] < at[limit]).all() or (at[rows] > at[limit]).all())
        self.below = bool((at[rows] < at[limit]).all())
        self.symbol = parameter_symbol(result, name)
        self.place = assignment(result, name, self.limit_at, 10)

    @property
    def label(self) -> str:
        """The distance in words: gamma_c - gamma, as [JAP] has it, where gamma is swept towards it from below."""
        if self.symbol == r"$\gamma$":
            return r"$\gamma_c - \gamma$" if self.below else r"$|\gamma - \gamma_c|$"
        return f"distance of {self.symbol} from its limit"


def _limits(result: Result) -> Array:
    return np.flatnonzero(result["orbits"]["outcome"] == "grazing")


def _reason(result: Result) -> str:
    limits = _limits(result)
    if len(limits) != 1:
        return f"{len(limits)} tasks with the outcome grazing, this figure needs one: the limit"
    count = len(_Approach(result).distance)
    return "" if count >= _FEWEST else f"{count} admissible orbits beside the limit, this figure needs {_FEWEST}"


def _is_approach(result: Result) -> bool:
    """Whether the values of the sweep accumulate at its limit, from one side."""
    way = _Approach(result)
    return way.one_sided and bool(np.median(way.distance) < _CLOSE * way.distance.max())


@figure(
    "orbits",
    shows="how a family of orbits comes to the grazing orbit in which it ends",
    columns=("orbits/q", "orbits/impulse"),
    swept=1,
    reason=_reason,
    natural=_is_approach,
)
def approach(result: Result) -> Figure:
    """Positions at t = 0+ on the way to the limit, the one task whose outcome is grazing; impulse and distance from the
    limit against the distance in the parameter, with slopes over the nearest third."""
    way = _Approach(result)
    if is_narrow():
        sheet = Sheet(result, 5.6, 8.6, rows=2)
        shapes, rates = sheet.panel(0), sheet.panel(1)
    else:
        sheet = Sheet(result, 11.0, 4.6, columns=2)
        shapes, rates = sheet.panel(0, 0), sheet.panel(0, 1)
    _draw_shapes(sheet, shapes, way)
    _draw_rates(sheet, rates, way)
    return sheet.finish(words=pattern(result))


def _draw_shapes(sheet: Sheet, axes: Axes, way: _Approach) -> None:
    """A line for each orbit, its colour the distance; rings for the limit."""
    particles = np.arange(way.q.shape[1])
    lines = LineCollection([np.column_stack([particles, row]) for row in way.q], linewidths=1.2, zorder=2)
    norm = LogNorm(way.distance.min(), way.distance.max())
    lines.set(array=way.distance, cmap=look.colour_map().reversed(), norm=norm)
    axes.add_collection(lines)
    rings = {"linestyle": "", "marker": "o", "markersize": 6.5, "markerfacecolor": "none", "markeredgecolor": look.INK}
    axes.plot(particles, way.limit, markeredgewidth=1.1, zorder=3, **rings)
    sheet.legend([Line2D([], [], label=f"limit, grazing, at {way.place}", **rings)])
    axes.set_xlim(-0.8, len(particles) - 0.2)
    axes.set_ylim(*scale.pad_limits(np.append(way.q, way.limit), 0.08))
    axes.set(xlabel="particle", ylabel=r"position $q$ at $t = 0^+$")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=8))
    sheet.figure.colorbar(lines, ax=axes, label=way.label, aspect=34, pad=0.02)


def _draw_rates(sheet: Sheet, axes: Axes, way: _Approach) -> None:
    count = max(_FEWEST, len(way.distance) // 3)
    for size, marker, colour, text in (
        (way.impulse, "o", look.BLUE, "impulse"),
        (way.gap, "s", look.RED, r"largest $|q_i - q_{i,\,\mathrm{limit}}|$"),
    ):
        marks = {"marker": marker, "color": colour, "markersize": 5, "linewidth": 1.2}
        axes.loglog(way.distance, np.where(size > 0, size, np.nan), **marks)
        slope = _tail_slope(way.distance, size, count)
        words = "" if np.isnan(slope) else f", slope {slope:.4f}"
        sheet.legend([Line2D([], [], label=f"{text}{words}", **marks)])
    axes.set(xlabel=way.label, ylabel="impulse, distance from the limit")
    axes.grid(True, color="#e4e4e4", linewidth=0.7)
    axes.set_axisbelow(True)
    sheet.note(f"slopes over the {count} nearest points")


def _tail_slope(distance: Array, size: Array, count: int) -> float:
    """Slope of the straight line through the nearest points, in decades; NaN where a size is exactly 0."""
    near, last = np.log10(distance[-count:]), size[-count:]
    if not (last > 0).all() or np.ptp(near) == 0:
        return float("nan")
    return float(np.polyfit(near, np.log10(last), 1)[0])
