"""Grazing in closed form: of a linear oscillator that is driven beside one obstacle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ricochet.plot.words import is_alone, obstacles
from ricochet.result import Result
from ricochet.sweep import Array

_PAIR = {"model.force", "model.frequency"}  # the plane in which the form is a curve


def grazing_form(result: Result, task: int) -> Callable[[Array], Array] | None:
    """The amplitude of the force with which the motion without impacts just touches the obstacle, of the frequency:
    A^2 = b^2 ((k - m w^2)^2 + c^2 w^2), b the distance of the obstacle. None for other models and parameters."""
    values = result.parameters_of(task)
    is_driven = values["orbit.motion"] == "forced"
    is_plane = {values["branch.parameter"], values["branch.trace.parameter"]} == _PAIR
    is_linear = not any(np.any(values[f"model.{term}"]) for term in ("quadratic", "cubic"))
    places = np.concatenate(list(obstacles(result, task).values()))
    places = places[np.isfinite(places)]
    if not (is_driven and is_plane and is_linear and is_alone(result) and len(places) == 1):
        return None
    mass, stiffness, damping = (
        float(np.ravel(values[f"model.{name}"])[0]) for name in ("mass", "stiffness", "damping")
    )
    return lambda frequency: abs(places[0]) * np.hypot(stiffness - mass * frequency**2, damping * frequency)
