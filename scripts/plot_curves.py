#!/usr/bin/python3
"""Draws the curves of special points in the plane of two parameters.

Datasets: /branch/outcome, curve_special, curve_part, curve_parameter, curve_second, curve_outcome; special_kind,
special_segment, segment_impacts, point_parameter. Each kind of special point has the colour and the marker of
plot_branch.py; the marker stands where its curve begins, on the branch that was followed, a grey line. Curves are full
where their motions are admissible or graze, dotted where they are not. Of several tasks later ones are darker.

Of a linear oscillator with one obstacle, driven by A cos(w t), a thin dashed line is the closed form of grazing,
A^2 = b^2 ((k - m w^2)^2 + c^2 w^2), and the legend says how far the computed curve is from it at most.
"""

import re
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

import figures
from plot_branch import SPECIAL_LOOK, Branches, choose_tasks

COLUMNS = 3  # of the legend
PAIR = {"model.force", "model.frequency"}  # with these the closed form is one of the plane
OTHER_LOOK = ("o", figures.INK, 6)
BRANCH_GREY = "#c4c4c4"


def as_number(word):
    return float(word) if re.fullmatch(r"[-+.\deE]+", word or "") else None


class Curves(Branches):
    """What the figure uses of a result."""

    def __init__(self, file):
        super().__init__(file)
        group = file["branch"]
        if "curve_special" not in group:
            raise figures.FigureError("no /branch/curve_special in it (the study did not ask for branch.trace)")
        attributes = group["curve_second"].attrs
        self.second = figures.text_of(attributes.get("parameter", attributes["long_name"]))
        self.columns["curve_outcome"] = figures.names_of(group["curve_outcome"])

    def curves(self, task):
        """Of each special point with a curve: its row in the file, and the rows of both ways, which begin at it."""
        rows = self.rows("curve", task)
        special, part = self.columns["curve_special"][rows], self.columns["curve_part"][rows]
        for which in np.unique(special):
            ways = [rows[(special == which) & (part == way)] for way in (0, 1)]
            yield self.columns["special_offset"][task] + which, [way for way in ways if len(way) > 0]

    def impacts(self, task, special):
        """Impacts per period of the motion at a special point."""
        segment = self.columns["segment_offset"][task] + self.columns["special_segment"][special]
        return self.columns["segment_impacts"][segment]

    def model_number(self, task, key, default=None):
        """A number of the model, the swept one where it is swept; None if the study holds anything else."""
        if f"model.{key}" in self.names:
            return self.swept[self.names.index(f"model.{key}")][task]
        word = self.study.word(key)
        return as_number(word) if word or self.study.items(key) else default

    def fixed(self):
        """What the study holds fixed, in words."""
        varied = [self.followed, self.second, *self.names]
        alone = self.study.word("particles") == "1"
        parts = figures.fixed_parameters(self.study, self.study.word("particles") or "?", varied)
        parts = parts[:1] if alone else parts  # a particle alone has no coupling
        told = ("floor", "wall") if self.study.in_series else ()
        for key, words in (("floor", "floor at"), ("wall", "wall at"), ("restitution",) * 2, ("damping",) * 2):
            if key not in told and as_number(self.study.word(key)) is not None and f"model.{key}" not in varied:
                parts.append(f"{words} {self.study.word(key)}")
        return parts

    def subtitle(self):
        several = ["later tasks darker"] if len(self.tasks) > 1 else []
        return ", ".join(self.fixed() + several + ["all quantities dimensionless"])


# --- the closed form of grazing ---


def obstacle_of(result, task):
    """Distance of the only obstacle; None where there are none or two."""
    defaults = {side: result.study.no_place(side) for side in ("floor", "wall")}
    listed = lambda key: bool(result.study.items(key))  # noqa: E731
    given = [key for key, default in defaults.items() if listed(key) or (result.study.word(key) or default) != "null"]
    number = result.model_number(task, given[0], -1.0) if len(given) == 1 else None
    return None if number is None else abs(number)


def grazing_form(result, task):
    """Amplitude of the force at which the motion without impacts touches the obstacle, as a function of its
    frequency; None for other models and parameters."""
    number = lambda key, default: result.model_number(task, key, default)  # noqa: E731
    linear = number("quadratic", 0.0) == number("cubic", 0.0) == 0.0
    alone = result.study.word("particles") == "1" and (result.study.word("ends") == "free" or number("gamma", 0.0) == 0)
    mass, stiffness, damping = number("mass", 1.0), number("stiffness", 1.0), number("damping", 0.0)
    place = obstacle_of(result, task)
    forced = result.study.word("motion") == "forced" and {result.followed, result.second} == PAIR
    if not (forced and linear and alone) or None in (mass, stiffness, damping, place):
        return None
    return lambda frequency: place * np.hypot(stiffness - mass * frequency**2, damping * frequency)


def far_from_form(result, task, form, rows):
    """Largest distance of a grazing curve from its closed form, in the amplitude of the force."""
    first, second = result.columns["curve_parameter"][rows], result.columns["curve_second"][rows]
    force, frequency = (first, second) if result.followed == "model.force" else (second, first)
    return np.abs(np.abs(force) - form(frequency)).max()


def draw_form(axes, result, form, rows):
    """The closed form over the frequencies of the curves."""
    along = "curve_second" if result.second == "model.frequency" else "curve_parameter"
    frequency = np.linspace(result.columns[along][rows].min(), result.columns[along][rows].max(), 1001)
    x, y = frequency, form(frequency)
    if result.second != "model.frequency":
        x, y = y, x
    axes.plot(x, y, color=figures.INK, linewidth=0.9, linestyle=(0, (5, 3)), zorder=4)


# --- the curves ---


