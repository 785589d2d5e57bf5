"""A map of the outcomes of orbits over two parameters, beside it a quantity of the admissible ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ricochet.plot import grid, look
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import outcomes, resonance
from ricochet.plot.pattern import pattern
from ricochet.plot.sheet import Sheet, is_narrow
from ricochet.result import Result
from ricochet.sweep import Array

Quantity = Literal["energy", "clearance", "impulse", "none"]


@figure(
    "orbits",
    shows="outcomes over two parameters, beside them a quantity of the admissible orbits",
    swept=2,
    reason=grid.reason,
    natural=lambda result: "orbit.functions" not in result.swept,  # all approximate one orbit
    options={"quantity": "what the second panel shows; none for the outcomes alone", **grid.X_OPTION},
)
def map(result: Result, *, quantity: Quantity = "energy", x: str | None = None) -> Figure:  # noqa: A001
    """Cells in the colours of the outcomes; a quantity of the sound orbits, others left pale: what is not admissible is
    no motion."""
    tasks = grid.Grid(result, x)
    sheet, panels = grid.panels_of(result, 1 if quantity == "none" else 2)
    words = outcomes.detailed(result)
    sheet.legend(grid.draw_words(panels[0], tasks, words, look.OUTCOMES))
    if quantity != "none":
        sheet.legend(_draw_quantity(sheet, panels[1], tasks, quantity))
    finish_map(sheet, panels, tasks, words)
    return sheet.finish(words=pattern(result))


def finish_map(sheet: Sheet, panels: Sequence[Axes], tasks: grid.Grid, words: Array) -> None:
    """What all maps of orbits have: axes, the resonance of the highest mode, a note on lone cells."""
    for axes in panels:
        tasks.frame(axes)
    grid.label_once(panels)
    sheet.legend(resonance.draw(panels, tasks))
    grid.note_lone_cells(sheet, tasks, words)


def _draw_quantity(sheet: Sheet, axes: Axes, tasks: grid.Grid, name: Quantity) -> list[Artist]:
    column = tasks.result["orbits"][name]
    column = column[:, 0] if name == "impulse" else column
    sound = outcomes.sound(tasks.result)
    shown = sound & np.isfinite(column) & (column > 0)
    label = f"{_words(tasks.result, name)} of admissible orbits"
    grid.draw_numbers(sheet, axes, tasks, np.where(shown, column, np.nan), label, "no admissible orbit")
    if shown.all():
        return []
    place = "lower" if is_narrow() else "right"
    what = "not admissible" if shown[sound].all() else f"not admissible, or {_words(tasks.result, name)} not positive"
    return [Patch(facecolor=look.PALE, label=f"{place} panel: {what}")]


def _words(result: Result, name: Quantity) -> str:
    if name == "impulse" and result["orbits"]["impulse"].shape[1] > 1:
        noun, numbers = outcomes.impacts(result)
        return f"impulse of {noun} {numbers[0]}"
    return {"clearance": "smallest gap", "energy": "energy $E$"}.get(name, name)
