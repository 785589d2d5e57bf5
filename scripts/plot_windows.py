#!/usr/bin/python3
"""Draws the edges of the windows of a diagram against their periods, and prints them as a table.

Datasets: /window/task, period, impacts, low, high, low_kind, high_kind, map_low, map_high, reason. Above, the edges of
the windows with one impact in a period, filled, and those of the closed form of the map, open; windows with other numbers
of impacts are grey. Below, each edge over that of the period before, beside lambda^2, to which the ratio tends as the
parameter goes to grazing. Edges at which the search came to its bounds are left out. Of a grid, one column for each line.

The table has the relative differences from the closed form, which along d is exact for the map and to leading order for
motions. Windows that repeat one by a multiple of its period, as slow transients make them, are counted only.
"""

import sys
from functools import partial

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

import diagrams
import figures

MOST_LINES = 4
NO_EDGE = ("open", "regular", "none")
LOOKS = {"low": (figures.BLUE, "v"), "high": (figures.RED, "^")}
CLOSED_LOOK = {"marker": "o", "linestyle": "", "color": figures.INK, "markersize": 10, "markerfacecolor": "none",
               "markeredgewidth": 0.9, "zorder": 4}  # fmt: skip
OTHER, RATIO = "#a8a8a8", figures.INK


def edges_of(windows, rows, side):
    """Edges of windows, NaN where the search came to its bounds."""
    kinds = getattr(windows, side + "_kind")[rows]
    return np.where(np.isin(kinds, NO_EDGE), np.nan, getattr(windows, side)[rows])


def ratios(period, edge):
    """Where periods follow one another: the later period, and its edge over that of the one before."""
    next_one = np.diff(period) == 1
    return period[1:][next_one], (edge[1:] / edge[:-1])[next_one]


# --- the table ---


def number_text(value, form=".10g"):
    return format(value, form) if np.isfinite(value) else "-"


def row_text(windows, row):
    words = [f"{windows.period[row]:6d}"]
    if not windows.located[row]:
        return words[0] + f"  not located: {windows.reason[row]}"
    words.append(f"{windows.impacts[row]:7d}")
    for side in ("low", "high"):
        kind, edge = getattr(windows, side + "_kind")[row], getattr(windows, side)[row]
        known = kind not in NO_EDGE
        closed = getattr(windows, "map_" + side)[row]
        apart = edge / closed - 1 if known and closed else np.nan
        words.append(f"{number_text(edge):>18s}  {kind if known else '(bound)':<15s}  {number_text(apart, '.1e'):>9s}")
    return "  ".join(words)


def print_table(result, line):
    windows = result.windows
    rows = windows.rows(line)
    held = "".join(f"{name} = {at[line.first]:.6g}, " for name, at in zip(result.names[:-1], result.values[:-1]))
    print(f"{held}along {line.name}:")
    if rows.size == 0:
        print("no windows\n")
        return
    heads = "  ".join(f"{side:>18s}  {'ended by':<15s}  {'over map':>9s}" for side in ("low", "high"))
    print(f"period  impacts  {heads}")
    for row in rows[windows.own[rows]]:
        print(row_text(windows, row))
    repeated = int((~windows.own[rows]).sum())
    if repeated:
        print(f"those that repeat one of these by a multiple of its period: {repeated}")
    print()


# --- the figure ---


def draw_edges(axes, windows, line):
    rows = windows.one_impact(line)
    mine = windows.rows(line)
    others = mine[windows.own[mine] & windows.located[mine] & (windows.impacts[mine] != 1)]
    for side, (colour, marker) in LOOKS.items():
        axes.plot(windows.period[others], edges_of(windows, others, side), marker, color=OTHER, markersize=4)
        axes.plot(windows.period[rows], getattr(windows, "map_" + side)[rows], **CLOSED_LOOK)
        axes.plot(windows.period[rows], edges_of(windows, rows, side), marker, color=colour, markersize=5.5, zorder=3)
    if rows.size:
        axes.vlines(windows.period[rows], windows.low[rows], windows.high[rows], color="#d5dde3", linewidth=4, zorder=1)
    axes.set_yscale("log")
    figures.label_decades(axes.yaxis)
    return others.size > 0


