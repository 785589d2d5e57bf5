"""The criterion of a grazing bifurcation: where the states after an impact point, and the coefficients c_i."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.grazings.fan import IMPACT, Fan, draw_fan
from ricochet.plot.grazings.points import (
    LATER_NEGATIVE,
    NEGATIVE,
    chosen_tasks,
    followed,
    grazing_tasks,
    verdict_words,
    why_none,
)
from ricochet.plot.sheet import Sheet, is_narrow
from ricochet.plot.words import assignment, complex_number, number, task_words
from ricochet.result import Result
from ricochet.sweep import Array

_LIMIT = {"color": look.GREEN, "linewidth": 1.3, "linestyle": (0, (5, 2.5))}
_PROVED = {"facecolor": tuple(0.12 * part + 0.88 for part in to_rgb(look.GREEN))}
_FEWEST, _MOST = 13, 40  # coefficients


@figure(
    "grazing",
    shows="the criterion of a grazing bifurcation: states after an impact, and the coefficients that decide",
    columns=("grazing/L", "grazing/xi", "grazing/eta", "grazing/coefficient"),
    reason=why_none,
    source="[FN97] Figure 3",
    part="task",
    parts=grazing_tasks,
    options={"task": "the task whose grazing point is drawn"},
)
def criterion(result: Result, *, task: int | None = None) -> Figure:
    """The arrows xi, L xi, ... beside the plane on which the motion grazes, and c_i = eta L^i xi over the powers of the
    dominant multiplier's modulus. The bifurcation is continuous if no arrow points behind the plane."""
    task = chosen_tasks(result, None if task is None else [task])[0]
    sheet = Sheet(result, 8.6, 8.4, rows=2) if is_narrow() else Sheet(result, 9.6, 4.5, columns=2, widths=(1, 1.12))
    fan = Fan(result, task)
    entries = draw_fan(sheet.panel(0, 0), fan)
    second = sheet.panel(1, 0) if is_narrow() else sheet.panel(0, 1)
    sheet.legend(_draw_coefficients(sheet, second, task, fan.first))
    sheet.legend([*entries, Patch(label="impact", **IMPACT)])
    if fan.note:
        sheet.note(fan.note)
    words = task_words(result, task) + _facts(result, task)
    return sheet.finish(verdict_words(result, task), varied=[followed(result)], words=words)


def _facts(result: Result, task: int) -> list[str]:
    """Parameter, dominant multiplier and acceleration at the grazing point."""
    points = result["grazing"]
    multiplier = complex(points["multiplier"][task])
    text = rf"$\lambda = {complex_number(multiplier)}$"
    if multiplier.imag:
        text += rf" ($|\lambda| = {number(abs(multiplier), 4)}$)"
    at = assignment(result, followed(result), float(points["parameter"][task]))
    return [at, text, f"$A_g = {number(float(points['A_g'][task]), 4)}$"]


# --- the coefficients ---


def _draw_coefficients(sheet: Sheet, axes: Axes, task: int, first: int) -> list[Artist]:
    """c_i over |lambda|^i, the limit alpha and from where all are proved positive; entries of the legend."""
    points = sheet.result["grazing"]
    alpha, settled = float(points["alpha"][task]), int(points["settled"][task])
    i, c, scaled = _scaled(sheet.result, task, max(_FEWEST, first + 4, settled + 3))
    colours = np.where(c > 0, look.BLUE, LATER_NEGATIVE).astype(object)
    colours[i == first] = NEGATIVE
    axes.vlines(i, 0, scaled, colors=list(colours), linewidth=1.6, zorder=3)
    axes.scatter(i, scaled, c=list(colours), s=30 if len(i) < 20 else 18, zorder=4, edgecolors="white", linewidths=0.6)
    entries = _coefficient_entries(c, first, complex(points["multiplier"][task]))
    if np.isfinite(alpha):
        axes.axhline(alpha, zorder=2, **_LIMIT)
        entries.append(Line2D([], [], label=rf"$\alpha = {number(alpha, 3)}$, the limit", **_LIMIT))
    if 0 <= settled <= i[-1]:
        axes.axvspan(settled - 0.5, i[-1] + 0.8, zorder=0, **_PROVED)
        entries.append(Patch(label=f"proved positive for $i \\geq {settled}$", **_PROVED))
    elif settled >= 0:
        sheet.note(f"$c_i$ proved positive for $i \\geq {settled}$, those before it one by one")
    _frame(axes, np.append(scaled, alpha if np.isfinite(alpha) else 0), i[-1])
    size = r"|\lambda|" if points["multiplier"][task].imag or points["multiplier"][task].real < 0 else r"\lambda"
    axes.set(xlabel="$i$", ylabel=rf"$c_i = \eta L^i \xi$ over ${size}^i$")
    return entries


def _scaled(result: Result, task: int, wanted: int) -> tuple[Array, Array, Array]:
    """i, c_i and c_i / |lambda|^i of as many as are wanted and stored."""
    c = result["grazing"]["coefficient"][task]
    size = abs(complex(result["grazing"]["multiplier"][task])) or 1.0
    i = np.arange(min(len(c), wanted, _MOST))
    with np.errstate(over="ignore", under="ignore", invalid="ignore", divide="ignore"):
        scaled = c[i] / size**i
    kept = np.isfinite(scaled)
    return i[kept], c[i][kept], scaled[kept]


def _coefficient_entries(c: Array, first: int, multiplier: complex) -> list[Artist]:
    marks = {"linewidth": 1.6, "marker": "o", "markersize": 5}
    entries: list[Artist] = []
    if (c > 0).any():
        entries.append(Line2D([], [], color=look.BLUE, label="$c_i > 0$", **marks))
    if first >= 0:
        value = f" = {number(float(c[first]), 3)}" if first < len(c) else ""
        text = f"first negative one, $c_{{{first}}}{value}$"
        entries.append(Line2D([], [], color=NEGATIVE, label=text, **marks))
    if (np.flatnonzero(c < 0) != first).any():
        entries.append(Line2D([], [], color=LATER_NEGATIVE, label="later $c_i < 0$", **marks))
    return entries


def _frame(axes: Axes, values: Array, last: int) -> None:
    """Limits, and the region of impacts below zero."""
    low, high = min(values.min(), 0), max(values.max(), 0)
    span = (high - low) or 1
    axes.set(xlim=(-0.6, last + 0.8), ylim=(low - (0.1 if low < 0 else 0.03) * span, high + 0.1 * span))
    axes.axhline(0, color=look.INK, linewidth=0.9, zorder=2)
    if low < 0:
        axes.axhspan(axes.get_ylim()[0], 0, zorder=0, **IMPACT)
    axes.xaxis.get_major_locator().set_params(integer=True)
