"""Basins of attraction over a grid of two numbers of the start."""

from __future__ import annotations

import re

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import grid as grids
from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.diagrams import lines
from ricochet.plot.grid import Grid
from ricochet.plot.words import count
from ricochet.result import Result
from ricochet.sweep import Array

_FACES = ("#7fb2d9", "#f3c178", "#8fd0b5", "#e3b9d0", "#c9c9c9", "#bfe0f4")  # of the attractors
_INKS = (look.BLUE, "#a85f00", "#006b4e", "#a0457a", "#4d4d4d", "#2a7fb0")  # the same, darker
_MOST = len(_FACES)  # attractors with colours of their own, those with the most starts
_OTHERS, _LOST = _MOST, _MOST + 1  # codes of the starts that come to none of them
_REST = ("#5a5a5a", "#ffffff")  # their faces
_UNLISTED = -2  # an attractor that is not among those of the table
_IN_PLANE = 1e-3
_MOST_STATES = 64  # marked, of one attractor
_SAME_STATE = 1e-4
_MARK = {"marker": "o", "linestyle": "", "markersize": 5.5, "markeredgewidth": 1.5}


@figure(
    "basin",
    shows="to which attractor each start comes, over two numbers of the start",
    columns=("basin/attractor", "basin/found"),
    swept=2,
    reason=grids.reason,
    options=grids.X_OPTION,
)
def basin(result: Result, *, x: str | None = None) -> Figure:
    """Coloured cells. The states in which the tasks of an attractor have ended, one for each iterate of its cycle, are
    marked: filled where they lie in the plane of the starts, within 1e-3 of their largest number, otherwise open."""
    grid, chosen = Grid(result, x), _chosen(result)
    codes = _codes(result, chosen)
    sheet, (axes,) = grids.panels_of(result, 1, 7.2, 6.6)
    grids.draw_cells(axes, grid, grid.matrix(codes), [*_FACES, *_REST])
    marks = _draw_states(axes, grid, result, chosen)
    grid.frame(axes)
    sheet.legend(_entries(result, chosen, codes) + marks)
    grids.note_lone_cells(sheet, grid, codes)
    return sheet.finish()


def _chosen(result: Result) -> list[int]:
    """The attractors with colours of their own, by falling size of their basins."""
    sizes = result["basin/found"]["tasks"]
    return [int(k) for k in np.argsort(-sizes, kind="stable")[:_MOST]]


def _codes(result: Result, chosen: list[int]) -> Array:
    """Of every task: place of its attractor in `chosen`, or one of the other codes."""
    attractor = result["basin"]["attractor"]
    codes = np.where((attractor >= 0) | (attractor == _UNLISTED), _OTHERS, _LOST)
    for place, which in enumerate(chosen):
        codes[attractor == which] = place
    return codes


# --- the legend ---


def _entries(result: Result, chosen: list[int], codes: Array) -> list[Artist]:
    entries: list[Artist] = []
    for place, which in enumerate(chosen):
        label = f"{_name(result, which)} ({_share(codes == place)})"
        entries.append(Patch(facecolor=_FACES[place], edgecolor=_INKS[place], linewidth=0.8, label=label))
    for code, face, words in zip((_OTHERS, _LOST), _REST, ("other attractors", "diverged or failed")):
        if (codes == code).any():
            label = f"{words} ({_share(codes == code)})"
            entries.append(Patch(facecolor=face, edgecolor=look.FAINT, linewidth=0.4, label=label))
    return entries


def _share(where: Array) -> str:
    return f"{100 * where.sum() / len(where):.3g} %"


def _name(result: Result, attractor: int) -> str:
    """An attractor by its period and its impacts."""
    period = int(result["basin/found"]["period"][attractor])
    if period == 0:
        return lines.no_period(result)
    impacts = result["basin"].where(attractor=attractor)["impacts"]
    return f"period {period}, {count(round(period * float(np.mean(impacts))), 'impact')}"


# --- the states of attractors ---


def _draw_states(axes: Axes, grid: Grid, result: Result, chosen: list[int]) -> list[Artist]:
    """Marks; their entries of the legend. On a section of impacts a start is no state of the section: no marks."""
    size = result["basin"]["end"].shape[1]
    across, up = (_index(result, name, size) for name in (grid.x_name, grid.y_name))
    if across is None or up is None or (size % 2 and not lines.is_map(result)):
        return []
    start = _start(result, size)
    rest = [k for k in range(size) if k not in (across, up)]
    seen = set()
    for attractor, ink in zip(chosen, _INKS):
        for state in _states(result, attractor):
            inside = bool((np.abs(state - start)[rest] <= _IN_PLANE * np.abs(state).max()).all())
            edge, face = ("white", ink) if inside else (ink, "none")
            axes.plot(
                state[across], state[up], color=ink, markeredgecolor=edge, markerfacecolor=face, zorder=4, **_MARK
            )
            seen.add(inside)
    words = {True: "states of an attractor", False: "states of an attractor, beside the plane"}
    faces = {True: look.INK, False: "none"}
    return [Line2D([], [], label=words[k], color=look.INK, markerfacecolor=faces[k], **_MARK) for k in sorted(seen)]


def _index(result: Result, name: str, size: int) -> int | None:
    """Which number of the state a swept parameter is; None if it is none, or all displacements at once."""
    found = re.fullmatch(r"(?:iterate\.start|start\.([qv]))(?:\[(\d+)\])?", name)
    half = size // 2
    if not found or (found[2] is None and not (found[1] and half == 1)):
        return None
    return int(found[2] or 0) + (half if found[1] == "v" else 0)


def _start(result: Result, size: int) -> Array:
    """The numbers of the start [size]; those that are swept at the first task."""
    values = result.parameters
    if lines.is_map(result):
        return np.array(np.broadcast_to(values["iterate.start"], size))
    return np.concatenate([np.broadcast_to(values[f"start.{letter}"], size // 2) for letter in "qv"])


def _states(result: Result, attractor: int) -> Array:
    """The different states in which its tasks have ended; none of more than _MOST_STATES."""
    ends = result["basin"].where(attractor=attractor)["end"]
    step = _SAME_STATE * (np.abs(ends).max() or 1.0)
    _, first = np.unique(np.round(ends / step), axis=0, return_index=True)
    states: list[Array] = []
    for end in ends[first]:  # of two that rounding has parted one is dropped
        if not any(np.abs(end - known).max() < 2 * step for known in states):
            states.append(end)
        if len(states) > _MOST_STATES:
            return np.empty((0, ends.shape[1]))
    return np.array(states)
