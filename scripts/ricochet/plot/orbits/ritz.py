"""Convergence of Ritz's method: measured errors against the number of trial functions."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import ricochet.result
from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.words import assignment
from ricochet.result import Result
from ricochet.sweep import Array

_PANELS = (  # column, its words, the power of the number of functions that it follows
    ("ritz_error", "error of displacements", -3),
    ("ritz_error_v", "error of velocities", -2),
    ("ritz_defect", "relative residual of the motion", -1),
)
_ALONG = ("orbit.functions", "orbit.tolerance")  # swept parameters that make no lines of their own
_MARKERS = "osDv^P*X"
_FREE = {"color": look.RED, "linestyle": ":", "linewidth": 1.5, "marker": "."}  # without constants


def _reason(result: Result) -> str:
    found = (result["orbits"]["ritz_functions"] > 0).any()
    return "" if found else "no approximation was found at any of its points"


@figure(
    "orbits",
    shows="errors of Ritz's method against the number of trial functions",
    columns=("orbits/ritz_functions", *(f"orbits/{name}" for name, _, _ in _PANELS)),
    reason=_reason,
    options={"stalled": "a result with orbit.constants: false, whose displacements are drawn for comparison"},
)
def ritz(result: Result, *, stalled: str | None = None) -> Figure:
    """Errors of displacements and velocities, and residuals, a line for each combination of the other swept parameters;
    thin straight lines are the powers that they follow."""
    wide = not is_narrow()
    sheet = Sheet(result, 10.6, 3.9, columns=3) if wide else Sheet(result, 5.6, 9.5, rows=3)
    for place, (column, label, power) in enumerate(_PANELS):
        axes = sheet.panel(0, place) if wide else sheet.panel(place)
        _frame(axes, result, label, wide or place == len(_PANELS) - 1)
        _draw_power(axes, result, column, power)
        _draw_lines(sheet, axes, result, column)
    if stalled is not None:
        _draw_stalled(sheet, stalled)
    return sheet.finish()


def _lines(result: Result) -> Iterator[tuple[Array, str]]:
    """Rows of each line in the order of their functions, and its name."""
    functions = result["orbits"]["ritz_functions"]
    names = [name for name in result.swept if name not in _ALONG]
    swept = np.column_stack([np.zeros(len(functions)), *(result.sweep.values[name] for name in names)])
    for values in np.unique(swept, axis=0):
        rows = np.flatnonzero((swept == values).all(axis=1) & (functions > 0))
        if len(rows):
            words = ", ".join(assignment(result, name, value) for name, value in zip(names, values[1:].tolist()))
            yield rows[np.argsort(functions[rows], kind="stable")], words


def _draw_lines(sheet: Sheet, axes: Axes, result: Result, column: str) -> None:
    lines = list(_lines(result))
    tints = look.colour_map()(np.linspace(0, 1, max(2, len(lines))))
    orbits = result["orbits"]
    for (rows, name), tint, marker in zip(lines, tints, cycle(_MARKERS)):
        marks = {"color": tint, "marker": marker, "markersize": 5, "linewidth": 1.4}
        axes.plot(orbits["ritz_functions"][rows], orbits[column][rows], **marks)
        if name:
            sheet.legend([Line2D([], [], label=name, **marks)])


def _draw_power(axes: Axes, result: Result, column: str, power: int) -> None:
    """The power, a bit below the middle of the last values."""
    orbits = result["orbits"]
    good = orbits["ritz_functions"] > 0
    n, y = orbits["ritz_functions"][good].astype(float), orbits[column][good]
    anchor = 0.4 * np.median(y[n == n.max()]) / n.max() ** power
    x = np.array([n.min(), n.max()])
    axes.plot(x, anchor * x**power, color=look.FAINT, linewidth=0.8, linestyle=(0, (5, 3)), zorder=1)
    middle = np.sqrt(x[0] * x[1])
    apart = {"xytext": (-8, -14), "textcoords": "offset points", "ha": "right", "color": look.FAINT}
    axes.annotate(f"$N^{{{power}}}$", (middle, anchor * middle**power), **apart)


def _frame(axes: Axes, result: Result, label: str, has_label: bool) -> None:
    functions = result["orbits"]["ritz_functions"]
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(np.unique(functions[functions > 0]))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.minorticks_off()
    axes.set_ylabel(label)
    axes.tick_params(labelbottom=has_label)
    axes.set_xlabel("trial functions $N$" if has_label else "")


def _draw_stalled(sheet: Sheet, path: str) -> None:
    """The displacements of another result, without constants."""
    with ricochet.result.open(path) as other:
        if "orbits" not in other or "ritz_error" not in other["orbits"]:
            raise FigureError(path, "it has no orbits/ritz_error (the study did not ask for orbit.method: ritz)")
        for rows, _ in _lines(other):
            orbits = other["orbits"]
            sheet.panels[0].plot(orbits["ritz_functions"][rows], orbits["ritz_error"][rows], **_FREE)
    sheet.legend([Line2D([], [], label="displacements without constants", **_FREE)])
