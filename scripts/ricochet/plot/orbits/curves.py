"""Quantities of orbits along a sweep, as curves that end where they must not be joined: at values that are not finite,
and at singular points, where the amplitude passes through infinity."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes

from ricochet.plot import scale
from ricochet.sweep import Array

DASHES = (0, (4, 1.6))  # of orbits that are not admissible
_MOST_DOTS = 80  # points that have dots on their curve


def cuts(at: Array, impulses: Array, singular: Iterable[float]) -> Array:
    """Intervals between neighbours that hold a singular point [points - 1].

    Listed, or inferred from an impulse [points, impacts] that changes its sign and grows towards the interval from both
    sides.
    """
    found = np.zeros(max(len(at) - 1, 0), dtype=bool)
    for where in singular:
        i = np.searchsorted(at, where) - 1
        if 0 <= i < len(found):
            found[i] = True
    if len(at) >= 4:
        size = np.abs(impulses)
        grows = (size[1:-2] > size[:-3]) & (size[2:-1] > size[3:])
        flips = impulses[1:-2] * impulses[2:-1] < 0
        found[1:-1] |= (grows & flips).any(axis=1)
    return found


def draw(axes: Axes, at: Array, values: Array, sound: Array, cut: Array, colour: str, width: float = 1.6) -> None:
    """A curve over rising parameters: full lines join sound points, dashed ones take the rest. Points that no line
    joins, and all points of a short sweep, have dots."""
    here = np.isfinite(values)
    joined = here[:-1] & here[1:] & ~cut
    full = joined & sound[:-1] & sound[1:]
    axes.plot(*_pieces(at, values, full), color=colour, linewidth=width, zorder=3)
    faint = {"linewidth": 0.75 * width, "alpha": 0.55, "linestyle": DASHES}
    axes.plot(*_pieces(at, values, joined & ~full), color=colour, zorder=3, **faint)
    alone = here & ~np.append(joined, False) & ~np.insert(joined, 0, False)
    dots = here if len(at) <= _MOST_DOTS else alone
    for some, face in ((dots & sound, colour), (dots & ~sound, "white")):
        axes.plot(at[some], values[some], ".", color=colour, markerfacecolor=face, markersize=5, zorder=3)


def _pieces(at: Array, values: Array, joined: Array) -> tuple[Array, Array]:
    """The points at the ends of the joined intervals, runs of them parted by NaN."""
    rows = [np.append(np.arange(first, last + 2), -1) for first, last in scale.runs(joined)]
    rows = np.concatenate([np.empty(0, dtype=int), *rows])
    return np.where(rows < 0, np.nan, at[rows]), np.where(rows < 0, np.nan, values[rows])
