"""Displacements as a picture: time across, particles upwards, impacts as dots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import FuncNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.plot.trajectories.motion import LABEL, OPTIONS, Hits, Motion, is_sampled, pen, picked_tasks
from ricochet.plot.words import number
from ricochet.result import Result
from ricochet.sweep import Array

_COLUMNS = 3000  # more samples than this are not seen
_CELLS = (150, 90)  # dots closer than the cells of such a grid would cover each other
_MOST_DOTS = 1000  # that are all drawn
_ROOT = (lambda x: np.sign(x) * np.sqrt(np.abs(x)), lambda x: np.sign(x) * x**2)  # of colours, and its inverse
_FEW = 4  # particles whose curves say more than colours


def _is_natural(result: Result) -> bool:
    return is_sampled(result) and bool(result.parameters["model.particles"] > _FEW)


@figure(
    "trajectory",
    shows="displacements as colours, time across and particles upwards",
    natural=_is_natural,
    part="task",
    parts=picked_tasks,
    options={
        **OPTIONS,
        "particles": "the first and the last particle",
        "limit": "the largest displacement with a colour of its own",
        "root": "colours by the square root of the displacement",
    },
)
def spacetime(
    result: Result,
    *,
    task: int | None = None,
    start: float | None = None,
    end: float | None = None,
    particles: Sequence[int] | None = None,
    limit: float | None = None,
    root: bool = False,
) -> Figure:
    """Colours are symmetric about zero. Of thousands of impacts those whose dots would cover others are left out."""
    motion = Motion(result, task, start, end)
    first, last = _checked_range(motion, particles)
    if limit is not None and not 0 < limit < np.inf:
        raise FigureError(result.path, f"limit = {limit:g}, expected a number > 0")
    sheet = Sheet(result, 9.6, float(np.clip(3.0 + 0.07 * (last + 1 - first), 3.6, 5.8)))
    axes = sheet.panel()
    q = motion.q[_even_samples(motion.t), first : last + 1].T
    ends = limit or _usual_limit(q)
    picture = _draw_picture(axes, motion, q, first, FuncNorm(_ROOT, -ends, ends) if root else Normalize(-ends, ends))
    axes.set(xlabel="time $t$", ylabel="particle", xlim=motion.limits, ylim=(first - 0.5, last + 0.5))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=10, min_n_ticks=1))
    largest = float(np.abs(q).max())
    extend = "both" if largest > ends else "neither"
    sheet.figure.colorbar(picture, ax=axes, label=LABEL, extend=extend, aspect=34, pad=0.015)
    if largest > ends:
        sheet.note(f"colours end at ${number(ends, 3)}$, displacements at ${number(largest, 3)}$")
    sheet.legend(_mark_hits(sheet, axes, motion, first, last))
    for note in motion.notes():
        sheet.note(note)
    return sheet.finish(words=motion.words())


def _checked_range(motion: Motion, particles: Sequence[int] | None) -> tuple[int, int]:
    first, last = (particles[0], particles[-1]) if particles else (0, motion.particles - 1)
    if not 0 <= first <= last < motion.particles or len(particles or (0, 0)) > 2:
        given = " ".join(map(str, particles or ()))
        raise FigureError(
            motion.result.path,
            f"particles {given}, expected the first and the last one, of 0 to {motion.particles - 1}",
        )
    return first, last


def _even_samples(t: Array) -> Array:
    """Samples nearest to equidistant times, no more than are seen."""
    return np.linspace(0, len(t) - 1, min(len(t), _COLUMNS)).round().astype(int)


def _usual_limit(q: Array) -> float:
    """The largest displacement, or less of it where few are so large."""
    size = np.abs(q)
    largest = float(size.max())
    usual = 3 * float(np.percentile(size, 95))
    return (largest if largest < 1.5 * usual else max(usual, largest / 4)) or 1.0


def _draw_picture(axes: Axes, motion: Motion, q: Array, first: int, norm: Normalize) -> AxesImage:
    half = 0.5 * (motion.t[-1] - motion.t[0]) / (q.shape[1] - 1)
    axes.set_facecolor(look.PALE)
    return axes.imshow(
        q,
        origin="lower",
        aspect="auto",
        extent=(motion.t[0] - half, motion.t[-1] + half, first - 0.5, first + len(q) - 0.5),
        cmap="RdBu_r",
        norm=norm,
        interpolation="antialiased" if q.size > 200_000 else "nearest",
    )


def _mark_hits(sheet: Sheet, axes: Axes, motion: Motion, first: int, last: int) -> list[Artist]:
    """Dots, filled at floors and open at walls."""
    hits = motion.hits.where((motion.hits.particle >= first) & (motion.hits.particle <= last))
    shown = hits if len(hits) <= _MOST_DOTS else hits.where(_apart(hits, motion, first, last))
    noun = "contacts" if len(motion.contacts) else "impacts"
    if len(shown) < len(hits):
        sheet.note(f"{len(shown)} of {len(hits)} {noun} are marked, the others lie under them")
    size = pen() ** 2 * np.clip(4000 / max(len(hits), 1), 3, 16)
    entries: list[Artist] = []
    for side, face, edge, width in (("floor", look.INK, "white", 0.35), ("wall", "white", look.INK, 0.6)):
        mine = shown.where(shown.side == side)
        if len(mine) == 0:
            continue
        colours = {"facecolors": face, "edgecolors": edge, "linewidths": width}
        axes.scatter(mine.time, mine.particle, s=size, rasterized=len(shown) > _MOST_DOTS, **colours)
        entries.append(_dot(f"{noun} at {side}s", face))
    return entries


def _dot(label: str, face: str) -> Line2D:
    return Line2D([], [], linestyle="", marker="o", markersize=4.5, color=look.INK, markerfacecolor=face, label=label)


def _apart(hits: Hits, motion: Motion, first: int, last: int) -> Array:
    """Mask of the first hit in each cell of a grid over the picture."""
    across = np.floor((hits.time - motion.limits[0]) / np.ptp(motion.limits) * _CELLS[0])
    upwards = np.floor((hits.particle - first) * min(_CELLS[1] / (last + 1 - first), 1))
    mask = np.zeros(len(hits), bool)
    mask[np.unique(across * (_CELLS[1] + 1) + upwards, return_index=True)[1]] = True
    return mask
