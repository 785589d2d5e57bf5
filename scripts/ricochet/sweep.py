"""The swept parameters of a study: the grid that its tasks span, and values that are asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
ROUNDING = 1e-9  # relative difference of values that count as equal: a study may write 1/3 in decimals


class Sweep:
    """The grid of the tasks; the last parameter varies fastest.

    names   the swept parameters in the order of the study: ("orbit.period", "model.gamma")
    shape   the number of values of each; () if nothing is swept
    axes    {name: its values [points]}, in the order of the study
    values  {name: its value at every task [tasks]}
    """

    def __init__(self, names: Sequence[str], shape: Sequence[int], values: Mapping[str, Array]):
        self.names = tuple(names)
        self.shape = tuple(shape)
        self.values = dict(values)
        self.axes = {name: self._axis(place) for place, name in enumerate(self.names)}

    @property
    def tasks(self) -> int:
        """The number of tasks."""
        return math.prod(self.shape)

    def _axis(self, place: int) -> Array:
        along = tuple(slice(None) if other == place else 0 for other in range(len(self.shape)))
        return self.values[self.names[place]].reshape(self.shape)[along]

    def full_name(self, name: str) -> str:
        """The swept parameter of this name; "gamma" is enough for "model.gamma" if no other one ends so.

        Raises ValueError with a sentence if there is none, or more than one.
        """
        if name in self.names:
            return name
        found = [full for full in self.names if full.rpartition(".")[2] == name]
        if len(found) == 1:
            return found[0]
        if found:
            raise ValueError(f"{name} may be {' or '.join(found)}")
        raise ValueError(f"{name} is not swept; the study sweeps {', '.join(self.names) or 'nothing'}")

    def nearest(self, name: str, value: float, exact: bool = False) -> float:
        """The value of the sweep nearest to `value`; with `exact` one that differs by rounding only.

        Raises ValueError with a sentence for a value outside the sweep, and with `exact` for one that is not in it.
        """
        axis = self.axes[name]
        low, high = float(axis.min()), float(axis.max())
        slack = ROUNDING * max(abs(low), abs(high))
        if not low - slack <= value <= high + slack:
            raise ValueError(f"{name} = {value:.12g} lies outside the sweep, {low:.12g} to {high:.12g}")
        found = float(axis[np.argmin(np.abs(axis - value))])
        if exact and abs(found - value) > slack:
            raise ValueError(f"{name} = {value:.12g} is not in the sweep; the nearest value is {found:.17g}")
        return found