def draw_ratios(axes, windows, line, multiplier):
    rows = windows.one_impact(line)
    for side, (colour, marker) in LOOKS.items():
        closed = ratios(windows.period[rows], getattr(windows, "map_" + side)[rows])
        axes.plot(*closed, **CLOSED_LOOK)
        axes.plot(*ratios(windows.period[rows], edges_of(windows, rows, side)), marker, color=colour, markersize=5.5, zorder=3)
    if multiplier:
        axes.axhline(multiplier**2, color=RATIO, linewidth=1.2, linestyle=(0, (5, 2)), zorder=2)
        axes.annotate(rf"$\lambda^2 = {multiplier**2:.5g}$", (0, multiplier**2), (4, 4), color=RATIO, size=9.5,
                      xycoords=axes.get_yaxis_transform(), textcoords="offset points")  # fmt: skip
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.12 * (high - low))


def entries_of(others, multiplier):
    look = {"linestyle": "", "markersize": 6}
    entries = [Line2D([], [], marker=marker, color=colour, label=f"{words} edge", **look)
               for words, (colour, marker) in zip(("lower", "upper"), LOOKS.values())]  # fmt: skip
    entries.append(Line2D([], [], label="closed form of the map", **CLOSED_LOOK))
    if others:
        entries.append(Line2D([], [], marker="^", color=OTHER, label="not one impact in a period", **look))
    if multiplier:
        entries.append(Line2D([], [], color=RATIO, linestyle=(0, (5, 2)), label=r"$\lambda^2$"))
    return entries


def draw_line(upper, lower, result, line, wanted):
    multiplier = wanted or diagrams.multiplier_of(result, line.first)
    others = draw_edges(upper, result.windows, line)
    draw_ratios(lower, result.windows, line, multiplier)
    lower.set_xlabel("period $n$")
    lower.xaxis.set_major_locator(MaxNLocator(12, integer=True, min_n_ticks=1))
    upper.tick_params(labelbottom=False)
    if line.title:
        upper.set_title(line.title, loc="left")
    return others, multiplier


def draw(result, options):
    if result.windows is None:
        raise figures.FigureError("no /window in it (the study did not ask for iterate.windows)")
    lines = result.lines(options.lines)
    for line in lines:
        print_table(result, line)
    lines = [line for line in lines if result.windows.one_impact(line).size]
    if not lines:
        raise figures.FigureError("no window with one impact in a period and located edges in it")
    lines = lines if options.lines else lines[:MOST_LINES]
    count = len(lines)
    figure = plt.figure(figsize=(1.4 + max(4.2 * count, 6.4), 7.6), constrained_layout=True)
    cells = figure.add_gridspec(4, count, height_ratios=[0.001, 1.25, 1, 0.12])
    words, shown = figure.add_subplot(cells[0, :]), []
    words.axis("off")
    for k, line in enumerate(lines):
        upper = figure.add_subplot(cells[1, k])
        lower = figure.add_subplot(cells[2, k], sharex=upper)
        shown.append(draw_line(upper, lower, result, line, options.multiplier))
        if k == 0:
            upper.set_ylabel(figures.parameter_label(line.name))
            lower.set_ylabel("edge of $n$ over that of $n - 1$")
    entries = entries_of(any(others for others, _ in shown), any(multiplier for _, multiplier in shown))
    figures.legend_row(figure.add_subplot(cells[3, :]), entries, 3 if count == 1 else 5)
    figures.put_title(figure, words, result, 60 if count == 1 else 40 * count)
    return figure


def options_of(parser):
    diagrams.line_options(parser)
    parser.add_argument("--lambda", dest="multiplier", type=float, metavar="L", help="the multiplier; default: the study's")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "windows", __doc__, options_of, partial(diagrams.Iterates, columns=())))
