"""Edges of the windows of a diagram against their periods, and as a table."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.diagrams import lines
from ricochet.plot.diagrams.edges import SIDES, Windows, windows_of
from ricochet.plot.diagrams.lines import FROM_GRAZING, Line
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.words import count, number, parameter_symbol
from ricochet.result import Result
from ricochet.sweep import Array

_MARKS = {"low": (look.BLUE, "v", "lower edge"), "high": (look.RED, "^", "upper edge")}
_CLOSED = {"linestyle": "", "markersize": 11, "markerfacecolor": "none", "markeredgewidth": 1.0}
_ASIDE = {"low": -0.12, "high": 0.12}  # of a period, by which ratios stand apart
_OTHER = "#a8a8a8"  # windows with other numbers of impacts
_LIMIT = {"color": look.INK, "linewidth": 1.2, "linestyle": (0, (5, 2))}


def _with_windows(result: Result) -> list[int]:
    """Lines with windows that have one impact in a period, of many a few."""
    if "window" not in result:
        return []
    having = np.unique(result["window"]["task"] // result.sweep.shape[-1])
    found = [index for index in having.tolist() if _one_impact(lines.line_of(result, index))]
    return [found[k] for k in lines.spread(len(found))]


def _one_impact(line: Line) -> bool:
    windows = windows_of(line)
    return windows is not None and len(windows.own().one_impact()) > 0


@figure(
    "diagram",
    shows="edges of windows with one impact in a period against the period, and their ratios",
    columns=("window",),
    natural=lambda result: bool(_with_windows(result)),
    part="line",
    parts=_with_windows,
    options={
        "line": "which line of the grid along the last sweep, from 0; default: each that has such windows",
        "multiplier": "the dominant multiplier lambda; default: that of the study",
    },
)
def windows(result: Result, *, line: int | None = None, multiplier: float | None = None) -> Figure:
    """Edges, and those of the closed form of the map; windows with other numbers of impacts are grey. Below, each edge
    over that of the period before, which tends to lambda^2 as the parameter goes to grazing."""
    chosen = lines.picked(result, line)
    every = _found(chosen).own()
    mine = every.one_impact()
    if len(mine) == 0:
        raise FigureError(result.path, f"no window of line {chosen.index} has one impact in a period and both edges")
    size = lines.multiplier(result, chosen.first) if multiplier is None else multiplier
    has_ratios = chosen.name in FROM_GRAZING and bool((np.diff(mine.period) == 1).any())
    sheet = Sheet(result, 7.0, 6.2 if has_ratios else 3.8, rows=1 + has_ratios, heights=(1.25, 1)[: 1 + has_ratios])
    _draw_edges(sheet, sheet.panel(0), every, mine, parameter_symbol(result, chosen.name))
    if has_ratios:
        sheet.panels[0].tick_params(labelbottom=False)
        _draw_ratios(sheet, sheet.panel(1, sharex=sheet.panels[0]), mine, size)
    sheet.panels[-1].set_xlabel("period $n$")
    sheet.panels[-1].xaxis.set_major_locator(MaxNLocator(12, integer=True, min_n_ticks=1))
    _note_missing(sheet, _found(chosen), mine)
    about = "edges of the windows with one impact in a period"
    return sheet.finish(about, varied=lines.varied(result), words=lines.line_words(chosen))


def _found(line: Line) -> Windows:
    found = windows_of(line)
    if found is None:
        raise FigureError(line.result.path, "it has no window (the study did not ask for iterate.windows)")
    return found


# --- panels ---


def _draw_edges(sheet: Sheet, axes: Axes, every: Windows, mine: Windows, symbol: str) -> None:
    others = every.take(every.located & (every.impacts != 1))
    axes.vlines(mine.period, *mine.edge.values(), color="#d5dde3", linewidth=4, zorder=1)
    for side, (colour, marker, _) in _MARKS.items():
        axes.plot(others.period, others.found(side), marker, color=_OTHER, markersize=4, zorder=2)
        axes.plot(mine.period, mine.found(side), marker, color=colour, markersize=5.5, zorder=3)
        axes.plot(mine.period, mine.closed[side], marker, color=colour, zorder=4, **_CLOSED)
    sheet.legend(_entries(mine, others))
    shown = np.concatenate([each.found(side) for each in (mine, others) for side in SIDES])
    if (shown[np.isfinite(shown)] > 0).all():
        axes.set_yscale("log")
        scale.label_decades(axes.yaxis)
    axes.set_ylabel(f"{symbol} at the edges")


def _entries(mine: Windows, others: Windows) -> list[Artist]:
    entries: list[Artist] = []
    for side, (colour, marker, label) in _MARKS.items():
        mark = {"linestyle": "", "marker": marker, "color": colour}
        entries.append(Line2D([], [], markersize=6, label=label, **mark))
        if np.isfinite(mine.closed[side]).any():
            entries.append(Line2D([], [], label=f"{label}, closed form of the map", **{**mark, **_CLOSED}))
    if len(others):
        label = "not one impact in a period"
        entries.append(Line2D([], [], linestyle="", marker="^", color=_OTHER, markersize=5, label=label))
    return entries


def _draw_ratios(sheet: Sheet, axes: Axes, mine: Windows, size: float | None) -> None:
    for side, (colour, marker, _) in _MARKS.items():
        for edges, options in ((mine.found(side), {"markersize": 5.5}), (mine.closed[side], _CLOSED)):
            period, ratio = _ratios(mine.period, edges)
            axes.plot(period + _ASIDE[side], ratio, marker, color=colour, zorder=3, **options)
    axes.margins(y=0.1)
    axes.set_ylabel("edge of $n$ over\nthat of $n - 1$")
    if size:
        axes.axhline(size**2, zorder=2, **_LIMIT)
        sheet.legend([Line2D([], [], label=rf"$\lambda^2 = {number(size**2, 5)}$", **_LIMIT)])


def _ratios(period: Array, edge: Array) -> tuple[Array, Array]:
    """Where periods follow one another: the later period, and its edge over that of the one before."""
    follows = np.diff(period) == 1
    return period[1:][follows], (edge[1:] / edge[:-1])[follows]


def _note_missing(sheet: Sheet, every: Windows, mine: Windows) -> None:
    beyond = sum(int(np.isnan(mine.found(side)).sum()) for side in SIDES)
    repeated = len(every) - len(every.own())
    lost = int((~every.own().located).sum())
    if beyond:
        sheet.note(f"{count(beyond, 'edge')} beyond the search: not drawn")
    if repeated:
        sheet.note(f"{count(repeated, 'window')} that repeat others by a multiple of their period: not drawn")
    if lost:
        sheet.note(f"{count(lost, 'window')} without located edges: not drawn")


# --- the table ---


def window_table(result: Result, line: int | None = None) -> str:
    """The windows of a line as text: edges, what ends them, and their relative differences from the closed form of the
    map, which along d is exact for the map and to leading order for motions. Windows that repeat one by a multiple of
    its period are counted only."""
    chosen = lines.picked(result, line)
    every = _found(chosen)
    held = "".join(f"{name} = {result.sweep.values[name][chosen.first]:.6g}, " for name in result.swept[:-1])
    rows = [f"{held}along {chosen.name}:"]
    if len(every) == 0:
        return f"{rows[0]}\nno windows\n"
    heads = "  ".join(f"{side:>18s}  {'ended by':<15s}  {'over map':>9s}" for side in SIDES)
    rows.append(f"period  impacts  {heads}")
    own = every.own()
    rows += [_row(own, k) for k in range(len(own))]
    if len(every) > len(own):
        rows.append(f"those that repeat one of these by a multiple of its period: {len(every) - len(own)}")
    return "\n".join(rows) + "\n"


def _row(windows: Windows, k: int) -> str:
    words = [f"{windows.period[k]:6d}"]
    if not windows.located[k]:
        return f"{words[0]}  not located: {windows.reason[k]}"
    words.append(f"{windows.impacts[k]:7d}")
    for side in SIDES:
        edge, closed, known = windows.edge[side][k], windows.closed[side][k], np.isfinite(windows.found(side)[k])
        apart = edge / closed - 1 if known and closed else np.nan
        kind = windows.kind[side][k] if known else "(bound)"
        words.append(f"{_text(edge, '.10g'):>18s}  {kind:<15s}  {_text(apart, '.1e'):>9s}")
    return "  ".join(words)


def _text(value: float, form: str) -> str:
    return format(value, form) if np.isfinite(value) else "-"
