#!/usr/bin/python3
"""Draws phase portraits of some particles: displacement across, velocity upwards, a panel each.

Datasets: /trajectory/q and /trajectory/v of one task over /trajectory/t (colour), /trajectory/impact_time,
impact_particle, impact_side, impact_gap_rate and impact_impulse. Impacts break the curve: its jump is a dashed
line at the obstacle from the velocity before (open circle) to the one after (filled). Without --particles: the
six with most impacts and a neighbour that does not hit.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D

import figures
import trajectories

MOST_PANELS = 12
MOST_MARKS = 400


def default_particles(motion):
    """The six with most impacts, and a neighbour of the first ones that does not hit; without impacts the largest."""
    hitting, _ = motion.hitting()
    if len(hitting) == 0:
        largest = np.argsort(-np.abs(motion.q()).max(axis=0), kind="stable")
        return largest[:4].tolist()
    chosen = hitting[:6].tolist()
    for particle in chosen:
        for neighbour in (particle - 1, particle + 1):
            if 0 <= neighbour < motion.particles and neighbour not in hitting:
                return chosen + [neighbour]
    return chosen


def choose(motion, options):
    chosen = options.particles or default_particles(motion)
    for particle in chosen:
        if not 0 <= particle < motion.particles:
            raise figures.FigureError(f"no particle {particle}, it has particles 0 to {motion.particles - 1}")
    chosen = list(dict.fromkeys(chosen))
    if len(chosen) > MOST_PANELS:
        raise figures.FigureError(f"{len(chosen)} particles are too many for one figure, at most {MOST_PANELS}")
    return chosen


class Portrait:
    """A particle's motion in pieces between its impacts.

    The velocity before an impact is the gap rate's, the one after it has the impulse more. Impulses over masses other
    than one are recognised by the next sample, which is free of them.
    """

    def __init__(self, motion, particle, obstacles):
        self.particle = particle
        self.t, self.q, self.v = motion.t, motion.q(particle), motion.v(particle)
        self.impacts = motion.impacts.pick(motion.impacts.particle == particle)
        side = self.impacts.side
        self.at = np.array([obstacles["floor" if s > 0 else "wall"][particle] for s in side])
        self.before = side * self.impacts.gap_rate
        self.after = self.before + side * self.impacts.impulse * self._inverse_mass()

    def _inverse_mass(self):
        """Jump of the velocity over impulse: 1 unless the samples clearly say otherwise."""
        times, impulse = self.impacts.time, self.impacts.impulse
        after = np.searchsorted(self.t, times + 1e-9 * (1 + np.abs(times)), side="right")
        following = np.append(times[1:], np.inf)
        use = after + 1 < len(self.t)
        after = np.minimum(after, len(self.t) - 2)
        use &= (impulse > 0.1 * impulse.max(initial=0)) & (following > self.t[after + 1])
        if not use.any():
            return 1.0
        slope = (self.v[after + 1] - self.v[after]) / (self.t[after + 1] - self.t[after])
        jump = self.v[after] - slope * (self.t[after] - times) - self.before
        ratio = float(np.median((self.impacts.side * jump / impulse)[use]))
        return ratio if abs(ratio - 1) > 0.1 else 1.0

    def pieces(self):
        """(t, q, v) between impacts, with the states at impacts."""
        times = self.impacts.time
        # A sample at an impact may have the state before or after it, as rounding will have it.
        near = 1e-9 * (1 + np.abs(times))
        firsts = np.searchsorted(self.t, np.append(-np.inf, times + near), side="right")
        lasts = np.searchsorted(self.t, np.append(times - near, np.inf), side="left")
        for k, (first, last) in enumerate(zip(firsts, lasts)):
            piece = [column[first:last] for column in (self.t, self.q, self.v)]
            if k > 0:
                start = times[k - 1], self.at[k - 1], self.after[k - 1]
                piece = [np.insert(column, 0, x) for column, x in zip(piece, start)]
            if k < len(times):
                end = times[k], self.at[k], self.before[k]
                piece = [np.append(column, x) for column, x in zip(piece, end)]
            yield piece


def draw_curve(axes, portrait, norm):
    """The pieces, coloured by time."""
    strokes, times = [], []
    for t, q, v in portrait.pieces():
        points = np.column_stack([q, v])
        strokes.append(np.stack([points[:-1], points[1:]], axis=1))
        times.append(0.5 * (t[1:] + t[:-1]))
    strokes = np.concatenate(strokes)
    lines = LineCollection(
        strokes, cmap=figures.colour_map(), norm=norm, linewidths=1.0, zorder=2, capstyle="round",
        rasterized=len(strokes) > 3000,
    )  # fmt: skip
    lines.set_array(np.concatenate(times))
    axes.add_collection(lines)
    axes.plot(portrait.q[0], portrait.v[0], "s", color=lines.cmap(norm(portrait.t[0])), markersize=4.5, zorder=2.5)
    return lines


def draw_jumps(axes, portrait):
    """Dashed lines at the obstacles, and the states before and after the impacts."""
    impacts = portrait.impacts
    for side in np.unique(impacts.side):
        mine = impacts.side == side
        ends = np.concatenate([portrait.before[mine], portrait.after[mine]])
        at = portrait.at[mine][0]
        axes.plot([at, at], [ends.min(), ends.max()], color=figures.INK, linewidth=1.1, linestyle=(0, (4, 3)), zorder=3)
    shown = np.unique(np.linspace(0, len(impacts) - 1, min(len(impacts), MOST_MARKS)).round().astype(int))
    if len(impacts):
        for speeds, face in ((portrait.before, "white"), (portrait.after, figures.INK)):
            axes.scatter(
                portrait.at[shown], speeds[shown], s=15, c=face, edgecolors=figures.INK, linewidths=0.8, zorder=4
            )


def set_limits(axes, portrait, obstacles):
    """Room around the curve, with its obstacles hatched."""
    speeds = np.concatenate([portrait.v, portrait.before, portrait.after])
    for values, limit in ((np.append(portrait.q, portrait.at), axes.set_xlim), (speeds, axes.set_ylim)):
        pad = 0.09 * np.ptp(values) or 0.1
        limit(values.min() - pad, values.max() + pad)
    left, right = axes.get_xlim()
    for name, side in trajectories.SIDES.items():
        at = obstacles[name][portrait.particle]
        if np.isfinite(at):
            look = {"facecolor": "#f4f4f4", "edgecolor": "#9a9a9a", "hatch": "//////", "linewidth": 0}
            axes.axvspan(left if side > 0 else at, at if side > 0 else right, zorder=0.5, **look)
    axes.set_xlim(left, right)


def draw_panel(axes, motion, particle, obstacles, norm):
    portrait = Portrait(motion, particle, obstacles)
    lines = draw_curve(axes, portrait, norm)
    set_limits(axes, portrait, obstacles)
    axes.axhline(0, color="#dddddd", linewidth=0.7, zorder=1)
    draw_jumps(axes, portrait)
    axes.text(0, 1.015, f"particle {particle}", weight="bold", va="bottom", transform=axes.transAxes)
    axes.text(1, 1.015, motion.count_of_hits(particle), color=figures.FAINT, ha="right", va="bottom", transform=axes.transAxes)
    return lines


def layout(count):
    """Rows and columns of panels, and the size of the figure."""
    columns = count if count <= 3 else 2 if count == 4 else 3 if count in (5, 6, 9) else 4
    rows = -(-count // columns)
    width = {1: 6.6, 2: 9.0, 4: 13.5}.get(columns, 11.5)
    return rows, columns, (width, 1.4 + rows * min(4.2, 0.86 * width / columns))


def legend(axes, motion):
    look = {"linestyle": "", "markersize": 5}
    entries = [Line2D([], [], marker="s", color=figures.colour_map()(0), label="start", **look)]
    if len(motion.impacts):
        look.update(marker="o", markeredgecolor=figures.INK)
        entries += [
            Line2D([], [], color=figures.INK, linewidth=1.1, linestyle=(0, (4, 3)), label="jump at the obstacle"),
            Line2D([], [], markerfacecolor="white", label="before the impact", **look),
            Line2D([], [], markerfacecolor=figures.INK, label="after", **look),
        ]
    figures.legend_row(axes, entries, len(entries))


def lay_out(count):
    """The figure, its panels, and a row for the legend."""
    rows, columns, size = layout(count)
    figure = plt.figure(figsize=size, constrained_layout=True)
    heights = [(size[1] - 1.4) / rows] * rows + [0.22]
    grid = figure.add_gridspec(rows + 1, columns, height_ratios=heights)
    panels = [figure.add_subplot(grid[i // columns, i % columns]) for i in range(count)]
    for i, axes in enumerate(panels):
        axes.set(xlabel=trajectories.LABEL if i + columns >= count else "")
        axes.set(ylabel="velocity $v$" if i % columns == 0 else "")
    return figure, panels, figure.add_subplot(grid[rows, :])


def draw(motion, options):
    chosen = choose(motion, options)
    obstacles = motion.met_obstacles()
    figure, panels, last = lay_out(len(chosen))
    norm = Normalize(*motion.limits)
    for axes, particle in zip(panels, chosen):
        lines = draw_panel(axes, motion, particle, obstacles, norm)
    figure.colorbar(lines, ax=panels, label="time $t$", aspect=40, pad=0.015)
    legend(last, motion)
    trajectories.put_title(figure, panels[0], motion, int(9.8 * figure.get_figwidth()), pad=24)
    return figure


def options(parser):
    parser.add_argument("--particles", type=int, nargs="+", metavar="I", help="particles to draw, from 0")


if __name__ == "__main__":
    sys.exit(trajectories.run(draw, "phase", __doc__, options))
