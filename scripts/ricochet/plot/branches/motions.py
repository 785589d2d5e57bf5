"""Single motions of a branch: displacements over a period, and the orbit in the plane of two components."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import look, scale
from ricochet.plot.branches import family
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.words import obstacles, state_symbol
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

_MOTIONS = 3  # that are drawn unless points are named
_MOST_NAMES = 4  # of particles in the label of their obstacles
_MOST_CURVES = 12  # particles that are drawn
_SQUEEZED = 0.12  # least part of a panel that a motion takes before an obstacle is left out


@figure(
    "branch",
    shows="single motions of a branch: displacements over the period, and orbits in the plane of two components",
    columns=("branch/point/history_q", "branch/point/history_v"),
    reason=family.none_begins,
    options={
        "task": "which task, from 0; default: the first one with a motion",
        "points": "which of its points, from 0; default: three admissible ones",
        "x": "component on the horizontal axis of the orbits, as q0 or v1; default: q0",
        "y": "component on the vertical axis; default: q1, of one particle v0",
    },
)
def motions(
    result: Result,
    *,
    task: int | None = None,
    points: Sequence[int] | None = None,
    x: str | None = None,
    y: str | None = None,
) -> Figure:
    """Displacements over a period, and orbits in a plane, of some points of a task. Dots are the first states, where
    motions with impacts hit; obstacles are hatched."""
    task = family.task_with_motions(result, task)
    table = result["branch/point"].task(task)
    rows = _chosen(result, table, points)
    pair = x or "q0", y or ("q1" if result.parameters["model.particles"] > 1 else "v0")
    sheet, panels = _panels(result, len(rows))
    drawing = _Drawing(result, task, table)
    for (left, right), row in zip(panels, rows):
        drawing.history(left, row)
        drawing.orbit(right, row, pair)
    _share_labels(panels, pair)
    sheet.legend(drawing.entries)
    for note in drawing.notes:
        sheet.note(note)
    name = family.task_name(result, task)
    return sheet.finish(about=f"motions: {name}" if name else "", varied=[family.followed(result)])


def _chosen(result: Result, table: Table, points: Sequence[int] | None) -> list[int]:
    """Rows of the points among those of the task."""
    if not points:
        sound = np.flatnonzero(family.is_sound(table))
        return sorted({int(row) for row in sound[np.linspace(0, len(sound) - 1, _MOTIONS).astype(int)]})
    for point in points:
        if not 0 <= point < len(table):
            raise FigureError(
                result.path, f"there is no point {point} of the task, it has points 0 to {len(table) - 1}"
            )
    return list(points)


def _panels(result: Result, count: int) -> tuple[Sheet, list[tuple[Axes, Axes]]]:
    """A row of two panels for each motion; below one another where the sheet is narrow."""
    if is_narrow():
        sheet = Sheet(result, 8.6, 4.6 * count, rows=2 * count)
        return sheet, [(sheet.panel(2 * k), sheet.panel(2 * k + 1)) for k in range(count)]
    sheet = Sheet(result, 8.6, 0.3 + 2.3 * count, rows=count, columns=2, widths=(1.7, 1))
    return sheet, [(sheet.panel(k, 0), sheet.panel(k, 1)) for k in range(count)]


def _share_labels(panels: Sequence[tuple[Axes, Axes]], pair: tuple[str, str]) -> None:
    """Labels of the horizontal axes, below each panel where they stand below one another, else below the last."""
    for left, right in panels if is_narrow() else panels[-1:]:
        left.set_xlabel("time over the period")
        right.set_xlabel(state_symbol(pair[0]))


class _Drawing:
    """The motions of a task, drawn one after another.

    entries  of the legend
    notes    on what is left out
    """

    def __init__(self, result: Result, task: int, table: Table):
        self.table, self.result = table, result
        self.states = {"q": table["history_q"], "v": table["history_v"]}
        self.obstacles = obstacles(result, task)
        particles = self.states["q"].shape[2]
        self.particles = np.unique(np.linspace(0, particles - 1, min(particles, _MOST_CURVES)).astype(int))
        self.colours = _colours(len(self.particles))
        self.entries: list[Artist] = [
            Line2D([], [], color=colour, linewidth=1.5, label=state_symbol(f"q{particle}"))
            for particle, colour in zip(self.particles, self.colours)
        ]
        self.entries.append(Line2D([], [], **_FIRST, label="first state"))
        self.notes: list[str] = []
        if len(self.particles) < particles:
            self.notes.append(f"{len(self.particles)} of {particles} particles")

    def history(self, axes: Axes, row: int) -> None:
        """Displacements over the period, and the obstacles of the particles that are drawn."""
        q = self.states["q"][row]
        for particle, colour in zip(self.particles, self.colours):
            axes.plot(np.linspace(0, 1, len(q)), q[:, particle], color=colour, linewidth=1.5, zorder=3)
        axes.axhline(0, color="#c4c4c4", linewidth=0.7, zorder=0)
        axes.set(xlim=(-0.03, 1.03), ylabel="displacement")
        axes.set_title(self._name(row), loc="left", color=look.INK)
        self._block(axes, "y", q[:, self.particles], self.particles)

    def orbit(self, axes: Axes, row: int, pair: tuple[str, str]) -> None:
        """The orbit in the plane of two components."""
        x, y = (family.component(self.result, self.states, name)[row] for name in pair)
        axes.plot(x, y, color=look.BLUE, linewidth=1.5, zorder=3)
        axes.plot(x[:1], y[:1], **_FIRST, zorder=4)
        axes.set_ylabel(state_symbol(pair[1]))
        for axis, name, values in zip("xy", pair, (x, y)):
            self._block(axes, axis, values, [int(name[1:])] if name[0] == "q" else [])

    def _name(self, row: int) -> str:
        words = f"energy {self.table['energy'][row]:.4g}, period {self.table['period'][row]:.4g}"
        outcome = self.table["outcome"][row]
        return words if outcome == "admissible" else f"{words}, {'not admissible' if outcome != 'grazing' else outcome}"

    def _block(self, axes: Axes, axis: str, values: Array, particles: Sequence[int] | Array) -> None:
        """Limits of an axis, and the obstacles of some particles, hatched, unless they squeeze the motion."""
        low, high = float(values.min()), float(values.max())
        places = [
            (side, place)
            for side, all in self.obstacles.items()
            for place in np.unique(all[particles])
            if np.isfinite(place)
        ]
        near = [
            (side, place) for side, place in places if high - low >= _SQUEEZED * (max(high, place) - min(low, place))
        ]
        if len(near) < len(places) and _AWAY not in self.notes:
            self.notes.append(_AWAY)
        bounds = scale.pad_limits(np.array([low, high, *(place for _, place in near)]), 0.08)
        getattr(axes, f"set_{axis}lim")(*bounds)
        for side, place in near:
            self._hatch(axes, axis, side, place, bounds[0] if side == "floor" else bounds[1])

    def _hatch(self, axes: Axes, axis: str, side: str, place: float, end: float) -> None:
        span, line = (axes.axhspan, axes.axhline) if axis == "y" else (axes.axvspan, axes.axvline)
        span(place, end, zorder=0.5, **look.OBSTACLE)
        line(place, color=look.INK, linewidth=1.0, zorder=1.5)
        label = self._owners(side)
        if label not in [entry.get_label() for entry in self.entries]:
            self.entries.append(Patch(label=label, **look.OBSTACLE))

    def _owners(self, side: str) -> str:
        """ "wall of q1": whose obstacles these are, unless all particles have them."""
        owners = np.flatnonzero(np.isfinite(self.obstacles[side]))
        if len(owners) == len(self.obstacles[side]) or len(owners) > _MOST_NAMES:
            return side
        return f"{side} of {', '.join(state_symbol(f'q{particle}') for particle in owners)}"


_FIRST: dict[str, Any] = {"linestyle": "", "marker": "o", "color": look.RED, "markersize": 5}
_AWAY = "obstacles far from a motion are not drawn"


def _colours(count: int) -> list[Any]:
    if count <= len(look.CYCLE):
        return list(look.CYCLE[:count])
    return list(look.colour_map()(np.linspace(0, 1, count)))
