"""Colours, lines and markers that all figures share, and matplotlib's settings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

INK = "#222222"
FAINT = "#6b6b6b"
PALE = "#dcdcdc"  # cells without a number
# Okabe and Ito's colours: distinct for every kind of colour vision.
BLUE, ORANGE, GREEN, PINK, SKY, RED = "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"
CYCLE = (BLUE, RED, GREEN, PINK, ORANGE, SKY)

AreaLook = tuple[str, str, str]  # face colour, hatch, marker of single points

# Lightness, hatch and marker tell outcomes apart in grey, too.
OUTCOMES: dict[str, AreaLook] = {
    "admissible": (BLUE, "", "o"),
    "inadmissible": ("#F3E3C6", "", "."),
    "inadmissible: obstacle passed": ("#F6EBD6", "", "."),
    "inadmissible: impulse not positive": ("#E2B982", "////", "."),
    "grazing": (GREEN, "\\\\\\\\", "D"),
    "resonant": (PINK, "xxxx", "s"),
    "singular": (RED, "++++", "X"),
    "not_converged": ("#999999", "----", "v"),
    "failed": ("#000000", "", "x"),
}
STABILITIES: dict[str, AreaLook] = {
    "stable": (BLUE, "", "o"),
    "unstable": (ORANGE, "", "X"),
    "undecided": (GREEN, "", "D"),
    "unknown": ("#8a8a8a", "", "v"),
}
OTHER_AREA: AreaLook = ("#c8c8c8", "||||", "^")

# Special points of branches: marker, colour, size.
SPECIAL_POINTS: dict[str, tuple[str, str, float]] = {
    "fold": ("s", RED, 7),
    "branch_point": ("P", PINK, 8),
    "symmetry_breaking": ("p", PINK, 8),
    "energy_extreme": ("d", BLUE, 7),
    "period_doubling": ("^", ORANGE, 8),
    "torus": ("*", GREEN, 10),
    "resonance": ("|", INK, 9),
    "grazing": ("D", GREEN, 6),
    "impact_lost": ("v", SKY, 8),
    "impulse_sign": ("X", RED, 8),
    "order": ("o", ORANGE, 6),
}
OTHER_POINT = ("o", INK, 6.0)

OBSTACLE = {"facecolor": "#f4f4f4", "edgecolor": "#9a9a9a", "hatch": "//////", "linewidth": 0}  # behind its surface


def settings(size: float = 10) -> dict[str, Any]:
    """Settings of matplotlib for text of `size` points."""
    return {
        "font.size": size,
        "axes.titlesize": size,
        "axes.labelsize": 1.05 * size,
        "legend.fontsize": 0.9 * size,
        "xtick.labelsize": 0.95 * size,
        "ytick.labelsize": 0.95 * size,
        "figure.titlesize": 1.2 * size,
        "axes.edgecolor": FAINT,
        "axes.labelcolor": INK,
        "text.color": INK,
        "xtick.color": FAINT,
        "ytick.color": FAINT,
        "xtick.labelcolor": INK,
        "ytick.labelcolor": INK,
        "axes.linewidth": 0.8,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "hatch.linewidth": 0.6,
        "mathtext.fontset": "dejavusans",
        "svg.hashsalt": "ricochet",  # equal data give equal files
    }


def colour_map() -> ListedColormap:
    """Light to dark, so that the last curves, drawn over the others, stand out; none too light for white."""
    return ListedColormap(plt.get_cmap("plasma")(np.linspace(0.86, 0, 256)))


def ordered(words: Iterable[str], looks: Iterable[str]) -> list[str]:
    """The different words in the order of their looks, unknown ones behind."""
    known = list(looks)
    return sorted(set(words), key=lambda word: (known.index(word) if word in known else len(known), word))
