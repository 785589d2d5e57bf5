"""Densities of iterates: the share that lies in each cell, for one set of columns or for two over one another."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap, LogNorm, Normalize, to_rgb

from ricochet.plot import look
from ricochet.sweep import Array

FIRST, SECOND = look.BLUE, look.RED  # of two densities on the same axes
_ROWS, _FINER = 240, 3  # cells over the height; each is so many where the iterates are periodic
_MOST_COLUMNS = 1000  # tasks of more share one
_LEVELS = 15  # of each of two densities
_FAINTEST = 0.28  # how strong the colour is where there is a single iterate
_ROUNDING = 1e-9  # values that spread less, relative to their size, are one


class Density:
    """Share of the iterates of each task in cells of its values: `share` [rows, columns] between the borders `y` and
    `x`. Periodic tasks have lines of three finer cells, which the eye finds."""

    def __init__(self, values: Array, periods: Array, edges: Array, limits: tuple[float, float]):
        """`values` [tasks, iterates] from left to right, `edges` [tasks + 1] their borders."""
        self.least = 1 / values.shape[1]
        self.y = np.linspace(*limits, _ROWS * _FINER + 1)
        shares = np.stack([self._share(*task) for task in zip(values, periods)], axis=1)
        together = -(-len(values) // _MOST_COLUMNS)
        starts = np.arange(0, len(values), together)
        self.x = np.append(edges[starts], edges[-1])
        self.share = np.add.reduceat(shares, starts, axis=1) / np.add.reduceat(np.ones(len(values)), starts)

    def _share(self, values: Array, period: int) -> Array:
        finite = values[np.isfinite(values)]
        if period == 0:
            return np.repeat(self._counts(finite, _ROWS), _FINER) / len(values)
        share = np.pad(self._counts(finite, _ROWS * _FINER) / len(values), 1)
        return np.asarray(np.max([share[:-2], share[1:-1], share[2:]], axis=0))

    def _counts(self, values: Array, cells: int) -> Array:
        return np.histogram(values, cells, (self.y[0], self.y[-1]))[0]

    def levels(self) -> Array:
        """0: no iterate, else 1 to _LEVELS on a logarithmic scale."""
        share = np.maximum(self.share, self.least / _MOST_COLUMNS)
        most = max(0.5, 2 * self.least)
        scaled = 1 + (_LEVELS - 1) * np.clip(np.log(share / self.least) / np.log(most / self.least), 0, 1)
        return np.where(self.share > 0, np.round(scaled), 0).astype(int)


def colour_map() -> ListedColormap:
    """Sparse to dense; no colour is too light for white."""
    return ListedColormap(plt.get_cmap("magma_r")(np.linspace(0.18, 1, 256)))


def draw(axes: Axes, density: Density) -> QuadMesh:
    """One density; its mesh has the colours for a bar."""
    share = np.where(density.share > 0, density.share, np.nan)
    norm = LogNorm(density.least, 1 if density.least < 1 else 2, clip=True)
    return axes.pcolormesh(density.x, density.y, share, cmap=colour_map(), norm=norm, rasterized=True)


def draw_two(axes: Axes, first: Density, second: Density) -> None:
    """Two densities over the same cells, in FIRST and SECOND."""
    pairs = (_LEVELS + 1) * first.levels() + second.levels()
    norm = Normalize(-0.5, (_LEVELS + 1) ** 2 - 0.5)
    cells = np.where(pairs > 0, pairs, np.nan)
    axes.pcolormesh(first.x, first.y, cells, cmap=ListedColormap(_blend()), norm=norm, rasterized=True)


def both() -> Array:
    """The colour of cells that both densities fill."""
    return np.asarray(_blend()[-1])


def _blend() -> Array:
    """Colours of all pairs of levels, as two inks on paper: dark where both are."""
    strength = np.concatenate([[0], np.linspace(_FAINTEST, 1, _LEVELS)])[:, None]
    one, other = (1 - strength * (1 - np.array(to_rgb(colour))) for colour in (FIRST, SECOND))
    return np.asarray((one[:, None, :] * other[None, :, :]).reshape(-1, 3))


def limits_of(*columns: Array, room: float = 0.03) -> tuple[float, float]:
    """The extent of all finite values, of which there is one, with some room."""
    whole = np.concatenate([np.ravel(column[np.isfinite(column)]) for column in columns])
    low, high = float(whole.min()), float(whole.max())
    size = max(abs(low), abs(high))
    pad = room * (high - low) if high - low > _ROUNDING * size else 0.05 * size or 0.05
    return low - pad, high + pad
