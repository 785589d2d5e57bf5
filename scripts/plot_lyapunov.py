#!/usr/bin/python3
"""Draws Lyapunov exponents: of all tasks against the swept parameter, or how those of one task converged.

Datasets: /trajectory/lyapunov and /trajectory/outcome, the swept parameter of /sweep; with --task, or without a sweep
over one parameter, /trajectory/lyapunov_time, lyapunov_history and lyapunov_offset. An exponent above zero is chaos;
one of minus infinity, a direction that contacts have put out, is marked at the lower edge. Runs that did not come to
their end are drawn with open circles.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import figures

FEW = 6  # exponents with colours and names of their own
LABEL = "Lyapunov exponents"


class Exponents:
    """What the figure uses of a result."""

    def __init__(self, file):
        if "trajectory/outcome" not in file:
            raise figures.FigureError("no /trajectory/outcome in it: not a result of kind trajectory")
        group = file["trajectory"]
        if "lyapunov" not in group:
            raise figures.FigureError("no /trajectory/lyapunov in it (the study did not ask for time.lyapunov)")
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        self.outcome = figures.names_of(group["outcome"])
        self.values = group["lyapunov"][()]
        self.offset, self.time = group["lyapunov_offset"][()], group["lyapunov_time"][()]
        self.history = group["lyapunov_history"][()]
        self.names = figures.text_of(file["sweep"].attrs.get("parameters", "")).split()
        self.swept = [file["sweep"][name][()] for name in self.names]
        self.task = None  # whose convergence is drawn

    def subtitle(self):
        parts = figures.fixed_parameters(self.study, self.study.word("particles") or "?", self.names)
        if self.task is not None:
            parts += [
                f"{figures.parameter_symbol(name)} = {values[self.task]:.6g}"
                for name, values in zip(self.names, self.swept)
            ]
            parts += [f"task {self.task}"] if len(self.outcome) > 1 else []
            parts += [self.outcome[self.task].replace("_", " ")]
        return ", ".join(parts + ["all quantities dimensionless"])


def colours(count):
    """Of exponents from the largest to the smallest."""
    if count <= FEW:
        return figures.CYCLE[:count]
    return [figures.colour_map()(x) for x in np.linspace(1, 0, count)]


def legend(axes, count):
    """Names of a few exponents, or a note on the colours of many."""
    if count <= FEW:
        looks = zip(colours(count), range(1, count + 1))
        entries = [Line2D([], [], color=colour, label=rf"$\lambda_{{{k}}}$") for colour, k in looks]
        axes.legend(handles=entries, loc="best", ncol=2 if count > 3 else 1)
        return
    figure = axes.figure
    scale = plt.cm.ScalarMappable(Normalize(1, count), figures.colour_map().reversed())
    figure.colorbar(scale, ax=axes, label="exponent, from the largest on", pad=0.015, aspect=40)


def frame(axes, values, x):
    """Limits that show all finite exponents; those of minus infinity as triangles at the lower edge."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        raise figures.FigureError("no exponent of it is known and finite")
    low, high = min(finite.min(), 0.0), max(finite.max(), 0.0)
    pad = 0.07 * (high - low) or 0.05
    axes.set_ylim(low - pad, high + pad)
    axes.axhline(0, color=figures.FAINT, linewidth=0.8, zorder=1)
    gone = np.isneginf(values)
    for column, colour in enumerate(colours(values.shape[1])):
        where = x[gone[:, column]]
        axes.plot(where, np.full(len(where), low - 0.6 * pad), "v", color=colour, markersize=5, zorder=4)
    return gone.any()


def draw_sweep(axes, result):
    """Exponents against the swept parameter, with the chaotic range of the largest shaded."""
    order = np.argsort(result.swept[0], kind="stable")
    at, values = result.swept[0][order], result.values[order]
    whole = result.outcome[order] == "completed"
    for column, colour in enumerate(colours(values.shape[1])):
        shown = np.where(np.isfinite(values[:, column]), values[:, column], np.nan)
        axes.plot(at, shown, color=colour, linewidth=1.2, zorder=3)
        axes.plot(at[whole], shown[whole], ".", color=colour, markersize=5, zorder=3)
        axes.plot(at[~whole], shown[~whole], "o", color=colour, markerfacecolor="white", markersize=5, zorder=3.5)
    gone = frame(axes, values, at)
    axes.axhspan(0, axes.get_ylim()[1], facecolor="#fbeee6", zorder=0)
    axes.set_xlabel(figures.parameter_label(result.names[0]))
    if figures.is_geometric(at):
        axes.set_xscale("log")
    else:
        axes.margins(x=0.015)
    return ~whole.all(), gone


def draw_history(axes, result):
    """Exponents of one task against the time over which they were taken."""
    first, last = result.offset[result.task : result.task + 2]
    if last == first:
        raise figures.FigureError(f"no exponent of task {result.task} is known ({result.outcome[result.task]})")
    time, values = result.time[first:last], result.history[first:last]
    for column, colour in enumerate(colours(values.shape[1])):
        shown = np.where(np.isfinite(values[:, column]), values[:, column], np.nan)
        axes.plot(time, shown, color=colour, linewidth=1.3, zorder=3)
    gone = frame(axes, values, time)
    axes.set_xscale("log")
    axes.set_xlim(time[0] / 1.06 if len(time) > 1 else 0.5 * time[0], time[-1] * 1.06)
    axes.set_xlabel("time $t$ over which they were taken")
    return False, gone


def choose(result, wanted):
    """Sets the task whose convergence is drawn, if one is."""
    tasks = len(result.outcome)
    if wanted is not None and not 0 <= wanted < tasks:
        raise figures.FigureError(f"no task {wanted}, it has tasks 0 to {tasks - 1}")
    if wanted is None and tasks > 1 and len(result.names) > 1:
        raise figures.FigureError(f"{len(result.names)} swept parameters, this figure needs 1, or --task")
    result.task = 0 if wanted is None and tasks == 1 else wanted


def draw(result, options):
    choose(result, options.task)
    figure, axes = plt.subplots(figsize=(8.6, 5.4), constrained_layout=True)
    partial, gone = (draw_sweep if result.task is None else draw_history)(axes, result)
    axes.set_ylabel(f"{LABEL} per unit of time")
    legend(axes, result.values.shape[1])
    look = {"linestyle": "", "color": figures.INK}
    entries = [Patch(facecolor="#fbeee6", label="above zero: chaos")] if result.task is None else []
    if partial:
        entries.append(Line2D([], [], marker="o", markerfacecolor="white", label="ended early", **look))
    if gone:
        entries.append(Line2D([], [], marker="v", label=r"$-\infty$: put out by contacts", **look))
    if entries:
        named = axes.get_legend()
        figures.legend_below(axes, 3, handles=entries)
        if named:
            axes.add_artist(named)
    figures.put_title(figure, axes, result, 88)
    return figure


def options(parser):
    parser.add_argument("--task", type=int, metavar="K", help="draw how the exponents of this task converged, from 0")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "lyapunov", __doc__, options, Exponents))
