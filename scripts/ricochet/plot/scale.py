"""Axes of numbers: logarithmic sweeps, borders of cells, limits that blow-ups do not squeeze, runs of equal values."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from ricochet.plot.words import number
from ricochet.sweep import Array


def is_geometric(values: Array) -> bool:
    """Whether values were swept on a logarithmic scale: equal ratios, unequal differences."""
    different = np.unique(values)
    if len(different) < 3 or different[0] <= 0 or different[-1] < 3 * different[0]:
        return False
    ratios = np.diff(np.log(different))
    return bool(np.ptp(ratios) < 1e-6 * ratios.max())


def cell_edges(values: Array, logarithmic: bool = False) -> Array:
    """Borders halfway between sorted values, on a logarithmic scale if asked for; the outer ones lie as far outside as
    the inner ones inside."""
    if logarithmic:
        return np.exp(cell_edges(np.log(values)))
    if len(values) == 1:
        half = 0.05 * max(abs(values[0]), 1.0)
        return np.array([values[0] - half, values[0] + half])
    middle = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def robust_limits(values: Array, sound: Array) -> tuple[float, float, bool]:
    """Limits that show the sound values whole unless blow-ups squeeze them, and whether anything is outside.

    A blow-up is a range beyond four times that of the inner 80 % (of all values) or 96 % (of the sound ones).
    """
    finite = np.isfinite(values)
    if not finite.any():
        return 0.0, 1.0, False
    whole = values[finite]
    low, high = whole.min(), whole.max()
    if high - low > 4 * np.ptp(np.percentile(whole, [10, 90])):
        core = values[finite & sound] if (finite & sound).any() else whole
        near = np.percentile(core, [2, 98])
        near = near if np.ptp(core) > 4 * np.ptp(near) else np.array([core.min(), core.max()])
        low, high = max(low, near[0] - 0.7 * np.ptp(near)), min(high, near[1] + 0.7 * np.ptp(near))
    pad = 0.06 * (high - low) or 0.05 * max(abs(high), 1.0)
    low, high = low - pad, high + pad
    return float(low), float(high), bool(((whole < low) | (whole > high)).any())


def label_decades(axis: Axis) -> None:
    """Ticks of a logarithmic axis: decades, and 2 and 5 in between where there are few of them."""
    low, high = axis.get_view_interval()
    if np.log10(high / low) <= 3:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FormatStrFormatter("%g"))
    else:
        axis.set_major_locator(LogLocator(numticks=7))
    axis.set_minor_formatter(NullFormatter())


def runs(flags: Array) -> list[tuple[int, int]]:
    """First and last index of every run of true values."""
    edges = np.diff(np.concatenate([[0], flags.astype(int), [0]]))
    return list(zip(np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist()))


def equal_runs(values: Array) -> list[tuple[int, int]]:
    """First and last index of every run of equal finite values."""
    if len(values) == 0:
        return []
    starts = np.flatnonzero(np.append(True, ~(np.diff(values) == 0)))
    ends = np.append(starts[1:], len(values)) - 1
    return [(int(first), int(last)) for first, last in zip(starts, ends) if np.isfinite(values[first])]


def pad_limits(values: Array, part: float) -> tuple[float, float]:
    """The extent of finite values with room on both sides."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    pad = part * (high - low) or 0.05 * max(abs(low), 1.0)
    return low - pad, high + pad


def clip_note(values: Array) -> str:
    low, high = np.nanmin(values) + 0.0, np.nanmax(values) + 0.0  # + 0.0 turns -0 into 0
    return f"axis clipped, values from ${number(low, 3)}$ to ${number(high, 3)}$"


def frame_parameter(axes: Axes, values: Array, part: float = 0.02) -> None:
    """The horizontal axis of a sweep: logarithmic where it is, with a little room."""
    if is_geometric(values):
        axes.set_xscale("log")
        room = (values.max() / values.min()) ** part
        axes.set_xlim(values.min() / room, values.max() * room)
    else:
        axes.set_xlim(*pad_limits(values, part))
