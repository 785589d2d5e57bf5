"""Positions and velocities of the orbits of a sweep against the particle."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import outcomes
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.words import obstacles, parameter_label
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
    shows="positions and velocities along the sweep, a curve for each orbit",
    columns=("orbits/q", "orbits/v"),
    swept=1,
    options={"all": "orbits that are not admissible, too", "curves": "at most so many curves, evenly picked"},
)
def modes(result: Result, *, all: bool = False, curves: int = 60) -> Figure:
    """Positions and velocities just after t = 0 against the particle, a curve for each orbit, its colour the parameter.
    Bands mark the particles that hit, hatching the floors."""
    rows, available = _picked(result, all, curves)
    name = result.swept[0]
    at = result.sweep.values[name]
    sheet = Sheet(result, 8.6, 6.6, rows=2)
    upper = sheet.panel(0)
    panels = [upper, sheet.panel(1, sharex=upper)]
    for axes, (column, label) in zip(panels, _PANELS):
        states = result["orbits"][column][rows]
        lines = _draw_curves(axes, states, at[rows], _norm(at[rows]))
        floors = obstacles(result)["floor"] if column == "q" else np.full(states.shape[1], np.nan)
        bottom = _frame(sheet, axes, states, floors)
        sheet.legend(_mark_particles(axes, result) + _mark_floor(axes, floors, bottom))
        axes.set_ylabel(label)
    upper.tick_params(labelbottom=False)
    panels[1].axhline(0, color=look.FAINT, linewidth=0.6, zorder=1)
    panels[1].set_xlabel("particle")
    panels[1].xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12))
    sheet.figure.colorbar(lines, ax=panels, label=parameter_label(result, name), aspect=40, pad=0.015)
    if len(rows) < len(at):
        what = "orbits" if all else "admissible orbits"
        sheet.note(f"{len(rows)} of {available} {what}, {len(at)} computed")
    return sheet.finish()


def _picked(result: Result, all: bool, curves: int) -> tuple[Array, int]:
    """Rows to draw in the order of the parameter, thinned evenly to at most `curves`; how many there were."""
    orbits = result["orbits"]
    usable = np.isfinite(orbits["q"]).all(axis=1) & np.isfinite(orbits["v"]).all(axis=1)
    sound = outcomes.sound(result)
    if not all:
        usable &= sound
    rows = np.flatnonzero(usable)
    if len(rows) == 0:
        raise FigureError(result.path, "no orbit of it is admissible; --all draws the others, too")
    rows = rows[np.argsort(result.sweep.values[result.swept[0]][rows], kind="stable")]
    picked = np.linspace(0, len(rows) - 1, min(len(rows), max(curves, 1)))
    return rows[np.unique(picked.round().astype(int))], len(rows)


def _norm(at: Array) -> Normalize:
    low, high = (at.min(), at.max()) if at.min() < at.max() else (0.95 * at[0], 1.05 * at[0] or 1.0)
    return (LogNorm if scale.is_geometric(at) else Normalize)(low, high)


def _draw_curves(axes: Axes, states: Array, at: Array, norm: Normalize) -> LineCollection:
    count = states.shape[1]
    particles = np.arange(count)
    colours = {"cmap": look.colour_map(), "norm": norm}
    segments = [np.column_stack([particles, row]) for row in states]
    lines = LineCollection(segments, linewidths=1.0, alpha=0.9, zorder=2, **colours)
    lines.set_array(at)
    axes.add_collection(lines)
    if count <= _MOST_DOTS:
        places = np.tile(particles, len(states))
        axes.scatter(places, states.ravel(), s=7, c=np.repeat(at, count), linewidths=0, zorder=2.5, **colours)
    axes.set_xlim(-0.6, count - 0.4)
    return lines


def _frame(sheet: Sheet, axes: Axes, states: Array, floors: Array) -> float:
    """Limits of the value axis; a few modes ten times as large as most leave it, with a note."""
    usual = np.percentile(np.abs(states).max(axis=1), 90)
    low, high = min(states.min(), 0.0), max(states.max(), 0.0)
    if usual > 0 and max(-low, high) > 10 * usual:
        low, high = max(low, -3 * usual), min(high, 3 * usual)
        sheet.note(scale.clip_note(states))
    if np.isfinite(floors).any():
        low = min(low, np.nanmin(floors))
    pad = 0.07 * (high - low) or 0.05
    axes.set_ylim(low - pad, high + pad)
    return float(low - pad)


def _mark_particles(axes: Axes, result: Result) -> list[Artist]:
    """Bands behind the particles of the pattern; their entries of the legend."""
    pattern = [result.parameters[f"orbit.at_{when}"] for when in ("start", "half")]
    entries: list[Artist] = []
    for particles, (text, area) in zip(pattern, _HITS):
        for particle in particles:
            axes.axvspan(particle - 0.25, particle + 0.25, zorder=0, **area)
        if len(particles):
            entries.append(Patch(label=text, **area))
    return entries


def _mark_floor(axes: Axes, floors: Array, bottom: float) -> list[Artist]:
    """The floor under each particle, hatched downwards."""
    found = np.flatnonzero(np.isfinite(floors))
    if len(found) == 0:
        return []
    depth = 0.035 * (axes.get_ylim()[1] - bottom)
    hatching = {"facecolor": "none", "edgecolor": "#8c8c8c", "hatch": "//////", "linewidth": 0, "zorder": 0.5}
    for first, last in scale.equal_runs(floors):
        axes.fill_between([first - 0.5, last + 0.5], floors[first] - depth, floors[first], **hatching)
        axes.hlines(floors[first], first - 0.5, last + 0.5, color=look.INK, linewidth=1.1, zorder=1.5)
    return [Line2D([], [], color=look.INK, linewidth=1.1, label="floor")]
