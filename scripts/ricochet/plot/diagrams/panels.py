"""The panels below a diagram, over the same axis: Lyapunov exponents, and the distance from the return map."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ricochet.plot import look, scale
from ricochet.plot.diagrams import densities
from ricochet.plot.diagrams.coordinates import Abscissa
from ricochet.plot.diagrams.lines import Line
from ricochet.plot.sheet import Sheet
from ricochet.sweep import Array

_CHAOS = "#fbeee6"
_ROOT = 0.25  # distances that grow with a higher power of the parameter have a slope
_MARK = {"marker": "o", "linestyle": ""}
_SAME = {**_MARK, "color": look.INK, "markeredgewidth": 0}
_OTHER = {**_MARK, "color": "#9a9a9a", "markerfacecolor": "white", "markeredgewidth": 0.6}


def series(line: Line, column: str, of_map: str) -> list[tuple[str, Array]]:
    """Columns to draw, and the rows of each: a column there and back, or a column and that of the return map."""
    found = [(column, way) for way in line.ways]
    if not line.goes_back and of_map in line.table and np.isfinite(line.table[of_map]).any():
        found.append((of_map, line.ways[0]))
    return found


# --- exponents ---


def draw_exponents(sheet: Sheet, axes: Axes, line: Line, x: Abscissa) -> None:
    """The largest exponent; the area of chaos, above zero, is shaded."""
    shown = [x.pick(line.table[name], way) for name, way in series(line, "lyapunov", "map_lyapunov")]
    looks = [(densities.FIRST, 1.7), (densities.SECOND, 0.8)] if len(shown) > 1 else [(look.INK, 0.8)]
    for numbers, (colour, width) in zip(shown, looks):
        finite = np.where(np.isfinite(numbers), numbers, np.nan)
        axes.plot(x.at, finite, color=colour, linewidth=width, alpha=0.85, zorder=3)
    whole = np.concatenate(shown)
    known = np.isfinite(whole)
    low, high, is_clipped = scale.robust_limits(np.append(whole[known], 0), np.ones(known.sum() + 1, bool))
    axes.set_ylim(low, max(high, -0.15 * low))
    axes.axhspan(0, axes.get_ylim()[1], facecolor=_CHAOS, zorder=0)
    axes.axhline(0, color=look.INK, linewidth=0.8, zorder=2)
    axes.set_ylabel("exponent\nper iterate")
    if is_clipped:  # superstable cycles go down without bound
        sheet.note(f"exponents: {scale.clip_note(whole[known])}")
    if not known.all():
        sheet.note(f"{(~known).sum()} of {len(known)} exponents are unknown: gaps in their curve")


# --- the distance from the map ---


def has_distance(line: Line) -> bool:
    return "distance" in line.table and bool(_is_shown(line.table["distance"]).any())


def _is_shown(distance: Array) -> Array:
    return np.asarray(np.isfinite(distance) & (distance > 0))


def draw_distance(sheet: Sheet, axes: Axes, line: Line, x: Abscissa) -> None:
    """Filled where motion and map have the same period, open where they have not, or none."""
    distance, period, of_map = (
        x.pick(line.table[name], line.ways[0]) for name in ("distance", "attractor_period", "map_period")
    )
    shown = _is_shown(distance)
    same = shown & (period > 0) & (period == of_map)
    for where, marks, size, label in (
        (shown & ~same, _OTHER, 2.6, "distance, other period or none"),
        (same, _SAME, 2.8, "distance, same period as the map"),
    ):
        if where.any():
            axes.plot(x.at[where], distance[where], **marks, markersize=size, rasterized=True)
            sheet.legend([Line2D([], [], **marks, markersize=4, label=label)])
    axes.set(yscale="log", ylim=(distance[shown].min() / 2, distance[shown].max() * 2), ylabel="distance\nfrom the map")
    if x.logarithmic and same.sum() > 1:
        _draw_slope(sheet, axes, x.at[same], distance[same])
    scale.label_decades(axes.yaxis)
    if not shown.all():
        sheet.note(f"{(~shown).sum()} distances from the map are not drawn: zero, infinite or unknown")
    if line.goes_back:
        sheet.note(f"distances are those with {line.words[0]} values")


def _draw_slope(sheet: Sheet, axes: Axes, at: Array, distance: Array) -> None:
    """The power with which distances grow: 1 of linear motions, 1/2 of all others."""
    power = np.polyfit(np.log(at), np.log(distance), 1)[0]
    if power < _ROOT:
        return
    slope, words = (1, "1") if power > 0.75 else (0.5, "1/2")
    dotted = {"color": look.ORANGE, "linestyle": (0, (1, 1.5)), "linewidth": 1.4}
    factor = np.exp(np.median(np.log(distance) - slope * np.log(at)))
    axes.plot(at, factor * at**slope, zorder=4, **dotted)
    sheet.legend([Line2D([], [], label=f"slope {words}", **dotted)])