def is_sound(result, rows):
    """Whether the motions are ones."""
    return np.isin(result.columns["curve_outcome"][rows], ("admissible", "grazing"))


def runs(sound):
    """Slices of equal values that share their ends, so that a line drawn in pieces has no gaps."""
    edges = np.flatnonzero(np.diff(sound)) + 1
    return [(slice(max(a - 1, 0), b), sound[a]) for a, b in zip([0, *edges], [*edges, len(sound)])]


def draw_way(axes, result, rows, colour, alpha):
    """One way of a curve. Whether any of it is not admissible."""
    x, y = result.columns["curve_second"][rows], result.columns["curve_parameter"][rows]
    sound = is_sound(result, rows)
    for piece, full in runs(sound):
        look = {"linestyle": "-", "linewidth": 1.8} if full else {"linestyle": (0, (1, 1.6)), "linewidth": 1.4}
        axes.plot(x[piece], y[piece], color=colour, alpha=alpha, zorder=3, **look)
    return not sound.all()


def draw_task(axes, result, task, alpha, seen):
    columns = result.columns
    for special, ways in result.curves(task):
        kind = columns["special_kind"][special]
        marker, colour, size = SPECIAL_LOOK.get(kind, OTHER_LOOK)
        for rows in ways:
            seen["inadmissible"] |= draw_way(axes, result, rows, colour, alpha)
        start = ways[0][0]
        axes.plot(columns["curve_second"][start], columns["curve_parameter"][start], marker=marker, color=colour,
                  markersize=size, markeredgecolor="white", markeredgewidth=1.1, zorder=5)  # fmt: skip
        seen["kinds"].append(kind)


def draw_branch(axes, result, task):
    """The branch on which the curves begin, a straight line in this plane."""
    points, curve = result.columns["point_parameter"][result.rows("point", task)], result.rows("curve", task)
    if len(curve) > 0:
        at = result.columns["curve_second"][curve[0]]
        axes.plot([at, at], [points.min(), points.max()], color=BRANCH_GREY, linewidth=1.0, zorder=1)


def draw_forms(axes, result, tasks):
    """Closed forms of grazing, and the largest difference; None where there are none."""
    worst = None
    for task in tasks:
        form = grazing_form(result, task)
        free = [
            np.concatenate(ways)
            for special, ways in result.curves(task)
            if result.columns["special_kind"][special] == "grazing" and result.impacts(task, special) == 0
        ]
        if form is not None and free:
            draw_form(axes, result, form, np.concatenate(free))
            worst = max([worst or 0.0, *(far_from_form(result, task, form, rows) for rows in free)])
    return worst


def entries_of(seen, worst):
    entries = []
    for kind in figures.ordered(seen["kinds"], SPECIAL_LOOK):
        marker, colour, size = SPECIAL_LOOK.get(kind, OTHER_LOOK)
        count = seen["kinds"].count(kind)
        label = kind.replace("_", " ") + (f" ({count} curves)" if count > 1 else "")
        entries.append(Line2D([], [], color=colour, linewidth=1.8, marker=marker, markersize=size,
                              markeredgecolor="white", markeredgewidth=1.1, label=label))  # fmt: skip
    if seen["inadmissible"]:
        look = {"linewidth": 1.4, "linestyle": (0, (1, 1.6))}
        entries.append(Line2D([], [], color=figures.FAINT, label="not admissible", **look))
    entries.append(Line2D([], [], color=BRANCH_GREY, linewidth=1.0, label="branch that was followed"))
    if worst is not None:
        label = f"grazing in closed form, within {worst:.1e}"
        entries.append(Line2D([], [], color=figures.INK, linewidth=0.9, linestyle=(0, (5, 3)), label=label))
    return entries


def frame(axes, result, tasks):
    """Labels, and limits that runaway ends of curves do not squeeze."""
    rows = np.concatenate([result.rows("curve", task) for task in tasks]).astype(int)
    if len(rows) == 0:
        raise figures.FigureError("no special point of it has a curve")
    values = result.columns["curve_parameter"][rows]
    axes.set_xlabel(figures.parameter_label(result.second))
    axes.set_ylabel(figures.parameter_label(result.followed))
    axes.margins(x=0.02, y=0.05)
    if result.study.word("scale") == "log":
        axes.set_yscale("log")
        return
    low, high, clipped = figures.robust_limits(values, is_sound(result, rows))
    axes.set_ylim(low, high)
    if clipped:
        axes.set_ylabel(f"{axes.get_ylabel()}\n({figures.clip_note(values)})")


def draw(result, options):
    tasks = result.tasks = choose_tasks(result, options.tasks)
    figure = plt.figure(figsize=(8.6, 6.2), constrained_layout=True)
    cells = figure.add_gridspec(2, 1)
    axes, seen = figure.add_subplot(cells[0]), {"kinds": [], "inadmissible": False}
    frame(axes, result, tasks)
    for task, alpha in zip(tasks, np.linspace(1 if len(tasks) == 1 else 0.4, 1, len(tasks))):
        draw_branch(axes, result, task)
        draw_task(axes, result, task, alpha, seen)
    worst = draw_forms(axes, result, tasks)
    if axes.get_yscale() == "log":
        figures.label_decades(axes.yaxis)
    entries = entries_of(seen, worst)
    cells.set_height_ratios([1, 0.02 + 0.045 * -(-len(entries) // COLUMNS)])
    figures.legend_row(figure.add_subplot(cells[1]), entries, COLUMNS)
    figures.put_title(figure, axes, result, 88)
    return figure


def options(parser):
    parser.add_argument(
        "--tasks", type=int, nargs="+", metavar="K", help="draw these tasks only, from 0; default: all"
    )


if __name__ == "__main__":
    sys.exit(figures.run(draw, "curves", __doc__, options, Curves))
