#!/usr/bin/python3
"""Draws the windows of stable periodic motion beyond a continuous grazing bifurcation: one panel for each task, one bar
for each period, over d, by which the motion would pass the obstacle.

Datasets: /grazing/verdict, regime, multiplier, alpha, stretch, window_period, window_exists, window_low_d, window_high_d,
window_low_kind, window_high_kind, predicted_border_d, predicted_flip_d. A bar is where the orbit with one impact in n
returns is admissible and stable, by the map (5.11) of [FN97]; marks at its ends say why it ends. The line under a bar is
what the limit map (5.14) predicts, a cross where it has the flip before the border: unstable from the beginning.
The strip below counts the bars: where there is none the motion is chaotic or has more impacts, where there are two
windows overlap; dotted is where longer periods than those of the result would be. All panels show as many periods, each of which takes
the factor lambda^2 of d.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import figures
import grazings

MOST_PANELS = 5  # spread over the tasks, unless they are asked for
COLUMNS = 3  # of the legend
BAR, PREDICTED = figures.BLUE, figures.ORANGE
UNSTABLE_LOOK = {"marker": "x", "linestyle": "", "color": figures.ORANGE, "markersize": 5, "markeredgewidth": 1.6}
COUNT_COLOURS = ["#ffffff", "#cfe3f1", "#2f78b0", "#123f66", "#000000"]
EDGE_COLOURS = {"border": figures.INK, "flip": figures.RED, "fold": figures.PINK, "complex": figures.GREEN, "zero": figures.FAINT}
EDGE_WORDS = {"border": "ends at the border", "flip": "at a flip", "fold": "at a fold", "complex": "at a complex pair",
              "zero": r"at $d = 0$"}  # fmt: skip


class Windows:
    """Those of one task with d > 0."""

    def __init__(self, result, task):
        columns = result.columns
        of = lambda name: columns[name][task]  # noqa: E731
        self.period, self.exists = of("window_period"), of("window_exists").astype(bool)
        self.low, self.high = of("window_low_d"), of("window_high_d")
        self.kinds = of("window_low_kind"), of("window_high_kind")
        self.border, self.flip = of("predicted_border_d"), of("predicted_flip_d")
        self.exists &= self.high > 0
        self.multiplier = float(columns["multiplier"][task].real)

    def limits(self):
        """Of d: the windows and the predicted ones, with half a period of room on both sides."""
        ends = np.concatenate([self.border, self.flip, self.low[self.exists], self.high[self.exists]])
        ends = ends[(ends > 0) & np.isfinite(ends)]
        if len(ends) == 0:
            raise figures.FigureError("no predicted window in it")
        room = 1 / self.multiplier
        return ends.min() / room, ends.max() * room


def need_windows(result):
    why = " (grazing.windows of the study is 0)"
    for name in ("window_period", "window_low_d", "predicted_border_d"):
        result.need(name, why)
    if result.columns["window_period"].shape[1] == 0:
        raise figures.FigureError("no windows in it" + why)


# --- a panel ---


def draw_bar(axes, windows, k, shown, seen):
    low, high = max(windows.low[k], shown[0] / 10), min(windows.high[k], shown[1] * 10)
    axes.plot([low, high], [windows.period[k]] * 2, color=BAR, linewidth=7, solid_capstyle="butt", zorder=3)
    for edge, kinds in ((windows.low[k], windows.kinds[0]), (windows.high[k], windows.kinds[1])):
        if kinds[k] in EDGE_COLOURS and shown[0] <= edge <= shown[1]:
            axes.plot(edge, windows.period[k], zorder=4, **edge_look(kinds[k]))
            seen.add(kinds[k])


def edge_look(kind):
    return {"marker": "|", "linestyle": "", "color": EDGE_COLOURS[kind], "markersize": 9, "markeredgewidth": 2}


def draw_prediction(axes, windows, k, seen):
    low, high = windows.flip[k], windows.border[k]
    if not (low > 0 and high > 0):
        return
    if low < high:
        axes.plot([low, high], [windows.period[k] - 0.42] * 2, color=PREDICTED, linewidth=2.6, solid_capstyle="butt", zorder=3)
    else:
        axes.plot(np.sqrt(low * high), windows.period[k] - 0.42, zorder=3, **UNSTABLE_LOOK)
    seen.add("predicted" if low < high else "unstable")


def stable_counts(windows, shown):
    """Edges of d and how many bars cover each part between them."""
    inside = windows.exists
    edges = np.concatenate([windows.low[inside], windows.high[inside], shown])
    edges = np.unique(edges[(edges >= shown[0]) & (edges <= shown[1])])
    middle = np.sqrt(edges[1:] * edges[:-1])
    count = [int(((windows.low[inside] < d) & (d < windows.high[inside])).sum()) for d in middle]
    return edges, np.array(count)


def draw_counts(axes, windows, shown, seen):
    """The strip, where the windows of all periods are known: down to the smallest border of the last one."""
    edges, count = stable_counts(windows, shown)
    known = windows.exists & (windows.period == windows.period.max())
    floor = windows.high[known][0] if known.any() else np.nanmin(windows.border)
    for a, b, number in zip(edges, edges[1:], count):
        a = max(a, floor)
        if a < b:
            axes.axvspan(a, b, 0, 1, facecolor=COUNT_COLOURS[min(number, len(COUNT_COLOURS) - 1)], linewidth=0)
            seen.add(("count", min(number, len(COUNT_COLOURS) - 1)))
    axes.axvspan(shown[0], floor, facecolor="#f2f2f2", hatch="....", edgecolor="#d9d9d9", linewidth=0)
    axes.set(yticks=[], xscale="log", xlim=shown)
    axes.set_ylabel("stable", rotation=0, ha="right", va="center", fontsize=8.5)
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)


def panel_title(result, task):
    regime = result.columns["regime"][task]
    words = "windows, chaos between them" if regime == "windows" else grazings.REGIME_WORDS.get(regime, regime)
    name = result.task_name(task)
    return rf"$\lambda = {result.columns['multiplier'][task].real:.4f}$, as $d \to 0$: {words}" + (f"   ({name})" if name else "")


def draw_panel(axes, strip, result, task, seen):
    windows = Windows(result, task)
    shown = windows.limits()
    for k in range(len(windows.period)):
        if windows.exists[k]:
            draw_bar(axes, windows, k, shown, seen)
        draw_prediction(axes, windows, k, seen)
    axes.set(xscale="log", xlim=shown, ylim=(windows.period.min() - 0.9, windows.period.max() + 0.6))
    axes.yaxis.get_major_locator().set_params(integer=True)
    axes.set_ylabel("period $n$")
    axes.tick_params(labelbottom=False, which="both")
    axes.grid(axis="x", color="#e6e6e6", linewidth=0.7, zorder=0)
    axes.set_title(panel_title(result, task), loc="left")
    draw_counts(strip, windows, shown, seen)
    figures.label_decades(axes.xaxis)
    figures.label_decades(strip.xaxis)


# --- the figure ---


def entries_of(seen):
    entries = [Line2D([], [], color=BAR, linewidth=7, label="stable orbit with one impact")]
    entries += [Line2D([], [], label=EDGE_WORDS[kind], **edge_look(kind)) for kind in EDGE_COLOURS if kind in seen]
    if "predicted" in seen:
        entries.append(Line2D([], [], color=PREDICTED, linewidth=2.6, label="predicted by the limit map"))
    if "unstable" in seen:
        entries.append(Line2D([], [], label="predicted unstable from birth", **UNSTABLE_LOOK))
    words = ["no such orbit is stable", "one is", "two are: windows overlap", "three are", "four and more are"]
    for number in sorted(item[1] for item in seen if isinstance(item, tuple)):
        entries.append(Patch(facecolor=COUNT_COLOURS[number], edgecolor=figures.FAINT, linewidth=0.4, label=words[number]))
    return entries


def draw(result, options):
    need_windows(result)
    tasks = grazings.choose_tasks(result, options.tasks, ("continuous",))
    if not options.tasks and len(tasks) > MOST_PANELS:
        tasks = [tasks[k] for k in np.linspace(0, len(tasks) - 1, MOST_PANELS).astype(int)]
    rows = len(tasks)
    figure = plt.figure(figsize=(8.6, 1.6 + 2.5 * rows), constrained_layout=True)
    cells, seen = figure.add_gridspec(2 * rows + 2, 1), set()
    words = figure.add_subplot(cells[0])
    words.axis("off")
    for k, task in enumerate(tasks):
        strip = figure.add_subplot(cells[2 * k + 2])
        draw_panel(figure.add_subplot(cells[2 * k + 1]), strip, result, task, seen)
    strip.set_xlabel("$d$, by which the motion would pass the obstacle")
    entries = entries_of(seen)
    cells.set_height_ratios([0.001, *[1, 0.1] * rows, 0.11 * -(-len(entries) // COLUMNS)])
    figures.legend_row(figure.add_subplot(cells[2 * rows + 1]), entries, COLUMNS)
    figures.put_title(figure, words, result, 88)
    return figure


if __name__ == "__main__":
    sys.exit(figures.run(draw, "grazing_windows", __doc__, grazings.task_options, grazings.Grazings))
