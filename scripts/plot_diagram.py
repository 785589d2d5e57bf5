#!/usr/bin/python3
"""Draws bifurcation diagrams: the kept iterates against the last swept parameter, of a grid one figure for each line.

Datasets: /diagram/outcome, values, attractor_period, the swept parameters of /sweep; lyapunov, where the study asked
for it; the table /window. Each column of the diagram is the density of the iterates of one task, on a logarithmic scale
of colours. Below it, over the same axis: the largest Lyapunov exponent, chaos where it is above zero; and the period of
the attractor, with a bar for each window between its located edges.

Of a sweep that goes there and back, what is found with rising values is blue, with falling ones red, both together dark:
where the colours part, two attractors exist. Of diagrams beyond grazing (/diagram/map_values, map_lyapunov, map_period,
d, distance) the motion is blue and the return map (5.11) of [FN97] red, and the lowest panel is the distance between them
over the extent of the map's values: filled where both have the same period, a circle where one has none.

Over equal ratios of d or of mu the ordinate is divided by the root of it, in which all scales look alike; --values draws
the values themselves. --scaled is Figure 5 of the source: z1 / sqrt(d) against ln sqrt(d) / ln lambda.
"""

import sys
from functools import partial

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import blended_transform_factory

import diagrams
import figures

COLUMNS = ("values", "lyapunov", "attractor_period", "map_values", "map_lyapunov", "map_period", "d", "distance")
MOST_LINES = 8  # of a grid, spread, unless they are asked for
WIDE = 100  # values over such a range are divided by the root
MOST_PERIOD = 12  # shown, unless windows with one impact have longer ones
SPREADS = 0.25  # power of it with which they spread at least then
NAMED = 0.022  # part of the axis that a bar takes whose number stands in it
OTHER_WINDOW, DASH = figures.GREEN, "#8a8a8a"
CHAOS = "#fbeee6"
PERIOD_OF = {"values": "attractor_period", "map_values": "map_period"}
ROOTS = ("model.d", "grazing.beyond")


class Abscissa:
    """The parameter, or of --scaled ln sqrt(d) / ln lambda."""

    def __init__(self, result, line, options):
        self.label, self.logarithmic = figures.parameter_label(line.name), line.logarithmic
        self.of = lambda at: at
        if options.scaled:
            self._scale(result, line, options.multiplier)
        self.order = np.argsort(self.of(line.at))
        self.at = self.of(line.at)[self.order]
        self.edges = diagrams.borders(self.at, self.logarithmic)

    def _scale(self, result, line, multiplier):
        if line.name != "model.d" or line.at[0] <= 0:
            raise figures.FigureError(f"--scaled is for maps along positive model.d, this sweep is over {line.name}")
        size = multiplier or diagrams.multiplier_of(result, line.first)
        if not size or not 0 < size < 1:
            raise figures.FigureError("--scaled needs lambda between 0 and 1, and the study has none: give --lambda")
        self.of = lambda d: np.log(np.sqrt(d)) / np.log(size)
        self.label, self.logarithmic = rf"$\ln\sqrt{{d}}\,/\,\ln\lambda$, with $\lambda = {size:.4g}$", False

    def pick(self, column, way):
        """The rows of one way, from left to right."""
        return column[way[self.order]]

    def place(self, low, high):
        """A window on the axis, from left to right, cut off at its ends."""
        ends = sorted(self.of(np.array([low, high])))
        return np.clip(ends, self.edges[0], self.edges[-1])

    def part(self, low, high):
        """Where on the axis the middle of a window lies, and which part of the axis it takes."""
        to = np.log if self.logarithmic else np.asarray
        low, high, first, last = to(np.array([low, high, self.edges[0], self.edges[-1]]))
        return ((low + high) / 2 - first) / (last - first), (high - low) / (last - first)


