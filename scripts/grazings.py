"""Results of kind `grazing` read for drawing: grazing points with the coefficients of the map there, windows of periods,
curves in two parameters."""

import numpy as np
from matplotlib.colors import to_rgba

import figures
from plot_branch import Branches
from plot_curves import Curves

VERDICTS = ("continuous", "discontinuous", "undecided")
CONTINUOUS, UNDECIDED = figures.BLUE, "#8a8a8a"
# Discontinuous by the first negative c_i, from the first return on: dark to light.
DISCONTINUOUS = ["#7a1f00", figures.RED, "#ee8f5a", "#f3b98f", "#f0d3ba"]
REGIME_WORDS = {
    "chaos": "chaos",
    "windows": "windows of rising periods, chaos between them",
    "overlap": "overlapping windows",
    "border": "on the border of two regimes",
}


class Grazings:
    """What figures use of a result."""

    def __init__(self, file):
        if "grazing/outcome" not in file:
            raise figures.FigureError("no /grazing/outcome in it: not a result of kind grazing")
        group = file["grazing"]
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        self.columns = {name: self._read(group[name]) for name in group}
        self.outcome = self.columns["outcome"]
        self.followed = self._name_of(group, "parameter")
        self.second = self._name_of(group, "curve_second")
        self.names = figures.text_of(file["sweep"].attrs.get("parameters", "")).split() if "sweep" in file else []
        self.swept = [file["sweep"][name][()] for name in self.names]
        self.tasks = range(len(self.outcome))

    @staticmethod
    def _read(dataset):
        if not np.issubdtype(dataset.dtype, np.integer) or figures.h5py.check_enum_dtype(dataset.dtype) is None:
            return dataset[()]
        return figures.names_of(dataset)

    @staticmethod
    def _name_of(group, column):
        attributes = group[column].attrs if column in group else {}
        return figures.text_of(attributes.get("parameter", attributes.get("long_name", "")))

    rows = Branches.rows
    task_name = Branches.task_name
    symbol = Branches.symbol
    model_number = Curves.model_number
    fixed = Curves.fixed

    def subtitle(self):
        return ", ".join(self.fixed() + ["all quantities dimensionless"])

    def need(self, name, why=""):
        if name not in self.columns:
            raise figures.FigureError(f"no /grazing/{name} in it{why}")
        return self.columns[name]


def choose_tasks(result, wanted, verdicts=VERDICTS):
    """The tasks with a grazing point and one of these verdicts."""
    count = len(result.outcome)
    for task in wanted or ():
        if not 0 <= task < count:
            raise figures.FigureError(f"no task {task}, it has tasks 0 to {count - 1}")
    chosen = list(wanted or range(count))
    touching = [task for task in chosen if result.outcome[task] == "grazing"]
    if not touching:
        outcomes = ", ".join(sorted(set(result.outcome[chosen])))
        raise figures.FigureError(f"no grazing point in it ({outcomes})")
    kept = [task for task in touching if result.need("verdict")[task] in verdicts]
    if not kept:
        met = ", ".join(sorted(set(result.columns["verdict"][touching])))
        raise figures.FigureError(f"no verdict {' or '.join(verdicts)} in it ({met})")
    return kept


def task_options(parser):
    parser.add_argument(
        "--tasks", type=int, nargs="+", metavar="K", help="draw these tasks only, from 0; default: all"
    )


def verdict_colour(verdict, first_negative):
    if verdict == "continuous":
        return CONTINUOUS
    if verdict == "discontinuous":
        return DISCONTINUOUS[min(max(first_negative, 0), len(DISCONTINUOUS) - 1)]
    return UNDECIDED


def verdict_label(verdict, first_negative):
    if verdict != "discontinuous":
        return verdict
    last = len(DISCONTINUOUS) - 1
    which = rf"$c_{{{first_negative}}} < 0$ first" if first_negative < last else rf"$c_i < 0$ with $i \geq {last}$"
    return f"discontinuous: {which}"


def number_text(value):
    """A real or complex number as mathematical text."""
    value = complex(value)
    if value.imag == 0:
        return f"{value.real:.4g}"
    return rf"{value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}\,\mathrm{{i}}"


def faint(colour, alpha):
    """The colour on white, for areas under lines."""
    return tuple(alpha * part + 1 - alpha for part in to_rgba(colour)[:3])
