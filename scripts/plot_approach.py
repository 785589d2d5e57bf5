#!/usr/bin/python3
"""Draws how a family of orbits approaches the linear mode in which it ends.

Datasets: /orbits/q and /orbits/impulse against the swept parameter of /sweep; the limit is the one task whose
/orbits/outcome is `grazing`. Left the positions at t = 0+ along the approach, right the impulse and the
distance to the limit against the distance in the parameter, with the slopes of straight lines through the
nearest third.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

import figures


class Approach:
    """The rows of the sweep ordered by their distance from the limit, farthest first."""

    def __init__(self, result):
        limit = np.flatnonzero(result.outcome == "grazing")
        if len(limit) != 1:
            raise figures.FigureError(
                f"{len(limit)} tasks with the outcome grazing, this figure needs one: the limit"
            )
        at, q = result.values[0], result.need("q")
        impulse = np.abs(result.need("impulse").reshape(len(at), -1)).max(axis=1)
        distance = np.abs(at - at[limit[0]])
        rows = np.flatnonzero(
            (distance > 0) & result.sound & np.isfinite(q).all(axis=1) & np.isfinite(impulse)
        )
        if len(rows) < 3:
            raise figures.FigureError(
                f"{len(rows)} admissible orbits beside the limit, this figure needs three"
            )
        rows = rows[np.argsort(-distance[rows], kind="stable")]
        self.limit, self.limit_at = q[limit[0]], at[limit[0]]
        self.q, self.impulse, self.distance = q[rows], impulse[rows], distance[rows]
        self.gap = np.abs(self.q - self.limit).max(axis=1)
        self.below = bool((at[rows] < self.limit_at).all())


def tail_slope(distance, size, count):
    """Slope of the straight line through the nearest points, in decades; NaN where a size is exactly 0."""
    near, size = np.log10(distance[-count:]), size[-count:]
    return np.polyfit(near, np.log10(size), 1)[0] if (size > 0).all() and np.ptp(near) > 0 else np.nan


def draw_shapes(figure, axes, approach, symbol):
    particles = np.arange(approach.q.shape[1])
    lines = LineCollection(
        [np.column_stack([particles, row]) for row in approach.q], linewidths=1.2, zorder=2
    )
    norm = LogNorm(approach.distance.min(), approach.distance.max())
    lines.set(array=approach.distance, cmap=figures.colour_map().reversed(), norm=norm)
    axes.add_collection(lines)
    axes.plot(
        particles,
        approach.limit,
        linestyle="",
        marker="o",
        markersize=6.5,
        markerfacecolor="none",
        markeredgecolor=figures.INK,
        markeredgewidth=1.1,
        zorder=3,
        label=f"limit at {symbol} = {approach.limit_at:.10g}, grazing",
    )
    everything = np.append(approach.q, approach.limit)
    pad = 0.08 * np.ptp(everything) or 0.1
    axes.set(
        xlim=(-0.8, len(particles) - 0.2),
        ylim=(everything.min() - pad, everything.max() + pad),
        xlabel="particle",
        ylabel=r"position $q$ at $t = 0^+$",
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=8))
    figures.legend_below(axes, 1)
    figure.colorbar(lines, ax=axes, label=distance_label(approach, symbol), aspect=34, pad=0.02)


def distance_label(approach, symbol):
    """`gamma_c - gamma` in the words of [JAP] where gamma is swept towards it from below."""
    if symbol == r"$\gamma$":
        return r"$\gamma_c - \gamma$" if approach.below else r"$|\gamma - \gamma_c|$"
    return f"distance of {symbol} from its limit"


def draw_rates(axes, approach, symbol):
    count = max(3, len(approach.distance) // 3)
    for size, marker, colour, text in (
        (approach.impulse, "o", figures.BLUE, "impulse"),
        (approach.gap, "s", figures.RED, r"$\max |q - q_{limit}|$"),
    ):
        slope = tail_slope(approach.distance, size, count)
        axes.loglog(
            approach.distance,
            np.where(size > 0, size, np.nan),
            marker=marker,
            color=colour,
            markersize=5,
            linewidth=1.2,
            label=f"{text}: slope {slope:.4f}",
        )
    axes.set(xlabel=distance_label(approach, symbol), ylabel="impulse, distance from the limit")
    axes.grid(True, color="#e4e4e4", linewidth=0.7)
    axes.set_axisbelow(True)
    title = f"slopes over the {count} nearest points"
    figures.legend_below(axes, 1, title=title, alignment="left", title_fontsize=9)


def draw(result, _options):
    result.need_sweep(1)
    approach = Approach(result)
    symbol = figures.parameter_symbol(result.names[0])
    figure, (shapes, rates) = plt.subplots(1, 2, figsize=(11, 5.9), constrained_layout=True)
    draw_shapes(figure, shapes, approach, symbol)
    draw_rates(rates, approach, symbol)
    figures.put_title(figure, shapes, result, 116)
    return figure


if __name__ == "__main__":
    sys.exit(figures.run(draw, "approach", __doc__))
