"""Positions and velocities of the orbits of a sweep against the particle."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import outcomes
from ricochet.plot.pattern import hitting
from ricochet.plot.sheet import FigureError, Sheet, expect_count
from ricochet.plot.words import count, obstacles, parameter_label
from ricochet.result import Result
from ricochet.sweep import Array

_PANELS = (("q", r"position $q$ at $t = 0^+$"), ("v", r"velocity $v$ at $t = 0^+$"))
_MOST_DOTS = 60  # particles that have dots on their curves
_HITS = (  # of the particles of the pattern
    ("hits at $t = 0$", {"facecolor": "#e4e4e4", "edgecolor": "#bdbdbd", "linewidth": 0}),
    ("hits at $t = T/2$", {"facecolor": "white", "edgecolor": "#bdbdbd", "hatch": "////", "linewidth": 0}),
)


@figure(
    "orbits",
    shows="positions and velocities of the particles, along a sweep a curve for each orbit",
    columns=("orbits/q", "orbits/v"),
    reason=lambda result: _too_many(result),
    source="Example 1 of [JAP]",
    options={"all": "orbits that are not admissible, too", "curves": "at most so many curves, evenly picked"},
)
def modes(result: Result, *, all: bool = False, curves: int = 60) -> Figure:
    """Positions and velocities just after t = 0 against the particle, a curve for each orbit, its colour the parameter.
    Bands mark the particles that hit, hatching the floors."""
    expect_count(result, "curves", curves)
    usable, left_out, missing = _usable(result, all)
    rows = _thinned(result, usable, curves)
    at = _parameter(result)
    sheet = Sheet(result, 8.6, 6.6, rows=2)
    upper = sheet.panel(0)
    panels = [upper, sheet.panel(1, sharex=upper)]
    for axes, (column, label) in zip(panels, _PANELS):
        states = result["orbits"][column][rows]
        lines = _draw_curves(axes, states, at[rows], _norm(at[rows]))
        sides = obstacles(result) if column == "q" else {}
        axes.set_ylabel(label)
        _frame(sheet, axes, states, sides)
        sheet.legend(_mark_particles(axes, result))
        sheet.legend([entry for side, places in sides.items() for entry in _mark_obstacles(axes, side, places)])
    upper.tick_params(labelbottom=False)
    panels[1].axhline(0, color=look.FAINT, linewidth=0.6, zorder=1)
    panels[1].set_xlabel("particle")
    panels[1].xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12, min_n_ticks=1))
    if result.swept:
        sheet.figure.colorbar(lines, ax=panels, label=parameter_label(result, result.swept[0]), aspect=40, pad=0.015)
    _note_rest(sheet, len(rows), usable.sum(), left_out, missing)
    return sheet.finish()


def _too_many(result: Result) -> str:
    return f"{count(len(result.swept), 'swept parameter')}, this figure shows one at most" if result.swept[1:] else ""


def _parameter(result: Result) -> Array:
    """The swept parameter [tasks], 0 of a single orbit."""
    return result.sweep.values[result.swept[0]] if result.swept else np.zeros(1)


def _usable(result: Result, all: bool) -> tuple[Array, int, int]:
    """Tasks that may be drawn [tasks]; how many are left out that are not admissible, and how many have no states."""
    orbits = result["orbits"]
    finite = np.isfinite(orbits["q"]).all(axis=1) & np.isfinite(orbits["v"]).all(axis=1)
    usable = finite & (outcomes.sound(result) | all)
    if not usable.any():
        raise FigureError(result.path, "no orbit of it is admissible; --all draws the others, too")
    return usable, int((finite & ~usable).sum()), int((~finite).sum())


def _thinned(result: Result, usable: Array, curves: int) -> Array:
    """At most so many tasks, evenly picked, in the order of the parameter."""
    rows = np.flatnonzero(usable)
    rows = rows[np.argsort(_parameter(result)[rows], kind="stable")]
    picked = np.linspace(0, len(rows) - 1, min(len(rows), curves))
    return np.asarray(rows[np.unique(picked.round().astype(int))])


def _note_rest(sheet: Sheet, drawn: int, usable: int, left_out: int, missing: int) -> None:
    if drawn < usable:
        sheet.note(f"{drawn} of {usable} orbits, evenly picked; --curves draws more")
    rest = [f"{count(left_out, 'orbit')} not admissible (drawn with --all)"] * (left_out > 0)
    rest += [f"{count(missing, 'task')} without an orbit"] * (missing > 0)
    if rest:
        sheet.note(f"not drawn: {', '.join(rest)}")


def _norm(at: Array) -> Normalize:
    low, high = (at.min(), at.max()) if at.min() < at.max() else (0.95 * at[0], 1.05 * at[0] or 1.0)
    return (LogNorm if scale.is_geometric(at) else Normalize)(low, high)


def _draw_curves(axes: Axes, states: Array, at: Array, norm: Normalize) -> LineCollection:
    count = states.shape[1]
    particles = np.arange(count)
    colours = {"cmap": look.colour_map() if len(np.unique(at)) > 1 else ListedColormap([look.BLUE]), "norm": norm}
    segments = [np.column_stack([particles, row]) for row in states]
    lines = LineCollection(segments, linewidths=1.0, alpha=0.9, zorder=2, **colours)
    lines.set_array(at)
    axes.add_collection(lines)
    if count <= _MOST_DOTS:
        places = np.tile(particles, len(states))
        axes.scatter(places, states.ravel(), s=7, c=np.repeat(at, count), linewidths=0, zorder=2.5, **colours)
    axes.set_xlim(-0.6, count - 0.4)
    return lines


def _frame(sheet: Sheet, axes: Axes, states: Array, sides: Mapping[str, Array]) -> None:
    """Limits of the value axis; a few modes ten times as large as most leave it, with a note."""
    usual = np.percentile(np.abs(states).max(axis=1), 90)
    low, high = min(states.min(), 0.0), max(states.max(), 0.0)
    if usual > 0 and max(-low, high) > 10 * usual:
        low, high = max(low, -3 * usual), min(high, 3 * usual)
        sheet.note(f"{axes.get_ylabel().split()[0]}: {scale.clip_note(states)}")
    near = [
        place for places in sides.values() for place in places if low - (high - low) <= place <= high + (high - low)
    ]
    low, high = min([low, *near]), max([high, *near])
    pad = 0.07 * (high - low) or 0.05
    axes.set_ylim(low - pad, high + pad)


def _mark_particles(axes: Axes, result: Result) -> list[Artist]:
    """Bands behind the particles of the pattern; their entries of the legend."""
    entries: list[Artist] = []
    for particles, (text, area) in zip(hitting(result), _HITS):
        for particle in particles:
            axes.axvspan(particle - 0.25, particle + 0.25, zorder=0, **area)
        if len(particles):
            entries.append(Patch(label=text, **area))
    return entries


def _mark_obstacles(axes: Axes, side: str, places: Array) -> list[Artist]:
    """The floor below each particle, or the wall above it, hatched behind its surface; those outside the picture are left
    out. The entry of the legend."""
    bottom, top = axes.get_ylim()
    shown = np.where((places >= bottom) & (places <= top), places, np.nan)
    if not np.isfinite(shown).any():
        return []
    depth = 0.035 * (top - bottom) * (-1 if side == "floor" else 1)
    hatching = {"facecolor": "none", "edgecolor": "#8c8c8c", "hatch": "//////", "linewidth": 0, "zorder": 0.5}
    surface = {"color": look.INK, "linewidth": 1.1, "linestyle": "-" if side == "floor" else (0, (7, 1.5))}
    for first, last in scale.equal_runs(shown):
        axes.fill_between([first - 0.5, last + 0.5], shown[first] + depth, shown[first], **hatching)
        axes.hlines(shown[first], first - 0.5, last + 0.5, zorder=1.5, **surface)
    return [Line2D([], [], label=side, **surface)]