class Ordinate:
    """The values, or what the root of d or of mu is the scale of."""

    def __init__(self, result, line, options):
        symbol = diagrams.number_label(result.observed)
        word = {"q": "displacement ", "v": "velocity "}.get(result.observed[:1], "")
        self.label, self.root, self.origin = word + symbol, None, 0.0
        wide = line.logarithmic and line.at[-1] >= WIDE * line.at[0]
        if options.values or not (options.scaled or wide) or line.name not in ROOTS or line.at[0] <= 0:
            return
        if not options.scaled and spread_exponent(line, result.columns["values"]) < SPREADS:
            return
        self.root = np.sqrt(line.at)
        root = r"\sqrt{d}" if line.name == "model.d" else r"\sqrt{\mu}"
        bare = symbol.strip("$")
        if "map_values" in result.columns:
            self.origin = origin_of(line, result.columns["map_values"])
            bare = rf"({bare} {'+' if self.origin < 0 else '-'} {abs(self.origin):.6g})"
        elif not result.study.is_map:
            self.root = None
            return
        self.label = rf"${bare}\,/\,{root}$"

    def of(self, column, way):
        """Values of one way, by rising parameter."""
        return column[way] if self.root is None else (column[way] - self.origin) / self.root[:, None]


def spread_exponent(line, values):
    """The power of the parameter with which the values of a task spread: 1/2 beyond a continuous grazing bifurcation."""
    spread = np.ptp(values[line.ways[0]], axis=1)
    known = np.isfinite(spread) & (spread > 0)
    return np.polyfit(np.log(line.at[known]), np.log(spread[known]), 1)[0] if known.sum() > 1 else 0.0


def origin_of(line, values):
    """The value at grazing. Iterates spread from it by sqrt(mu) to one side, and to the other by mu only: a line through
    their ends on that side, where mu is small, meets it."""
    whole = values[line.ways[0]]
    known = np.isfinite(whole).all(axis=1)
    if known.sum() < 2:
        raise figures.FigureError("no value of /diagram/map_values is finite")
    at, whole = line.at[known], whole[known]
    end = min(whole.min(axis=1), whole.max(axis=1), key=np.ptp)
    return np.polyfit(at, end, 1, w=1 / at)[1]


# --- the panels ---


def draw_values(axes, result, line, x, y):
    """The densities; returns entries of the legend."""
    beyond = "map_values" in result.columns
    names = [("values", way) for way in line.ways] + [("map_values", line.ways[0])] * (beyond and not line.back)
    columns = [y.of(result.columns[name], way)[x.order] for name, way in names]
    limits = diagrams.limits_of(*columns)
    periods = [x.pick(result.columns[PERIOD_OF[name]], way) for name, way in names]
    densities = [diagrams.Density(column, period, x.edges, limits) for column, period in zip(columns, periods)]
    axes.set(ylim=limits, ylabel=y.label)
    if len(densities) == 1:
        mesh = diagrams.draw_density(axes, densities[0])
        bar = axes.inset_axes([1.015, 0, 0.018, 1])
        axes.figure.colorbar(mesh, cax=bar, label="share of the iterates in a cell")
        return []
    diagrams.draw_two(axes, *densities)
    words = [f"with {word} values" for word in line.way_words] if line.back else ["motion", "its return map"]
    colours = [diagrams.FIRST, diagrams.SECOND, diagrams.blend((diagrams.FIRST, diagrams.SECOND))[-1]]
    return [Patch(facecolor=colour, label=word) for colour, word in zip(colours, [*words, "both"])]


def draw_exponents(axes, result, line, x):
    series = [("lyapunov", way) for way in line.ways]
    if "map_lyapunov" in result.columns and not line.back:
        series.append(("map_lyapunov", line.ways[0]))
    shown = [x.pick(result.columns[name], way) for name, way in series]
    colours = [diagrams.FIRST, diagrams.SECOND] if len(shown) > 1 else [figures.INK]
    for numbers, colour in zip(shown, colours):
        axes.plot(x.at, np.where(np.isfinite(numbers), numbers, np.nan), color=colour, linewidth=0.8, alpha=0.85, zorder=3)
    whole = np.concatenate(shown)
    whole = np.append(whole[np.isfinite(whole)], 0)
    low, high, _ = figures.robust_limits(whole, np.ones(len(whole), bool))  # superstable cycles go down without bound
    axes.set_ylim(low, max(high, -0.15 * low))
    axes.axhspan(0, axes.get_ylim()[1], facecolor=CHAOS, zorder=0)
    axes.axhline(0, color=figures.INK, linewidth=0.8, zorder=2)
    axes.set_ylabel("exponent\nper iterate")


