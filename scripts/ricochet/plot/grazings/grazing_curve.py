"""Curves of grazing points in the plane of two parameters, coloured by what the grazing leads to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from ricochet.plot import look, scale
from ricochet.plot.branches.closed_form import grazing_form
from ricochet.plot.catalogue import figure
from ricochet.plot.grazings.points import (
    CONTINUOUS,
    DISCONTINUOUS,
    VERDICTS,
    chosen_tasks,
    followed,
    verdict_colour,
    verdict_label,
    why_none,
)
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.words import number, parameter_label
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

Kind = tuple[str, int]  # verdict, and the first negative c_i as far as colours tell it
_MARKS: dict[str, dict[str, Any]] = {
    "change": {"marker": "D", "markersize": 5.5, "markeredgecolor": "white", "markeredgewidth": 0.7},
    "later": {"marker": "o", "markersize": 2.6, "markerfacecolor": "white", "markeredgewidth": 0.5},
    "start": {"marker": "o", "markersize": 8, "markerfacecolor": "white", "markeredgewidth": 1.4},
}
_CLOSE = 1e-3  # relative distance from the closed form within which a curve is one of motions without impacts


@dataclass
class _Seen:
    """What the curves hold, for the legend."""

    kinds: set[Kind] = field(default_factory=set)
    changes: list[tuple[float, float, int, bool]] = field(default_factory=list)  # x, y, which c_i, rising curve
    later: int = 0


def _why_not(result: Result) -> str:
    return why_none(result) or ("" if len(result["grazing/curve"]) else "no grazing point of it has a curve")


@figure(
    "grazing",
    shows="curves of grazing points in two parameters, and where the bifurcation changes",
    columns=("grazing/curve",),
    reason=_why_not,
    options={"tasks": "the tasks whose curves are drawn"},
)
def grazing_curve(result: Result, *, tasks: Sequence[int] | None = None) -> Figure:
    """Curves coloured by the verdict, the discontinuous ones by the first negative c_i; marks where a c_i changes its
    sign. Below, the return at which the first negative c_i leads to another impact."""
    curves = {task: result["grazing/curve"].task(task) for task in chosen_tasks(result, tasks)}
    curves = {task: curve for task, curve in curves.items() if len(curve)}
    if not curves:
        raise FigureError(result.path, "no grazing point of these tasks has a curve")
    leaps = any((curve["first_negative"] >= 0).any() for curve in curves.values())
    sheet = Sheet(result, 8.6, 6.2, rows=2, heights=(1, 0.36)) if leaps else Sheet(result, 8.6, 5.2)
    axes, seen = sheet.panel(0), _Seen()
    for task, curve in curves.items():
        for way in _ways(curve):
            _draw_way(axes, way, seen)
        axes.plot(curve["second"][0], result["grazing"]["parameter"][task], zorder=5.5, **_mark("start"))
    names = followed(result), str(result.parameters["branch.trace.parameter"])
    _frame(sheet, axes, result, names, np.concatenate([curve["parameter"] for curve in curves.values()]))
    if leaps:
        _draw_first(sheet.panel(1, sharex=axes), list(curves.values()))
        axes.tick_params(labelbottom=False)
    sheet.panels[-1].set_xlabel(parameter_label(result, names[1]))
    sheet.legend(_entries(seen))
    _note_closed_form(sheet, result, curves, names)
    drawn = sheet.finish("curve of grazing points, coloured by the first $c_i < 0$", names)
    _name_changes(axes, seen)
    return drawn


def _ways(curve: Table) -> list[Table]:
    """Both ways of a curve, which begin at the grazing point of its task."""
    ways = [curve.where(part=part) for part in (0, 1)]
    return [way for way in ways if len(way)]


def _frame(sheet: Sheet, axes: Axes, result: Result, names: tuple[str, str], values: Array) -> None:
    """Label and limits of the followed parameter, logarithmic as it was followed, without runaway ends."""
    axes.set_ylabel(parameter_label(result, names[0]))
    axes.margins(x=0.02, y=0.05)
    if result.parameters["branch.scale"] == "log":
        axes.set_yscale("log")
        scale.label_decades(axes.yaxis)
        return
    low, high, clipped = scale.robust_limits(values, np.ones(len(values), dtype=bool))
    axes.set_ylim(low, high)
    if clipped:
        sheet.note(scale.clip_note(values))


# --- the curves ---


def _mark(name: str) -> dict[str, Any]:
    """The look of a mark, as large as the text allows."""
    own = _MARKS[name]
    sizes = {"markersize": own["markersize"] * _size(), "linestyle": ""}
    return {"color": look.INK, "markeredgecolor": look.INK, **own, **sizes}


def _line() -> float:
    return 3 * _size()


def _size() -> float:
    """Of marks, over that in a figure of usual width."""
    return float(mpl.rcParams["font.size"]) / 10


def _kinds(curve: Table) -> list[Kind]:
    most = len(DISCONTINUOUS) - 1
    firsts = np.minimum(curve["first_negative"], most).tolist()
    return [(word, first if word == "discontinuous" else -1) for word, first in zip(curve["verdict"].tolist(), firsts)]


def _draw_way(axes: Axes, way: Table, seen: _Seen) -> None:
    """One way in pieces of one kind, with marks where it changes."""
    x, y, change = way["second"], way["parameter"], way["change"]
    cut = _pieces(_kinds(way), change)
    for piece, kind in cut:
        axes.plot(x[piece], y[piece], color=verdict_colour(*kind), linewidth=_line(), solid_capstyle="butt", zorder=3)
        seen.kinds.add(kind)
    switches = {after[0].start: _changed(before[1], after[1]) for before, after in pairwise(cut)}
    rises = np.gradient(y) * np.gradient(x) >= 0 if len(x) > 1 else [True]
    for k in np.flatnonzero(change >= 0).tolist():
        if k in switches:
            seen.changes.append((float(x[k]), float(y[k]), switches[k], bool(rises[k])))
        else:
            seen.later += 1
        axes.plot(x[k], y[k], zorder=5 if k in switches else 4, **_mark("change" if k in switches else "later"))


def _pieces(kinds: list[Kind], change: Array) -> list[tuple[slice, Kind]]:
    """Slices of one kind, which share their ends. Where a c_i changes its sign the curve has a point whose own verdict
    is that of a zero: it counts to what follows."""
    regular = np.flatnonzero(change < 0)
    if len(regular) == 0:
        return [(slice(0, len(kinds)), kinds[0])]
    following = regular[np.minimum(np.searchsorted(regular, np.arange(len(kinds))), len(regular) - 1)]
    own = [kinds[k] for k in following]
    edges = [k for k in range(1, len(own)) if own[k] != own[k - 1]]
    return [(slice(a, min(b + 1, len(own))), own[a]) for a, b in pairwise([0, *edges, len(own)])]


def _changed(before: Kind, after: Kind) -> int:
    """The i whose c_i is negative on one side only: of two kinds that which comes first; -1 if none is."""
    return min((first for _, first in (before, after) if first >= 0), default=-1)


def _name_changes(axes: Axes, seen: _Seen) -> None:
    """Which c_i changes, beside its mark, where there is room for words; the sheet is finished."""
    axes.figure.draw_without_rendering()  # places the panels
    size, placed = mpl.rcParams["font.size"] * axes.figure.dpi / 72, np.empty((0, 2))
    marks = axes.transData.transform([change[:2] for change in seen.changes]) if seen.changes else placed
    for (x, y, i, rises), mark in sorted(zip(seen.changes, marks.tolist())):
        if i < 0 or (np.abs(placed - mark).max(axis=1) < 2.2 * size).any():
            continue
        beside = {"xytext": (-0.7, 0.45), "ha": "right"} if rises else {"xytext": (0.7, 0.45), "ha": "left"}
        word = axes.annotate(f"$c_{{{i}}}$", (x, y), textcoords="offset fontsize", zorder=6, **beside)
        word.set_in_layout(False)
        placed = np.vstack([placed, mark])


def _draw_first(axes: Axes, curves: Sequence[Table]) -> None:
    """The first negative c_i, as the number of returns until it leads to an impact."""
    for curve in curves:
        for way in _ways(curve):
            regular = way.where(way["change"] < 0)
            x, first = regular["second"], regular["first_negative"]
            returns = np.where(first >= 0, first + 1.0, np.nan)
            axes.plot(x, returns, color=look.FAINT, linewidth=0.8, drawstyle="steps-mid")
            colours = [verdict_colour(*kind) for kind in _kinds(regular)]
            axes.scatter(x, returns, c=colours, s=7 * _size() ** 2, zorder=3)
            smooth = x[regular["verdict"] == "continuous"]
            mark = {"marker": "|", "linestyle": "", "color": CONTINUOUS, "markersize": 8 * _size(), "clip_on": False}
            if len(smooth):
                axes.plot(smooth, np.ones(len(smooth)), zorder=4, transform=axes.get_xaxis_transform(), **mark)
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.8)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.0f}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel("returns until\nanother impact")


# --- below the panels ---


def _entries(seen: _Seen) -> list[Artist]:
    order = {word: k for k, word in enumerate(VERDICTS)}
    entries: list[Artist] = [
        Line2D([], [], color=verdict_colour(*kind), linewidth=_line(), label=verdict_label(*kind))
        for kind in sorted(seen.kinds, key=lambda kind: (order.get(kind[0], 9), kind[1]))
    ]
    if seen.changes:
        label = f"the first negative $c_i$ changes ({len(seen.changes)})"
        entries.append(Line2D([], [], label=label, **_mark("change")))
    if seen.later:
        entries.append(Line2D([], [], label=f"a later $c_i$ changes its sign ({seen.later})", **_mark("later")))
    return [*entries, Line2D([], [], label="grazing point at which the curve begins", **_mark("start"))]


def _note_closed_form(sheet: Sheet, result: Result, curves: dict[int, Table], names: tuple[str, str]) -> None:
    """How far curves of motions without impacts are from the closed form of grazing."""
    far = []
    for task, curve in curves.items():
        form = grazing_form(result, task)
        if form is None:
            return
        columns = dict(zip(names, (curve["parameter"], curve["second"])))
        exact = form(columns["model.frequency"])
        far.append(np.max(np.abs(np.abs(columns["model.force"]) - exact) / exact))
    if max(far) < _CLOSE:
        sheet.note(f"relative distance from the closed form of grazing: at most ${number(max(far), 1)}$")
