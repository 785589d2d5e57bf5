"""A chain in motion: particles at their displacements, springs between them, obstacles, and flashes at impacts."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.trajectories.film import Film
from ricochet.plot.trajectories.motion import LABEL, OPTIONS, UPWARDS, Motion
from ricochet.plot.words import number
from ricochet.result import Result
from ricochet.sweep import Array

_FEWEST, _MOST = 120, 600  # pictures, if their number is not given
_STEP = 0.06  # of the range of displacements: what a particle may move from one picture to the next
_WIDEST_STEP = 0.35  # beyond which the eye does not follow
_MOST_ASKED = 2000
_MOST_FPS = 50  # of a GIF
_FLASH = 6  # pictures that a flash lasts
_BLOCK = 0.3  # half the width of an obstacle; particles are 1 apart
_RESTING = "#8a8a8a"  # particles that never hit
_SPRING = "#9a9a9a"


@figure(
    "trajectory",
    shows="the motion as an animation, GIF or MP4",
    natural=lambda result: False,
    writes=(".gif", ".mp4"),
    options={
        **OPTIONS,
        "task": "task of the sweep, from 0; default: the first one",
        "frames": f"number of pictures; default: as many as the eye needs to follow the motion, at most {_MOST}",
        "fps": "pictures a second",
    },
)
def animation(
    result: Result,
    *,
    task: int | None = None,
    start: float | None = None,
    end: float | None = None,
    frames: int | None = None,
    fps: int = 20,
) -> Film:
    """Between samples particles move on straight lines. It shows the whole motion; `start` and `end` pick a part."""
    _check(result, "frames", frames, _MOST_ASKED)
    _check(result, "fps", fps, _MOST_FPS)
    motion = Motion(result, task, start, end)
    count = frames or _count(motion)
    times = np.linspace(motion.t[0], motion.t[-1], count)
    q = _displacements(motion, times)
    sheet = Sheet(result, 8.4, 3.7)
    stage = _Stage(sheet.panel(), motion, q, times)
    if count > 1 and np.abs(np.diff(q, axis=0)).max() > _WIDEST_STEP * np.ptp(q) > 0:
        sheet.note(f"{count} pictures are too few to follow the motion; --start and --end show a part of it")
    for note in motion.notes():
        sheet.note(note)
    span = f"$t = {number(times[0], 4)}$ to ${number(times[-1], 4)}$ in {count / fps:.3g} s"
    drawn = sheet.finish(words=[*motion.words(), span])
    drawn.draw_without_rendering()
    drawn.set_layout_engine("none")  # laid out once for all pictures
    return Film(drawn, stage.show, count, fps, 200 if is_narrow() else 100, result.path)


def _check(result: Result, name: str, value: int | None, most: int) -> None:
    if value is not None and not 1 <= value <= most:
        raise FigureError(result.path, f"{name} = {value}, expected 1 to {most}")


def _count(motion: Motion) -> int:
    """Pictures between which no particle moves far."""
    fastest = np.abs(np.diff(motion.q, axis=0)).max() / (motion.t[1] - motion.t[0])
    steps = fastest * (motion.t[-1] - motion.t[0]) / (_STEP * np.ptp(motion.q) or 1.0)
    return int(np.clip(np.ceil(steps), _FEWEST, _MOST))


def _displacements(motion: Motion, times: Array) -> Array:
    """Displacements at the times [picture, particle], on straight lines between samples."""
    after = np.clip(np.searchsorted(motion.t, times), 1, len(motion.t) - 1)
    weight = ((times - motion.t[after - 1]) / (motion.t[after] - motion.t[after - 1]))[:, None]
    between: Array = (1 - weight) * motion.q[after - 1] + weight * motion.q[after]
    return between


class _Stage:
    """What stands still, and the artists that move."""

    def __init__(self, axes: Axes, motion: Motion, q: Array, times: Array):
        self.axes, self.q, self.times, self.count = axes, q, times, motion.particles
        self._left, self._right = _anchors(motion)
        self._ring = motion.parameters.get("model.ends") == "periodic" and self.count > 2
        axes.set(xlabel="particle", ylabel=LABEL)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12, min_n_ticks=1))
        self._draw_obstacles(motion)
        self._make_movers(motion)
        self._find_flashes(motion)
        self._digits = len(f"{times[-1]:.2f}")
        self._clock = axes.set_title("", loc="right", family="monospace", pad=3)
        self.show(0)

    def _draw_obstacles(self, motion: Motion) -> None:
        """A block beyond the obstacle of each particle; neighbours with equal ones share it."""
        obstacles = motion.in_sight(motion.q.min(), motion.q.max())
        ends = [0.0] if self._left or self._right else []
        shown = np.concatenate([[motion.q.min(), motion.q.max()], ends, *obstacles.values()])
        low, high = np.nanmin(shown), np.nanmax(shown)
        pad = 0.1 * (high - low) or 0.1
        self.axes.set(ylim=(low - pad, high + pad), xlim=(-0.95, self.count - 0.05))
        self._blocks: list[Artist] = []
        for side, places in obstacles.items():
            for first, last in scale.equal_runs(places):
                self._draw_block(places[first], 0.6 * pad * UPWARDS[side], first - _BLOCK, last + _BLOCK)

    def _draw_block(self, place: float, depth: float, left: float, right: float) -> None:
        """An obstacle before the springs, which lead behind it."""
        corner = (left, min(place - depth, place))
        block = self.axes.add_patch(Rectangle(corner, right - left, abs(depth), zorder=2.2, **look.OBSTACLE))
        face = self.axes.hlines(place, left, right, color=look.INK, linewidth=1.1, zorder=2.3)
        self._blocks += [block, face]

    def _make_movers(self, motion: Motion) -> None:
        between = 60 * self.axes.figure.get_figwidth() / (self.count + 1)  # points from one particle to the next
        self._size = float(np.clip(0.5 * between, 2, 13)) ** 2
        colours = np.where(np.isin(np.arange(self.count), motion.hitting), look.BLUE, _RESTING)
        self._springs = LineCollection([], colors=_SPRING, linewidths=0.9 if self.count < 100 else 0.5, zorder=2)
        self.axes.add_collection(self._springs)
        self.axes.axhline(0, color="#e4e4e4", linewidth=0.7, zorder=1)
        self._discs = self.axes.scatter(
            np.arange(self.count), self.q[0], s=self._size, c=colours.tolist(), linewidths=0, zorder=3
        )
        self._rings = self.axes.scatter([], [], s=[], facecolors="none", linewidths=2, zorder=5)
        for place in (self._left, self._right):
            if place:
                self.axes.plot(*place, "s", color=look.INK, markersize=5, zorder=3)

    def _find_flashes(self, motion: Motion) -> None:
        """For each hit the picture in which it begins to flash, and where."""
        hits = motion.hits
        places = [motion.obstacles[side][particle] for side, particle in zip(hits.side, hits.particle)]
        self._flash_from = np.searchsorted(self.times, hits.time)
        self._flash_at = np.column_stack([hits.particle, places]) if len(hits) else np.empty((0, 2))

    def _spring_line(self, q: Array) -> Array:
        line = [*np.column_stack([np.arange(self.count), q])]
        if self._ring:  # half a spring at both ends: it goes on at the other one
            half = 0.5 * (q[0] + q[-1])
            line = [(-0.5, half), *line, (self.count - 0.5, half)]
        line = [self._left, *line] if self._left else line
        return np.array([*line, self._right] if self._right else line)

    def show(self, k: int) -> tuple[Artist, ...]:
        """The k-th picture; the artists that it changes and those over them, from the back to the front."""
        q = self.q[k]
        self._discs.set_offsets(np.column_stack([np.arange(self.count), q]))
        self._springs.set_segments([self._spring_line(q)])
        age = k - self._flash_from
        young = (age >= 0) & (age < _FLASH)
        self._rings.set_offsets(self._flash_at[young])
        self._rings.set_sizes(self._size * (1.4 + 1.2 * age[young]) + 12)
        self._rings.set_edgecolors([to_rgba(look.RED, 1 - picture / _FLASH) for picture in age[young]])
        self._clock.set_text(f"t = {self.times[k]:{self._digits}.2f}")
        return self._springs, *self._blocks, self._discs, self._rings, self._clock


def _anchors(motion: Motion) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Where springs to the ground end, left and right of the particles."""
    fixed = motion.parameters.get("model.ends") == "fixed"
    left = (-0.75, 0.0) if fixed or motion.parameters["model.type"] == "duffing_chain" else None
    return left, (motion.particles - 0.25, 0.0) if fixed else None
