"""Coordinates of a diagram: along it the parameter, or ln sqrt(d) / ln lambda; upwards the values, or values over the
root of the parameter, in which all scales look alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from ricochet.plot import scale
from ricochet.plot.diagrams.lines import FROM_GRAZING, Line, is_map, label_along, multiplier, state_label
from ricochet.plot.sheet import FigureError
from ricochet.plot.words import number, state_symbol, with_units
from ricochet.sweep import Array

_WIDE = 100  # values over such a range are divided by the root
_SPREADS = 0.25  # power of the parameter with which they spread then, at least


class Abscissa:
    """The horizontal axis: `at` [tasks] from left to right, and the borders `edges` [tasks + 1] of their cells."""

    def __init__(self, line: Line, label: str, size: float | None = None):
        """`size`: lambda of ln sqrt(d) / ln lambda; None for the parameter itself."""
        self.label, self._size = label, size
        self.logarithmic = size is None and scale.is_geometric(line.at)
        at = self.of(line.at)
        self._order = np.argsort(at)
        self.at = at[self._order]
        self.edges = scale.cell_edges(self.at, self.logarithmic)

    def of(self, values: Array) -> Array:
        """Places of values of the parameter."""
        return values if self._size is None else np.log(np.sqrt(values)) / np.log(self._size)

    def pick(self, column: Array, way: Array) -> Array:
        """The rows of one way, from left to right."""
        return np.asarray(column[way[self._order]])

    def place(self, low: float, high: float) -> tuple[float, float]:
        """A range of the parameter from left to right, cut off at the ends of the axis."""
        ends = np.clip(np.sort(self.of(np.array([low, high]))), self.edges[0], self.edges[-1])
        return float(ends[0]), float(ends[1])

    def fraction(self, place: float) -> float:
        """Where a place lies between the ends of the axis: 0 on the left, 1 on the right."""
        ends = np.array([place, self.edges[0], self.edges[-1]])
        at, first, last = np.log(ends) if self.logarithmic else ends
        return float((at - first) / (last - first))

    def frame(self, axes: Axes) -> None:
        axes.set_xscale("log" if self.logarithmic else "linear")
        axes.set_xlim(self.edges[0], self.edges[-1])
        if self.logarithmic:
            scale.label_decades(axes.xaxis)


def along(line: Line) -> Abscissa:
    """The swept parameter."""
    return Abscissa(line, label_along(line.result, line.name))


def scaled(line: Line, given: float | None) -> Abscissa:
    """ln sqrt(d) / ln lambda, with lambda as given or as in the study."""
    size = multiplier(line.result, line.first) if given is None else given
    if size is None:
        raise FigureError(
            line.result.path, "the study gives no lambda: say --multiplier, the dominant multiplier of the map"
        )
    if not 0 < size < 1:
        raise FigureError(line.result.path, f"lambda = {size:.6g}, this figure needs one between 0 and 1")
    return Abscissa(line, rf"$\ln\sqrt{{d}}\,/\,\ln\lambda$, with $\lambda = {number(size, 4)}$", size)


@dataclass(frozen=True)
class Ordinate:
    """The vertical axis: the values, less `origin`, over the root of the parameter if `rooted`.

    words  what the heading says of it
    """

    label: str
    rooted: bool = False
    origin: float = 0.0
    words: tuple[str, ...] = ()

    def of(self, line: Line, name: str) -> Array:
        """A column of a line on this axis [tasks, iterates]."""
        values = line.table[name]
        if not self.rooted:
            return values
        return np.asarray((values - self.origin) / np.sqrt(line.table[line.name])[:, None])


def upwards(line: Line) -> Ordinate:
    """Values over the root where they spread with it over a wide range of the parameter, otherwise as they are."""
    wide = scale.is_geometric(line.at) and line.at[-1] >= _WIDE * line.at[0] and line.name in FROM_GRAZING
    if wide and _spread_exponent(line) >= _SPREADS:
        return over_root(line)
    return plain(line)


def plain(line: Line) -> Ordinate:
    return Ordinate(with_units(state_label(_observed(line)), line.table.attributes("values").get("units")))


def over_root(line: Line) -> Ordinate:
    """Values over the root of d or mu, of motions less the value at grazing, which their map gives."""
    symbol = state_symbol(_observed(line))
    bare, root = symbol.strip("$"), r"\sqrt{d}" if line.name == "model.d" else r"\sqrt{\mu}"
    if is_map(line.result):
        return Ordinate(rf"${bare}\,/\,{root}$", rooted=True)
    if "map_values" not in line.table or not symbol.startswith("$"):
        return plain(line)
    origin = _value_at_grazing(line)
    if origin is None:
        return plain(line)
    word = f"${bare} = {number(origin, 6)}$ at grazing"
    sign = "+" if origin < 0 else "-"
    return Ordinate(rf"$({bare} {sign} {abs(origin):.6g})\,/\,{root}$", True, origin, (word,))


def _observed(line: Line) -> str:
    return str(line.table.attributes("values")["observed"])


def _spread_exponent(line: Line) -> float:
    """The power of the parameter with which values of a task spread: 1/2 beyond a continuous grazing bifurcation."""
    spread = np.ptp(line.table["values"][line.ways[0]], axis=1)
    known = np.isfinite(spread) & (spread > 0)
    return float(np.polyfit(np.log(line.at[known]), np.log(spread[known]), 1)[0]) if known.sum() > 1 else 0.0


def _value_at_grazing(line: Line) -> float | None:
    """Iterates of the map spread from it by sqrt(mu) to one side, and to the other by mu only: a line through their
    ends on that side, where mu is small, meets it. None if there is no map."""
    whole = line.table["map_values"][line.ways[0]]
    known = np.isfinite(whole).all(axis=1)
    if known.sum() < 2:
        return None
    at, whole = line.at[known], whole[known]
    end = min(whole.min(axis=1), whole.max(axis=1), key=np.ptp)
    return float(np.polyfit(at, end, 1, w=1 / at)[1])
