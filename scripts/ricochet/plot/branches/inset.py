"""A crowded place of a plane, and an inset that shows it larger where the panel is empty."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look
from ricochet.plot.sheet import is_narrow
from ricochet.sweep import Array

_HIDDEN = 5.0  # points, between markers of which one hides the other
_LINKED = 11.0  # points, between markers of one crowd
_LEAST = 1e-3  # extent of a crowd in one direction over that in the other
_ROOM = 0.45  # around a crowd, over its extent
_ENLARGED = 1.8  # the least enlargement that is worth an inset
_CELLS = 40  # of the panel each way, empty or not
# Width and height of the inset over the panel, the largest first.
_SIZES = ((0.46, 0.46), (0.5, 0.36), (0.36, 0.5), (0.4, 0.4), (0.46, 0.3), (0.34, 0.34), (0.4, 0.25), (0.28, 0.28))
_LABELS = (0.11, 0.09)  # of the panel, for the labels of ticks at the left and below


def crowd(places: Array, kinds: Array, axes: Axes) -> Array | None:
    """The limits [2, 2] of the most crowded place, rows low and high; None if no marker hides one of another kind.

    places  of markers [marker, 2] in data
    kinds   of the same [marker]
    """
    to_page = 72 / axes.figure.dpi
    pages = axes.transData.transform(places) * to_page
    inside = axes.transAxes.inverted().transform(pages / to_page)
    shown = np.isfinite(pages).all(axis=1) & ((inside >= 0) & (inside <= 1)).all(axis=1)
    pages, inside, kinds = pages[shown], inside[shown], kinds[shown]
    groups = [group for group in _groups(pages) if _hides(pages[group], kinds[group])]
    if not groups:
        return None
    return _limits(inside[max(groups, key=len)], axes)


def draw(axes: Axes, limits: Array, curves: list[Array], paint: Callable[[Axes], None]) -> Axes | None:
    """An inset with these limits, painted by `paint`, where no curve [node, 2] of the panel goes; None without room."""
    inside = axes.transAxes.inverted().transform(axes.transData.transform(limits))
    middle = inside.mean(axis=0)
    box = _free_box(_taken(curves, limits, axes), middle)
    if box is None or (box[2:] < _ENLARGED * np.ptp(inside, axis=0)).all():
        return None
    inset = axes.inset_axes(box, zorder=7)
    inset.set(xlim=limits[:, 0], ylim=limits[:, 1], autoscale_on=False)
    paint(inset)
    _frame(inset, is_right=box[0] > middle[0], is_above=box[1] > middle[1])
    axes.indicate_inset_zoom(inset, edgecolor=look.FAINT, alpha=0.6, zorder=1.5)
    return inset


def _frame(inset: Axes, is_right: bool, is_above: bool) -> None:
    """All four sides; ticks at those away from the crowd, where no connecting line passes."""
    inset.spines[["top", "right"]].set_visible(True)
    inset.tick_params(labelsize=0.8 * mpl.rcParams["font.size"], length=2.5, pad=2)
    if is_right:
        inset.yaxis.tick_right()
    if is_above:
        inset.xaxis.tick_top()
    inset.xaxis.set_major_locator(MaxNLocator(2 if is_narrow() else 3))
    inset.yaxis.set_major_locator(MaxNLocator(3))
    inset.ticklabel_format(useOffset=False)


# --- crowds ---


def _groups(pages: Array) -> list[Array]:
    """Indices of markers that are linked by small distances, on the page."""
    left, groups = set(range(len(pages))), []
    while left:
        group, border = [], [left.pop()]
        while border:
            one = border.pop()
            group.append(one)
            near = [other for other in left if np.hypot(*(pages[one] - pages[other])) < _LINKED]
            left.difference_update(near)
            border += near
        groups.append(np.array(sorted(group)))
    return groups


def _hides(pages: Array, kinds: Array) -> bool:
    """Whether two markers at different places are so near that one hides the other, of another kind."""
    far = np.hypot(*(pages[:, None] - pages[None]).transpose(2, 0, 1))
    return bool(((far > 1e-6 * _HIDDEN) & (far < _HIDDEN) & (kinds[:, None] != kinds[None])).any())


def _limits(inside: Array, axes: Axes) -> Array:
    low, extent = inside.min(axis=0), np.ptp(inside, axis=0)
    extent = np.maximum(extent, _LEAST * extent.max())
    middle = 0.5 * (low + inside.max(axis=0))
    corners = middle + np.array([[-1], [1]]) * (0.5 + _ROOM) * extent
    return np.asarray(axes.transData.inverted().transform(axes.transAxes.transform(corners)))


# --- room ---


def _taken(curves: list[Array], limits: Array, axes: Axes) -> Array:
    """Cells of the panel [column, row] through which a curve goes."""
    taken = np.zeros((_CELLS, _CELLS), dtype=bool)
    for nodes in [*curves, limits]:
        inside = axes.transAxes.inverted().transform(axes.transData.transform(nodes))
        for one, other in itertools.pairwise(inside):
            places = _inner_part(one, other)
            cells = np.minimum(_CELLS * places, _CELLS - 1).astype(int)
            taken[tuple(cells.T)] = True
    return taken


def _inner_part(one: Array, other: Array) -> Array:
    """Close places [place, 2] along a straight line, as far as it goes through the panel."""
    if not np.isfinite([one, other]).all():
        return np.empty((0, 2))
    step = np.where(other == one, 1e-12, other - one)
    crossings = np.sort([-one / step, (1 - one) / step], axis=0)
    first, last = max(0.0, crossings[0].max()), min(1.0, crossings[1].min())
    if not first < last:
        return np.empty((0, 2))
    places = one + np.linspace(first, last, 2 + int(2 * _CELLS * (last - first) * np.abs(step).max()))[:, None] * step
    return np.asarray(np.clip(places, 0, 1))


def _free_box(taken: Array, middle: Array) -> tuple[float, float, float, float] | None:
    """Left, bottom, width, height over the panel of the largest inset that covers no curve, near a place; there is room
    for labels on its sides away from that place."""
    sums = np.zeros((_CELLS + 1, _CELLS + 1), dtype=int)
    sums[1:, 1:] = taken.cumsum(axis=0).cumsum(axis=1)
    for size in np.array(_SIZES):
        wide, high = np.round(_CELLS * (size + _LABELS)).astype(int)
        covered = sums[wide:, high:] - sums[:-wide, high:] - sums[wide:, :-high] + sums[:-wide, :-high]
        free = np.argwhere(covered == 0) / _CELLS
        if len(free):
            far = np.hypot(*(free + 0.5 * size - middle).T)
            corner = free[far.argmin()]
            left, bottom = corner + np.where(corner > middle, 0.01, _LABELS)
            return float(left), float(bottom), *(size - 0.02)
    return None
