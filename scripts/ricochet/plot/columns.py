"""Columns of tables against swept parameters or one another: what no other figure draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ricochet.plot import catalogue, look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.quantities import ROW, Quantity, numeric_columns, quantity
from ricochet.plot.sheet import FigureError, Sheet, words_of, wrapped
from ricochet.plot.words import assignment, count, parameter_label
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

_ORDERED = {"point": ("segment",), "curve": ("special", "part"), "lyapunov": ()}  # ragged tables: what divides lines
_SAMPLES = "sample"  # the axis that columns run along in time
_MOST_CURVES = 60
_MOST_ELEMENTS = 24  # of an axis that are curves, more are dots
_MOST_ENTRIES = len(look.CYCLE)  # of a legend, more are a colour bar
_MOST_MARKED = 400  # points of curves that have dots on them
_BLOWN_UP = 10  # extent of all values over that of 98 % of them, with which an axis is clipped
_WIDE = 1e3  # ratio of values with which an axis is logarithmic


@dataclass(frozen=True)
class _Family:
    """What tells curves apart: a parameter, the task, or the element of an axis.

    name     "model.gamma", "task", "particle"; "" if all look alike
    values   its value at every row [rows], or of every element [elements]
    per_row  which of both
    """

    name: str
    values: Array
    per_row: bool = True

    @property
    def different(self) -> Array:
        return np.unique(self.values)

    @property
    def is_listed(self) -> bool:
        """Whether a legend lists its values; otherwise they have a colour bar."""
        return len(self.different) <= _MOST_ENTRIES

    def shades(self) -> Array:
        """Numbers whose colours `colours` says, in place of the values."""
        return np.searchsorted(self.different, self.values).astype(float) if self.is_listed else self.values

    def colours(self) -> ScalarMappable:
        if self.is_listed:
            count = len(self.different)
            return ScalarMappable(Normalize(-0.5, count - 0.5), ListedColormap(look.CYCLE[:count]))
        norm = LogNorm if scale.is_geometric(self.values) else Normalize
        return ScalarMappable(norm(self.values.min(), self.values.max()), look.colour_map())


def _is_alone(result: Result) -> bool:
    others = [spec for spec in catalogue.figures_of(result) if spec.name != "columns"]
    return not any(spec.natural(result) for spec in others)


@figure(
    "orbits",
    "trajectory",
    "branch",
    "grazing",
    "diagram",
    "basin",
    shows="any column of numbers against a swept parameter or another column",
    natural=_is_alone,
    options={
        "x": "column or swept parameter on the horizontal axis",
        "y": "column on the vertical axis; q[3] is one element",
        "table": "the table of the columns, such as branch/point; default: that of the kind",
        "tasks": "rows of these tasks only",
    },
)
def columns(
    result: Result,
    *,
    x: str | None = None,
    y: str | None = None,
    table: str | None = None,
    tasks: Sequence[int] | None = None,
) -> Figure:
    """A curve for each value of the other swept parameters, each task of a ragged table, or each element of a column;
    dots where rows have no order, or a column has many elements."""
    rows = _rows(result, table or result.kind, tasks)
    if y is None:
        y = _default_y(result, rows, x or _default_x(result, rows))
    up = quantity(result, rows, y)
    across = quantity(result, rows, x or _default_x(result, rows, up))
    if up.axes[: len(across.axes)] != across.axes:
        raise FigureError(
            result.path, f"{across.name} has the axis {across.axes[-1]}, {up.name} has not: pick an element"
        )
    sheet = Sheet(result, 8.6, 5.4)
    axes = sheet.panel()
    family = _family(result, rows, across, up)
    _draw(sheet, axes, _lines(result, rows, across), across, up, family)
    _frame(sheet, axes, across, up)
    _tell_apart(sheet, axes, family)
    _note_outcomes(sheet, rows)
    followed = [str(result.parameters["branch.parameter"])] if "branch.parameter" in result.parameters else []
    return sheet.finish(f"{up.name} of {rows.name} against {across.name}", followed)


def _rows(result: Result, name: str, tasks: Sequence[int] | None) -> Table:
    """The table, or its rows of some tasks."""
    table = result[name]
    if tasks is not None:
        if table.tasks is None:
            raise FigureError(result.path, f"rows of {name} belong to no task")
        for task in tasks:
            result.parameters_of(task)  # refuses a task that there is not
        table = table.where(np.isin(table.tasks, tasks))
    if len(table) == 0:
        raise FigureError(result.path, f"{name} has no rows" + (" of these tasks" if tasks is not None else ""))
    return table


def _default_x(result: Result, table: Table, up: Quantity | None = None) -> str:
    """Times of samples; the last swept parameter of a table with one row per task; of others what they run along."""
    if up and up.axes[:1] == (_SAMPLES,) and "t" in table.columns:
        return "t"
    if table.name == result.kind and result.swept:
        return result.swept[-1]
    names = [name for name in ("parameter", "time") if name in table.columns and not (up and up.name == name)]
    return [*names, *(result.swept[-1:] if table.tasks is not None else ()), ROW][0]


def _default_y(result: Result, table: Table, x: str) -> str:
    """The first column with one real number per row, else the first one of numbers."""
    names = [name for name in numeric_columns(table) if name != x]
    if not names:
        raise FigureError(result.path, f"{table.name} has no other column of numbers")
    return max(names, key=lambda name: (table[name].ndim == 1 and table[name].dtype.kind == "f", table[name].ndim == 1))


# --- curves ---


def _lines(result: Result, table: Table, across: Quantity) -> list[Array] | None:
    """Rows of every curve in their order; None if rows have no order."""
    if across.axes:
        return None if across.axes[0] != _SAMPLES else [np.array([row]) for row in range(len(table))]
    dividing = _ORDERED.get(table.name.rpartition("/")[2])
    swept, tasks = table.coordinates, table.tasks
    if table.name == result.kind:
        along = across.name if across.name in swept else next(reversed(swept), "")
        keys = [values for name, values in swept.items() if name != along]
    elif dividing is not None and tasks is not None:
        keys = [tasks, *(table[name] for name in dividing if name in table.columns)]
    else:
        return None
    if not keys:
        return [np.arange(len(table))]
    _, owner = np.unique(np.column_stack(keys), axis=0, return_inverse=True)
    return [np.flatnonzero(owner == k) for k in range(owner.max() + 1)]


def _family(result: Result, table: Table, across: Quantity, up: Quantity) -> _Family:
    others = {name: values for name, values in table.coordinates.items() if name not in (across.name, up.name)}
    is_grid = table.name == result.kind
    if is_grid and across.name not in table.coordinates and not across.axes:
        others.pop(next(reversed(others), ""), None)  # curves run along the last one
    varied = {name: values for name, values in others.items() if len(np.unique(values)) > 1}
    if len(varied) == 1 or (varied and is_grid):
        return _Family(*next(iter(varied.items())))
    if varied and table.tasks is not None:
        return _Family("task", table.tasks)
    extra, elements = up.axes[len(across.axes) :], up.values.shape[1 + len(across.axes) :]
    if len(extra) == 1 and 1 < elements[0] <= _MOST_ELEMENTS:
        return _Family(extra[0], np.arange(elements[0]), per_row=False)
    return _Family("", np.zeros(len(table)))


def _draw(sheet: Sheet, axes: Axes, lines: list[Array] | None, across: Quantity, up: Quantity, family: _Family) -> None:
    """A curve of every line and element, in the colours of the family; dots where there are too many elements."""
    numbers = up.values.reshape(*up.values.shape[: 1 + len(across.axes)], -1)  # [rows, (samples,) elements]
    elements, shades = numbers.shape[-1], family.shades()
    joined = lines is not None and elements <= _MOST_ELEMENTS
    groups = lines if lines is not None and joined else [np.arange(len(numbers))]
    if len(groups) > _MOST_CURVES:
        sheet.note(f"{_MOST_CURVES} of {len(groups)} curves are drawn, evenly picked; --tasks picks others")
        groups = [groups[k] for k in np.linspace(0, len(groups) - 1, _MOST_CURVES).round().astype(int)]
    if joined and elements > 1 and family.name and family.per_row:
        sheet.note(f"{elements} curves of each colour: one for each {up.axes[-1]}")
    paths, own = [], []
    for rows in groups:
        for element in range(elements):
            values = numbers[rows, ..., element].ravel()
            paths.append(np.column_stack([across.values[rows].ravel(), values]))
            shade = shades[rows] if family.per_row else np.full(len(rows), shades[element])
            own.append(np.repeat(shade, len(values) // len(rows)))
    _draw_paths(axes, paths, own, family.colours(), joined)


def _draw_paths(axes: Axes, paths: list[Array], shades: list[Array], colours: ScalarMappable, joined: bool) -> None:
    """Lines [points, 2], and dots where there are few points or these have no order."""
    points, shade = np.concatenate(paths), np.concatenate(shades)
    look_of = {"cmap": colours.cmap, "norm": colours.norm}
    if joined:
        first = np.array([each[0] for each in shades])
        axes.add_collection(LineCollection(paths, array=first, linewidths=1.3, zorder=2, **look_of))
    seen = np.isfinite(points).all(axis=1)
    if seen.sum() <= _MOST_MARKED or not joined:
        size = np.clip(15 * _MOST_MARKED / max(seen.sum(), 1), 1.0, 14.0)
        dots = {"s": size, "linewidths": 0, "rasterized": bool(seen.sum() > 20 * _MOST_MARKED)}
        axes.scatter(*points[seen].T, c=shade[seen], zorder=3, **dots, **look_of)


# --- around them ---


def _frame(sheet: Sheet, axes: Axes, across: Quantity, up: Quantity) -> None:
    """Labels; logarithmic axes where values span decades, limits that a few blow-ups do not squeeze."""
    for name, shown, room in (("x", across, sheet.width), ("y", up, sheet.height)):
        values = shown.values[np.isfinite(shown.values)]
        if len(values) == 0:
            raise FigureError(sheet.result.path, f"{shown.name} has no finite value")
        is_wide = values.min() > 0 and values.max() > _WIDE * values.min()
        getattr(axes, f"set_{name}scale")("log" if is_wide or scale.is_geometric(values) else "linear")
        getattr(axes, f"set_{name}lim")(*_limits(sheet, values, getattr(axes, f"get_{name}scale")() == "log"))
        if getattr(axes, f"get_{name}scale")() == "log":
            scale.label_decades(getattr(axes, f"{name}axis"))
        font = {"size": mpl.rcParams["axes.labelsize"]}
        getattr(axes, f"set_{name}label")("\n".join(wrapped(words_of(shown.label), " ", 72 * 0.7 * room, font)))


def _limits(sheet: Sheet, values: Array, logarithmic: bool) -> tuple[float, float]:
    if logarithmic:
        room = (values.max() / values.min()) ** 0.03 or 1.1
        return float(values.min() / room), float(values.max() * room)
    core = np.percentile(values, [1, 99])
    rounding = 1e-9 * np.abs(values).max()
    if np.ptp(values) > _BLOWN_UP * np.ptp(core) > rounding:
        sheet.note(scale.clip_note(values))
        values = core
    return scale.pad_limits(values, 0.04)


def _tell_apart(sheet: Sheet, axes: Axes, family: _Family) -> None:
    """The legend of a few values, or the colour bar of many."""
    if not family.name:
        return
    colours = family.colours()
    is_parameter = family.name in sheet.result.swept
    if not family.is_listed:
        label = parameter_label(sheet.result, family.name) if is_parameter else family.name
        bar = sheet.figure.colorbar(colours, ax=axes, label=label, pad=0.015, aspect=40)
        if not is_parameter:
            bar.ax.yaxis.set_major_locator(MaxNLocator(integer=True))
        return
    for shade, value in enumerate(family.different.tolist()):
        label = assignment(sheet.result, family.name, value) if is_parameter else f"{family.name} {value:g}"
        sheet.legend([Line2D([], [], color=colours.to_rgba(shade), linewidth=1.6, label=label)])


def _note_outcomes(sheet: Sheet, table: Table) -> None:
    """Rows are drawn whatever their outcome."""
    if "outcome" in table.columns:
        words, numbers = np.unique(table["outcome"], return_counts=True)
        if len(words) > 1:
            found = ", ".join(f"{number} {word.replace('_', ' ')}" for word, number in zip(words, numbers))
            sheet.note(f"{count(len(table), 'row')} of all outcomes: {found}")
