"""Results of kinds `diagram` and `basin` read for drawing: lines of the grid, iterates as densities, windows of periods."""

import re

import h5py
import numpy as np
from matplotlib.colors import ListedColormap, LogNorm, Normalize, to_rgb

import figures
from plot_branch import Branches
from plot_curves import Curves, as_number

FIRST, SECOND = figures.BLUE, figures.RED  # of two densities on the same axes
ROWS, FINER = 240, 3  # cells of a density over its height; each is so many where the iterates are periodic
MOST_COLUMNS = 1000  # of a density: tasks of more share one
LEVELS = 15  # of each of two densities
FAINTEST = 0.28  # how strong its colour is where it has a single iterate
ONE_IMPACT = figures.BLUE
ROUNDING = 1e-9  # values that spread less, relative to their size, are one
SAME_EDGE = 1e-3  # relative difference of edges that are one


class Iterates:
    """What figures use of a result: swept values, the columns that they ask for, the table /window."""

    kind = "diagram"

    def __init__(self, file, columns=()):
        if f"{self.kind}/outcome" not in file:
            raise figures.FigureError(f"no /{self.kind}/outcome in it: not a result of kind {self.kind}")
        group = file[self.kind]
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        self.outcome = figures.names_of(group["outcome"])
        self.columns = {name: group[name][()] for name in columns if name in group}
        attributes = group["values"].attrs if "values" in group else {}
        self.observed = figures.text_of(attributes.get("observed", attributes.get("long_name", "")))
        self.followed, self.second = self.study.word("parameter") or "", ""
        self._read_sweep(file)
        self.windows = Windows(file["window"]) if "window" in file else None

    def _read_sweep(self, file):
        sweep = file["sweep"] if "sweep" in file else None
        self.names = figures.text_of(sweep.attrs.get("parameters", "")).split() if sweep else []
        self.grid = [int(points) for points in np.atleast_1d(sweep.attrs["grid"])] if self.names else []
        self.values = self.swept = [sweep[name][()] for name in self.names]
        if len(self.grid) != len(self.names) or len(self.outcome) != np.prod(self.grid, dtype=int):
            raise figures.FigureError(f"the rows of /{self.kind} do not fill the grid of /sweep")

    task_name = Branches.task_name
    symbol = Branches.symbol
    model_number = Curves.model_number
    fixed = Curves.fixed

    def subtitle(self):
        parts = self.fixed()
        frequency = self.study.number("frequency")
        if frequency and "model.frequency" not in self.names:
            parts.append(rf"$\omega = {frequency}$")
        return ", ".join(parts + ["all quantities dimensionless"])

    def need(self, name, why=""):
        if name not in self.columns:
            raise figures.FigureError(f"no /{self.kind}/{name} in it{why}")
        return self.columns[name]

    def need_sweep(self, count):
        if len(self.names) != count:
            held = ", ".join(self.names) or "none"
            raise figures.FigureError(f"{len(self.names)} swept parameters ({held}), this figure needs {count}")

    def lines(self, wanted=None, most=None):
        """The lines of the grid along the last sweep; of more than `most` that nobody has asked for a few, spread."""
        if not self.names:
            raise figures.FigureError("no swept parameter in it, this figure needs one")
        count = len(self.outcome) // self.grid[-1]
        for line in wanted or ():
            if not 0 <= line < count:
                raise figures.FigureError(f"no line {line}, it has lines 0 to {count - 1}")
        chosen = wanted or range(count)
        if not wanted and most and count > most:
            chosen = np.linspace(0, count - 1, most).astype(int)
        return [Line(self, int(line)) for line in chosen]

    def coordinate_names(self, size):
        """Symbols of the numbers of a state."""
        if self.study.is_map:
            return [f"z{i + 1}" for i in range(size)]
        names = [f"{letter}{i}" for letter in "qv" for i in range(size // 2)]
        return names + ["time"] * (size % 2)


class Line:
    """Tasks of the grid along the last sweep, in the order of the file and by rising values, of a sweep that goes
    back once for each way."""

    def __init__(self, result, index):
        points = result.grid[-1]
        self.index, self.first = index, index * points
        self.tasks = np.arange(self.first, self.first + points)
        self.name = result.names[-1]
        at = result.values[-1][self.tasks]
        half = points // 2
        self.back = points > 2 and points % 2 == 0 and (at[:half] == at[half:][::-1]).all()
        parts = np.split(self.tasks, [half]) if self.back else [self.tasks]
        self.ways = [part[np.argsort(result.values[-1][part], kind="stable")] for part in parts]
        self.at = result.values[-1][self.ways[0]]
        if len(np.unique(self.at)) < len(self.at):
            raise figures.FigureError(f"a value of {self.name} stands twice in a line, and not on the way back")
        self.logarithmic = bool(figures.is_geometric(self.at))
        self.way_words = ("rising", "falling") if at[0] <= at[min(1, points - 1)] else ("falling", "rising")
        self.title = ", ".join(
            f"{result.symbol(name)} = {values[self.first]:.4g}"
            for name, values in zip(result.names[:-1], result.values[:-1])
        )


def line_options(parser):
    parser.add_argument(
        "--lines", type=int, nargs="+", metavar="K", help="of a grid, these lines along the last sweep, from 0"
    )


def number_label(name):
    """The symbol of a number of a state, as mathematical text."""
    found = re.fullmatch(r"([a-z])(\d+)", name)
    return f"${found[1]}_{{{found[2]}}}$" if found else "time in the period of the force"


def multiplier_of(result, task):
    """The dominant multiplier that the study gives: lambda of the example map, or that of one particle on a linear
    spring over a period of the force; None if it does not, or if it is complex."""
    if result.study.is_map:
        return result.model_number(task, "lambda")
    number = lambda key, default: result.model_number(task, key, default)  # noqa: E731
    linear = all(number(key, 0.0) == 0 for key in ("gamma", "quadratic", "cubic"))
    values = [number(*pair) for pair in (("mass", 1.0), ("damping", 0.0), ("stiffness", 1.0), ("frequency", None))]
    if result.study.word("particles") != "1" or not linear or None in values:
        return None
    mass, damping, stiffness, frequency = values
    under = damping**2 - 4 * mass * stiffness
    return float(np.exp((np.sqrt(under) - damping) / (2 * mass) * 2 * np.pi / frequency)) if under >= 0 else None


# --- windows ---


class Windows:
    """The table /window; `own` tells which rows are no repetition of another one by a multiple of its period."""

    def __init__(self, group):
        for name in ("task", "period", "impacts", "parameter", "low", "high", "map_low", "map_high"):
            setattr(self, name, group[name][()])
        self.low_kind, self.high_kind = (figures.names_of(group[name]) for name in ("low_kind", "high_kind"))
        self.inside = np.array([group["low_inside"][()], group["high_inside"][()]])
        self.reason = np.array([figures.text_of(text) for text in group["reason"][()]], dtype=object)
        self.located = np.isfinite(self.low) & np.isfinite(self.high)
        self.own = np.array([not self.repeats(row) for row in range(len(self.period))], dtype=bool)

    def repeats(self, row):
        """Whether a shorter period that divides this one has a window at its value: transients hide it here."""
        shorter = self.located & (self.period < self.period[row]) & (self.period[row] % self.period == 0)
        multiple = self.period[row] // self.period
        same = np.isclose(self.low, self.low[row], SAME_EDGE, 0) | np.isclose(self.high, self.high[row], SAME_EDGE, 0)
        same |= ~self.located[row]
        around = (self.low <= self.parameter[row]) & (self.parameter[row] <= self.high)
        times = (self.impacts[row] == multiple * self.impacts) | ~self.located[row]
        return bool((shorter & same & around & times).any())

    def rows(self, line):
        """Those of a line, by rising period."""
        mine = np.flatnonzero(np.isin(self.task, line.tasks))
        return mine[np.lexsort((self.parameter[mine], self.period[mine]))]

    def one_impact(self, line):
        """Those with one impact and located edges, one for each period."""
        rows = self.rows(line)
        rows = rows[self.located[rows] & self.own[rows] & (self.impacts[rows] == 1)]
        return rows[np.unique(self.period[rows], return_index=True)[1]]


# --- densities ---


def borders(at, logarithmic):
    return np.exp(figures.cell_edges(np.log(at))) if logarithmic else figures.cell_edges(at)


class Density:
    """Share of the iterates of each task in cells of its values: [rows, columns]. Periodic ones are lines of three finer
    cells, which the eye finds."""

    def __init__(self, columns, periods, edges, limits):
        self.y = np.linspace(*limits, ROWS * FINER + 1)
        shares = np.stack([self._share(*column) for column in zip(columns, periods)], axis=1)
        together = -(-len(columns) // MOST_COLUMNS)
        starts = np.arange(0, len(columns), together)
        self.x = np.append(edges[starts], edges[-1])
        self.share = np.add.reduceat(shares, starts, axis=1) / np.add.reduceat(np.ones(len(columns)), starts)
        self.least = 1 / columns.shape[1]

    def _share(self, column, period):
        finite = column[np.isfinite(column)]
        if period == 0:
            return np.repeat(np.histogram(finite, self.y[::FINER])[0], FINER) / len(column)
        share = np.pad(np.histogram(finite, self.y)[0] / len(column), 1)
        return np.max([share[:-2], share[1:-1], share[2:]], axis=0)

    def levels(self):
        """0: no iterate, else 1 to LEVELS on a logarithmic scale."""
        share = np.maximum(self.share, self.least / MOST_COLUMNS)
        scaled = 1 + (LEVELS - 1) * np.clip(np.log(share / self.least) / np.log(0.5 / self.least), 0, 1)
        return np.where(self.share > 0, np.round(scaled), 0).astype(int)


def density_map():
    """Sparse to dense; no colour is too light for white."""
    return ListedColormap(figures.plt.get_cmap("magma_r")(np.linspace(0.18, 1, 256)))


def draw_density(axes, density):
    """One density, with the colours of the bar that the mesh is for."""
    share = np.ma.masked_equal(density.share, 0)
    norm = LogNorm(density.least, 1 if density.least < 1 else 2, clip=True)
    return axes.pcolormesh(density.x, density.y, share, cmap=density_map(), norm=norm, rasterized=True)


def blend(colours):
    """Colours of all pairs of levels, as two inks on paper: dark where both are."""
    strength = np.concatenate([[0], np.linspace(FAINTEST, 1, LEVELS)])[:, None]
    one, other = (1 - strength * (1 - np.array(to_rgb(colour))) for colour in colours)
    return (one[:, None, :] * other[None, :, :]).reshape(-1, 3)


def draw_two(axes, first, second, colours=(FIRST, SECOND)):
    """Two densities over the same cells."""
    pairs = (LEVELS + 1) * first.levels() + second.levels()
    cells = np.ma.masked_equal(pairs, 0)
    norm = Normalize(-0.5, (LEVELS + 1) ** 2 - 0.5)
    axes.pcolormesh(first.x, first.y, cells, cmap=ListedColormap(blend(colours)), norm=norm, rasterized=True)


def limits_of(*columns, room=0.03):
    """Of all finite values, with some room."""
    whole = np.concatenate([column[np.isfinite(column)] for column in columns])
    if whole.size == 0:
        raise figures.FigureError("no iterate of it is finite")
    low, high = whole.min(), whole.max()
    size = max(abs(low), abs(high))
    pad = room * (high - low) if high - low > ROUNDING * size else 0.05 * size or 0.05
    return low - pad, high + pad
