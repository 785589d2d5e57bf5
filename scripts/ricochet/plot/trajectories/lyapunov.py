"""Lyapunov exponents of trajectories: along a sweep, and how those of one task converge."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.trajectories.motion import picked_tasks
from ricochet.plot.words import count, parameter_label, task_words
from ricochet.result import Result
from ricochet.sweep import Array

_FEW = 6  # exponents with colours and names of their own
_LABEL = "Lyapunov exponents per unit of time"
_CHAOS = "#fbeee6"
_BEYOND = 10  # how far its colour goes, over the upper limit: to the edge whatever the limits


@figure(
    "trajectory",
    shows="Lyapunov exponents against the swept parameter",
    columns=("trajectory/lyapunov",),
    swept=1,
)
def lyapunov(result: Result) -> Figure:
    """An exponent above zero is chaos. Open circles are runs that ended early, triangles at the lower edge exponents of
    minus infinity."""
    table, name = result["trajectory"], result.swept[0]
    order = np.argsort(table[name], kind="stable")
    at, values, outcome = table[name][order], table["lyapunov"][order], table["outcome"][order]
    sheet = Sheet(result, 8.6, 4.8)
    axes = sheet.panel()
    _frame(result, axes, values)
    limits = axes.get_ylim()
    axes.axhspan(0, _BEYOND * limits[1], facecolor=_CHAOS, zorder=0)
    axes.set_ylim(limits)
    early = outcome != "completed"
    for exponents, colour in zip(values.T, _colours(values.shape[1])):
        shown = np.where(np.isfinite(exponents), exponents, np.nan)
        axes.plot(at, shown, color=colour, linewidth=1.2, zorder=3)
        axes.plot(at[~early], shown[~early], ".", color=colour, markersize=5, zorder=3)
        axes.plot(at[early], shown[early], "o", color=colour, markerfacecolor="white", markersize=5, zorder=3.5)
    sheet.legend(_named(sheet, axes, values))
    sheet.legend([Patch(facecolor=_CHAOS, label="above zero: chaos")])
    known = ~np.isnan(values).any(axis=1)
    if (early & known).any():
        sheet.legend([_marker("o", "run that ended early", markerfacecolor="white")])
        sheet.note(_why(outcome[early & known], "ended early"))
    sheet.legend(_mark_lost(axes, values, at))
    if not known.all():
        sheet.note(_why(outcome[~known], "without exponents"))
    axes.set(xlabel=parameter_label(result, name), ylabel=_LABEL)
    scale.frame_parameter(axes, at)
    return sheet.finish()


@figure(
    "trajectory",
    shows="how the Lyapunov exponents of a task converge",
    columns=("trajectory/lyapunov",),
    natural=lambda result: len(result.swept) != 1,
    part="task",
    parts=picked_tasks,
    options={"task": "task of the sweep, from 0; default: the first, the middle and the last one"},
)
def lyapunov_history(result: Result, *, task: int | None = None) -> Figure:
    """Exponents against the time over which they were taken, on a logarithmic scale."""
    which = task if task is not None else next(iter(picked_tasks(result)), 0)
    rows = result["trajectory/lyapunov"].task(which)
    outcome = str(result["trajectory"].task(which)["outcome"][0])
    if len(rows) == 0:
        raise FigureError(result.path, f"no exponents of task {which} are known ({outcome.replace('_', ' ')})")
    time, values = rows["time"], rows["history"]
    sheet = Sheet(result, 8.6, 4.8)
    axes = sheet.panel()
    _frame(result, axes, values)
    for exponents, colour in zip(values.T, _colours(values.shape[1])):
        shown = np.where(np.isfinite(exponents), exponents, np.nan)
        axes.plot(time, shown, color=colour, linewidth=1.3, zorder=3, marker="." if len(time) == 1 else "")
    sheet.legend(_named(sheet, axes, values) + _mark_lost(axes, values, time))
    axes.set(xscale="log", xlabel="time $t$ over which they were taken", ylabel=_LABEL)
    axes.set_xlim(time[0] / 1.06 if len(time) > 1 else 0.5 * time[0], time[-1] * 1.06)
    number = [f"task {which}"] if result.sweep.tasks > 1 else []
    return sheet.finish(words=[*task_words(result, which), *number, *_ended(outcome)])


def _ended(outcome: str) -> list[str]:
    return [] if outcome == "completed" else [f"ended early: {outcome.replace('_', ' ')}"]


def _colours(number: int) -> list[object]:
    """Of exponents from the largest to the smallest."""
    if number <= _FEW:
        return list(look.CYCLE[:number])
    return [look.colour_map()(shade) for shade in np.linspace(1, 0, number)]


def _named(sheet: Sheet, axes: Axes, values: Array) -> list[Artist]:
    """Entries of a few exponents, or a scale for the colours of many."""
    number = values.shape[1]
    if number <= _FEW:
        looks = enumerate(_colours(number), 1)
        return [Line2D([], [], color=colour, label=rf"$\lambda_{{{k}}}$") for k, colour in looks]
    ticks = MaxNLocator(integer=True)
    colours = ScalarMappable(Normalize(1, number), look.colour_map().reversed())
    sheet.figure.colorbar(colours, ax=axes, label="exponent, from the largest on", pad=0.015, aspect=40, ticks=ticks)
    return []


def _frame(result: Result, axes: Axes, values: Array) -> None:
    """Limits that show all finite exponents and zero."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        raise FigureError(result.path, "no exponent of it is known and finite")
    axes.set_ylim(*scale.pad_limits(np.append(finite, 0.0), 0.07))
    axes.axhline(0, color=look.FAINT, linewidth=0.8, zorder=1)


def _mark_lost(axes: Axes, values: Array, at: Array) -> list[Artist]:
    """Exponents of minus infinity at the lower edge, later ones as smaller triangles in those before them."""
    lost = np.isneginf(values)
    low, high = axes.get_ylim()
    sizes = np.linspace(9, 4, max(int(lost.any(axis=0).sum()), 2))
    for column, size in zip(np.flatnonzero(lost.any(axis=0)), sizes):
        where = at[lost[:, column]]
        height = np.full(len(where), low + 0.03 * (high - low))
        axes.plot(where, height, "v", color=_colours(values.shape[1])[column], markersize=size, zorder=4)
    return [_marker("v", r"$-\infty$: direction lost when a contact sticks")] if lost.any() else []


def _marker(marker: str, label: str, **more: str) -> Line2D:
    return Line2D([], [], linestyle="", color=look.INK, marker=marker, label=label, **more)


def _why(outcomes: Array, what: str) -> str:
    """ "3 runs without exponents: 2 grazing, 1 refused", of one cause "3 runs without exponents: refused"."""
    causes, counts = np.unique([outcome.replace("_", " ") for outcome in outcomes], return_counts=True)
    several = [f"{times} {cause}" for cause, times in zip(causes, counts)] if len(causes) > 1 else causes.tolist()
    return f"{count(len(outcomes), 'run')} {what}: {', '.join(several)}"