def draw_bar(axes, windows, row, x):
    """A window between its edges, with its period where there is room."""
    low, high = x.place(windows.low[row], windows.high[row])
    period, alone = windows.period[row], windows.impacts[row] == 1
    colour = diagrams.ONE_IMPACT if alone else OTHER_WINDOW
    axes.plot([low, high], [period] * 2, color=colour, linewidth=9, solid_capstyle="butt", zorder=3)
    middle, part = x.part(low, high)
    if part > NAMED:
        at = blended_transform_factory(axes.transAxes, axes.transData)
        axes.text(middle, period, str(period), transform=at, color="white", size=7.5, ha="center", va="center", zorder=4)
    return "one" if alone else "other"


PERIOD_LOOK = {"linewidth": 2.5, "rasterized": True, "zorder": 2}
WINDOW_ENTRIES = {
    "one": (diagrams.ONE_IMPACT, "window, one impact in a period"),
    "other": (OTHER_WINDOW, "window, other numbers of impacts"),
}


def draw_dashes(axes, result, line, x, most):
    """The period of every attractor; there and back beside one another."""
    shift = 0.14 if line.back else 0
    shown = []
    for way, colour, up in zip(line.ways, (diagrams.FIRST if line.back else DASH, diagrams.SECOND), (shift, -shift)):
        period = x.pick(result.columns["attractor_period"], way)
        is_shown = (period > 0) & (period <= most)
        axes.hlines(period[is_shown] + up, x.edges[:-1][is_shown], x.edges[1:][is_shown], color=colour, **PERIOD_LOOK)
        shown.append(period[is_shown])
    return np.concatenate(shown)


def draw_periods(axes, result, line, x):
    """Periods of the attractors as dashes, windows as bars; returns entries of the legend."""
    windows, seen = result.windows, set()
    rows = [row for row in windows.rows(line) if windows.own[row]] if windows else []
    period = result.columns["attractor_period"][line.tasks]
    alone = [windows.period[row] for row in rows if windows.impacts[row] == 1]
    most = max([MOST_PERIOD, period[period > 0].min(), *alone])
    shown = draw_dashes(axes, result, line, x, most)
    for row in rows:
        if windows.period[row] <= most and windows.located[row]:
            seen.add(draw_bar(axes, windows, row, x))
    axes.set_ylim(shown.min() - 0.8, shown.max() + 0.8)
    axes.yaxis.set_major_locator(MaxNLocator(6, integer=True, min_n_ticks=1))
    axes.set_ylabel("period")
    entries = [] if line.back else [Line2D([], [], color=DASH, linewidth=2.5, label="period of the attractor")]
    looks = [WINDOW_ENTRIES[word] for word in WINDOW_ENTRIES if word in seen]
    return entries + [Patch(facecolor=colour, label=label) for colour, label in looks]


