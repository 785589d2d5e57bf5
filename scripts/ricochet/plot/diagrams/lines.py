"""Lines of a diagram: the tasks along its last sweep, and what is told of them in words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ricochet.plot.sheet import FigureError
from ricochet.plot.words import assignment, is_alone, number, parameter_label, parameter_symbol, state_symbol
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

MOST = 8  # lines or tasks that are drawn, spread, unless one is asked for
BEYOND = "grazing.beyond"
_ROUNDING = 1e-6  # relative difference of values at grazing that are one
FROM_GRAZING = ("model.d", BEYOND)  # parameters that are zero at grazing


@dataclass(frozen=True)
class Line:
    """Tasks along the last sweep, the other parameters fixed.

    result  that it is of
    index   of the line, from 0
    first   its first task
    name    of the parameter along it
    table   its tasks, in the order of the sweep
    at      values of the parameter, rising
    ways    rows of the table at these values; of a sweep that goes back once for each way
    words   of each way: "rising" or "falling"
    """

    result: Result
    index: int
    first: int
    name: str
    table: Table
    at: Array
    ways: tuple[Array, ...]
    words: tuple[str, str]

    @property
    def goes_back(self) -> bool:
        return len(self.ways) > 1


def count(result: Result) -> int:
    """How many lines there are."""
    return result.sweep.tasks // result.sweep.shape[-1] if result.swept else 0


def spread(number: int) -> list[int]:
    """Numbers from 0 to `number` - 1, of more than MOST a few."""
    return np.unique(np.linspace(0, number - 1, min(number, MOST)).astype(int)).tolist() if number else []


def needs_sweep(result: Result) -> str:
    """Why a figure along a line cannot be drawn; "" if it can."""
    return "" if result.swept else "no parameter is swept, this figure needs one"


def picked(result: Result, line: int | None) -> Line:
    """The line of this number, or the only one."""
    lines = count(result)
    if line is None and lines > 1:
        raise FigureError(
            result.path, f"{lines} lines along {result.swept[-1]} in it: say which, --line 0 to {lines - 1}"
        )
    if not 0 <= (line or 0) < lines:
        raise FigureError(result.path, f"it has no line {line}, only lines 0 to {lines - 1}")
    return line_of(result, line or 0)


def line_of(result: Result, index: int) -> Line:
    """A line; values that stand twice, and not on the way back, are refused."""
    points, name = result.sweep.shape[-1], result.swept[-1]
    first = index * points
    at = result.sweep.values[name][first : first + points]
    half = points // 2
    back = points > 2 and points % 2 == 0 and bool((at[:half] == at[half:][::-1]).all())
    parts = np.split(np.arange(points), [half]) if back else [np.arange(points)]
    ways = tuple(part[np.argsort(at[part], kind="stable")] for part in parts)
    rising = at[ways[0]]
    if (np.diff(rising) == 0).any():
        raise FigureError(result.path, f"a value of {name} stands twice in a line, and not on the way back")
    tasks = np.arange(result.sweep.tasks)
    table = result[result.kind].where((tasks >= first) & (tasks < first + points))
    words = ("rising", "falling") if at[0] <= at[min(1, points - 1)] else ("falling", "rising")
    return Line(result, index, first, name, table, rising, ways, words)


# --- words ---


def line_words(line: Line) -> list[str]:
    """The swept parameters that are fixed along a line, and where the motion grazes."""
    result = line.result
    fixed = [assignment(result, name, float(result.sweep.values[name][line.first])) for name in result.swept[:-1]]
    return [*fixed, *grazing_words(result, line.table)]


def grazing_words(result: Result, tasks: Table) -> list[str]:
    """Of motions beyond grazing: the value of the followed parameter at grazing, "force 39.3573 at grazing", or from
    which to which value it varies."""
    followed = followed_parameter(result)
    if followed is None or "parameter" not in tasks:
        return []
    beyond = tasks[BEYOND] if BEYOND in tasks else np.full(len(tasks), result.parameters[BEYOND])
    at = tasks["parameter"] / (1 + beyond)
    at = at[np.isfinite(at)]
    if len(at) == 0:
        return []
    if np.ptp(at) <= _ROUNDING * np.abs(at).max():
        at = np.median(at, keepdims=True)
    symbol = parameter_symbol(result, followed)
    ends = [number(float(end), 6) for end in (at.min(), at.max())]
    value = f"{'' if symbol.isalpha() else '= '}{ends[0]}" + (f"$ to ${ends[1]}" if ends[1] != ends[0] else "")
    words = [f"{symbol} ${value}$ at grazing".replace("$ $", " ")]  # one formula, not two
    return words if BEYOND in tasks else [*words, rf"$\mu = {number(result.parameters[BEYOND])}$ beyond it"]


def followed_parameter(result: Result) -> str | None:
    """The parameter of which `grazing.beyond` says how far beyond grazing it is; None without it."""
    beyond = BEYOND in result.swept or result.parameters.get(BEYOND) is not None
    return result.parameters.get("branch.parameter") if beyond else None


def varied(result: Result) -> list[str]:
    """Parameters besides the swept ones whose value in the study is not that of the motions."""
    followed = followed_parameter(result)
    return [] if followed is None else [followed]


def label_along(result: Result, name: str) -> str:
    """The label of an axis along a swept parameter."""
    followed = followed_parameter(result)
    if name == BEYOND and followed is not None:
        return f"$\\mu$ = {parameter_symbol(result, followed)} / its value at grazing \u2212 1"
    return parameter_label(result, name)


def no_period(result: Result) -> str:
    """What `aperiodic` means."""
    if "iterate.period_limit" in result.swept:
        return "no period up to the limit"
    return f"no period up to {result.parameters['iterate.period_limit']}"


# --- states ---


def is_map(result: Result) -> bool:
    return bool(result.parameters["model.type"] == "grazing_map")


def state_names(result: Result, size: int) -> list[str]:
    """Names of the numbers of a state: z1, z2, ... of a map, otherwise q0, ..., v0, ..., at impacts also "time"."""
    if is_map(result):
        return [f"z{i + 1}" for i in range(size)]
    return [f"{letter}{i}" for letter in "qv" for i in range(size // 2)] + ["time"] * (size % 2)


def state_label(name: str) -> str:
    """A number of a state as the label of an axis."""
    if name == "time":
        return "time in the period of the force"
    word = {"q": "displacement ", "v": "velocity "}.get(name[:1], "")
    return word + state_symbol(name)


def multiplier(result: Result, task: int) -> float | None:
    """The dominant multiplier that the study gives: lambda of the example map, or that of one particle on a linear
    spring over a period of the force. None if it gives none, or a complex one."""
    values = result.parameters_of(task)
    if is_map(result):
        given = values["model.lambda"]
        return None if given is None else float(given)
    if not is_alone(result) or not values.get("model.frequency"):
        return None
    single = {key: float(np.ravel(values[f"model.{key}"])[0]) for key in ("mass", "damping", "stiffness")}
    curved = [np.ravel(values.get(f"model.{key}") or 0)[0] for key in ("quadratic", "cubic")]
    under = single["damping"] ** 2 - 4 * single["mass"] * single["stiffness"]
    if any(curved) or under < 0:
        return None
    slowest = (np.sqrt(under) - single["damping"]) / (2 * single["mass"])
    return float(np.exp(slowest * 2 * np.pi / values["model.frequency"]))
