"""Curves of special points in the plane of two parameters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ricochet.plot import look, scale
from ricochet.plot.branches import family
from ricochet.plot.branches.closed_form import grazing_form
from ricochet.plot.branches.plane import marker, special_label
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.words import count, number, parameter_label, parameter_symbol, task_words
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

_FULL: dict[str, Any] = {"linestyle": "-", "linewidth": 1.8}
_DOTTED: dict[str, Any] = {"linestyle": (0, (1, 1.6)), "linewidth": 1.4}
_FORM: dict[str, Any] = {"color": look.INK, "linewidth": 0.9, "linestyle": (0, (5, 3))}
_BRANCH: dict[str, Any] = {"color": "#c4c4c4", "linewidth": 1.0}


@figure(
    "branch",
    shows="curves of special points in the plane of two parameters",
    columns=("branch/curve",),
    reason=lambda result: family.none_begins(result) or _no_curve(result),
    options={
        "tasks": "draw these tasks only, from 0",
        "all": "stretches that are not admissible, too",
    },
)
def curves(result: Result, *, tasks: Sequence[int] | None = None, all: bool = False) -> Figure:
    """Where special points lie in two parameters: each curve begins at its marker, on the branch that was followed. Of
    a linear oscillator with one obstacle, grazing in closed form is a dashed line."""
    chosen = family.chosen_tasks(result, tasks)
    found = _drawable(result, [curve for task in chosen for curve in _curves(result, task)], all)
    sheet = Sheet(result, 8.6, 5.4)
    axes = sheet.panel(xlabel=parameter_label(result, family.second(result)))
    axes.set_ylabel(parameter_label(result, family.followed(result)))
    shades = _shades(sheet, chosen)
    for curve in found:
        _draw(axes, curve, shades[curve.task], all)
        _draw_branch(axes, result, curve)
    _limit(sheet, axes, found, all)
    sheet.legend(_entries(found, all, _draw_forms(axes, result, found)))
    left = sum(int((~curve.sound).sum()) for curve in found)
    if left and not all:
        sheet.note(f"{count(left, 'point')} of the curves, not admissible: not drawn; --all draws them")
    words = task_words(result, chosen[0]) if len(chosen) == 1 else []
    return sheet.finish(varied=[family.followed(result), family.second(result)], words=words)


@dataclass
class _Curve:
    """The curve of a special point.

    kind, impacts  of the special point, and of its motion in a period
    ways           its points in both directions, which begin at the special point
    """

    task: int
    kind: str
    impacts: int
    ways: list[Table]

    def points(self) -> Array:
        """(second parameter, parameter that is followed) [point, 2]."""
        return np.concatenate([_places(way) for way in self.ways])

    @property
    def sound(self) -> Array:
        """Whether the points are motions [point]."""
        return np.concatenate([family.is_sound(way) for way in self.ways])


def _places(way: Table) -> Array:
    return np.column_stack([way["second"], way["parameter"]])


def _no_curve(result: Result) -> str:
    return "" if len(result["branch/curve"]) else "no special point of it has a curve"


def _curves(result: Result, task: int) -> Iterator[_Curve]:
    rows, special = result["branch/curve"].task(task), result["branch/special"].task(task)
    impacts = result["branch/segment"].task(task)["impacts"]
    for which in np.unique(rows["special"]):
        ways = [way for part in (0, 1) if len(way := rows.where(special=which, part=part))]
        yield _Curve(task, special["kind"][which], int(impacts[special["segment"][which]]), ways)


def _drawable(result: Result, found: list[_Curve], all: bool) -> list[_Curve]:
    """The curves of which anything is drawn."""
    if not found:
        raise FigureError(result.path, "no special point of these tasks has a curve")
    kept = [curve for curve in found if all or curve.sound.any()]
    if not kept:
        raise FigureError(result.path, "no motion on its curves is admissible; --all draws the others, too")
    return kept


# --- lines ---


def _shades(sheet: Sheet, tasks: Sequence[int]) -> dict[int, float]:
    """The opacity of the curves of each task, and a note that explains it."""
    if len(tasks) == 1:
        return {tasks[0]: 1.0}
    ordered, swept = list(tasks), sheet.result.swept
    if len(swept) == 1:
        values = sheet.result.sweep.values[swept[0]]
        ordered.sort(key=lambda task: values[task])
        ends = (number(float(values[task]), 6) for task in (ordered[0], ordered[-1]))
        sheet.note(f"from pale to dark: {parameter_symbol(sheet.result, swept[0])} from ${'$ to $'.join(ends)}$")
    else:
        sheet.note("later tasks are darker")
    return dict(zip(ordered, np.linspace(0.35, 1, len(ordered))))


def _draw(axes: Axes, curve: _Curve, opacity: float, all: bool) -> None:
    """Full where the motions are admissible or graze; the marker stands where the curve begins."""
    style = marker(curve.kind)
    colour = {"color": style["color"], "alpha": opacity, "zorder": 3}
    for way in curve.ways:
        places, sound = _places(way), family.is_sound(way)
        for first, last in scale.runs(sound):
            axes.plot(*places[first : last + 1].T, **_FULL, **colour)
        for first, last in scale.runs(~sound) if all else ():
            axes.plot(*places[max(first - 1, 0) : last + 2].T, **_DOTTED, **colour)
    if all or family.is_sound(curve.ways[0])[0]:
        axes.plot(*_places(curve.ways[0])[0], linestyle="", zorder=5, **style)


def _draw_branch(axes: Axes, result: Result, curve: _Curve) -> None:
    """The branch on which a curve begins, a straight line in this plane."""
    points = result["branch/point"].task(curve.task)["parameter"]
    at = _places(curve.ways[0])[0, 0]
    axes.plot([at, at], [points.min(), points.max()], zorder=1, **_BRANCH)


def _draw_forms(axes: Axes, result: Result, found: list[_Curve]) -> float | None:
    """The closed forms of grazing, and the largest distance of a curve from its form; None if there is none."""
    worst: list[float] = []
    for curve in found:
        form = grazing_form(result, curve.task)
        if form is None or curve.kind != "grazing" or curve.impacts:
            continue
        is_across = family.second(result) == "model.frequency"  # the frequency is on the horizontal axis
        frequency, force = curve.points().T if is_across else curve.points().T[::-1]
        along = np.linspace(frequency.min(), frequency.max(), 1001)
        axes.plot(*((along, form(along)) if is_across else (form(along), along)), zorder=4, **_FORM)
        worst.append(float(np.abs(np.abs(force) - form(frequency)).max()))
    return max(worst, default=None)


def _limit(sheet: Sheet, axes: Axes, found: list[_Curve], all: bool) -> None:
    """Limits that runaway ends of curves do not squeeze."""
    axes.margins(x=0.02, y=0.05)
    if sheet.result.parameters["branch.scale"] == "log":
        axes.set_yscale("log")
        scale.label_decades(axes.yaxis)
        return
    sound = np.concatenate([curve.sound for curve in found])
    values = np.concatenate([curve.points()[:, 1] for curve in found])
    kept = sound | all
    low, high, clipped = scale.robust_limits(values[kept], sound[kept])
    axes.set_ylim(low, high)
    if clipped:
        sheet.note(scale.clip_note(values[kept]))


def _entries(found: list[_Curve], all: bool, worst: float | None) -> list[Artist]:
    entries: list[Artist] = []
    kinds = [curve.kind for curve in found]
    for kind in look.ordered(kinds, look.SPECIAL_POINTS):
        number_of = kinds.count(kind)
        label = special_label(kind) + (f" ({number_of} curves)" if number_of > 1 else "")
        entries.append(Line2D([], [], **_FULL, **marker(kind), label=label))
    if all and not np.concatenate([curve.sound for curve in found]).all():
        entries.append(Line2D([], [], color=look.FAINT, **_DOTTED, label="not admissible"))
    entries.append(Line2D([], [], **_BRANCH, label="branch that was followed"))
    if worst is not None:
        entries.append(Line2D([], [], **_FORM, label=f"grazing in closed form, within ${number(worst, 2)}$"))
    return entries
