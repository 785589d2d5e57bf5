"""Attractors in planes of two numbers of their states."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ricochet.plot import look
from ricochet.plot.catalogue import figure
from ricochet.plot.diagrams import densities, lines
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.words import task_words
from ricochet.result import Result
from ricochet.sweep import Array

_MOST_POINTS = 10000  # more are a density
_MOST_PLANES = 3
_CELLS = 360  # of a density, each way

Plane = tuple[str, str]


def _parts(result: Result) -> list[int]:
    return lines.spread(result.sweep.tasks)


@figure(
    "diagram",
    shows="the kept states of a task, in planes of two of their numbers",
    columns=("diagram/state",),
    source="[FN97] Figure 6",
    natural=lambda result: result.sweep.tasks <= lines.MOST,
    part="task",
    parts=_parts,
    options={
        "task": "which task; default: each, of more than 8 a few",
        "x": "what is on the horizontal axis: a number of the state, as z1, q0, v0, time",
        "y": "what is on the vertical axis: a number of the state, as z1, q0, v0, time",
    },
)
def attractor(result: Result, *, task: int | None = None, x: str | None = None, y: str | None = None) -> Figure:
    """Points, or the density of many. The planes are those of z1, z2, z3 of a map; of displacement and velocity of the
    first particles of a motion; of time and velocity at impacts."""
    which = _picked(result, task)
    states = result["diagram"].task(which)["state"][0]
    states = states[np.isfinite(states).all(axis=1)]
    if len(states) == 0:
        raise FigureError(result.path, f"no state of task {which} is finite: it has {_outcome(result, which)}")
    names = lines.state_names(result, states.shape[1])
    planes = _planes(result, names, x, y)
    sheet = _draw(result, names, states, planes[:_MOST_PLANES])
    if len(planes) > _MOST_PLANES:
        last = ", ".join(planes[_MOST_PLANES])
        sheet.note(f"{len(planes) - _MOST_PLANES} more planes are not drawn, the next one is that of {last}")
    return sheet.finish(varied=lines.varied(result), words=_words(result, which, len(states)))


def _picked(result: Result, task: int | None) -> int:
    tasks = result.sweep.tasks
    if task is None and tasks > 1:
        raise FigureError(result.path, f"{tasks} tasks in it: say which, --task 0 to {tasks - 1}")
    if not 0 <= (task or 0) < tasks:
        raise FigureError(result.path, f"it has no task {task}, only tasks 0 to {tasks - 1}")
    return task or 0


# --- planes ---


def _planes(result: Result, names: list[str], x: str | None, y: str | None) -> list[Plane]:
    """Names on the two axes of each plane: those that are usual, or as `x` and `y` say."""
    for name in (x, y):
        if name is not None and name not in names:
            raise FigureError(result.path, f"a state has no number {name}, it has {', '.join(names)}")
    if x is not None and y is not None:
        return [(x, y)]
    usual = _usual_planes(result, names)
    found = [plane for pair in usual for plane in (pair, pair[::-1]) if _has(plane, x, y)]
    if x is None and y is None:
        found = usual
    if not found:
        missing = "a state has one number, a plane needs two" if len(names) < 2 else "say --x and --y"
        raise FigureError(result.path, missing)
    return found


def _has(plane: Plane, x: str | None, y: str | None) -> bool:
    return x in (None, plane[0]) and y in (None, plane[1])


def _usual_planes(result: Result, names: list[str]) -> list[Plane]:
    if lines.is_map(result):
        return list(combinations(names[:3], 2))
    particles = len(names) // 2
    if names[-1] == "time":
        return [("time", f"v{i}") for i in range(particles)]
    return [(f"q{i}", f"v{i}") for i in range(particles)]


def _draw(result: Result, names: list[str], states: Array, planes: list[Plane]) -> Sheet:
    """Panels side by side, or below one another on a narrow sheet."""
    many = len(planes)
    if is_narrow():
        sheet = Sheet(result, 5.4, 2.8 * many, rows=many)
    else:
        sheet = Sheet(result, max(3.7 * many, 5.6), 3.9 if many > 1 else 4.6, columns=many)
    for k, plane in enumerate(planes):
        axes = sheet.panel(k) if is_narrow() else sheet.panel(0, k)
        i, j = (names.index(name) for name in plane)
        mesh = _draw_plane(axes, states[:, i], states[:, j])
        axes.set(xlabel=lines.state_label(plane[0]), ylabel=lines.state_label(plane[1]))
        axes.set_xlim(densities.limits_of(states[:, i], room=0.04))
        axes.set_ylim(densities.limits_of(states[:, j], room=0.04))
        axes.locator_params(nbins=5)
        axes.ticklabel_format(useOffset=False)
        if mesh is not None:
            options = {"location": "bottom", "aspect": 34, "label": "share of the states in a cell"}
            sheet.figure.colorbar(mesh, ax=axes, **options)
    return sheet


def _draw_plane(axes: Axes, x: Array, y: Array) -> QuadMesh | None:
    """Points, or the density of many, whose mesh is returned."""
    if len(x) <= _MOST_POINTS:
        size = 2 if len(x) > 500 else 4
        axes.plot(x, y, "o", color=look.BLUE, markersize=size, markeredgewidth=0, rasterized=True)
        return None
    share, *edges = np.histogram2d(x, y, _CELLS, [densities.limits_of(x), densities.limits_of(y)])
    cells = np.where(share > 0, share / len(x), np.nan).T
    norm = LogNorm(np.nanmin(cells), max(np.nanmax(cells), 2 * np.nanmin(cells)))
    return axes.pcolormesh(*edges, cells, cmap=densities.colour_map(), norm=norm, rasterized=True)


# --- words ---


def _outcome(result: Result, task: int) -> str:
    return str(result["diagram"]["outcome"][task])


def _words(result: Result, task: int, states: int) -> list[str]:
    """The task, and what its attractor is."""
    row = result["diagram"].task(task)
    period = int(row["attractor_period"][0])
    words = [*task_words(result, task), *lines.grazing_words(result, row)]
    words += [f"{states} iterates", f"period {period}" if period > 0 else lines.no_period(result)]
    if "exponents" in row:
        return [*words, f"exponents {', '.join(map(_exponent, row['exponents'][0]))} per iterate"]
    return [*words, f"exponent {_exponent(row['lyapunov'][0])} per iterate"] if "lyapunov" in row else words


def _exponent(value: float) -> str:
    return f"${value:.4f}$" if np.isfinite(value) else "unknown"
