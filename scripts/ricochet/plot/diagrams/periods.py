"""Maps of the periods of attractors over two parameters."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from ricochet.plot import grid as grids
from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.diagrams import lines
from ricochet.plot.grid import Grid
from ricochet.result import Result
from ricochet.sweep import Array

# Colours of odd and of even periods, from dark to light, at equal distances for the eye.
_ODD = ("#7a0b22", "#b21929", "#da482b", "#f47a2d", "#faa73a", "#fdcd67", "#fbe69d", "#f6efd2")
_EVEN = ("#14206e", "#1f51ae", "#2c77c3", "#2f9bd0", "#51b6ca", "#70d0c0", "#a8dfab", "#e4f3c6")
_COLOURS = [colour for pair in zip(_ODD, _EVEN) for colour in pair]  # of period 1, 2, ...
_MOST = len(_COLOURS)
_LONGER, _NONE, _LOST = range(_MOST, _MOST + 3)  # codes; that of period n is n - 1
_FACES = [*_COLOURS, "#d9a7c7", "#2b2b2b", "#ffffff"]  # of the codes
_FEWEST = 8  # values each way; of fewer the diagrams along them say more
_BORDERS = {1 / 4: "1/4", 2 / 3: "2/3"}  # of regimes, in lambda
_SAMPLES = 250  # of the map, each way, among which a number looks for its place
_ROOM = 5  # samples from a number to the end of its region, at least


@figure(
    "diagram",
    shows="the period of the attractor over two swept parameters",
    columns=("diagram/attractor_period",),
    swept=2,
    reason=grids.reason,
    natural=lambda result: min(result.sweep.shape) >= _FEWEST,
    options=grids.X_OPTION,
)
def periods(result: Result, *, x: str | None = None) -> Figure:
    """Coloured cells; a number stands in the largest part of its period's region.

    Where lambda of the example map is on an axis, lines mark 1/4 and 2/3: as d tends to zero, windows overlap below
    1/4, are separated by chaos between them, and there is chaos beyond 2/3.
    """
    grid, codes = Grid(result, x), _codes(result)
    cells = grid.matrix(codes)
    sheet, (axes,) = grids.panels_of(result, 1, 8.2, 6.9)
    grids.draw_cells(axes, grid, cells, _FACES)
    grid.frame(axes)
    axes.set(xlabel=lines.label_along(result, grid.x_name), ylabel=lines.label_along(result, grid.y_name))
    _put_numbers(axes, grid, cells)
    sheet.legend(_entries(result, np.unique(codes)) + _draw_borders(axes, grid))
    grids.note_lone_cells(sheet, grid, codes)
    return sheet.finish(varied=lines.varied(result), words=lines.grazing_words(result, result["diagram"]))


def _codes(result: Result) -> Array:
    """Codes of the tasks: place in _FACES."""
    diagrams = result["diagram"]
    period = diagrams["attractor_period"]
    codes = np.where(period == 0, _NONE, np.minimum(period - 1, _LONGER))
    known = [diagrams.words("outcome").index(word) for word in ("periodic", "aperiodic")]
    return np.where(np.isin(diagrams.codes("outcome"), known), codes, _LOST)


def _entries(result: Result, present: Array) -> list[Artist]:
    names = [f"period {k + 1}" for k in range(_MOST)]
    names += [f"period above {_MOST}", lines.no_period(result), "diverged or failed"]
    edge = {"edgecolor": look.FAINT, "linewidth": 0.4}
    return [Patch(facecolor=_FACES[code], label=names[code], **edge) for code in present]


# --- numbers in regions ---


def _put_numbers(axes: Axes, grid: Grid, cells: Array) -> None:
    rows, columns = (np.linspace(0, n - 1, min(n, _SAMPLES)).astype(int) for n in cells.shape)
    sample = cells[np.ix_(rows, columns)]
    for code in range(_MOST):
        depth, row, column = _innermost(sample == code)
        if depth > _ROOM:
            at = grid.x[columns[column]], grid.y[rows[row]]
            axes.text(*at, str(code + 1), ha="center", va="center", **_legible())


def _innermost(region: Array) -> tuple[int, int, int]:
    """How many layers may be taken off a region until none is left; row and column of a cell that stays longest."""
    depth, row, column = 0, 0, 0
    while region.any():
        rows, columns = np.nonzero(region)
        depth, row, column = depth + 1, int(rows[len(rows) // 2]), int(columns[len(rows) // 2])
        inner = np.zeros_like(region)
        inner[1:-1, 1:-1] = (
            region[1:-1, 1:-1] & region[2:, 1:-1] & region[:-2, 1:-1] & region[1:-1, 2:] & region[1:-1, :-2]
        )
        region = inner
    return depth, row, column


def _legible() -> dict[str, object]:
    """Text that can be read on light and dark cells."""
    return {"color": "white", "path_effects": [withStroke(linewidth=1.6, foreground=look.INK)], "zorder": 4}


# --- regimes ---


def _draw_borders(axes: Axes, grid: Grid) -> list[Artist]:
    """Borders of the regimes; their entry of the legend."""
    if "model.lambda" not in (grid.x_name, grid.y_name):
        return []
    is_vertical = grid.x_name == "model.lambda"
    draw, values = (axes.axvline, grid.x) if is_vertical else (axes.axhline, grid.y)
    inside = {value: words for value, words in _BORDERS.items() if values[0] <= value <= values[-1]}
    for value, words in inside.items():
        draw(value, color=look.INK, linewidth=2.4, zorder=3)
        draw(value, color="white", linewidth=1.4, linestyle=(0, (5, 3)), zorder=3)
        if is_vertical:
            place, shift, where = axes.get_xaxis_transform(), (4, -4), {"ha": "left", "va": "top"}
        else:
            place, shift, where = axes.get_yaxis_transform(), (-4, 3), {"ha": "right", "va": "bottom"}
        at = (value, 1) if is_vertical else (1, value)
        axes.annotate(words, at, shift, xycoords=place, textcoords="offset points", size="small", **where, **_legible())
    label = rf"$\lambda$ = {', '.join(inside.values())}"
    return [Line2D([], [], color=look.FAINT, linestyle=(0, (5, 3)), label=label)] if inside else []
