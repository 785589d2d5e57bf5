"""Strips above the panels of a sweep: words of its tasks as coloured bands, special points as ticks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ricochet.plot import look, scale
from ricochet.sweep import Array

# Of special points: what they are, the line through the panels (None: they change nothing there), its colour.
SPECIAL: dict[str, tuple[str, tuple[float, tuple[float, ...]] | None, str]] = {
    "resonance": ("resonance: a mode carries the orbit, or is free", (0, (1, 1.6)), look.GREEN),
    "idle resonance": ("resonance of a mode that the impacts hold", None, look.FAINT),
    "singular": ("singular point: amplitudes blow up", (0, (5, 2)), look.RED),
    "free impulses": ("singular but solvable: not unique", None, look.PINK),
    "pair at +1": ("multipliers leave or join the circle at +1", None, look.BLUE),
    "pair at \u22121": ("multipliers leave or join the circle at \u22121", None, look.SKY),
    "collision": ("pairs of multipliers collide on the circle", None, look.ORANGE),
}
_RARE = ("grazing", "resonant", "singular", "not_converged", "failed", "undecided", "unknown")
_THIN = 0.02  # of the strip: what rare words cover when they need markers


def edges(at: Array) -> Array:
    """Borders of the tasks: halfway between them, a hundredth of the range beyond the ends."""
    logarithmic = scale.is_geometric(at)
    scaled = np.log(at) if logarithmic else at
    borders: Array = np.concatenate([scaled[:1], 0.5 * (scaled[1:] + scaled[:-1]), scaled[-1:]])
    pad = 0.01 * np.ptp(scaled) or 0.05 * max(abs(scaled[0]), 1.0)
    borders[[0, -1]] += [-pad, pad]
    return np.asarray(np.exp(borders)) if logarithmic else borders


def draw_words(axes: Axes, name: str, at: Array, words: Array, looks: Mapping[str, look.AreaLook]) -> list[Artist]:
    """A strip of words [points], "" where it stays empty; entries of the legend, with counts. Rare words have markers
    where their bands are hairs."""
    _bare(axes, [0.5], [name])
    borders = edges(at)
    entries: list[Artist] = []
    for word in look.ordered(words[words != ""], looks):
        face, hatch, marker = looks.get(word, look.OTHER_AREA)
        where = words == word
        area = {"facecolor": face, "edgecolor": look.FAINT, "hatch": hatch, "linewidth": 0}
        for first, last in scale.runs(where):
            axes.axvspan(borders[first], borders[last + 1], **area)
        label = f"{word.replace('_', ' ')} ({where.sum()})"
        if word in _RARE and _is_thin(where, borders):
            marks = {"marker": marker, "color": face, "markeredgecolor": "white", "markersize": 8, "linestyle": ""}
            axes.plot(at[where], np.full(where.sum(), 0.5), clip_on=False, zorder=5, **marks)
            entries.append(Line2D([], [], label=label, **marks))
        else:
            entries.append(Patch(label=label, **area))
    return entries


def _is_thin(where: Array, borders: Array) -> bool:
    width = sum(borders[last + 1] - borders[first] for first, last in scale.runs(where))
    return bool(width < _THIN * (borders[-1] - borders[0]))


def draw_special(rug: Axes, panels: Sequence[Axes], special: Mapping[str, Array], borders: Array) -> list[Artist]:
    """Special points: ticks in the rug, a row for each kind, and lines through the panels for those that change the
    orbit; entries of the legend, with counts."""
    height = 1 / len(special)
    _bare(rug, [1 - (row + 0.5) * height for row in range(len(special))], list(special))
    entries: list[Artist] = []
    for row, (kind, places) in enumerate(special.items()):
        text, dashes, colour = SPECIAL[kind]
        inside = places[(places >= borders[0]) & (places <= borders[-1])]
        top = 1 - row * height
        rug.vlines(inside, top - 0.88 * height, top - 0.12 * height, color=colour, linewidth=1.3)
        for axes in panels if dashes else []:
            across = {"transform": axes.get_xaxis_transform(), "linestyle": [dashes], "zorder": 1}
            axes.vlines(inside, 0, 1, color=colour, linewidth=0.8, alpha=0.55, **across)
        if len(inside):
            label = f"{text} ({len(inside)})"
            entries.append(Line2D([], [], color=colour, linestyle=dashes or "-", linewidth=1.2, label=label))
    return entries


def _bare(axes: Axes, places: list[float], names: list[str]) -> None:
    """Takes lines and ticks off a strip; names stand at the left."""
    axes.set(ylim=(0, 1), yticks=places, yticklabels=names)
    axes.xaxis.set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.spines[["left", "bottom"]].set_visible(False)
