"""The geometry of the criterion, [FN97] Figure 3: the states xi, L xi, L^2 xi, ... after an impact, as arrows in a plane.

Across is the distance eta z from the plane on which the motion grazes, upwards the direction within that plane along
which the arrows spread most. Arrows that point behind the plane lead to another impact.
"""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ricochet.plot import look
from ricochet.plot.grazings.points import LATER_NEGATIVE, NEGATIVE
from ricochet.plot.sheet import FigureError
from ricochet.result import Result
from ricochet.sweep import Array

IMPACT = {"facecolor": "#ececec", "edgecolor": "#d2d2d2", "hatch": "///", "linewidth": 0}
_AXIS = {"color": look.FAINT, "linewidth": 0.9, "linestyle": (0, (5, 3))}
_FEWEST, _MOST = 5, 9  # arrows
_SHORTEST = 0.3  # of the arrows, over the longest
_BEYOND = 100.0  # outside of every frame
_TURNS = np.radians([0, 35, -35, 70, -70, 100, -100])  # of the places for the label of an arrow around its tip


class Fan:
    """The arrows of a task.

    shown      i of the arrows L^i xi
    tips       their ends [arrow, 2]: distance from the plane, direction within it
    zeta       direction of the dominant eigenvector [2], out of the plane; None where it is complex or has none
    first      the first i with c_i < 0, -1 if there is none
    stretch    by how much the distance from the plane is stretched
    power      of their lengths: less than 1 keeps short arrows visible
    """

    def __init__(self, result: Result, task: int):
        points = result["grazing"]
        self.first = int(points["first_negative"][task])
        units, sizes = _iterates(points["L"][task], points["xi"][task], max(self.first + 1, _MOST))
        if len(units) == 0:
            raise FigureError(result.path, f"xi of task {task} has no direction")
        self.shown = _shown(self.first, len(units))
        units, sizes = units[self.shown], sizes[self.shown]
        across, within = _directions(points["eta"][task], units)
        self.stretch = _stretch(units @ across, units @ within)
        plane = np.column_stack([self.stretch * across, within])
        self.tips, self.power = _shortened(units @ plane, sizes)
        self.zeta = None if points["multiplier"][task].imag else _eigenvector(points["L"][task], plane)

    @property
    def note(self) -> str:
        """What is not true to scale."""
        parts = []
        if self.stretch != 1:
            parts.append(f"distance from the plane stretched {self.stretch:g} times")
        if self.power < 1:
            parts.append(f"lengths to the power {self.power:.2g}, so that later ones stay visible")
        return f"arrows: {', '.join(parts)}" if parts else ""


def _iterates(L: Array, xi: Array, count: int) -> tuple[Array, Array]:
    """Unit vectors along xi, L xi, ... [count, coordinates], and logarithms of the lengths of these, which may sink
    below any number."""
    units, logarithms, logarithm, x = [], [], 0.0, xi
    for _ in range(count):
        size = float(np.linalg.norm(x))
        if not 0 < size < np.inf:
            break
        logarithm += np.log(size)
        units.append(x / size)
        logarithms.append(logarithm)
        x = L @ units[-1]
    return np.array(units), np.array(logarithms)


def _shown(first_negative: int, available: int) -> Array:
    """Which i have arrows: the first ones; where the first negative one is late, some before it as well."""
    if first_negative < _MOST - 1:
        return np.arange(min(max(_FEWEST, first_negative + 2), _MOST, available))
    chosen = [*range(5), *range(first_negative - 2, first_negative + 1)]
    return np.array([i for i in chosen if i < available])


def _directions(eta: Array, units: Array) -> tuple[Array, Array]:
    """Unit vectors across the plane eta z = 0, and within it along which the unit vectors spread most; the second is 0
    where there is one coordinate."""
    across = eta / np.linalg.norm(eta)
    within = units - np.outer(units @ across, across)
    if np.linalg.norm(within) < 1e-12:
        return across, np.zeros_like(across)
    direction = np.linalg.svd(within)[2][0]
    direction = direction - (direction @ across) * across
    direction /= np.linalg.norm(direction)
    return across, direction if within[0] @ direction >= 0 else -direction


