#!/usr/bin/python3
"""Draws branches: a quantity of the periodic motions against the parameter that is followed, or against another one,
with every special point.

Datasets: /branch/outcome, point_parameter, point_outcome, point_stable, point_segment and the quantities, which are of
energy, amplitude, clearance, period, frequency (2 pi / period) and multiplier_max; the same of special points. Full lines are stable motions, dashed ones unstable or undecided, thin ones of unknown stability; dotted grey lines are
solutions of the equations that are not admissible. Each segment of a branch has its colour, or, with several tasks, each
task.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D

import figures

QUANTITIES = {
    "energy": "energy",
    "amplitude": "largest displacement over the period",
    "clearance": "smallest gap",
    "period": "period $T$",
    "frequency": r"frequency $2 \pi / T$",
    "multiplier_max": "largest modulus of a multiplier",
}
SPECIAL_LOOK = {
    "fold": ("s", figures.RED, 7),
    "branch_point": ("P", figures.PINK, 8),
    "symmetry_breaking": ("p", figures.PINK, 8),
    "energy_extreme": ("d", figures.BLUE, 7),
    "period_doubling": ("^", figures.ORANGE, 8),
    "torus": ("*", figures.GREEN, 10),
    "resonance": ("|", figures.INK, 9),
    "grazing": ("D", figures.GREEN, 6),
    "impact_lost": ("v", figures.SKY, 8),
    "impulse_sign": ("X", figures.RED, 8),
    "order": ("o", figures.ORANGE, 6),
}
LINE_LOOK = {
    "stable": ("stable", "-", 1.8),
    "unstable": ("unstable", (0, (4, 1.6)), 1.5),
    "undecided": ("stability undecided", (0, (6, 1.2, 1.2, 1.2)), 1.5),
    "unknown": ("stability unknown", "-", 0.9),
    "inadmissible": ("not admissible", (0, (1, 1.6)), 1.2),
}
GREY = "#9a9a9a"
COLUMNS = 4  # of the legend
FEW = 6  # tasks with colours and names of their own


class Branches:
    """What the figure uses of a result."""

    def __init__(self, file):
        if "branch/outcome" not in file:
            raise figures.FigureError("no /branch/outcome in it: not a result of kind branch")
        group = file["branch"]
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        attributes = group["point_parameter"].attrs
        self.followed = figures.text_of(attributes.get("parameter", attributes["long_name"]))
        self.outcome = figures.names_of(group["outcome"])
        words = ("point_outcome", "point_stable", "special_kind")
        self.columns = {name: group[name][()] for name in group if name not in words and group[name].ndim == 1}
        self.columns |= {name: figures.names_of(group[name]) for name in words}
        for what in ("point", "special"):
            self.columns[f"{what}_frequency"] = 2 * np.pi / self.columns[f"{what}_period"]
        self.names = figures.text_of(file["sweep"].attrs.get("parameters", "")).split() if "sweep" in file else []
        self.swept = [file["sweep"][name][()] for name in self.names]
        self.tasks = range(len(self.outcome))

    def rows(self, what, task):
        """Rows of a ragged table that belong to a task."""
        first, last = self.columns[f"{what}_offset"][task : task + 2]
        return np.arange(first, last)

    def subtitle(self):
        varied = [self.followed, *self.names]
        parts = figures.fixed_parameters(self.study, self.study.word("particles") or "?", varied)
        return ", ".join(parts + ["all quantities dimensionless"])

    def task_name(self, task):
        return ", ".join(
            f"{self.symbol(name)} = {values[task]:.4g}" for name, values in zip(self.names, self.swept)
        )

    def symbol(self, name):
        """Of a swept parameter; elements of masses in series are those of springs."""
        symbol = figures.parameter_symbol(name)
        springs = self.study.in_series and name.startswith(("model.stiffness", "model.quadratic", "model.cubic"))
        return symbol.replace("of particle", "of spring") if springs else symbol


def styles(result, rows):
    """The look of the line at each point."""
    stable, outcome = result.columns["point_stable"][rows], result.columns["point_outcome"][rows]
    return np.where(np.isin(outcome, ("admissible", "grazing")), stable, "inadmissible")


class Line:
    """One segment as nodes in their order: its points, and the special points between them."""

    def __init__(self, result, rows, special, along, quantity):
        columns = result.columns
        at = np.concatenate([rows, columns["special_point"][special] + rows_offset(result, rows) + 0.5])
        order = np.argsort(at, kind="stable")
        value = lambda name: np.concatenate([columns[f"point_{name}"][rows], columns[f"special_{name}"][special]])  # noqa: E731
        self.x, self.y = value(along)[order], value(quantity)[order]
        look = np.concatenate([styles(result, rows), np.full(len(special), None)])[order]
        self.parts = self._parts_of(look)

    @staticmethod
    def _parts_of(look):
        """The look of each part between neighbours; a change happens at the first special point on the way."""
        parts, last = [], look[0]
        for k in range(1, len(look)):
            ahead = next((name for name in look[k:] if name is not None), last)
            parts.append(ahead if look[k - 1] is None else last if look[k] is None else ahead)
            last = last if look[k] is None else look[k]
        return parts

    def pieces(self):
        """Runs of one look: (look, x, y)."""
        first = 0
        for k in range(1, len(self.parts) + 1):
            if k == len(self.parts) or self.parts[k] != self.parts[first]:
                yield self.parts[first], self.x[first : k + 1], self.y[first : k + 1]
                first = k


def rows_offset(result, rows):
    """Row of the first point of the task that a row belongs to."""
    offsets = result.columns["point_offset"]
    return offsets[np.searchsorted(offsets, rows[0], side="right") - 1]


def draw_line(axes, line, colour, seen):
    for name, x, y in line.pieces():
        _, dashes, width = LINE_LOOK[name]
        axes.plot(x, y, linestyle=dashes, linewidth=width, color=GREY if name == "inadmissible" else colour, zorder=3)
        seen.add(name)
    if not line.parts:
        axes.plot(line.x, line.y, ".", color=colour, markersize=5, zorder=3)


def draw_task(axes, result, task, along, quantity, colour_of, seen):
    points, special = result.rows("point", task), result.rows("special", task)
    of_point, of_special = result.columns["point_segment"][points], result.columns["special_segment"][special]
    for segment in np.unique(of_point):
        line = Line(result, points[of_point == segment], special[of_special == segment], along, quantity)
        draw_line(axes, line, colour_of(task, segment), seen)


def draw_special(axes, result, tasks, along, quantity, hidden=()):
    """Markers of the special points, but for those of hidden kinds. Legend entries."""
    special = np.concatenate([result.rows("special", task) for task in tasks]).astype(int)
    kinds, columns = result.columns["special_kind"][special], result.columns
    entries = []
    for name in figures.ordered(set(kinds) - set(hidden), SPECIAL_LOOK):
        marker, colour, size = SPECIAL_LOOK.get(name, ("o", figures.INK, 6))
        where = special[kinds == name]
        look = {"marker": marker, "linestyle": "", "color": colour, "markersize": size, "markeredgewidth": 1.1}
        if marker != "|":
            look |= {"markeredgecolor": "white"}
        axes.plot(columns[f"special_{along}"][where], columns[f"special_{quantity}"][where], zorder=5, **look)
        entries.append(Line2D([], [], label=f"{name.replace('_', ' ')} ({len(where)})", **look))
    return entries


def choose_tasks(result, wanted):
    count = len(result.outcome)
    for task in wanted or ():
        if not 0 <= task < count:
            raise figures.FigureError(f"no task {task}, it has tasks 0 to {count - 1}")
    tasks = [task for task in wanted or range(count) if len(result.rows("point", task)) > 0]
    if not tasks:
        raise figures.FigureError(f"no branch of it begins ({', '.join(sorted(set(result.outcome)))})")
    return tasks


def colours(figure, axes, result, tasks):
    """The colour of a task and segment, and legend entries that tell them."""
    if len(tasks) == 1:
        segments = int(result.columns["point_segment"][result.rows("point", tasks[0])].max()) + 1
        look = [figures.CYCLE[k % len(figures.CYCLE)] for k in range(segments)]
        entries = [Line2D([], [], color=look[k], label=f"segment {k}") for k in range(segments) if segments > 1]
        return lambda task, segment: look[segment], entries
    if len(tasks) <= FEW:
        look = dict(zip(tasks, figures.CYCLE))
        entries = [Line2D([], [], color=look[task], label=result.task_name(task) or f"task {task}") for task in tasks]
        return lambda task, segment: look[task], entries
    numbers = result.swept[0] if len(result.names) == 1 else np.arange(len(result.outcome), dtype=float)
    scale = LogNorm if figures.is_geometric(numbers) else Normalize
    norm = scale(numbers[tasks].min(), numbers[tasks].max())
    label = figures.parameter_label(result.names[0]) if len(result.names) == 1 else "task"
    figure.colorbar(plt.cm.ScalarMappable(norm, figures.colour_map()), ax=axes, label=label, pad=0.015, aspect=40)
    return lambda task, segment: figures.colour_map()(norm(numbers[task])), []


def frame(axes, result, along, quantity, tasks):
    axes.set_xlabel(QUANTITIES.get(along) or figures.parameter_label(result.followed))
    axes.set_ylabel(QUANTITIES[quantity])
    if along == "parameter" and result.study.word("scale") == "log":
        axes.set_xscale("log")
    axes.margins(x=0.03, y=0.06)
    rows = np.concatenate([result.rows("point", task) for task in tasks])
    if not np.isfinite(result.columns[f"point_{quantity}"][rows]).any():
        raise figures.FigureError(f"/branch/point_{quantity} is not known of any point")


def line_entries(seen):
    return [
        Line2D([], [], linestyle=dashes, linewidth=width, label=label,
               color=GREY if name == "inadmissible" else figures.INK)
        for name, (label, dashes, width) in LINE_LOOK.items() if name in seen
    ]  # fmt: skip


def draw(result, options):
    tasks = choose_tasks(result, options.tasks)
    figure = plt.figure(figsize=(8.6, 6.2), constrained_layout=True)
    cells = figure.add_gridspec(2, 1)
    axes, seen = figure.add_subplot(cells[0]), set()
    frame(axes, result, options.x, options.y, tasks)
    colour_of, entries = colours(figure, axes, result, tasks)
    for task in tasks:
        draw_task(axes, result, task, options.x, options.y, colour_of, seen)
    entries = line_entries(seen) + entries + draw_special(axes, result, tasks, options.x, options.y)
    cells.set_height_ratios([1, 0.02 + 0.045 * -(-len(entries) // COLUMNS)])
    figures.legend_row(figure.add_subplot(cells[1]), entries, COLUMNS)
    figures.put_title(figure, axes, result, 88)
    return figure


def options(parser):
    along = ("parameter", *QUANTITIES)
    parser.add_argument("--x", choices=along, default="parameter", help="against what; default: the parameter")
    parser.add_argument("--y", choices=tuple(QUANTITIES), default="energy", help="what is drawn; default: energy")
    parser.add_argument(
        "--tasks", type=int, nargs="+", metavar="K", help="draw these tasks only, from 0; default: all"
    )


if __name__ == "__main__":
    sys.exit(figures.run(draw, "branch", __doc__, options, Branches))
