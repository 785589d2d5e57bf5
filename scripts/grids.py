"""Results over a grid of two parameters, for drawing: the tasks as a matrix, coloured cells, what goes with them."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import figures

GRAZING_CURVE = {"model.gamma", "orbit.period"}
EMPTY = "#dcdcdc"  # cells without a number
RARE = 0.01  # a word of fewer cells is marked as well, lest it drown


class Grid:
    """The tasks of a two-parameter sweep as a matrix [y, x] over rising axes."""

    def __init__(self, result, swap):
        shape, names = tuple(result.grid), result.names
        axes = [result.values[0].reshape(shape)[:, 0], result.values[1].reshape(shape)[0]]
        self.order = [np.argsort(axis, kind="stable") for axis in axes]
        self.shape, self.swap = shape, swap
        x, y = (1, 0) if swap else (0, 1)
        self.x_name, self.y_name = names[x], names[y]
        self.x, self.y = axes[x][self.order[x]], axes[y][self.order[y]]
        if any(len(np.unique(axis)) < len(axis) for axis in (self.x, self.y)):
            raise figures.FigureError("a swept value stands twice in the grid")
        self.logarithmic = [figures.is_geometric(axis) for axis in (self.x, self.y)]

    def matrix(self, column):
        sorted_column = column.reshape(self.shape)[np.ix_(*self.order)]
        return sorted_column if self.swap else sorted_column.T

    def edges(self):
        """Borders of the cells, halfway between neighbours on the axis's own scale."""
        return [
            np.exp(figures.cell_edges(np.log(axis))) if log else figures.cell_edges(axis)
            for axis, log in zip((self.x, self.y), self.logarithmic)
        ]

    def frame(self, axes):
        x, y = self.edges()
        axes.set_xscale("log" if self.logarithmic[0] else "linear")
        axes.set_yscale("log" if self.logarithmic[1] else "linear")
        axes.set(
            xlim=(x[0], x[-1]),
            ylim=(y[0], y[-1]),
            xlabel=figures.parameter_label(self.x_name),
            ylabel=figures.parameter_label(self.y_name),
        )


def draw_words(axes, grid, words, looks):
    """Coloured cells, from dark to light in the order of the looks; markers where a word is rare. Legend entries."""
    names, cells = figures.ordered(words, looks), grid.matrix(words)
    number = np.vectorize(names.index, otypes=[float])(cells)
    chosen = [looks.get(name, figures.OTHER_LOOK) for name in names]
    axes.pcolormesh(
        *grid.edges(),
        number,
        cmap=ListedColormap([look[0] for look in chosen]),
        rasterized=True,
        norm=Normalize(-0.5, len(names) - 0.5),
    )
    entries = []
    for name, (face, hatch, marker) in zip(names, chosen):
        where = cells == name
        label = f"{name.replace('_', ' ')} ({where.sum()})"
        if where.mean() < RARE:
            rows, columns = np.nonzero(where)
            axes.plot(
                grid.x[columns],
                grid.y[rows],
                marker,
                color=face,
                markeredgecolor="white",
                markersize=7,
                linestyle="",
                zorder=4,
            )
            entries.append(
                Line2D([], [], linestyle="", marker=marker, color=face, markersize=7, label=label)
            )
        else:
            entries.append(Patch(facecolor=face, edgecolor=figures.FAINT, linewidth=0.3, label=label))
    return entries


def draw_numbers(figure, axes, grid, column, label, nothing):
    """Positive numbers on a logarithmic scale of colours with its bar; cells of NaN stay empty.

    A long tail at either end, less than one cell in 200, shares the colour there; `nothing` says that all are NaN.
    """
    values = grid.matrix(column)
    axes.set_facecolor(EMPTY)
    shown = values[np.isfinite(values)]
    if shown.size == 0:
        axes.text(0.5, 0.5, nothing, ha="center", transform=axes.transAxes)
        return
    low, high = np.percentile(shown, [0.5, 99.5]) if shown.size > 50 else (shown.min(), shown.max())
    norm = LogNorm(low, high) if low < high else Normalize(low - 0.5, low + 0.5)
    mesh = axes.pcolormesh(*grid.edges(), values, cmap="viridis", norm=norm, rasterized=True)
    ends = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
    extend = ends[bool(shown.min() < low), bool(shown.max() > high)]
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, aspect=34, label=label, extend=extend)
    if isinstance(norm, LogNorm):
        figures.label_decades(bar.ax.yaxis)


def draw_grazing_curve(panels, grid):
    """[JAP] (13), where the axes are its two variables."""
    if {grid.x_name, grid.y_name} != GRAZING_CURVE:
        return []
    period_edges = grid.edges()[0 if grid.x_name == "orbit.period" else 1]
    period = np.linspace(period_edges[0], period_edges[-1], 400)
    coupling = ((2 * np.pi / period) ** 2 - 1) / 4
    curve = (period, coupling) if grid.x_name == "orbit.period" else (coupling, period)
    for axes in panels:
        axes.plot(*curve, color="white", linewidth=3.4, zorder=3)
        axes.plot(*curve, color="black", linewidth=1.5, linestyle=(0, (6, 2)), zorder=3.5)
    return [
        Line2D(
            [],
            [],
            color="black",
            linewidth=1.5,
            linestyle=(0, (6, 2)),
            label=r"$\gamma_c(T) = ((2\pi/T)^2 - 1)/4$, equation (13)",
        )
    ]


def lay_out(count):
    """Panels side by side over a row for the legend."""
    figure = plt.figure(figsize=(3.0 + 4.2 * count, 6.0), constrained_layout=True)
    cells = figure.add_gridspec(2, count, height_ratios=[1, 0.13])
    panels = [figure.add_subplot(cells[0, i]) for i in range(count)]
    return figure, panels, figure.add_subplot(cells[1, :])
