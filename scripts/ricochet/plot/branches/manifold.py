"""The invariant manifold of a nonlinear mode: the surface that the motions of a family sweep in the space of three of
their displacements and velocities."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox

from ricochet.plot import look
from ricochet.plot.branches import family
from ricochet.plot.catalogue import figure
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.words import count, state_symbol
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

_LINES = 9  # single motions of a segment
_ZOOMS = (1.15, 1.05, 0.95, 0.85, 0.75, 0.65)  # of the box, from the largest
_VIEW = {"elev": 22, "azim": -58}


@figure(
    "branch",
    shows="the surface that the motions of a family sweep: the invariant manifold of a nonlinear mode",
    columns=("branch/point/history_q", "branch/point/history_v"),
    reason=lambda result: family.none_begins(result) or _one_particle(result),
    natural=family.is_modes,
    source="[VID] Figure 2, right",
    options={
        "task": "which task, from 0; default: the first one with a motion",
        "x": "component on the first axis, as q0 or v1; default: q0",
        "y": "component on the second axis; default: v0",
        "z": "component on the third, vertical axis; default: q1",
        "energy_high": "largest energy of the motions; default: all",
    },
)
def manifold(
    result: Result,
    *,
    task: int | None = None,
    x: str | None = None,
    y: str | None = None,
    z: str | None = None,
    energy_high: float | None = None,
) -> Figure:
    """The surface of the admissible motions of a task, coloured by their energy; dark lines are single motions. Each
    segment of the branch is a surface of its own."""
    task = family.task_with_motions(result, task)
    points = _motions(result, task, energy_high)
    names = x or "q0", y or "v0", z or "q1"
    norm = Normalize(points["energy"].min(), points["energy"].max())
    sheet = Sheet(result, 8.4, 5.2 if is_narrow() else 5.9)
    axes = sheet.panel(projection="3d", computed_zorder=False)
    for segment in np.unique(points["segment"]):
        part = points.where(segment=segment)
        states = {"q": part["history_q"], "v": part["history_v"]}
        _draw_segment(axes, [family.component(result, states, name) for name in names], part["energy"], norm)
    _frame(axes, names)
    bar = _draw_bar(sheet, norm)
    left = len(result["branch/point"].task(task)) - len(points)
    if left:
        limit = "" if energy_high is None else f" or above the energy {energy_high:g}"
        sheet.note(f"{count(left, 'point')} that {'is' if left == 1 else 'are'} not admissible{limit}: not drawn")
    name = family.task_name(result, task)
    about = "surface of the motions of a family" + (f": {name}" if name else "")
    drawn = sheet.finish(about=about, varied=[family.followed(result)])
    _fit(drawn, axes, bar)
    return drawn


def _one_particle(result: Result) -> str:
    alone = result.parameters["model.particles"] == 1
    return "the motions of one particle have a plane, not a space; figure motions draws them" if alone else ""


def _motions(result: Result, task: int, energy_high: float | None) -> Table:
    """The admissible points of a task up to an energy."""
    points = result["branch/point"].task(task)
    wanted = family.is_sound(points)
    if energy_high is not None:
        wanted &= points["energy"] <= energy_high
    if not wanted.any():
        raise FigureError(result.path, f"no motion of task {task} up to the energy {energy_high:g} is admissible")
    return points.where(wanted)


def _draw_segment(axes: Any, values: list[Array], energy: Array, norm: Normalize) -> None:
    """A surface; the first and the last column of an impact differ in velocity, and are not joined."""
    colours = look.colour_map()(norm(np.repeat(energy[:, None], values[0].shape[1], axis=1)))
    if len(energy) > 1:
        still = {"rstride": 1, "cstride": 1, "linewidth": 0, "antialiased": False, "shade": False}
        axes.plot_surface(*values, facecolors=colours, alpha=0.72, **still)
    for k in np.unique(np.linspace(0, len(energy) - 1, _LINES).astype(int)):
        axes.plot(*(value[k] for value in values), color=look.INK, linewidth=0.7, alpha=0.8)


def _frame(axes: Any, names: tuple[str, str, str]) -> None:
    for put, name in zip((axes.set_xlabel, axes.set_ylabel, axes.set_zlabel), names):
        put(state_symbol(name), labelpad=1 if is_narrow() else 6)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis) if is_narrow() else ():
        axis.set_major_locator(MaxNLocator(4))
        axis.set_tick_params(pad=1)
    axes.view_init(**_VIEW)


def _draw_bar(sheet: Sheet, norm: Normalize) -> Axes:
    """The bar of energies: beside the surface, or below it where the sheet is narrow."""
    place = {"location": "bottom", "pad": 0.02} if is_narrow() else {"location": "right", "pad": 0.08}
    colours = ScalarMappable(norm, look.colour_map())
    bar = sheet.figure.colorbar(colours, ax=sheet.panels[0], label="energy $E$", shrink=0.6, aspect=30, **place)
    return bar.ax


def _fit(drawn: Figure, axes: Any, bar: Axes) -> None:
    """Zooms so that the labels of all axes lie inside the figure and beside the bar: matplotlib's layout does not know
    labels in space."""
    left, bottom, width, height = drawn.get_layout_engine().get()["rect"]
    room = Bbox.from_bounds(left, bottom, width, height).transformed(drawn.transFigure)
    for zoom in _ZOOMS:
        axes.set_box_aspect(None, zoom=zoom)
        drawn.draw_without_rendering()
        renderer = drawn.canvas.get_renderer()
        labels = [axis.label.get_window_extent(renderer) for axis in (axes.xaxis, axes.yaxis, axes.zaxis)]
        box = Bbox.union([axes.get_tightbbox(renderer), *labels])
        inside = box.x0 >= room.x0 and box.x1 <= room.x1 and box.y0 >= room.y0 and box.y1 <= room.y1
        if inside and not box.overlaps(bar.get_tightbbox(renderer)):
            return
