"""The panel of periods below a diagram: a row for each period, with the attractors that have it and the windows."""

from __future__ import annotations

from collections import Counter

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import look, scale
from ricochet.plot.diagrams import densities
from ricochet.plot.diagrams.coordinates import Abscissa
from ricochet.plot.diagrams.edges import Windows, windows_of
from ricochet.plot.diagrams.lines import Line, no_period
from ricochet.plot.sheet import Sheet
from ricochet.sweep import Array

_MOST_ROWS = 14
_HALF = 0.38  # height of a bar, of half a row
_APART = 0.17  # of a row, between there and back
_MARGIN = 0.06  # of the axis: a bar that ends nearer to its end has its number on the other side
_FEW = 3  # tasks, whose dash alone would be hard to see
_NAMED = 8  # periods that a note lists
_WINDOWS = {  # whether there is one impact in a period: face, edge, words
    True: ("#bfe3d6", look.GREEN, "window, one impact in a period"),
    False: ("#efd9e6", look.PINK, "window, other numbers of impacts"),
}


def is_wanted(line: Line) -> bool:
    """Whether the tasks of a line differ in their periods."""
    return len(np.unique(line.table["attractor_period"])) > 1


def height(line: Line) -> float:
    """Inches of the panel."""
    return 0.4 + 0.17 * max(len(_rows(*_found(line))), 5)


def draw(sheet: Sheet, axes: Axes, line: Line, x: Abscissa) -> None:
    """Dashes are the periods of attractors, bars the windows, from edge to edge."""
    period, windows = _found(line)
    rows = _rows(period, windows)
    entries: list[Artist] = []
    if windows is not None:
        _draw_windows(axes, windows.take(windows.located), rows, x)
        kinds = windows.impacts[windows.located & np.isin(windows.period, rows)] == 1
        entries = [Patch(facecolor=face, edgecolor=edge, label=label)
                   for one, (face, edge, label) in _WINDOWS.items() if (kinds == one).any()]  # fmt: skip
    _draw_dashes(axes, line, rows, x)
    _frame(axes, rows)
    if not line.goes_back:
        entries.insert(0, Line2D([], [], color=look.INK, linewidth=2.2, label="period of the attractor"))
    sheet.legend(entries)
    _note_missing(sheet, line, windows, rows)


def _found(line: Line) -> tuple[Array, Windows | None]:
    windows = windows_of(line)
    return line.table["attractor_period"], None if windows is None else windows.own()


def _rows(period: Array, windows: Windows | None) -> list[int]:
    """The periods that have a row, rising: all between the least and the largest, or those that occur; of too many
    those of windows and of the most tasks."""
    tasks = Counter(period[period > 0].tolist())
    if windows is not None:
        tasks.update({of_window: len(period) for of_window in windows.period[windows.located].tolist()})
    present = sorted(tasks)
    if present[-1] - present[0] < _MOST_ROWS:
        return list(range(present[0], present[-1] + 1))
    return sorted(sorted(present, key=lambda each: -tasks[each])[:_MOST_ROWS])


def _draw_windows(axes: Axes, windows: Windows, rows: list[int], x: Abscissa) -> None:
    for period, impacts, low, high in zip(windows.period, windows.impacts, *windows.edge.values()):
        if period not in rows:
            continue
        left, right = x.place(low, high)
        face, edge, _ = _WINDOWS[bool(impacts == 1)]
        row = rows.index(period)
        axes.fill_between(
            [left, right], row - _HALF, row + _HALF, facecolor=face, edgecolor=edge, linewidth=0.8, zorder=2
        )
        _number(axes, period, row, x, (left, right))


def _number(axes: Axes, period: int, row: int, x: Abscissa, ends: tuple[float, float]) -> None:
    """The period beside its bar, which may be narrow: on the right, or where there is no room on the left."""
    left, right = (x.fraction(place) for place in ends)
    if left < _MARGIN and right > 1 - _MARGIN:
        return
    onward = right <= 1 - _MARGIN
    axes.annotate(
        str(period), (ends[onward], row), (3 if onward else -3, 0), textcoords="offset points", size="small",
        ha="left" if onward else "right", va="center_baseline", zorder=4,
    )  # fmt: skip


def _draw_dashes(axes: Axes, line: Line, rows: list[int], x: Abscissa) -> None:
    """The period of every attractor; there and back beside one another."""
    looks = [(look.INK, 0.0)] if not line.goes_back else [(densities.FIRST, _APART), (densities.SECOND, -_APART)]
    for way, (colour, up) in zip(line.ways, looks):
        period = x.pick(line.table["attractor_period"], way)
        shown = np.where(np.isin(period, rows), period, np.nan)
        runs = scale.equal_runs(shown)
        first, last = np.array(runs, dtype=int).reshape(-1, 2).T
        at = np.searchsorted(rows, shown[first]) + up
        axes.hlines(at, x.edges[first], x.edges[last + 1], color=colour, linewidth=2.2, zorder=3)
        few = last - first < _FEW
        axes.plot(x.at[first[few]], at[few], "s", color=colour, markersize=2.2, markeredgewidth=0, zorder=3)


def _frame(axes: Axes, rows: list[int]) -> None:
    """Every row has its number; where periods are left out between two rows, a dotted line."""
    axes.set_yticks(range(len(rows)), [str(period) for period in rows])
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(-0.7, len(rows) - 0.3)
    axes.set_ylabel("period")
    for row in np.flatnonzero(np.diff(rows) > 1):
        axes.axhline(row + 0.5, color=look.FAINT, linewidth=0.7, linestyle=":", zorder=1)


def _note_missing(sheet: Sheet, line: Line, windows: Windows | None, rows: list[int]) -> None:
    period = line.table["attractor_period"]
    missing = np.setdiff1d(period[period > 0], rows)
    if len(missing):
        points = int(np.isin(period, missing).sum())
        sheet.note(f"periods {_listed(missing)} of {points} points are not shown")
    if (line.table["outcome"] == "aperiodic").any():
        sheet.note(f"{no_period(line.result)} where the panel of periods is empty")
    if windows is not None and not windows.located.all():
        sheet.note(f"windows of period {_listed(np.unique(windows.period[~windows.located]))} are not located")


def _listed(periods: Array) -> str:
    words = ", ".join(map(str, periods[:_NAMED]))
    return words + (f" and {len(periods) - _NAMED} others" if len(periods) > _NAMED else "")
