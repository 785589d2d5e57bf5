"""Bifurcation diagrams: the kept iterates against the last swept parameter."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ricochet.plot.catalogue import figure
from ricochet.plot.diagrams import coordinates, densities, lines, panels, rows
from ricochet.plot.diagrams.coordinates import Abscissa, Ordinate
from ricochet.plot.diagrams.lines import Line
from ricochet.plot.sheet import FigureError, Sheet
from ricochet.result import Result

_TOP, _EXPONENTS, _DISTANCE = 4.1, 1.25, 1.4  # heights of panels, inches
_Draw = Callable[[Sheet, Axes, Line, Abscissa], None]
_PERIOD_OF = {"values": "attractor_period", "map_values": "map_period"}
_LINE_OPTION = {"line": "which line of the grid along the last sweep, from 0; default: each, of more than 8 a few"}


def _parts(result: Result) -> list[int]:
    return lines.spread(lines.count(result))


@figure(
    "diagram",
    shows="iterates along the last sweep, with exponents, periods, windows and the distance from the return map",
    columns=("diagram/values",),
    reason=lines.needs_sweep,
    source="[FN97] Figure 4",
    part="line",
    parts=_parts,
    options={**_LINE_OPTION, "values": "the values themselves, not over the root of the parameter"},
)
def diagram(result: Result, *, line: int | None = None, values: bool = False) -> Figure:
    """The density of the iterates of every task, on a logarithmic scale of colours; below it the largest Lyapunov
    exponent, periods and windows.

    Of a sweep that goes back, what is found with rising values is blue, with falling ones red, both together dark:
    where the colours part, there are two attractors. Of motions beyond grazing the motion is blue and its return map
    (5.11) of [FN97] red, and the lowest panel is the distance between them over the extent of the map's values.
    """
    chosen = _chosen(result, line)
    x = coordinates.along(chosen)
    return _drawn(chosen, x, coordinates.plain(chosen) if values else coordinates.upwards(chosen))


def _not_scalable(result: Result) -> str:
    """Why a result has no scaled view; "" if it has one."""
    name = result.swept[-1] if result.swept else "nothing"
    if name != "model.d" or (result.sweep.axes[name] <= 0).any():
        return f"this figure needs a map along positive model.d, the last sweep is over {name}"
    return ""


@figure(
    "diagram",
    shows="the diagram of a map as z1 / sqrt(d) over ln sqrt(d) / ln lambda",
    source="[FN97] Figure 5",
    columns=("diagram/values",),
    reason=_not_scalable,
    natural=lambda result: False,
    part="line",
    parts=_parts,
    options={**_LINE_OPTION, "multiplier": "the dominant multiplier lambda; default: that of the study"},
)
def scaled(result: Result, *, line: int | None = None, multiplier: float | None = None) -> Figure:
    """As d tends to zero, the part between two whole numbers repeats."""
    chosen = _chosen(result, line)
    x = coordinates.scaled(chosen, multiplier)
    return _drawn(chosen, x, coordinates.over_root(chosen))


def _chosen(result: Result, line: int | None) -> Line:
    chosen = lines.picked(result, line)
    if not np.isfinite(chosen.table["values"]).any():
        raise FigureError(result.path, f"no iterate of line {chosen.index} is finite")
    return chosen


def _drawn(line: Line, x: Abscissa, y: Ordinate) -> Figure:
    lower = _lower_panels(line)
    heights = [_TOP, *(height for height, _ in lower)]
    sheet = Sheet(line.result, 8.8, sum(heights), rows=len(heights), heights=heights)
    top = sheet.panel(0)
    x.frame(top)
    mesh = _draw_values(sheet, top, line, x, y)
    for k, (_, draw) in enumerate(lower, 1):
        sheet.panels[-1].tick_params(labelbottom=False, which="both")
        draw(sheet, sheet.panel(k, sharex=top), line, x)
    sheet.panels[-1].set_xlabel(x.label)
    if mesh is not None:
        where = {"shrink": _TOP / sum(heights), "anchor": (0, 1), "aspect": 28, "pad": 0.025}
        sheet.figure.colorbar(mesh, ax=sheet.panels, label="share of the iterates in a cell", **where)
    _note_missing(sheet, line)
    return sheet.finish(varied=lines.varied(line.result), words=[*lines.line_words(line), *y.words, *_one_period(line)])


def _lower_panels(line: Line) -> list[tuple[float, _Draw]]:
    """Height and function of each."""
    found: list[tuple[float, _Draw]] = []
    if "lyapunov" in line.table and np.isfinite(line.table["lyapunov"]).any():
        found.append((_EXPONENTS, panels.draw_exponents))
    if rows.is_wanted(line):
        found.append((rows.height(line), rows.draw))
    if panels.has_distance(line):
        found.append((_DISTANCE, panels.draw_distance))
    return found


def _draw_values(sheet: Sheet, axes: Axes, line: Line, x: Abscissa, y: Ordinate) -> QuadMesh | None:
    """One density, whose mesh is returned, or two in colours of the legend."""
    series = panels.series(line, "values", "map_values")
    columns = [x.pick(y.of(line, name), way) for name, way in series]
    limits = densities.limits_of(*columns)
    periods = [x.pick(line.table[_PERIOD_OF[name]], way) for name, way in series]
    found = [densities.Density(values, period, x.edges, limits) for values, period in zip(columns, periods)]
    axes.set(ylim=limits, ylabel=y.label)
    if len(found) == 1:
        if (periods[0] > 0).any():
            sheet.note("a line of an attractor of period n has 1/n of the iterates")
        return densities.draw(axes, found[0])
    densities.draw_two(axes, *found)
    words = [f"with {word} values" for word in line.words] if line.goes_back else ["motion", "its return map"]
    colours = [densities.FIRST, densities.SECOND, densities.both()]
    sheet.legend([Patch(facecolor=colour, label=word) for colour, word in zip(colours, [*words, "both"])])
    return None


def _one_period(line: Line) -> list[str]:
    """The period of all tasks, where no panel shows it."""
    period = line.table["attractor_period"]
    if rows.is_wanted(line):
        return []
    return [f"period {period[0]}" if period[0] else lines.no_period(line.result)]


def _note_missing(sheet: Sheet, line: Line) -> None:
    lost = np.isin(line.table["outcome"], ("diverged", "failed"))
    if lost.any():
        sheet.note(f"{lost.sum()} of {len(lost)} points have diverged or failed")
    if "lyapunov" in line.table and not np.isfinite(line.table["lyapunov"]).any():
        sheet.note("no exponent is known")
    if line.goes_back and "map_values" in line.table:
        sheet.note("the return map is not drawn where the sweep goes back")
