"""Grids of two parameters: tasks as a matrix, cells coloured by words or by numbers, notes on what cells can show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import look, scale
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.words import parameter_label
from ricochet.result import Result
from ricochet.sweep import Array

X_OPTION = {"x": "the swept parameter on the horizontal axis; by default the first one"}
_RARE = 0.01  # a word of fewer cells is marked as well, lest it drown
_MOST_MARKED = 100  # cells of a word
_FEWEST = 5  # points each way of a grid on which regions have a shape


def reason(result: Result) -> str:
    """Why a result whose tasks are a grid has no map: a value that stands twice in a sweep, there and back."""
    twice = [name for name, axis in result.sweep.axes.items() if len(np.unique(axis)) < len(axis)]
    return f"a value of {twice[0]} stands twice in the sweep" if twice else ""


class Grid:
    """The tasks of a result as matrices [y, x] over rising values of its two swept parameters.

    x_name, y_name  the parameters; `x` says which is on the horizontal axis, by default the first one
    x, y            their values
    """

    def __init__(self, result: Result, x: str | None = None):
        self.result = result
        self._across = _place(result, x)  # the axis of the sweep that is horizontal
        self.x_name, self.y_name = result.swept[self._across], result.swept[1 - self._across]
        axes = result.sweep.axes
        self._order = np.ix_(*(np.argsort(axes[name], kind="stable") for name in result.swept))
        self.x, self.y = np.sort(axes[self.x_name]), np.sort(axes[self.y_name])
        self._logarithmic = [scale.is_geometric(values) for values in (self.x, self.y)]

    def matrix(self, column: Array) -> Array:
        """A column [tasks] as a matrix."""
        cells: Array = column.reshape(self.result.sweep.shape)[self._order]
        return cells if self._across == 1 else cells.T

    def edges(self) -> list[Array]:
        """Borders of the cells [x + 1], [y + 1], halfway between neighbours on the axis's own scale."""
        return [scale.cell_edges(values, log) for values, log in zip((self.x, self.y), self._logarithmic)]

    def frame(self, axes: Axes) -> None:
        """Scales, limits and labels of both axes."""
        x, y = self.edges()
        axes.set_xscale("log" if self._logarithmic[0] else "linear")
        axes.set_yscale("log" if self._logarithmic[1] else "linear")
        axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
        axes.set_xlabel(parameter_label(self.result, self.x_name))
        axes.set_ylabel(parameter_label(self.result, self.y_name))


def _place(result: Result, x: str | None) -> int:
    if x is None:
        return 0
    try:
        return result.swept.index(result.sweep.full_name(x))
    except ValueError as error:
        raise FigureError(result.path, str(error)) from None


def panels_of(result: Result, count: int, width: float = 5.4, height: float = 4.6) -> tuple[Sheet, list[Axes]]:
    """A sheet of `count` equal panels with one pair of axes: side by side, or below one another on a narrow sheet."""
    if is_narrow():
        sheet = Sheet(result, width, 0.75 * count * height, rows=count)
    else:
        sheet = Sheet(result, count * width, height, columns=count)
    first = sheet.panel()
    where = {"row": -1} if is_narrow() else {"column": -1}
    return sheet, [first] + [sheet.panel(**where, sharex=first, sharey=first) for _ in range(count - 1)]


def label_once(panels: Sequence[Axes]) -> None:
    """Takes the labels off the axes between panels, which are the same."""
    for axes in panels[:-1] if is_narrow() else panels[1:]:
        if is_narrow():
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)
        else:
            axes.set_ylabel("")
            axes.tick_params(labelleft=False)


# --- cells ---


def draw_cells(axes: Axes, grid: Grid, codes: Array, faces: Sequence[Any]) -> QuadMesh:
    """Cells of a matrix of codes, which count from 0, in the colours of the codes."""
    norm = Normalize(-0.5, len(faces) - 0.5)
    return axes.pcolormesh(*grid.edges(), codes, cmap=ListedColormap(list(faces)), norm=norm, rasterized=True)


def draw_words(axes: Axes, grid: Grid, words: Array, looks: Mapping[str, look.AreaLook]) -> list[Artist]:
    """Cells in the colours of words [tasks]; entries of the legend, with counts. Single cells of a rare word, which
    are hard to see, have markers as well."""
    names, cells = look.ordered(words, looks), grid.matrix(words)
    chosen = [looks.get(name, look.OTHER_AREA) for name in names]
    codes = np.zeros(cells.shape, dtype=int)
    for code, name in enumerate(names):
        codes[cells == name] = code
    draw_cells(axes, grid, codes, [face for face, _, _ in chosen])
    return [_entry(axes, grid, cells == name, name, *area) for name, area in zip(names, chosen)]


def _entry(axes: Axes, grid: Grid, where: Array, name: str, face: str, hatch: str, marker: str) -> Artist:
    """The entry of a word in the legend, and its markers if it is rare."""
    label = f"{name.replace('_', ' ')} ({where.sum()})"
    if where.mean() >= _RARE or where.sum() > _MOST_MARKED:
        return Patch(facecolor=face, edgecolor=look.FAINT, linewidth=0.3, label=label)
    rows, columns = np.nonzero(where)
    marks = {"marker": marker, "color": face, "markeredgecolor": "white", "markersize": 7, "linestyle": ""}
    axes.plot(grid.x[columns], grid.y[rows], zorder=4, **marks)
    return Line2D([], [], label=label, **marks)


def draw_numbers(sheet: Sheet, axes: Axes, grid: Grid, column: Array, label: str, nothing: str) -> None:
    """Cells of positive numbers [tasks] on a logarithmic scale of colours with its bar; cells of NaN stay pale.

    A long tail at either end, less than one cell in 200, shares the colour there; `nothing` says that all are NaN.
    """
    values = grid.matrix(column)
    axes.set_facecolor(look.PALE)
    shown = values[np.isfinite(values)]
    if shown.size == 0:
        axes.text(0.5, 0.5, nothing, ha="center", transform=axes.transAxes)
        return
    low, high = np.percentile(shown, [0.5, 99.5]) if shown.size > 50 else (shown.min(), shown.max())
    norm = LogNorm(low, high) if low < high else Normalize(low - 0.5, low + 0.5)
    mesh = axes.pcolormesh(*grid.edges(), values, cmap="viridis", norm=norm, rasterized=True)
    ends = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
    extend = ends[bool(shown.min() < low), bool(shown.max() > high)]
    bar = sheet.figure.colorbar(mesh, ax=axes, pad=0.02, aspect=34, label=label, extend=extend)
    if isinstance(norm, LogNorm):
        scale.label_decades(bar.ax.yaxis)


# --- what cells cannot show ---


def note_lone_cells(sheet: Sheet, grid: Grid, words: Array) -> None:
    """A note on cells that look like islands: those of a word that none of their neighbours has."""
    count = int(lone(grid.matrix(words)).sum())
    if count and min(len(grid.x), len(grid.y)) >= _FEWEST:
        points = f"{len(grid.x)} \u00d7 {len(grid.y)}"
        sheet.note(
            f"{count} of {points} points differ from all four neighbours: they lie in regions narrower than the "
            "spacing of the grid, whose shape it does not resolve"
        )


def lone(cells: Array) -> Array:
    """Cells of a matrix that differ from those above, below, left and right."""
    alone = np.ones(cells.shape, dtype=bool)
    for flags, values in ((alone, cells), (alone.T, cells.T)):
        same = values[1:] == values[:-1]
        flags[1:] &= ~same
        flags[:-1] &= ~same
    return alone
