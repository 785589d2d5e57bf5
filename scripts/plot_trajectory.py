#!/usr/bin/python3
"""Draws the displacement of every particle against time.

Datasets: /trajectory/q over /trajectory/t of one task, /trajectory/impact_time, impact_particle and impact_side
(marks on the obstacles; they also sharpen the kinks between samples), /trajectory/outcome. Particles that hit
are emphasised and labelled, beyond twelve of them coloured by their index; the others are grey.
Positions of floor and wall come from the study. Vertical lines are periods of the orbit that the study
starts on.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D

import figures
import trajectories

MUTED = "#b4b4b4"
LABELLED = 12
MOST_MUTED = 400
MOST_MARKS = 2000


class Look:
    """Colours and line styles of the particles that hit, by particle."""

    def __init__(self, particles):
        self.particles = np.sort(particles)
        self.labelled = len(particles) <= LABELLED
        if not self.labelled:
            self.map = ScalarMappable(Normalize(self.particles[0], self.particles[-1]), figures.colour_map())

    def __call__(self, particle):
        if not self.labelled:
            return self.map.to_rgba(particle), "-"
        i = int(np.searchsorted(self.particles, particle))
        return figures.CYCLE[i % len(figures.CYCLE)], "-" if i < len(figures.CYCLE) else (0, (5, 1.5))


def with_impacts(motion, particle, obstacles):
    """The curve of a particle with its kinks, which fall between samples."""
    t, q = motion.t, motion.q(particle)
    impacts = motion.impacts.pick(motion.impacts.particle == particle)
    for name, side in trajectories.SIDES.items():
        times = impacts.time[impacts.side == side]
        if np.isfinite(obstacles[name][particle]):
            at = np.searchsorted(t, times)
            t, q = np.insert(t, at, times), np.insert(q, at, obstacles[name][particle])
    return t, q


def draw_muted(axes, motion, others):
    """The particles that do not hit, at most MOST_MUTED of them; returns how many were drawn."""
    shown = np.unique(np.linspace(0, len(others) - 1, min(len(others), MOST_MUTED)).round().astype(int))
    others = others[shown] if len(others) else others
    curves = [np.column_stack([motion.t, motion.q(i)]) for i in others]
    axes.add_collection(
        LineCollection(
            curves,
            colors=MUTED,
            linewidths=0.7 if len(others) <= 60 else 0.4,
            zorder=2,
            rasterized=len(curves) * len(motion.t) > 100_000,
        ),
        autolim=True,
    )
    return len(others)


def draw_hitting(axes, motion, look, obstacles):
    """The particles that hit; returns the last displacement of each."""
    ends = []
    heavy = len(look.particles) * len(motion.t) > 100_000
    for particle in look.particles:
        colour, style = look(particle)
        t, q = with_impacts(motion, particle, obstacles)
        width = 1.3 if look.labelled else 0.8
        axes.plot(t, q, color=colour, linestyle=style, linewidth=width, zorder=3, rasterized=heavy)
        ends.append(q[-1])
    return np.array(ends)


def label_ends(axes, motion, look, ends):
    """Numbers of the particles at the ends of their curves, moved apart where they would overlap."""
    low, high = axes.get_ylim()
    order = np.argsort(ends)
    step = 0.045 * (high - low)
    heights = ends[order].copy()
    for i in range(1, len(heights)):
        heights[i] = max(heights[i], heights[i - 1] + step)
    heights -= max(0.0, heights[-1] - (high - 0.5 * step))
    left, right = motion.limits
    for height, i in zip(heights, order):
        colour = look(look.particles[i])[0]
        axes.annotate(
            str(look.particles[i]),
            (motion.t[-1], ends[i]),
            (motion.t[-1] + 0.012 * (right - left), height),
            color=colour,
            weight="bold",
            va="center",
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0},
        )


def mark_impacts(axes, motion, look, obstacles):
    hits = motion.hits
    if len(hits) > MOST_MARKS:
        return
    depth = 0.022 * np.ptp(axes.get_ylim())
    for name, side in trajectories.SIDES.items():
        picked = hits.pick(hits.side == side)
        axes.scatter(
            picked.time,
            obstacles[name][picked.particle] - side * depth,
            s=20,
            marker="^" if side > 0 else "v",
            c=[look(particle)[0] for particle in picked.particle],
            edgecolors="white",
            linewidths=0.4,
            zorder=4,
        )


def draw_obstacles(axes, obstacles):
    """Hatching beyond the outermost floor and wall, thin lines at others.

    Where particles without that obstacle pass it, the hatching is a strip.
    """
    inside = axes.dataLim.intervaly
    for name, side in trajectories.SIDES.items():
        positions = np.unique(obstacles[name][np.isfinite(obstacles[name])])
        if len(positions) == 0:
            continue
        outermost = positions[0] if side > 0 else positions[-1]
        passed = min(side * inside) < side * outermost - 1e-6
        strip = 0.045 * np.ptp(axes.get_ylim())
        trajectories.hatch(axes, outermost, side, depth=strip if passed else None)
        for position in positions[positions != outermost] if len(positions) <= 8 else ():
            axes.axhline(position, color=figures.INK, linewidth=0.8, linestyle=(0, (6, 3)), zorder=1.5)


def mark_periods(axes, motion):
    """Lines at the periods and their count on top, if there are few enough to be read."""
    period = motion.period()
    span = motion.limits[1] - motion.limits[0]
    if not period or not 1 <= span / period <= 40:
        return
    first, last = np.ceil(motion.limits[0] / period - 1e-9), np.floor(motion.limits[1] / period + 1e-9)
    for k in np.arange(first, last + 1):
        axes.axvline(k * period, color="#dddddd", linewidth=0.7, zorder=1)
    top = axes.secondary_xaxis("top", functions=(lambda t: t / period, lambda k: k * period))
    top.set_xticks(np.arange(first, last + 1, 1 if last - first <= 25 else 5))
    top.spines["top"].set_visible(False)
    top.tick_params(length=0, pad=1, labelsize=8.5, labelcolor=figures.FAINT)
    axes.text(
        -0.012, 1.008, "period", ha="right", va="bottom", fontsize=8.5, color=figures.FAINT, transform=axes.transAxes
    )


def value_limits(axes, obstacles):
    """Room below the floor and above the wall for hatching and marks."""
    axes.autoscale_view()
    low, high = axes.dataLim.intervaly
    positions = np.concatenate(list(obstacles.values()))
    positions = positions[np.isfinite(positions)]
    low, high = min([low, *positions]), max([high, *positions])
    pad = 0.08 * (high - low) or 0.1
    axes.set_ylim(low - pad, high + pad)


def particles_text(drawn, count, word):
    """"29 others", "400 of 9791 others", "1 other"."""
    number = str(count) if drawn == count else f"{drawn} of {count}"
    return f"{number} {word}{'s' if count != 1 else ''}"


def legend(axes, motion, look, muted, others):
    entries = []
    if len(look.particles) == 1:
        label = f"particle {look.particles[0]}, which hits"
        entries.append(Line2D([], [], color=look(look.particles[0])[0], linewidth=1.4, label=label))
    if others:
        text = particles_text(muted, others, "other" if len(look.particles) else "particle")
        entries.append(Line2D([], [], color=MUTED, linewidth=1.2, label=text))
    if len(look.particles) and len(motion.hits) <= MOST_MARKS:
        look_of_mark = {"color": figures.FAINT, "marker": "^", "markersize": 5, "linestyle": ""}
        entries.append(Line2D([], [], label="impacts", **look_of_mark))
    figures.legend_below(axes, 3, handles=entries)


def draw(motion, _options):
    hitting, _ = motion.hitting()
    look, obstacles = Look(hitting), motion.met_obstacles()
    figure, axes = plt.subplots(figsize=(11.5, 5.4), constrained_layout=True)
    axes.set_xlim(motion.limits)
    others = np.setdiff1d(np.arange(motion.particles), hitting)
    muted = draw_muted(axes, motion, others)
    ends = draw_hitting(axes, motion, look, obstacles)
    value_limits(axes, obstacles)
    draw_obstacles(axes, obstacles)
    mark_impacts(axes, motion, look, obstacles)
    mark_periods(axes, motion)
    if look.labelled and len(hitting):
        label_ends(axes, motion, look, ends)
    elif len(hitting):
        figure.colorbar(look.map, ax=axes, label="particle that hits", aspect=34, pad=0.015)
    axes.set(xlabel="time $t$", ylabel=trajectories.LABEL)
    legend(axes, motion, look, muted, len(others))
    trajectories.put_title(figure, axes, motion, 118)
    return figure


if __name__ == "__main__":
    sys.exit(trajectories.run(draw, "trajectory", __doc__))
