"""Phase portraits of some particles: displacement across, velocity upwards, a panel each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.trajectories.motion import LABEL, OPTIONS, UPWARDS, Motion, is_sampled, pen, picked_tasks
from ricochet.result import Result
from ricochet.sweep import Array

_MOST_PANELS = 12
_MOST_CHOSEN = 6  # panels if no particles are asked for
_MOST_LARGEST = 4  # panels if none hits
_MOST_MARKS = 400
_BEYOND = 10  # how far hatching goes, over the width of the panel: to its edge whatever the limits
_DASHES = (0, (4, 3))


@figure(
    "trajectory",
    shows="phase portraits of some particles, with the jumps at impacts",
    natural=is_sampled,
    part="task",
    parts=picked_tasks,
    options={**OPTIONS, "particles": "the particles, from 0"},
)
def phase(
    result: Result,
    *,
    task: int | None = None,
    start: float | None = None,
    end: float | None = None,
    particles: Sequence[int] | None = None,
) -> Figure:
    """Impacts break the curve: the jump is a dashed line at the obstacle from the velocity before, an open circle, to
    the one after, a filled circle. Each panel has the obstacles of its own particle."""
    motion = Motion(result, task, start, end)
    chosen, which = (_checked(motion, particles), "") if particles else _chosen(motion)
    columns, width = _columns(len(chosen))
    rows = -(-len(chosen) // columns)
    sheet = Sheet(result, width, 0.35 + rows * 0.8 * width / columns, rows=rows, columns=columns)
    norm = Normalize(*motion.limits)
    for place, particle in enumerate(chosen):
        axes = sheet.panel(place // columns, place % columns)
        axes.set(xlabel=LABEL if place + columns >= len(chosen) else "")
        axes.set(ylabel="velocity $v$" if place % columns == 0 else "")
        lines = _draw_panel(axes, motion, particle, norm)
    side = {"location": "bottom", "aspect": 50} if is_narrow() else {"aspect": 40}
    sheet.figure.colorbar(lines, ax=sheet.panels, label="time $t$", pad=0.02, **side)
    sheet.legend(_entries(motion, chosen))
    if which and len(chosen) < motion.particles:
        sheet.note(f"{which}; --particles draws others")
    for note in motion.notes():
        sheet.note(note)
    return sheet.finish(words=motion.words())


# --- which particles ---


def _checked(motion: Motion, particles: Sequence[int]) -> list[int]:
    chosen = list(dict.fromkeys(particles))
    for particle in chosen:
        if not 0 <= particle < motion.particles:
            reason = f"it has no particle {particle}, only particles 0 to {motion.particles - 1}"
            raise FigureError(motion.result.path, reason)
    if len(chosen) > _MOST_PANELS:
        raise FigureError(
            motion.result.path, f"{len(chosen)} particles for one figure, expected at most {_MOST_PANELS}"
        )
    return chosen


def _chosen(motion: Motion) -> tuple[list[int], str]:
    """The particles with the most impacts, and a neighbour of one that does not hit; without impacts those that move
    most. Which these are, in words."""
    if len(motion.hitting) == 0:
        largest = np.argsort(-np.abs(motion.q).max(axis=0), kind="stable")
        return sorted(largest[:_MOST_LARGEST].tolist()), f"the {_MOST_LARGEST} particles that move most"
    hitting, counts = np.unique(motion.hits.particle, return_counts=True)
    most = hitting[np.argsort(-counts, kind="stable")][:_MOST_CHOSEN].tolist()
    neighbours = [particle + step for particle in most for step in (-1, 1) if 0 <= particle + step < motion.particles]
    quiet = [particle for particle in neighbours if particle not in hitting][:1]
    most = most[: _MOST_CHOSEN - len(quiet)]
    which = "the particle that hits" if len(most) == 1 else f"the {len(most)} particles that hit"
    which = which if len(most) == len(hitting) else f"{which} most often"
    return sorted(most + quiet), which + (", and a neighbour that does not" if quiet else "")


def _columns(count: int) -> tuple[int, float]:
    """Panels beside one another, and the width of the figure."""
    if is_narrow():
        return (1 if count == 1 else 2), 6.0
    columns = {1: 1, 2: 2, 4: 2}.get(count, 3 if count in (3, 5, 6, 9) else 4)
    return columns, {1: 6.0, 2: 8.6, 3: 10.4, 4: 12.5}[columns]


# --- a portrait ---


class Portrait:
    """A particle's motion in pieces between its impacts.

    `before`, `after`: velocities at the impacts, of the rate of the gap, and with the impulse over the mass more.
    """

    def __init__(self, motion: Motion, particle: int):
        self.t, self.q, self.v = motion.t, motion.q[:, particle], motion.v[:, particle]
        impacts = motion.impacts.where(particle=particle)
        upwards = np.array([UPWARDS[side] for side in impacts["side"]], dtype=float)
        mass = np.broadcast_to(motion.parameters["model.mass"], motion.particles)[particle]
        self.times = impacts["time"]
        self.at = np.array([motion.obstacles[side][particle] for side in impacts["side"]], dtype=float)
        self.before = upwards * impacts["gap_rate"]
        self.after = self.before + upwards * impacts["impulse"] / mass

    def pieces(self) -> Iterator[list[Array]]:
        """(t, q, v) between impacts, with the states at impacts."""
        # A sample at an impact has the state before or after it, as rounding will have it: it is left out.
        near = 1e-9 * (1 + np.abs(self.times))
        firsts = np.searchsorted(self.t, np.append(-np.inf, self.times + near), side="right")
        lasts = np.searchsorted(self.t, np.append(self.times - near, np.inf), side="left")
        for k, (first, last) in enumerate(zip(firsts, lasts)):
            piece = [column[first:last] for column in (self.t, self.q, self.v)]
            if k > 0:
                begin = self.times[k - 1], self.at[k - 1], self.after[k - 1]
                piece = [np.insert(column, 0, x) for column, x in zip(piece, begin)]
            if k < len(self.times):
                end = self.times[k], self.at[k], self.before[k]
                piece = [np.append(column, x) for column, x in zip(piece, end)]
            yield piece


def _draw_panel(axes: Axes, motion: Motion, particle: int, norm: Normalize) -> LineCollection:
    portrait = Portrait(motion, particle)
    lines = _draw_curve(axes, portrait, norm)
    _frame(axes, motion, particle, portrait)
    axes.axhline(0, color="#dddddd", linewidth=0.7, zorder=1)
    axes.locator_params(axis="x", nbins=3 if is_narrow() else 5)
    _draw_jumps(axes, portrait)
    axes.set_title(f"particle {particle}: {motion.count_of_hits(particle)}", loc="left", pad=4)
    return lines


def _draw_curve(axes: Axes, portrait: Portrait, norm: Normalize) -> LineCollection:
    """The pieces, coloured by time."""
    strokes, times = [], []
    for t, q, v in portrait.pieces():
        points = np.column_stack([q, v])
        strokes.append(np.stack([points[:-1], points[1:]], axis=1))
        times.append(0.5 * (t[1:] + t[:-1]))
    whole = np.concatenate(strokes)
    lines = LineCollection(
        list(whole), cmap=look.colour_map(), norm=norm, linewidths=pen(), zorder=2, capstyle="round",
        rasterized=len(whole) > 3000,
    )  # fmt: skip
    lines.set_array(np.concatenate(times))
    axes.add_collection(lines)
    axes.plot(
        portrait.q[0], portrait.v[0], "s", color=lines.cmap(norm(portrait.t[0])), markersize=4.5 * pen(), zorder=2.5
    )
    return lines


def _frame(axes: Axes, motion: Motion, particle: int, portrait: Portrait) -> None:
    """Room around the curve, and the particle's own obstacles, hatched."""
    places = {side: found[particle] for side, found in motion.in_sight(portrait.q.min(), portrait.q.max()).items()}
    across = np.concatenate([portrait.q, portrait.at, [place for place in places.values() if np.isfinite(place)]])
    upwards = np.concatenate([portrait.v, portrait.before, portrait.after])
    for values, set_limits in ((across, axes.set_xlim), (upwards, axes.set_ylim)):
        pad = 0.09 * np.ptp(values) or 0.1
        set_limits(values.min() - pad, values.max() + pad)
    left, right = axes.get_xlim()
    for side, place in places.items():
        if np.isfinite(place):
            axes.axvspan(place, place - UPWARDS[side] * _BEYOND * (right - left), zorder=0.5, **look.OBSTACLE)
    axes.set_xlim(left, right)


