"""Windows of stable periodic motion beyond continuous grazing bifurcations: a panel for each task, a bar for each period.

A bar is where the orbit with one impact in n returns is admissible and stable, by the map (5.11) of [FN97]; the line
under it is what the limit map (5.14) predicts. Each further period takes the factor lambda^2 of d.
"""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.grazings.points import chosen_tasks, followed, grazing_tasks, regime_words, why_none
from ricochet.plot.sheet import FigureError, Sheet, is_narrow, words_of, wrapped
from ricochet.plot.words import count, number, parameter_label, task_words
from ricochet.result import Result
from ricochet.sweep import Array

_MOST_PANELS = 5  # spread over the tasks, unless they are asked for
_BAR, _PREDICTED = look.BLUE, look.ORANGE
_BAR_SPAN, _PREDICTED_SPAN = np.array([-0.22, 0.42]), np.array([-0.5, -0.25])  # heights from the period on
_UNSTABLE = {"marker": "x", "linestyle": "", "color": _PREDICTED, "markersize": 5, "markeredgewidth": 1.6}
_ENDS = {  # of a bar: colour, words
    "border": (look.INK, "end of a window: border collision"),
    "flip": (look.RED, "end of a window: period doubling"),
    "fold": (look.PINK, "end of a window: fold"),
    "complex": (look.GREEN, "end of a window: complex pair"),
    "zero": (look.FAINT, "end of a window: $d = 0$"),
}
_COUNTS = (  # of orbits that are stable: colour, words
    ("#ffffff", "strip: no such orbit is stable"),
    ("#cfe3f1", "strip: one such orbit is stable"),
    ("#2f78b0", "strip: two such orbits are stable: windows overlap"),
    ("#123f66", "strip: three such orbits are stable"),
    ("#000000", "strip: four or more such orbits are stable"),
)
_UNKNOWN = {"facecolor": "#f2f2f2", "hatch": "....", "edgecolor": "#d9d9d9", "linewidth": 0}


class Windows:
    """Windows of one task, each [windows].

    period, low, high       of the orbit; the range of d in which it is admissible and stable
    exists                  whether there is such a range
    low_kind, high_kind     what ends it
    border, flip            the ends that the limit map predicts
    """

    def __init__(self, result: Result, task: int):
        points = result["grazing"]
        self.task, self.regime = task, str(points["regime"][task])
        self.multiplier = float(points["multiplier"][task].real)
        self.period, self.exists = points["window_period"][task], points["window_exists"][task].astype(bool)
        self.low, self.high = points["window_low_d"][task], points["window_high_d"][task]
        self.low_kind, self.high_kind = points["window_low_kind"][task], points["window_high_kind"][task]
        self.border, self.flip = points["predicted_border_d"][task], points["predicted_flip_d"][task]
        self.exists &= self.high > 0

    @property
    def ends(self) -> Array:
        """All ends with d > 0, computed and predicted."""
        found = np.concatenate([self.border, self.flip, self.low[self.exists], self.high[self.exists]])
        return np.asarray(found[(found > 0) & np.isfinite(found)])

    @property
    def limits(self) -> tuple[float, float]:
        """Of d, with half a period of room on both sides."""
        return float(self.ends.min() * self.multiplier), float(self.ends.max() / self.multiplier)

    @property
    def known_from(self) -> float:
        """Below this d windows of longer periods may lie, which the result does not have."""
        last = self.exists & (self.period == self.period.max())
        return float(self.high[last][0] if last.any() else np.nanmin(self.border))

    def counts(self) -> tuple[Array, Array]:
        """Edges of d, and how many orbits are stable between them."""
        low, high = self.low[self.exists], self.high[self.exists]
        edges = np.concatenate([low, high, self.limits])
        edges = np.unique(edges[(edges >= self.limits[0]) & (edges <= self.limits[1])])
        middle = np.sqrt(edges[1:] * edges[:-1])[:, None]
        return edges, ((low < middle) & (middle < high)).sum(axis=1)


def _continuous(result: Result, tasks: Sequence[int] | None = None) -> list[Windows]:
    found = [Windows(result, task) for task in chosen_tasks(result, tasks, ("continuous",))]
    return [windows for windows in found if windows.ends.size]


def _why_not(result: Result) -> str:
    missing = why_none(result, ("continuous",))
    return missing or ("" if _continuous(result) else "no window in it has d > 0")


@figure(
    "grazing",
    shows="windows of stable periodic motion beyond a continuous grazing bifurcation",
    columns=("grazing/window_period",),
    reason=_why_not,
    options={"tasks": "the tasks that have a panel"},
)
def grazing_windows(result: Result, *, tasks: Sequence[int] | None = None) -> Figure:
    """Windows of the periods over d, by which the motion would pass the obstacle. The strip below counts the orbits that
    are stable: where there is none the motion is chaotic or has more impacts."""
    found = _continuous(result, tasks)
    if not found:
        raise FigureError(result.path, "no window of these tasks has d > 0")
    drawn = found
    if tasks is None and len(found) > _MOST_PANELS:
        drawn = [found[k] for k in np.linspace(0, len(found) - 1, _MOST_PANELS).astype(int)]
    height = 0.4 + (3 if is_narrow() else 2.2) * len(drawn)
    sheet = Sheet(result, 8.6, height, rows=2 * len(drawn), heights=[1, 0.1] * len(drawn))
    seen: set[str] = set()
    for k, windows in enumerate(drawn):
        axes = sheet.panel(2 * k)
        _draw_panel(axes, windows, seen)
        axes.set_title(_title(sheet, windows), loc="left")
        _draw_strip(sheet.panel(2 * k + 1, sharex=axes), windows, seen)
    sheet.panels[-1].set_xlabel(parameter_label(result, "model.d"))
    sheet.legend(_entries(seen))
    _note_left_out(sheet, result, len(drawn), len(found))
    return sheet.finish("windows of stable orbits with one impact in $n$ returns", [followed(result)])


