#!/usr/bin/python3
"""Draws the modes of a sweep over one parameter: positions and velocities at t = 0+ against the particle.

Datasets: /orbits/q and /orbits/v (one curve per task), /orbits/outcome, the swept parameter of /sweep
(colour). Bands mark the particles that hit, hatching the floors. Inadmissible orbits are drawn
with --all only.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

import figures

PANELS = (("q", r"position $q$ at $t = 0^+$"), ("v", r"velocity $v$ at $t = 0^+$"))


def pick_rows(result, options):
    """Rows to draw in the order of the parameter, thinned evenly to at most --curves; how many there were."""
    usable = np.isfinite(result.need("q")).all(axis=1) & np.isfinite(result.need("v")).all(axis=1)
    if (usable & result.sound).any() and not options.all:
        usable &= result.sound
    rows = np.flatnonzero(usable)
    if len(rows) == 0:
        raise figures.FigureError("no row of it has finite states")
    rows = rows[np.argsort(result.values[0][rows], kind="stable")]
    picked = np.linspace(0, len(rows) - 1, min(len(rows), max(options.curves, 1)))
    return rows[np.unique(picked.round().astype(int))], len(rows)


def impacting(result):
    """Particles that hit at t = 0 and at half a period; else those that move at t = 0+."""
    start = result.study.at_start
    if not start and not result.study.at_half:
        start = np.flatnonzero((np.nan_to_num(result.need("v")) != 0).any(axis=0)).tolist()
    return start, result.study.at_half


def mark_particles(axes, result):
    """Bands behind the particles of the pattern; returns their legend entries."""
    entries = []
    for particles, hatch, text in zip(
        impacting(result), ("", "////"), ("hits at $t = 0$", "hits at $t = T/2$")
    ):
        look = {
            "facecolor": "#e4e4e4" if not hatch else "white",
            "edgecolor": "#bdbdbd",
            "hatch": hatch,
            "linewidth": 0,
        }
        for particle in particles:
            axes.axvspan(particle - 0.25, particle + 0.25, zorder=0, **look)
        if particles:
            entries.append(Patch(label=text, **look))
    return entries


def mark_floor(axes, floors, bottom):
    """The floor under each particle, hatched downwards."""
    found = np.flatnonzero(np.isfinite(floors))
    if len(found) == 0:
        return []
    depth = 0.035 * (axes.get_ylim()[1] - bottom)
    for i in found:
        axes.fill_between(
            [i - 0.5, i + 0.5],
            floors[i] - depth,
            floors[i],
            facecolor="none",
            edgecolor="#8c8c8c",
            hatch="//////",
            linewidth=0,
            zorder=0.5,
        )
    axes.hlines(floors[found], found - 0.5, found + 0.5, color=figures.INK, linewidth=1.1, zorder=1.5)
    return [Line2D([], [], color=figures.INK, linewidth=1.1, label="floor")]


def draw_curves(axes, states, colour_of, parameter):
    count = states.shape[1]
    particles = np.arange(count)
    lines = LineCollection(
        [np.column_stack([particles, row]) for row in states], linewidths=1.0, alpha=0.9, zorder=2
    )
    lines.set(array=parameter, cmap=colour_of[0], norm=colour_of[1])
    axes.add_collection(lines)
    if count <= 60:
        axes.scatter(
            np.tile(particles, len(states)),
            states.ravel(),
            s=7,
            c=np.repeat(parameter, count),
            cmap=colour_of[0],
            norm=colour_of[1],
            linewidths=0,
            zorder=2.5,
        )
    axes.set_xlim(-0.6, count - 0.4)
    return lines


def limit(axes, states, floors):
    """Limits of the value axis; a few modes ten times as large as most leave it, with a note."""
    usual = np.percentile(np.abs(states).max(axis=1), 90)
    low, high = min(states.min(), 0.0), max(states.max(), 0.0)
    if usual > 0 and max(-low, high) > 10 * usual:
        low, high = max(low, -3 * usual), min(high, 3 * usual)
        axes.text(
            0.995,
            0.97,
            figures.clip_note(states),
            ha="right",
            va="top",
            transform=axes.transAxes,
            fontsize=9,
            color=figures.FAINT,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 2},
            zorder=4,
        )
    if np.isfinite(floors).any():
        low = min(low, np.nanmin(floors))
    pad = 0.07 * (high - low) or 0.05
    axes.set_ylim(low - pad, high + pad)
    return low - pad


def draw_panel(axes, result, rows, key, colour_of):
    states = result.need(key)[rows]
    lines = draw_curves(axes, states, colour_of, result.values[0][rows])
    floors = result.floor_of(states.shape[1]) if key == "q" else np.full(states.shape[1], np.nan)
    bottom = limit(axes, states, floors)
    entries = mark_particles(axes, result) + mark_floor(axes, floors, bottom)
    if key == "v":
        axes.axhline(0, color=figures.FAINT, linewidth=0.6, zorder=1)
    return lines, entries


def draw(result, options):
    result.need_sweep(1)
    rows, available = pick_rows(result, options)
    at = result.values[0][rows]
    spread = (at.min(), at.max()) if at.min() < at.max() else (0.95 * at[0], 1.05 * at[0] or 1.0)
    norm = (LogNorm if figures.is_geometric(result.values[0]) else Normalize)(*spread)
    colour_of = (figures.colour_map(), norm)
    figure, panels = plt.subplots(2, 1, sharex=True, figsize=(8.6, 7.4), constrained_layout=True)
    for axes, (key, label) in zip(panels, PANELS):
        lines, entries = draw_panel(axes, result, rows, key, colour_of)
        axes.set_ylabel(label)
        if key == "q":
            first_entries = entries
    panels[1].set_xlabel("particle")
    panels[1].xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12))
    figures.legend_below(panels[1], 3, handles=first_entries)
    figure.colorbar(
        lines, ax=list(panels), label=figures.parameter_label(result.names[0]), aspect=40, pad=0.015
    )
    figures.put_title(figure, panels[0], result, 88)
    if len(rows) < len(result.outcome):
        what = "orbits" if options.all or not result.sound.any() else "admissible orbits"
        panels[1].text(
            1,
            -0.19,
            f"{len(rows)} of {available} {what}, {len(result.outcome)} computed",
            ha="right",
            va="center",
            transform=panels[1].transAxes,
            fontsize=9,
            color=figures.FAINT,
        )
    return figure


def options(parser):
    parser.add_argument("--all", action="store_true", help="draw inadmissible orbits too")
    parser.add_argument(
        "--curves",
        type=int,
        default=60,
        metavar="N",
        help="draw at most N curves, evenly picked " "(default 60)",
    )


if __name__ == "__main__":
    sys.exit(figures.run(draw, "modes", __doc__, options))