def draw_distance(axes, result, line, x):
    way = line.ways[0]
    distance, period, of_map = (
        x.pick(result.columns[name], way) for name in ("distance", "attractor_period", "map_period")
    )
    known = np.isfinite(distance) & (distance > 0)
    same = known & (period > 0) & (period == of_map)
    axes.plot(x.at[known & ~same], distance[known & ~same], "o", color="#9a9a9a", markersize=2.6, markerfacecolor="white",
              markeredgewidth=0.6, rasterized=True)  # fmt: skip
    axes.plot(x.at[same], distance[same], "o", color=figures.INK, markersize=2.8, markeredgewidth=0, rasterized=True)
    if not known.any():
        return []
    low, high = distance[known].min(), distance[known].max()
    axes.set(yscale="log", ylim=(low / 2, high * 2), ylabel="distance")
    entries = []
    if same.any():
        entries.append(Line2D([], [], marker="o", linestyle="", color=figures.INK, markersize=4, label="same period"))
    if (known & ~same).any():
        entries.append(Line2D([], [], marker="o", linestyle="", color="#9a9a9a", markerfacecolor="white", markersize=4,
                              label="other period, or none"))  # fmt: skip
    fitted = np.polyfit(*np.log([x.at[same], distance[same]]), 1)[0] if x.logarithmic and same.sum() > 1 else 0
    if fitted > SPREADS:
        look = {"color": figures.ORANGE, "linestyle": (0, (1, 1.5)), "linewidth": 1.4}
        slope, words = (1, "1") if fitted > 0.75 else (0.5, "1/2")  # of linear motions, and of all others
        factor = np.exp(np.median(np.log(distance[same]) - slope * np.log(x.at[same])))
        axes.plot(x.at, factor * x.at**slope, zorder=4, **look)
        entries.append(Line2D([], [], label=f"slope {words}", **look))
    figures.label_decades(axes.yaxis)
    return entries


# --- the figure ---


def panels_of(result, line):
    """Lower panels: their heights over that of the first, and what draws them."""
    columns, panels = result.columns, []
    if "lyapunov" in columns:
        panels.append((0.3, draw_exponents))
    if len(np.unique(columns["attractor_period"][line.tasks])) > 1:
        panels.append((0.34, draw_periods))
    if "distance" in columns and np.isfinite(columns["distance"][line.tasks]).any():
        panels.append((0.34, draw_distance))
    return panels


def frame(axes, x, last):
    axes.set_xscale("log" if x.logarithmic else "linear")
    axes.set_xlim(x.edges[0], x.edges[-1])
    axes.tick_params(labelbottom=last, which="both")
    if x.logarithmic:
        figures.label_decades(axes.xaxis)
    if last:
        axes.set_xlabel(x.label)


def draw(result, line, options):
    x, y = Abscissa(result, line, options), Ordinate(result, line, options)
    lower = panels_of(result, line)
    heights = [1] + [height for height, _ in lower]
    figure = plt.figure(figsize=(8.8, 1.5 + 4.1 * sum(heights)), constrained_layout=True)
    cells = figure.add_gridspec(len(heights) + 1, 1, height_ratios=[*heights, 0.12])
    top = figure.add_subplot(cells[0])
    frame(top, x, not lower)
    entries = draw_values(top, result, line, x, y)
    for k, (_, drawn) in enumerate(lower, 1):
        axes = figure.add_subplot(cells[k])
        frame(axes, x, k == len(lower))
        entries += drawn(axes, result, line, x) or []
    legend = figure.add_subplot(cells[-1])
    figures.legend_row(legend, entries, 4) if entries else legend.axis("off")
    figures.put_title(figure, top, result, 90)
    if line.title:
        top.set_title(f"{result.subtitle()}\n{line.title}", loc="left", color=figures.FAINT)
    return figure


def options_of(parser):
    diagrams.line_options(parser)
    parser.add_argument("--scaled", action="store_true", help="z1 / sqrt(d) against ln sqrt(d) / ln lambda")
    parser.add_argument(
        "--lambda", dest="multiplier", type=float, metavar="L", help="lambda of --scaled; default: the study's"
    )
    parser.add_argument("--values", action="store_true", help="draw the values, over no root")


def run():
    parser = figures.make_parser("diagram", __doc__, "STEM.png and STEM.svg, of several lines STEM_K.png and STEM_K.svg")
    options_of(parser)
    options = parser.parse_args()
    stem = figures.stem_of(options, "scaled" if options.scaled else "diagram")

    def action():
        result = figures.open_result(options.result, partial(diagrams.Iterates, columns=COLUMNS))
        result.need("values", " (iterate.keep of the study is 0)")
        for line in result.lines(options.lines, MOST_LINES):
            alone = len(line.tasks) == len(result.outcome)
            figures.save(draw(result, line, options), stem if alone else f"{stem}_{line.index}")

    return figures.exit_code(options, action)


if __name__ == "__main__":
    sys.exit(run())
