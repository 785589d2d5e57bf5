"""Windows of a line, in which the period is constant, and their edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ricochet.plot.diagrams.lines import Line
from ricochet.sweep import Array

SIDES = ("low", "high")
_SAME_EDGE = 1e-3  # relative difference of edges that are one
_NO_EDGE = ("open", "regular", "none")  # kinds of edges where the search came to its bounds
_NUMBERS = ("period", "impacts", "parameter")


@dataclass(frozen=True)
class Windows:
    """Windows by rising period. Arrays [window], those of edges by their side.

    edge    where the window ends, NaN if it is not located
    kind    what ends it
    closed  the edge in the closed form of the map
    reason  why it is not located, "" if it is
    """

    period: Array
    impacts: Array
    parameter: Array
    edge: dict[str, Array]
    kind: dict[str, Array]
    closed: dict[str, Array]
    reason: Array

    def __len__(self) -> int:
        return len(self.period)

    @property
    def located(self) -> Array:
        """Which have both edges [window]."""
        return np.asarray(np.isfinite(self.edge["low"]) & np.isfinite(self.edge["high"]))

    def found(self, side: str) -> Array:
        """Edges, NaN also where the search came to its bounds."""
        return np.where(np.isin(self.kind[side], _NO_EDGE), np.nan, self.edge[side])

    def take(self, rows: Array) -> Windows:
        """Some of them, by a condition or by their indices."""
        columns: dict[str, Any] = {name: getattr(self, name)[rows] for name in (*_NUMBERS, "reason")}
        sides: dict[str, Any] = {
            name: {side: getattr(self, name)[side][rows] for side in SIDES} for name in ("edge", "kind", "closed")
        }
        return Windows(**columns, **sides)

    def own(self) -> Windows:
        """Those that repeat no other one by a multiple of its period, as slow transients make them."""
        return self.take(np.array([not self._repeats(row) for row in range(len(self))], dtype=bool))

    def _repeats(self, row: int) -> bool:
        """Whether a shorter period that divides this one has a window at its value."""
        at, period, low, high = self.parameter[row], self.period[row], self.edge["low"], self.edge["high"]
        shorter = self.located & (self.period < period) & (period % self.period == 0)
        same = np.isclose(low, low[row], _SAME_EDGE, 0) | np.isclose(high, high[row], _SAME_EDGE, 0)
        times = self.impacts[row] == period // self.period * self.impacts
        alike = (same & times) | ~self.located[row]
        return bool((shorter & alike & (low <= at) & (at <= high)).any())

    def one_impact(self) -> Windows:
        """Those with one impact and both edges, one for each period."""
        rows = np.flatnonzero(self.located & (self.impacts == 1))
        return self.take(rows[np.unique(self.period[rows], return_index=True)[1]])


def windows_of(line: Line) -> Windows | None:
    """The windows of a line; None if the study did not ask for them."""
    if "window" not in line.result:
        return None
    table = line.result["window"]
    tasks = table["task"]
    table = table.where((tasks >= line.first) & (tasks < line.first + len(line.table)))
    order = np.lexsort((table["parameter"], table["period"]))
    return Windows(
        **{name: table[name] for name in _NUMBERS},
        edge={side: table[side] for side in SIDES},
        kind={side: table[f"{side}_kind"] for side in SIDES},
        closed={side: table[f"map_{side}"] for side in SIDES},
        reason=table["reason"],
    ).take(order)
