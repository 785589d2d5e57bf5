"""Grazing points in words and colours: which tasks have one, and what the bifurcation there leads to."""

from __future__ import annotations

from collections.abc import Sequence

from ricochet.plot import look
from ricochet.plot.sheet import FigureError, plain
from ricochet.result import Result

VERDICTS = ("continuous", "discontinuous", "undecided")
CONTINUOUS, UNDECIDED = look.BLUE, "#8a8a8a"
DISCONTINUOUS = ("#7a1f00", look.RED, "#ee8f5a", "#f3b98f", "#f0d3ba")  # by the first negative c_i: dark to light
NEGATIVE, LATER_NEGATIVE = look.RED, "#c98a6b"  # coefficients of one grazing point
_REGIMES = {
    "chaos": "chaos",
    "windows": "windows of rising periods with chaos between them",
    "overlap": "overlapping windows of rising periods",
    "border": "the border of two regimes",
}


def grazing_tasks(result: Result, verdicts: Sequence[str] = VERDICTS) -> list[int]:
    """The tasks with a grazing point and one of these verdicts."""
    points = result["grazing"]
    kept = zip(points["outcome"] == "grazing", points["verdict"])
    return [task for task, (grazes, verdict) in enumerate(kept) if grazes and verdict in verdicts]


def why_none(result: Result, verdicts: Sequence[str] = VERDICTS) -> str:
    """Why there is no such task; "" if there is one."""
    if grazing_tasks(result, verdicts):
        return ""
    points = result["grazing"].where(outcome="grazing")
    if len(points) == 0:
        return f"no grazing point in it ({', '.join(sorted(set(result['grazing']['outcome'])))})"
    return f"no {' or '.join(verdicts)} grazing bifurcation in it, only {' and '.join(sorted(set(points['verdict'])))}"


def chosen_tasks(result: Result, tasks: Sequence[int] | None, verdicts: Sequence[str] = VERDICTS) -> list[int]:
    """Those of `tasks`, or of all, that have such a grazing point."""
    possible = grazing_tasks(result, verdicts)
    for task in tasks or ():
        result.parameters_of(task)  # refuses a task that there is not
    kept = possible if tasks is None else [task for task in dict.fromkeys(tasks) if task in possible]
    if not kept:
        words = ", ".join(map(str, tasks or ()))
        raise FigureError(result.path, f"task {words} has no {' or '.join(verdicts)} grazing bifurcation")
    return kept


# --- words ---


def followed(result: Result) -> str:
    """The parameter that the family was followed in."""
    return str(result.parameters["branch.parameter"])


def regime_words(regime: str) -> str:
    """What follows a continuous bifurcation as d tends to 0."""
    return _REGIMES.get(regime, regime)


def verdict_words(result: Result, task: int) -> str:
    """The bifurcation at the grazing point of a task, in a sentence without a stop."""
    points = result["grazing"]
    verdict, first = points["verdict"][task], int(points["first_negative"][task])
    if verdict == "continuous":
        return f"continuous grazing bifurcation: {regime_words(points['regime'][task])}"
    if verdict == "discontinuous":
        returns = f"{first + 1} returns" if first else "one return"
        return f"discontinuous grazing bifurcation: $c_{{{first}}} < 0$, another impact after {returns}"
    return f"undecided grazing bifurcation: {plain(points['verdict_reason'][task])}"


def verdict_label(verdict: str, first_negative: int) -> str:
    """A verdict in a legend, the discontinuous ones by their first negative c_i."""
    if verdict != "discontinuous":
        return verdict
    last = len(DISCONTINUOUS) - 1
    which = rf"$c_{{{first_negative}}} < 0$ first" if first_negative < last else rf"$c_i < 0$ first, $i \geq {last}$"
    return f"discontinuous: {which}"


def verdict_colour(verdict: str, first_negative: int) -> str:
    """The colour of a verdict."""
    if verdict == "continuous":
        return CONTINUOUS
    if verdict == "discontinuous":
        return DISCONTINUOUS[min(max(first_negative, 0), len(DISCONTINUOUS) - 1)]
    return UNDECIDED
