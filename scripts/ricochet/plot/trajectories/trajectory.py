"""Displacements of all particles against time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import Sheet
from ricochet.plot.trajectories.motion import LABEL, OPTIONS, UPWARDS, Motion, is_sampled, pen, picked_tasks
from ricochet.plot.words import count
from ricochet.result import Result
from ricochet.sweep import Array

_MUTED = "#b4b4b4"  # particles that do not hit
_MOST_MUTED = 400
_MOST_NAMED = 12  # particles with a colour of their own
_MOST_MARKS = 2000
_MOST_LINES = 12  # obstacles of different particles
_HEAVY = 100_000  # points of curves that are stored as pixels in a PDF
_BEYOND = 10  # how far hatching goes, over the height of the panel: to its edge whatever the limits
_DASHES = (0, (6, 3))

Looks = dict[int, tuple[Any, Any]]  # {particle: (colour, line style)}


@figure(
    "trajectory",
    shows="displacement of every particle against time, with the impacts",
    natural=is_sampled,
    part="task",
    parts=picked_tasks,
    options=OPTIONS,
)
def trajectory(
    result: Result, *, task: int | None = None, start: float | None = None, end: float | None = None
) -> Figure:
    """Particles that hit have colours, the others are grey; triangles mark the impacts. An obstacle that all particles
    share is hatched; otherwise each is a dashed line in the colour of its particle."""
    motion = Motion(result, task, start, end)
    sheet = Sheet(result, 9.6, 4.6)
    axes = sheet.panel()
    axes.set_xlim(motion.limits)
    axes.set(xlabel="time $t$", ylabel=LABEL)
    looks = _looks(_named(motion))
    obstacles = motion.in_sight(motion.q.min(), motion.q.max())
    _frame(axes, motion.q, obstacles)
    sheet.legend(_draw_named(axes, motion, looks) + _draw_muted(axes, motion, looks))
    sheet.legend(_draw_obstacles(sheet, axes, obstacles, looks))
    sheet.legend(_mark_hits(sheet, axes, motion, looks))
    _mark_periods(axes, motion)
    if len(looks) > _MOST_NAMED:
        colours = ScalarMappable(Normalize(min(looks), max(looks)), look.colour_map())
        ticks = MaxNLocator(integer=True)
        sheet.figure.colorbar(colours, ax=axes, label="particle that hits", aspect=34, pad=0.015, ticks=ticks)
    for note in motion.notes():
        sheet.note(note)
    return sheet.finish(words=motion.words())


def _named(motion: Motion) -> Array:
    """Particles with colours: those that hit; if none does, all of a few."""
    if len(motion.hitting) or motion.particles > _MOST_NAMED:
        return motion.hitting
    return np.arange(motion.particles)


def _looks(named: Array) -> Looks:
    if len(named) > _MOST_NAMED:
        shades = look.colour_map()((named - named[0]) / np.ptp(named))
        return {int(particle): (shade, "-") for particle, shade in zip(named, shades)}
    colours = len(look.CYCLE)
    styles = ("-", (0, (5, 1.5)))
    return {int(particle): (look.CYCLE[i % colours], styles[i // colours]) for i, particle in enumerate(named)}


def _frame(axes: Axes, q: Array, obstacles: dict[str, Array]) -> None:
    """Room for the motion and the obstacles in sight, and for marks beyond them."""
    shown = np.concatenate([[q.min(), q.max()], *obstacles.values()])
    low, high = np.nanmin(shown), np.nanmax(shown)
    pad = 0.08 * (high - low) or 0.1
    axes.set_ylim(low - pad, high + pad)


# --- curves ---


def _draw_named(axes: Axes, motion: Motion, looks: Looks) -> list[Artist]:
    heavy = len(looks) * len(motion.t) > _HEAVY
    entries: list[Artist] = []
    for particle, (colour, style) in looks.items():
        width = pen() * (1.3 if len(looks) <= _MOST_NAMED else 0.8)
        (line,) = axes.plot(
            *_with_impacts(motion, particle), color=colour, linestyle=style, linewidth=width, zorder=3, rasterized=heavy
        )
        line.set_label(f"particle {particle}")
        entries.append(line)
    return entries if len(looks) <= _MOST_NAMED else []


def _with_impacts(motion: Motion, particle: int) -> tuple[Array, Array]:
    """The curve of a particle with its kinks, which fall between samples."""
    t, q = motion.t, motion.q[:, particle]
    for side in UPWARDS:
        times = motion.impacts.where(particle=particle, side=side)["time"]
        at = np.searchsorted(t, times)
        t, q = np.insert(t, at, times), np.insert(q, at, motion.obstacles[side][particle])
    return t, q


def _draw_muted(axes: Axes, motion: Motion, looks: Looks) -> list[Artist]:
    """The other particles, at most _MOST_MUTED of them."""
    others = np.setdiff1d(np.arange(motion.particles), list(looks))
    if len(others) == 0:
        return []
    shown = others[np.unique(np.linspace(0, len(others) - 1, min(len(others), _MOST_MUTED)).round().astype(int))]
    curves = [np.column_stack([motion.t, motion.q[:, particle]]) for particle in shown]
    width, heavy = pen() * (0.7 if len(shown) <= 60 else 0.4), len(shown) * len(motion.t) > _HEAVY
    axes.add_collection(
        LineCollection(curves, colors=_MUTED, linewidths=width, zorder=2, rasterized=heavy), autolim=False
    )
    text = count(len(others), "other" if looks else "particle")
    text = text if len(shown) == len(others) else f"{len(shown)} of {text}"
    return [Line2D([], [], color=_MUTED, linewidth=1.2, label=text)]


# --- obstacles ---


def _draw_obstacles(sheet: Sheet, axes: Axes, obstacles: dict[str, Array], looks: Looks) -> list[Artist]:
    """Hatching where all particles share an obstacle, otherwise lines."""
    low, high = axes.get_ylim()
    lines: list[tuple[str, float, Array]] = []  # side, place, the particles that have it there
    for side, places in obstacles.items():
        different = np.unique(places[np.isfinite(places)])
        if len(different) == 1 and np.isfinite(places).all():
            axes.axhspan(
                different[0], different[0] - UPWARDS[side] * _BEYOND * (high - low), zorder=0.5, **look.OBSTACLE
            )
            axes.axhline(different[0], color=look.INK, linewidth=1.1, zorder=1.5)
        else:
            lines += [(side, place, np.flatnonzero(places == place)) for place in different]
    axes.set_ylim(low, high)
    if len(lines) <= _MOST_LINES:
        return _draw_lines(axes, lines, looks)
    sheet.note(f"{len(lines)} different {_plural(side for side, _, _ in lines)} are not drawn")
    return []


def _plural(sides: Iterable[str]) -> str:
    return " and ".join(sorted({f"{side}s" for side in sides}))


def _draw_lines(axes: Axes, lines: list[tuple[str, float, Array]], looks: Looks) -> list[Artist]:
    """A dashed line for each obstacle, in the colour of its particle if only one with a colour has it."""
    sides: dict[tuple[str, str], set[str]] = {}
    for side, place, owners in lines:
        named = [particle for particle in owners.tolist() if particle in looks]
        colour = looks[named[0]][0] if len(named) == 1 else look.INK if named else _MUTED
        axes.axhline(place, color=colour, linewidth=0.9, linestyle=_DASHES, zorder=1.5)
        kinds = (look.FAINT, "in the colour of the particle"), (look.INK, "of several particles")
        kind = kinds[len(named) > 1] if named else (_MUTED, "of particles that do not hit")
        sides.setdefault(kind, set()).add(side)
    style = {"linewidth": 0.9, "linestyle": _DASHES}
    return [
        Line2D([], [], color=colour, label=f"{_plural(found)} {whose}", **style)
        for (colour, whose), found in sides.items()
    ]


def _mark_hits(sheet: Sheet, axes: Axes, motion: Motion, looks: Looks) -> list[Artist]:
    """Triangles beyond the obstacles."""
    hits = motion.hits
    noun = "contacts" if len(motion.contacts) else "impacts"
    if len(hits) > _MOST_MARKS:
        sheet.note(f"{len(hits)} {noun} have no marks")
        return []
    depth = 0.022 * np.ptp(axes.get_ylim())
    for side, upwards in UPWARDS.items():
        mine = hits.where(hits.side == side)
        axes.scatter(
            mine.time,
            motion.obstacles[side][mine.particle] - upwards * depth,
            s=20 * pen() ** 2,
            marker="^" if upwards > 0 else "v",
            c=[looks[particle][0] for particle in mine.particle.tolist()],
            edgecolors="white",
            linewidths=0.4,
            zorder=4,
        )
    return [Line2D([], [], color=look.FAINT, marker="^", markersize=5, linestyle="", label=noun)] if len(hits) else []


def _mark_periods(axes: Axes, motion: Motion) -> None:
    """Lines at the periods of the orbit and their count on top, if there are few enough to be read."""
    period, (low, high) = motion.period, motion.limits
    if not period or not 1 <= (high - low) / period <= 40:
        return
    counts = np.arange(np.ceil(low / period - 1e-9), np.floor(high / period + 1e-9) + 1)
    for k in counts:
        axes.axvline(k * period, color="#dddddd", linewidth=0.7, zorder=1)
    top = axes.secondary_xaxis("top", functions=(lambda t: t / period, lambda k: k * period))
    top.set_xticks(counts[:: 1 if len(counts) <= 13 else 5])
    top.spines["top"].set_visible(False)
    top.tick_params(length=0, pad=1, labelcolor=look.FAINT)
    top.set_xlabel("time in periods of the orbit", color=look.FAINT)