def _draw_jumps(axes: Axes, portrait: Portrait) -> None:
    """Dashed lines at the obstacles, and the states before and after the impacts."""
    for place in np.unique(portrait.at):
        ends = np.concatenate([portrait.before[portrait.at == place], portrait.after[portrait.at == place]])
        axes.plot(
            [place, place], [ends.min(), ends.max()], color=look.INK, linewidth=1.1 * pen(), linestyle=_DASHES, zorder=3
        )
    if len(portrait.at) == 0:
        return
    shown = np.unique(np.linspace(0, len(portrait.at) - 1, min(len(portrait.at), _MOST_MARKS)).round().astype(int))
    for speeds, face in ((portrait.before, "white"), (portrait.after, look.INK)):
        axes.scatter(
            portrait.at[shown], speeds[shown], s=15 * pen() ** 2, c=face, edgecolors=look.INK, linewidths=0.8, zorder=4
        )


def _entries(motion: Motion, chosen: Sequence[int]) -> list[Artist]:
    shape = {"linestyle": "", "markersize": 5}
    entries: list[Artist] = [Line2D([], [], marker="s", color=look.colour_map()(0), label="start", **shape)]
    if np.isin(motion.impacts["particle"], chosen).any():
        shape.update(marker="o", markeredgecolor=look.INK)
        entries += [
            Line2D([], [], color=look.INK, linewidth=1.1, linestyle=_DASHES, label="jump at the obstacle"),
            Line2D([], [], markerfacecolor="white", label="before the impact", **shape),
            Line2D([], [], markerfacecolor=look.INK, label="after the impact", **shape),
        ]
    return entries
