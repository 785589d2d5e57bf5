"""Branches in the plane of two quantities: lines by stability, markers of special points, and what is left out."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ricochet.plot import look, scale
from ricochet.plot.branches import colours, family, inset
from ricochet.plot.branches.family import INADMISSIBLE
from ricochet.plot.pattern import pattern
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.words import count, followed
from ricochet.result import Result
from ricochet.sweep import Array

# Label, dashes and width of parts of branches.
_LINES: dict[str, tuple[str, Any, float]] = {
    "stable": ("stable", "-", 1.8),
    "unstable": ("unstable", (0, (4, 1.6)), 1.5),
    "undecided": ("stability undecided", (0, (6, 1.2, 1.2, 1.2)), 1.5),
    "unknown": ("stability unknown", "-", 0.9),
    INADMISSIBLE: ("not admissible", (0, (1, 1.6)), 1.2),
}
_GREY = "#9a9a9a"
_LABELS = {
    "energy_extreme": "$dE/dT = 0$",
    "impulse_sign": "impulse changes sign",
    "order": "impacts coincide",
}
_BARE = ("|",)  # markers that are lines, and hide nothing
_TEXT = 10.0  # size of the text for which those of markers are meant
_NEAR = 1.5  # points, between markers that lie on one another
_EQUAL = 1e-6  # of the extent of all, difference of special points that count as one
_RING = 0.6  # by which a marker around another one is larger, over the size of its kind
_SMALL = 0.6  # the size of markers in a place that an inset enlarges


def special_label(kind: str) -> str:
    """A kind of special point in the words of figures."""
    return _LABELS.get(kind, kind.replace("_", " "))


def marker(kind: str) -> dict[str, Any]:
    """The marker of a kind of special point as options of a line, as large as the text wants it."""
    shape, colour, size = look.SPECIAL_POINTS.get(kind, look.OTHER_POINT)
    size *= mpl.rcParams["font.size"] / _TEXT
    edge = (colour, 1.1) if shape in _BARE else (look.INK, 0.7)
    return {
        "marker": shape,
        "color": colour,
        "markersize": size,
        "markeredgecolor": edge[0],
        "markeredgewidth": edge[1],
    }


class Plane:
    """The branches of some tasks, to be drawn on any axes.

    x, y     quantities
    at       places of the special points that are drawn [special, 2]; their kinds [special]
    owners   task and segment of each [special, 2]
    hidden   how many are not drawn because of their kind
    """

    def __init__(self, result: Result, x: str, y: str, tasks: Sequence[int], all: bool, without: Sequence[str] = ()):
        """`all`: also what is not admissible. `without`: kinds of special points that are not drawn."""
        self.result, self.x, self.y, self.tasks, self.all = result, x, y, tasks, all
        self.colours = colours.of_tasks(result, tasks)
        self.segments = family.segments(result, tasks)
        self._expect_motions()
        kept = [self._kept(segment, without) for segment in self.segments]
        self.at = np.concatenate([self._nodes(segment)[nodes] for segment, nodes in zip(self.segments, kept)])
        self.kinds = np.concatenate([segment.kinds[nodes] for segment, nodes in zip(self.segments, kept)])
        owners = [
            np.tile([segment.task, segment.number], (nodes.sum(), 1)) for segment, nodes in zip(self.segments, kept)
        ]
        self.owners = np.concatenate(owners)
        self.sound = np.concatenate([segment.sound[nodes] for segment, nodes in zip(self.segments, kept)])
        self.hidden = sum(int((np.isin(s.kinds, without) & (s.sound | all)).sum()) for s in self.segments)

    def _expect_motions(self) -> None:
        if not self.all and not any(segment.sound[segment.kinds == ""].any() for segment in self.segments):
            raise FigureError(self.result.path, "no motion of it is admissible; --all draws the others, too")

    def _kept(self, segment: family.Segment, without: Sequence[str]) -> Array:
        """Whether a node is a special point that is drawn."""
        return np.asarray((segment.kinds != "") & ~np.isin(segment.kinds, without) & (segment.sound | self.all))

    def _nodes(self, segment: family.Segment) -> Array:
        return np.column_stack([segment.values(self.x), segment.values(self.y)])

    def curves(self) -> list[tuple[str, str, Array]]:
        """What is drawn of the segments: the look, the colour, and the nodes [node, 2] of each piece."""
        found = []
        for segment in self.segments:
            nodes, colour = self._nodes(segment), self.colours.of(segment.task, segment.number)
            for name, piece in segment.pieces():
                if name != INADMISSIBLE:
                    found.append((name, colour, nodes[piece]))
                elif self.all:
                    found.append((name, _GREY, nodes[piece]))
        return found

    # --- drawing ---

    def draw(self, axes: Axes) -> None:
        """Lines; motions beside which there are no others are dots."""
        for name, colour, nodes in self.curves():
            _, dashes, width = _LINES[name]
            depth = 2 if name == INADMISSIBLE else 3
            axes.plot(*nodes.T, linestyle=dashes, linewidth=width, color=colour, zorder=depth)
        for segment in self.segments:
            if segment.lone().any():
                colour = self.colours.of(segment.task, segment.number)
                axes.plot(*self._nodes(segment)[segment.lone()].T, ".", color=colour, markersize=5, zorder=3)

    def mark(self, axes: Axes, crowded: Array | None = None) -> None:
        """Markers of the special points, when the limits are known. One that lies on another is a ring around it; those
        between the limits [2, 2] of a crowded place are small."""
        pages = axes.transData.transform(self.at) * 72 / axes.figure.dpi
        small = np.zeros(len(self.at), dtype=bool) if crowded is None else _within(self.at, crowded)
        depth = np.where(small, 0, _depths(pages, self.kinds))
        for kind in self._drawn_kinds():
            for level, is_small, sound in itertools.product(range(3), (False, True), (False, True)):
                rows = (self.kinds == kind) & (depth == level) & (small == is_small) & (self.sound == sound)
                if rows.any():
                    axes.plot(*self.at[rows].T, linestyle="", zorder=6 - level, **_style(kind, level, is_small, sound))

    def _drawn_kinds(self) -> list[str]:
        return look.ordered(self.kinds, look.SPECIAL_POINTS)

    # --- the figure ---

    def picture(self, logarithmic: bool, notes: Sequence[str] = ()) -> Figure:
        """The figure of this plane; `logarithmic`: its horizontal axis."""
        sheet = Sheet(self.result, 8.6, 5.4)
        axes = sheet.panel(xlabel=family.label(self.result, self.x), ylabel=family.label(self.result, self.y))
        axes.margins(x=0.03, y=0.06)
        if logarithmic:
            axes.set_xscale("log")
        if self.y == "multiplier_max":
            axes.axhline(1, color=look.FAINT, linewidth=0.6, zorder=1)
        self.draw(axes)
        self._limit(sheet, axes)
        if logarithmic:
            scale.label_decades(axes.xaxis)
        self._mark_enlarged(sheet, axes)
        self.colours.draw_bar(sheet)
        sheet.legend(self.entries())
        for note in filter(None, [self.left_out(), *notes]):
            sheet.note(note)
        words = [*pattern(self.result), *colours.others(self.result, self.tasks, self.colours.shown)]
        return sheet.finish(varied=[followed(self.result)], words=words)

    def _limit(self, sheet: Sheet, axes: Axes) -> None:
        """Limits of the panel, which stay. Solutions that are no motions may blow up."""
        axes.set_xlim(axes.get_xlim())
        axes.set_ylim(axes.get_ylim())
        if self.all:
            heights = np.concatenate([segment.values(self.y) for segment in self.segments])
            low, high, clipped = scale.robust_limits(heights, np.concatenate([s.sound for s in self.segments]))
            axes.set_ylim(low, high)
            if clipped:
                sheet.note(scale.clip_note(heights))
        sheet.apply_limits()

    def _mark_enlarged(self, sheet: Sheet, axes: Axes) -> None:
        """Markers, and an inset where they hide one another."""
        solid = self.sound & _solid(self.kinds)
        limits = inset.crowd(self.at[solid], self.kinds[solid], axes)
        curves = [nodes for _, _, nodes in self.curves()]
        if limits is not None and inset.draw(axes, limits, curves, self._paint) is None:
            sheet.note("special points lie on one another: --xlim and --ylim enlarge the place")
            limits = None
        self.mark(axes, limits)

    def _paint(self, axes: Axes) -> None:
        self.draw(axes)
        self.mark(axes)

    # --- words ---

    def entries(self) -> list[Artist]:
        """Entries of the legend."""
        seen = {name: _GREY if name == INADMISSIBLE else look.INK for name, _, _ in self.curves()}
        lines = [
            Line2D([], [], linestyle=dashes, linewidth=width, label=text, color=seen[name])
            for name, (text, dashes, width) in _LINES.items()
            if name in seen
        ]
        new = ~self._returning()
        counts = {kind: int((new & (self.kinds == kind)).sum()) for kind in self._drawn_kinds()}
        marks = [
            Line2D([], [], linestyle="", label=f"{special_label(kind)} ({number})", **marker(kind))
            for kind, number in counts.items()
        ]
        return lines + self.colours.entries + marks

    def _returning(self) -> Array:
        """Whether a special point is one of an earlier segment of its task, along which its own segment returns
        [special]."""
        returning = np.zeros(len(self.at), dtype=bool)
        for k, (place, kind, (task, segment)) in enumerate(zip(self.at, self.kinds, self.owners)):
            tasks, segments = self.owners[:k].T
            earlier = self.at[:k][(self.kinds[:k] == kind) & (tasks == task) & (segments != segment)]
            returning[k] = (np.abs(earlier - place) <= _EQUAL * np.ptp(self.at, axis=0)).all(axis=1).any()
        return returning

    def left_out(self) -> str:
        """A note on the points that are not drawn; "" if all are."""
        points = sum(int((~segment.sound & (segment.kinds == "")).sum()) for segment in self.segments)
        special = sum(int((~segment.sound & (segment.kinds != "")).sum()) for segment in self.segments)
        if self.all or not points:
            return ""
        there = f", {count(special, 'special point')} there:" if special else ":"
        return f"{count(points, 'point')} on stretches that are not admissible{there} not drawn; --all draws them"


def _style(kind: str, level: int, is_small: bool, sound: bool) -> dict[str, Any]:
    style = marker(kind)
    if level:
        style |= {"markerfacecolor": "none", "markeredgecolor": style["color"], "markeredgewidth": 1.3}
    if not sound:
        style |= {"color": _GREY, "markeredgecolor": _GREY}
    style["markersize"] *= (_SMALL if is_small else 1) * (1 + _RING * level)
    return style


def _solid(kinds: Array) -> Array:
    """Whether markers hide others [special]."""
    return np.array([marker(kind)["marker"] not in _BARE for kind in kinds], dtype=bool)


def _within(places: Array, limits: Array) -> Array:
    return np.asarray(((places >= limits.min(axis=0)) & (places <= limits.max(axis=0))).all(axis=1))


def _depths(pages: Array, kinds: Array) -> Array:
    """How many markers of other kinds lie under each one at the same place, at most two [special]."""
    depths = np.zeros(len(pages), dtype=int)
    solid = _solid(kinds)
    for i in np.flatnonzero(solid):
        under = solid[:i] & (np.hypot(*(pages[:i] - pages[i]).T) < _NEAR)
        depths[i] = min(len(set(kinds[:i][under]) - {kinds[i]}), 2)
    return depths
