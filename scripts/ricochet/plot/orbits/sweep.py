"""A sweep of orbits over one parameter: outcome, stability, impulses, energy and smallest gap."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import curves, outcomes, strips
from ricochet.plot.pattern import list_text, pattern
from ricochet.plot.sheet import Sheet
from ricochet.plot.words import parameter_label
from ricochet.result import Result
from ricochet.sweep import Array

_NAMES = {"impulse": "impulse", "energy": "energy", "clearance": "smallest gap"}
_HEIGHTS = {"impulse": 1.75, "energy": 1.4, "clearance": 1.4}
_STRIP, _TICKS = 0.28, 0.16  # heights of a strip of words, and of a row of ticks
_STABILITIES = {**look.STABILITIES, "stable": (look.SKY, "", "o")}  # blue is what is admissible
_MANY = 20  # an energy with a larger range has a logarithmic axis
_MOST_CURVES = 6  # of different impulses that the legend tells apart
_EQUAL = 1e-9  # relative difference of impulses that count as equal


@figure(
    "orbits",
    shows="outcome, stability, impulses, energy and smallest gap along the sweep",
    swept=1,
    options={"all": "the stability of orbits that are not admissible, too"},
)
def sweep(result: Result, *, all: bool = False) -> Figure:
    """Outcome and stability as strips, special points as ticks; impulses, energy and smallest gap as curves, dashed
    where the orbit is not admissible."""
    order = np.argsort(result.sweep.values[result.swept[0]], kind="stable")
    at = result.sweep.values[result.swept[0]][order]
    special = outcomes.special_points(result)
    sheet, panels, bands, rug = _lay_out(result, len(special))
    _draw_words(sheet, bands, result, order, all)
    if rug is not None:
        sheet.legend(strips.draw_special(rug, list(panels.values()), special, strips.edges(at)))
    impulses = result["orbits"]["impulse"][order]
    cut = curves.cuts(at, impulses, special.get("singular", ()))
    sound = outcomes.sound(result)[order]
    if "impulse" in panels:
        _draw_impulses(sheet, panels["impulse"], impulses, at, sound, cut)
    for name in panels.keys() - {"impulse"}:
        _draw_column(sheet, panels[name], name, at, sound, cut, result["orbits"][name][order])
    _frame_parameter(sheet, result, at)
    if (~sound & np.isfinite(impulses).any(axis=1)).any():
        dashed = {"color": look.INK, "linestyle": curves.DASHES, "alpha": 0.6}
        sheet.legend([Line2D([], [], label="orbit that is not admissible", **dashed)])
    sheet.figure.align_ylabels(list(panels.values()))
    return sheet.finish(words=pattern(result))


# --- panels ---


def _lay_out(result: Result, kinds: int) -> tuple[Sheet, dict[str, Axes], list[Axes], Axes | None]:
    """The sheet; from below the panels of columns that hold numbers, a rug for the kinds of special points, and strips
    for outcome and stability."""
    orbits = result["orbits"]
    columns = [name for name in _NAMES if np.isfinite(orbits[name]).any()]
    words = 2 if "stable" in orbits else 1
    heights = [_STRIP] * words + [_TICKS * (1 + kinds)] * (kinds > 0) + [_HEIGHTS[name] for name in columns]
    sheet = Sheet(result, 8.6, 0.6 + 1.15 * sum(heights), rows=len(heights), heights=heights)
    first = words + (kinds > 0)
    panels: dict[str, Axes] = {}
    for row, name in enumerate(columns, first):  # the first panel made is the one to which limits apply
        panels[name] = sheet.panel(row, sharex=panels[columns[0]] if panels else None)
    main = panels[columns[0]] if panels else None
    bands = [sheet.panel(row, sharex=main) for row in range(words)]
    rug = sheet.panel(words, sharex=main or bands[0]) if kinds else None
    return sheet, panels, bands, rug


def _draw_words(sheet: Sheet, bands: Sequence[Axes], result: Result, order: Array, all: bool) -> None:
    at = result.sweep.values[result.swept[0]][order]
    words = outcomes.detailed(result)[order]
    sheet.legend(strips.draw_words(bands[0], "outcome", at, words, look.OUTCOMES))
    if len(bands) == 1:
        return
    stable = outcomes.stability(result, all)[order]
    left_out = stable == outcomes.NOT_ADMISSIBLE
    sheet.legend(strips.draw_words(bands[1], "stability", at, np.where(left_out, "", stable), _STABILITIES))
    if left_out.any():
        sheet.note(f"stability of {left_out.sum()} orbits that are not admissible is left out; --all shows it")


def _frame_parameter(sheet: Sheet, result: Result, at: Array) -> None:
    borders = strips.edges(at)
    lowest = max(sheet.panels, key=lambda axes: axes.get_subplotspec().rowspan.start)
    lowest.xaxis.set_visible(True)
    for axes in sheet.panels:
        axes.tick_params(labelbottom=axes is lowest)
    lowest.set_xscale("log" if scale.is_geometric(at) else "linear")
    lowest.set_xlim(borders[0], borders[-1])
    lowest.set_xlabel(parameter_label(result, result.swept[0]))


def _frame(sheet: Sheet, axes: Axes, name: str, values: Array, sound: Array) -> None:
    """Limits of the value axis that blow-ups cannot squeeze; a note where they leave it."""
    logarithmic = axes.get_yscale() == "log"
    if logarithmic:
        values = np.where(values > 0, values, np.nan)
    shown = np.log10(values) if logarithmic else values
    which = np.broadcast_to(sound, shown.T.shape).T
    low, high, clipped = scale.robust_limits(shown.ravel(), which.ravel())
    axes.set_ylim(*(10.0 ** np.array([low, high]) if logarithmic else (low, high)))
    if clipped:
        sheet.note(f"{_NAMES[name]}: {scale.clip_note(values)}")


# --- curves ---


def _draw_impulses(sheet: Sheet, axes: Axes, impulses: Array, at: Array, sound: Array, cut: Array) -> None:
    groups = _equal_columns(impulses)
    noun, numbers = outcomes.impacts(sheet.result)
    for i, group in enumerate(groups):
        colour = look.CYCLE[i % len(look.CYCLE)]
        width = 1.6 + 0.9 * (len(groups) - 1 - i)  # those below others show on both sides of them
        curves.draw(axes, at, impulses[:, group[0]], sound, cut, colour, min(width, 5))
        if 1 < impulses.shape[1] and len(groups) <= _MOST_CURVES:
            sheet.legend([Line2D([], [], color=colour, label=_impulse_label(noun, [numbers[k] for k in group]))])
    _frame(sheet, axes, "impulse", impulses, sound)
    axes.axhline(0, color=look.FAINT, linewidth=0.7, zorder=1)
    axes.set_ylabel("impulse" if impulses.shape[1] == 1 else "impulses")


def _equal_columns(impulses: Array) -> list[list[int]]:
    """Columns in groups that are equal in every row."""
    size = np.nanmax(np.abs(impulses), initial=1e-300, axis=1)
    groups: list[list[int]] = []
    for column in range(impulses.shape[1]):
        mine = impulses[:, column] / size
        same = (g for g in groups if np.allclose(mine, impulses[:, g[0]] / size, atol=_EQUAL, equal_nan=True))
        found = next(same, None)
        if found is None:
            groups.append([column])
        else:
            found.append(column)
    return groups


def _impulse_label(noun: str, numbers: Sequence[int]) -> str:
    if len(numbers) == 1:
        return f"impulse of {noun} {numbers[0]}"
    return f"equal impulses of {noun}s {list_text(sorted(numbers))}"


def _draw_column(sheet: Sheet, axes: Axes, name: str, at: Array, sound: Array, cut: Array, values: Array) -> None:
    curves.draw(axes, at, values, sound, cut, look.INK)
    positive = values[np.isfinite(values) & (values > 0)]
    if name == "energy" and positive.size and positive.max() > _MANY * positive.min():
        axes.set_yscale("log")
    _frame(sheet, axes, name, values, sound)
    if axes.get_yscale() == "log":
        scale.label_decades(axes.yaxis)
    elif name == "clearance":
        axes.axhline(0, color=look.FAINT, linewidth=0.7, zorder=1)
    axes.set_ylabel("energy $E$" if name == "energy" else _NAMES[name])