def _title(sheet: Sheet, windows: Windows) -> str:
    """The task and its regime, in lines that fit the panel."""
    task = "".join(f"{words}, " for words in task_words(sheet.result, windows.task))
    regime = rf"$\lambda = {number(windows.multiplier, 4)}$: {regime_words(windows.regime)} as $d \to 0$"
    font = {"size": mpl.rcParams["axes.titlesize"]}
    return "\n".join(wrapped(words_of(task + regime), " ", 72 * (sheet.width - 0.8), font))


# --- a panel ---


def _draw_panel(axes: Axes, windows: Windows, seen: set[str]) -> None:
    """A bar for each period, under it the prediction."""
    shown = windows.limits
    for k in np.flatnonzero(windows.exists):
        _draw_bar(axes, windows, k, seen)
    for k in np.flatnonzero((windows.flip > 0) & (windows.border > 0)):
        low, high, span = windows.flip[k], windows.border[k], windows.period[k] + _PREDICTED_SPAN
        if low < high:
            axes.fill_between([low, high], *span, color=_PREDICTED, linewidth=0, zorder=3)
        else:
            axes.plot(np.sqrt(low * high), span.mean(), zorder=3, **_UNSTABLE)
        seen.add("predicted" if low < high else "unstable")
    axes.set(xscale="log", xlim=shown, ylim=(windows.period.min() - 0.9, windows.period.max() + 0.6))
    axes.set_ylabel("period $n$")
    axes.yaxis.get_major_locator().set_params(integer=True)
    axes.tick_params(labelbottom=False)
    axes.minorticks_off()
    axes.grid(axis="x", color="#e6e6e6", linewidth=0.7, zorder=0)


def _draw_bar(axes: Axes, windows: Windows, k: int, seen: set[str]) -> None:
    shown, (bottom, top) = windows.limits, windows.period[k] + _BAR_SPAN
    low, high = max(windows.low[k], shown[0] / 10), min(windows.high[k], shown[1] * 10)
    axes.fill_between([low, high], bottom, top, color=_BAR, linewidth=0, zorder=3)
    for edge, kind in ((windows.low[k], windows.low_kind[k]), (windows.high[k], windows.high_kind[k])):
        if kind in _ENDS and shown[0] <= edge <= shown[1]:
            axes.vlines(edge, bottom, top + 0.1, color=_ENDS[kind][0], linewidth=2, zorder=4)
            seen.add(str(kind))


def _draw_strip(axes: Axes, windows: Windows, seen: set[str]) -> None:
    """How many orbits are stable, as far as windows of all periods are known."""
    edges, counts = windows.counts()
    known = windows.known_from
    for low, high, orbits in zip(np.maximum(edges[:-1], known), edges[1:], np.minimum(counts, len(_COUNTS) - 1)):
        if low < high:
            axes.axvspan(low, high, facecolor=_COUNTS[orbits][0], linewidth=0)
            seen.add(_COUNTS[orbits][1])
    axes.axvspan(windows.limits[0], known, **_UNKNOWN)
    axes.set(yticks=[], ylim=(0, 1))
    axes.set_ylabel("stable", rotation=0, ha="right", va="center", fontsize="small")
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)
    scale.label_decades(axes.xaxis)
    axes.minorticks_off()


# --- below the panels ---


def _entries(seen: set[str]) -> list[Artist]:
    entries: list[Artist] = [Patch(color=_BAR, linewidth=0, label="window: orbit admissible and stable")]
    for kind, (colour, words) in _ENDS.items():
        if kind in seen:
            end = {"marker": "|", "linestyle": "", "color": colour, "markersize": 9, "markeredgewidth": 2}
            entries.append(Line2D([], [], label=words, **end))
    if "predicted" in seen:
        entries.append(Patch(color=_PREDICTED, linewidth=0, label="window predicted by the limit map"))
    if "unstable" in seen:
        entries.append(Line2D([], [], label="limit map: orbit never stable", **_UNSTABLE))
    for colour, words in _COUNTS:
        if words in seen:
            entries.append(Patch(facecolor=colour, edgecolor=look.FAINT, linewidth=0.4, label=words))
    return [*entries, Patch(label="strip: longer periods, not computed", **_UNKNOWN)]


def _note_left_out(sheet: Sheet, result: Result, drawn: int, found: int) -> None:
    if drawn < found:
        sheet.note(f"{drawn} of {found} tasks with windows are drawn; --tasks picks others")
    other = result.sweep.tasks - len(grazing_tasks(result, ("continuous",)))
    if other and drawn < result.sweep.tasks:
        sheet.note(f"{count(other, 'task')} without a continuous grazing bifurcation")
