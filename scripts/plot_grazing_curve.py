#!/usr/bin/python3
"""Draws curves of grazing in the plane of two parameters, coloured by what the grazing leads to.

Datasets: /grazing/outcome, parameter, second, verdict, first_negative; curve_offset, curve_part, curve_parameter,
curve_second, curve_verdict, curve_first_negative, curve_change. Blue is a continuous bifurcation, brown to orange a
discontinuous one, darker where an earlier c_i is the first negative one, grey undecided. Diamonds are where a c_i changes
its sign and another one becomes the first negative one; dots where a later one changes. A circle is the grazing point at
which the curve begins. Below, which c_i is the first negative one along the second parameter: where that rises without
bound the bifurcation becomes continuous.

Of a linear oscillator with one obstacle, driven by A cos(w t), the line above the figure says how far the curve is at most
from the closed form of grazing, A^2 = b^2 ((k - m w^2)^2 + c^2 w^2).
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

import figures
import grazings
import plot_curves

COLUMNS = 3  # of the legend


class GrazingCurves(grazings.Grazings):
    def __init__(self, file):
        super().__init__(file)
        self.need("curve_second", " (the study did not ask for branch.trace)")
        self.columns["curve_outcome"] = np.full(len(self.columns["curve_second"]), "grazing", dtype=object)

    def ways(self, task):
        """Rows of both ways, which begin at the grazing point of the task."""
        rows = self.rows("curve", task)
        part = self.columns["curve_part"][rows]
        return [rows[part == way] for way in (0, 1) if (part == way).any()]

    def kinds(self, rows):
        """What each point leads to: verdict, and the first negative one as far as colours tell it."""
        verdict, first = self.columns["curve_verdict"][rows], self.columns["curve_first_negative"][rows]
        most = len(grazings.DISCONTINUOUS) - 1
        return [
            (word, min(int(i), most) if word == "discontinuous" else -1) for word, i in zip(verdict, first)
        ]  # fmt: skip


# --- the curves ---


def pieces(kinds, change):
    """Slices of one kind, and the kind; a change happens at the marked point between them, where its own verdict is
    that of a zero."""
    regular = [k for k in range(len(kinds)) if change[k] < 0]
    if not regular:
        return [(slice(0, len(kinds)), kinds[0])]
    own = list(kinds)
    for k in np.flatnonzero(change >= 0):
        after = [j for j in regular if j > k]
        own[k] = kinds[after[0] if after else regular[-1]]
    edges = [k for k in range(1, len(own)) if own[k] != own[k - 1]]
    return [(slice(a, min(b + 1, len(own))), own[a]) for a, b in zip([0, *edges], [*edges, len(own)])]


def draw_way(axes, result, rows, seen):
    columns = result.columns
    x, y, change = (columns[f"curve_{name}"][rows] for name in ("second", "parameter", "change"))
    cut = pieces(result.kinds(rows), change)
    for piece, kind in cut:
        axes.plot(x[piece], y[piece], color=grazings.verdict_colour(*kind), linewidth=3, solid_capstyle="butt", zorder=3)
        seen["kinds"].add(kind)
    switches = {piece.start: changed_one(before, after) for (_, before), (piece, after) in zip(cut, cut[1:])}
    for k in np.flatnonzero(change >= 0):
        matters = k in switches
        draw_change(axes, x[k], y[k], matters)
        seen["switch" if matters else "idle"] += 1
    rises = np.gradient(y) * np.gradient(x) >= 0 if len(x) > 1 else [True]
    return [(x[k], y[k], i, rises[k]) for k, i in switches.items()]


def changed_one(before, after):
    """The i whose c_i is negative on one side only: of two kinds that which comes first. Others may change there, too."""
    return min(i for _, i in (before, after) if i >= 0) if max(before[1], after[1]) >= 0 else -1


def draw_change(axes, x, y, matters):
    marker, size, edge = ("D", 6.5, "white") if matters else (".", 5, "none")
    axes.plot(x, y, marker, markersize=size, color=figures.INK, markeredgecolor=edge, zorder=5 if matters else 4)


def name_changes(axes, changes):
    """Which c_i changes, beside its mark, where there is room for words."""
    to_pixels, placed = axes.transData.transform, []
    for x, y, i, rises in sorted(change for change in changes if change[2] >= 0):
        place = to_pixels((x, y))
        if all(np.abs(place - other).max() > 26 for other in placed):
            word = axes.annotate(f"$c_{{{i}}}$", (x, y), (-7 if rises else 7, 5), textcoords="offset points",
                                 ha="right" if rises else "left", color=figures.INK, fontsize=9.5, zorder=6)  # fmt: skip
            word.set_in_layout(False)
            placed.append(place)


def draw_start(axes, result, task):
    axes.plot(result.columns["curve_second"][result.ways(task)[0][0]], result.columns["parameter"][task], "o", markersize=8,
              markerfacecolor="white", markeredgecolor=figures.INK, markeredgewidth=1.4, zorder=5.5)  # fmt: skip


def far_from_forms(result, tasks):
    """Largest distance from the closed form of grazing; None where there is none, or the motion has impacts."""
    far = []
    for task in tasks:
        form = plot_curves.grazing_form(result, task)
        far.append(np.nan if form is None else plot_curves.far_from_form(result, task, form, result.rows("curve", task)))
    return max(far) if np.all(np.array(far) < 1e-3) else None


def draw_first(axes, result, tasks):
    """The first negative c_i along the curve, counted from 1 so that a logarithmic scale has room for it."""
    for task in tasks:
        for rows in result.ways(task):
            rows = rows[result.columns["curve_change"][rows] < 0]
            x, first = (result.columns[f"curve_{name}"][rows] for name in ("second", "first_negative"))
            axes.plot(x, np.where(first >= 0, first + 1.0, np.nan), color=figures.FAINT, linewidth=0.8, drawstyle="steps-mid")
            colour = [grazings.verdict_colour(*kind) for kind in result.kinds(rows)]
            axes.scatter(x, np.where(first >= 0, first + 1.0, np.nan), c=colour, s=7, zorder=3)
            smooth = result.columns["curve_verdict"][rows] == "continuous"
            for line in axes.plot(x[smooth], np.ones(smooth.sum()), "|", color=grazings.CONTINUOUS, markersize=8, zorder=4,
                                  transform=axes.get_xaxis_transform(), clip_on=False):  # fmt: skip
                line.set_in_layout(False)  # without points it would be at the origin
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.8)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:.0f}")
    axes.yaxis.set_minor_formatter(figures.NullFormatter())
    axes.set_xlabel(figures.parameter_label(result.second))
    axes.set_ylabel("returns until\n$c_i < 0$, $i + 1$")


def entries_of(seen):
    order = {word: k for k, word in enumerate(grazings.VERDICTS)}
    entries = [
        Line2D([], [], color=grazings.verdict_colour(*kind), linewidth=3, label=grazings.verdict_label(*kind))
        for kind in sorted(seen["kinds"], key=lambda kind: (order.get(kind[0], 9), kind[1]))
    ]
    mark = {"linestyle": "", "color": figures.INK}
    if seen["switch"]:
        label = f"the first negative one changes ({seen['switch']})"
        entries.append(Line2D([], [], marker="D", markersize=6.5, markeredgecolor="white", label=label, **mark))
    if seen["idle"]:
        entries.append(Line2D([], [], marker=".", markersize=5, label=f"a later $c_i$ changes ({seen['idle']})", **mark))
    entries.append(Line2D([], [], linestyle="", marker="o", markersize=8, markerfacecolor="white", markeredgewidth=1.4,
                          markeredgecolor=figures.INK, label="where the curve begins"))  # fmt: skip
    return entries


def draw(result, options):
    chosen = grazings.choose_tasks(result, options.tasks)
    tasks = [task for task in chosen if len(result.rows("curve", task)) > 0]
    if not tasks:
        raise figures.FigureError("no grazing point of it has a curve")
    leaps = (result.columns["curve_first_negative"] >= 0).any()
    figure = plt.figure(figsize=(8.6, 7.4 if leaps else 6.2), constrained_layout=True)
    cells = figure.add_gridspec(3, 1)
    axes, seen, changes = figure.add_subplot(cells[0]), {"kinds": set(), "switch": 0, "idle": 0}, []
    plot_curves.frame(axes, result, tasks)
    for task in tasks:
        for rows in result.ways(task):
            changes += draw_way(axes, result, rows, seen)
        draw_start(axes, result, task)
    if leaps:
        draw_first(figure.add_subplot(cells[1], sharex=axes), result, tasks)
        axes.set_xlabel("")
        axes.tick_params(labelbottom=False)
    if axes.get_yscale() == "log":
        figures.label_decades(axes.yaxis)
    entries = entries_of(seen)
    cells.set_height_ratios([1, 0.36 if leaps else 0.001, 0.02 + 0.05 * -(-len(entries) // COLUMNS)])
    figures.legend_row(figure.add_subplot(cells[2]), entries, COLUMNS)
    figures.put_title(figure, axes, result, 88)
    far = far_from_forms(result, tasks)
    if far is not None:
        axes.set_title(f"{axes.get_title(loc='left')},\nwithin {far:.1e} of the closed form of grazing", loc="left",
                       color=figures.FAINT)  # fmt: skip
    figure.canvas.draw()  # places, for the room beside marks
    name_changes(axes, changes)
    return figure


if __name__ == "__main__":
    sys.exit(figures.run(draw, "grazing_curve", __doc__, grazings.task_options, GrazingCurves))