def _stretch(across: Array, within: Array) -> float:
    """Of the distance from the plane, one digit: arrows that nearly lie in it would hide their sign."""
    distance, along = np.median(np.abs(across)), np.median(np.abs(within))
    return float(f"{along / distance:.1g}") if 0 < 2.5 * distance < along else 1.0


def _shortened(flat: Array, sizes: Array) -> tuple[Array, float]:
    """Tips whose lengths have the power that leaves the shortest one at _SHORTEST of the longest, which is 1."""
    own = np.linalg.norm(flat, axis=1)
    lengths = sizes + np.log(own)
    span = float(np.ptp(lengths))
    power = min(1.0, -np.log(_SHORTEST) / span) if span > 0 else 1.0
    return flat * (np.exp(power * (lengths - lengths.max())) / own)[:, None], power


def _eigenvector(L: Array, plane: Array) -> Array | None:
    values, vectors = np.linalg.eig(L)
    zeta = vectors[:, np.argmax(np.abs(values))].real @ plane
    size = np.linalg.norm(zeta)
    return None if size <= 1e-9 else np.asarray(zeta / (size if zeta[0] >= 0 else -size))


# --- drawing ---


def draw_fan(axes: Axes, fan: Fan) -> list[Artist]:
    """Arrows with their labels in front of the region of impacts; entries of the legend."""
    _frame(axes, fan)
    size = mpl.rcParams["font.size"]
    look_of_heads = f"-|>,head_width={0.028 * size},head_length={0.055 * size}"
    for i, tip, place in zip(fan.shown, fan.tips, _label_places(fan.tips)):
        colour = NEGATIVE if i == fan.first else look.BLUE if tip[0] > 0 else LATER_NEGATIVE
        arrow = {"arrowstyle": look_of_heads, "color": colour, "linewidth": 0.19 * size, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", tip, (0, 0), zorder=4, arrowprops={**arrow, "mutation_scale": 1.3 * size})
        text = axes.text(*place, _label(int(i)), ha="center", va="center", color=colour, zorder=6)
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.08 * size, "alpha": 0.75})
    axes.plot(0, 0, "o", color=look.INK, markersize=0.5 * size, zorder=5)
    if fan.zeta is None:
        return []
    axes.plot(*np.outer(fan.zeta, [0, _BEYOND]), zorder=1, scalex=False, scaley=False, **_AXIS)
    return [Line2D([], [], label=r"eigenvector $\zeta$ of $\lambda$", **_AXIS)]


def _frame(axes: Axes, fan: Fan) -> None:
    """Limits around the arrows, the region of impacts, the plane."""
    ends = np.vstack([fan.tips, [[0, 0]]])
    low, high = ends.min(axis=0) - 0.2, ends.max(axis=0) + 0.2
    axes.axvspan(-_BEYOND, 0, zorder=0, **IMPACT)
    axes.axvline(0, color=look.INK, linewidth=1.2, zorder=2)
    axes.set(xlim=(min(low[0], -0.32), high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel=r"distance from the plane $\eta z = 0$", ylabel="direction within the plane")
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)


def _label(i: int) -> str:
    return {0: r"$\xi$", 1: r"$L\xi$"}.get(i, rf"$L^{{{i}}}\xi$")


def _label_places(tips: Array) -> list[Array]:
    """A free place beside each tip: of some around it the one farthest from arrows, and from labels placed before."""
    placed: list[Array] = []
    for tip in tips:
        turns = np.arctan2(tip[1], tip[0]) + _TURNS
        places = tip + 0.09 * np.column_stack([np.cos(turns), np.sin(turns)])
        room = [_room(place, tips, placed) - 0.02 * k for k, place in enumerate(places)]
        placed.append(places[int(np.argmax(room))])
    return placed


def _room(place: Array, tips: Array, placed: Sequence[Array]) -> float:
    """How free a place is, at most 1: its distance from arrows over 0.07, from labels over 0.16."""
    along = np.clip(tips @ place / np.maximum((tips**2).sum(axis=1), 1e-30), 0, 1)
    room = float(np.linalg.norm(place - along[:, None] * tips, axis=1).min()) / 0.07
    return min([1.0, room, *(float(np.linalg.norm(place - other)) / 0.16 for other in placed)])
