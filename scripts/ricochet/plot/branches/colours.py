"""Colours of branches: of one task each segment has its own, of several tasks the values of a swept parameter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize, to_hex
from matplotlib.lines import Line2D

from ricochet.plot import look, scale
from ricochet.plot.branches import family
from ricochet.plot.sheet import Sheet
from ricochet.plot.words import assignment, number, parameter_label, parameter_symbol
from ricochet.result import Result
from ricochet.sweep import Array

_FEW = 7  # values that have colours and entries of their own


@dataclass
class Colours:
    """of       the colour of a task and a segment
    entries  of the legend
    bar      colours that a bar explains instead, and its label
    shown    the swept parameters that the colours show
    """

    of: Callable[[int, int], str]
    entries: list[Artist] = field(default_factory=list)
    bar: tuple[ScalarMappable, str] | None = None
    shown: tuple[str, ...] = ()

    def draw_bar(self, sheet: Sheet) -> None:
        """The colour bar beside the main panel, if there is one."""
        if self.bar:
            sheet.figure.colorbar(self.bar[0], ax=sheet.panels[0], label=self.bar[1], pad=0.015, aspect=40)


def of_tasks(result: Result, tasks: Sequence[int]) -> Colours:
    if len(tasks) == 1:
        return _of_segments(result, tasks[0])
    name = _varying(result, tasks)
    values = result.sweep.values[name].astype(float)
    different = np.unique(values[tasks])
    if len(different) > _FEW:
        shade, bar = _graded(different, parameter_label(result, name))
        return Colours(lambda task, segment: shade(values[task]), bar=bar, shown=(name,))
    shades = _shades(name, different)
    entries = [_entry(shades[value], assignment(result, name, value)) for value in different]
    return Colours(lambda task, segment: shades[values[task]], entries, shown=(name,))


def others(result: Result, tasks: Sequence[int], shown: Sequence[str]) -> list[str]:
    """The swept parameters that the colours do not show, with their values: for the heading."""
    return [
        _range(result, name, np.unique(result.sweep.values[name][tasks])) for name in result.swept if name not in shown
    ]


def _range(result: Result, name: str, values: Array) -> str:
    if len(values) == 1:
        return assignment(result, name, float(values[0]))
    texts = [number(value, 6) for value in values.tolist()]
    listed = ",\\, ".join(texts) if len(texts) <= _FEW else rf"{texts[0]} \ldots {texts[-1]}"
    return f"{parameter_symbol(result, name)} $= {listed}$".replace("$ $", " ")  # one formula, not two


def _of_segments(result: Result, task: int) -> Colours:
    names = family.segment_names(result, task)
    if len(names) > len(look.CYCLE):
        numbers = np.arange(len(names))
        shade, bar = _graded(numbers, "segment")
        return Colours(lambda task, segment: shade(segment), bar=bar)
    entries = [_entry(*pair) for pair in zip(look.CYCLE, names)] if len(names) > 1 else []
    return Colours(lambda task, segment: look.CYCLE[segment], entries)


def _varying(result: Result, tasks: Sequence[int]) -> str:
    """The swept parameter with which colours vary: the last one of the model, otherwise the last one."""
    varied = [name for name in result.swept if len(np.unique(result.sweep.values[name][tasks])) > 1]
    varied = varied or list(result.swept)
    return ([name for name in varied if name.startswith("model.")] or varied)[-1]


def _shades(name: str, values: Array) -> dict[float, str]:
    """Modes and other numbers of things have colours of their own, other values the shades of a colour map."""
    if not name.startswith("model.") and len(values) <= len(look.CYCLE) and (values % 1 == 0).all():
        return dict(zip(values, look.CYCLE))
    return dict(zip(values, map(to_hex, look.colour_map()(np.linspace(0, 1, len(values))))))


def _graded(drawn: Array, label: str) -> tuple[Callable[[float], str], tuple[ScalarMappable, str]]:
    """Shades of a colour map for many values, and their bar."""
    norm = (LogNorm if scale.is_geometric(drawn) else Normalize)(drawn.min(), drawn.max())
    shades = look.colour_map()
    return lambda value: to_hex(shades(norm(value))), (ScalarMappable(norm, shades), label)


def _entry(colour: str, label: str) -> Artist:
    return Line2D([], [], color=colour, linewidth=2, label=label)
