"""A map of the stability of orbits over two parameters, beside it the largest multiplier of the unstable ones."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ricochet.plot import grid, look
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import outcomes
from ricochet.plot.orbits.maps import finish_map
from ricochet.plot.pattern import pattern
from ricochet.plot.sheet import Sheet, is_narrow
from ricochet.result import Result
from ricochet.sweep import Array

_LOOKS = {**look.STABILITIES, outcomes.NOT_ADMISSIBLE: ("#ededed", "", ".")}


@figure(
    "orbits",
    shows="stability over two parameters, beside it the largest multiplier of unstable orbits",
    columns=("orbits/stable", "orbits/multiplier_max"),
    swept=2,
    reason=grid.reason,
    natural=lambda result: "orbit.functions" not in result.swept,  # all approximate one orbit
    options={"all": "orbits that are not admissible, too", **grid.X_OPTION},
)
def stability(result: Result, *, all: bool = False, x: str | None = None) -> Figure:
    """Cells in the colours of the stability; the largest modulus of a multiplier mu where the orbit is
    unstable."""
    tasks = grid.Grid(result, x)
    sheet, panels = grid.panels_of(result, 2)
    words = outcomes.stability(result, all)
    sheet.legend(grid.draw_words(panels[0], tasks, words, _LOOKS))
    sheet.legend(_draw_modulus(sheet, panels[1], tasks, words))
    finish_map(sheet, panels, tasks, words)
    if (words == outcomes.NOT_ADMISSIBLE).any():
        sheet.note("--all shows the stability of orbits that are not admissible, too")
    return sheet.finish(words=pattern(result))


def _draw_modulus(sheet: Sheet, axes: Axes, tasks: grid.Grid, words: Array) -> list[Artist]:
    largest = tasks.result["orbits"]["multiplier_max"]
    shown = (words == "unstable") & np.isfinite(largest)
    label = r"largest $|\mu|$ of unstable orbits"
    grid.draw_numbers(sheet, axes, tasks, np.where(shown, largest, np.nan), label, "no unstable orbit")
    place = "lower" if is_narrow() else "right"
    return [] if shown.all() else [Patch(facecolor=look.PALE, label=f"{place} panel: no unstable orbit")]
