#!/usr/bin/python3
"""Draws the displacement of every particle as a picture: time across, particles upwards, impacts as dots.

Datasets: /trajectory/q over /trajectory/t of one task, /trajectory/impact_time, impact_particle and impact_side.
The colours are symmetric about zero; arrows at their scale say that a few displacements are beyond it, --limit
sets its end, --root stretches small displacements. Of thousands of impacts those that would cover each other are
left out, and their number is said.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import FuncNorm, Normalize
from matplotlib.ticker import MaxNLocator

import figures
import trajectories

COLUMNS = 3000  # more samples than this are not seen
CELLS = (150, 90)  # dots closer than the cells of such a grid would cover each other
BAD = "#d9d9d9"


def even_samples(motion):
    """Samples nearest to equidistant times: a picture has columns of one width."""
    count = min(len(motion.t), COLUMNS)
    times = np.linspace(motion.t[0], motion.t[-1], count)
    after = np.clip(np.searchsorted(motion.t, times), 1, len(motion.t) - 1)
    return np.where(times - motion.t[after - 1] < motion.t[after] - times, after - 1, after)


def colours(q, options):
    """Limit and scale of the colours: the largest displacement, or less of it where few are so large."""
    size = np.abs(q)
    largest = float(size.max())
    usual = 3 * np.percentile(size[:: max(1, len(size) // 1000)], 95)
    limit = options.limit or (largest if largest < 1.5 * usual else max(usual, largest / 4)) or 1.0
    if not options.root:
        return limit, Normalize(-limit, limit)
    root = lambda x: np.sign(x) * np.sqrt(np.abs(x))  # noqa: E731
    return limit, FuncNorm((root, lambda x: np.sign(x) * x**2), -limit, limit)


def draw_picture(axes, motion, first, last, options):
    q = motion.q(slice(first, last + 1))[even_samples(motion)].T
    limit, norm = colours(q, options)
    half = 0.5 * (motion.t[-1] - motion.t[0]) / (q.shape[1] - 1)
    picture = axes.imshow(
        q,
        origin="lower",
        aspect="auto",
        extent=(motion.t[0] - half, motion.t[-1] + half, first - 0.5, last + 0.5),
        cmap="RdBu_r",
        norm=norm,
        interpolation="antialiased" if q.size > 200_000 else "nearest",
    )
    axes.set_facecolor(BAD)
    axes.set_xlim(motion.limits)
    return picture, bool(np.abs(q).max() > limit)


def apart(hits, motion, first, last):
    """Mask of the first hit in each cell of a grid over the picture."""
    across = (hits.time - motion.limits[0]) / np.ptp(motion.limits) * CELLS[0]
    upwards = (hits.particle - first) * (CELLS[1] / max(last + 1 - first, CELLS[1]))
    cells = np.floor(across) * (CELLS[1] + 1) + np.floor(upwards)
    mask = np.zeros(len(cells), bool)
    mask[np.unique(cells, return_index=True)[1]] = True
    return mask


def mark_impacts(axes, motion, first, last):
    """Dots, filled at floors and open at walls, and their legend."""
    hits = motion.hits
    hits = hits.pick((hits.particle >= first) & (hits.particle <= last))
    if len(hits) == 0:
        return
    shown = hits.pick(apart(hits, motion, first, last)) if len(hits) > 1000 else hits
    size = np.clip(4000 / len(hits), 3, 16)
    part = f", {len(shown)} of {len(hits)} marked" if len(shown) < len(hits) else ""
    for side, face in ((1, figures.INK), (-1, "white")):
        mask = shown.side == side
        if not mask.any():
            continue
        where = "" if (shown.side == side).all() else " at the floor" if side > 0 else " at the wall"
        axes.scatter(
            shown.time[mask],
            shown.particle[mask],
            s=size,
            c=face,
            edgecolors="white" if face != "white" else figures.INK,
            linewidths=0.35 if face != "white" else 0.6,
            label="impacts" + where + part,
            rasterized=len(shown) > 1000,
        )
        part = ""
    figures.legend_below(axes, 2, markerscale=np.sqrt(20 / size), handletextpad=0.2)


def particle_range(motion, options):
    first, last = options.particles or (0, motion.particles - 1)
    if not 0 <= first <= last < motion.particles:
        raise figures.FigureError(f"no particles {first} to {last}, it has 0 to {motion.particles - 1}")
    return first, last


def draw(motion, options):
    first, last = particle_range(motion, options)
    height = np.clip(3.6 + 0.07 * (last + 1 - first), 4.2, 6.4)
    figure, axes = plt.subplots(figsize=(10.5, height), constrained_layout=True)
    picture, clipped = draw_picture(axes, motion, first, last, options)
    axes.set(xlabel="time $t$", ylabel="particle", ylim=(first - 0.5, last + 0.5))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=10))
    extend = "both" if clipped else "neither"
    figure.colorbar(picture, ax=axes, label=trajectories.LABEL, extend=extend, aspect=34, pad=0.015)
    mark_impacts(axes, motion, first, last)
    trajectories.put_title(figure, axes, motion, 104)
    return figure


def positive(word):
    value = float(word)
    if not 0 < value < np.inf:
        raise ValueError
    return value


def options(parser):
    parser.add_argument("--particles", type=int, nargs=2, metavar=("I", "J"), help="only the particles I to J")
    parser.add_argument("--limit", type=positive, metavar="Q", help="largest displacement with a colour of its own")
    parser.add_argument("--root", action="store_true", help="colours by the square root of the displacement")


if __name__ == "__main__":
    sys.exit(trajectories.run(draw, "spacetime", __doc__, options))
