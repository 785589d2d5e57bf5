"""Grazing of a linear oscillator beside one obstacle in closed form, to compare computed curves with."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ricochet.plot.words import is_alone, obstacles
from ricochet.result import Result
from ricochet.sweep import Array


def grazing_force(result: Result, task: int) -> Callable[[Array], Array] | None:
    """Amplitude of the force at which the motion without impacts grazes, as a function of its frequency:
    |b| |k - m w^2 + i c w|. None for systems that are not linear, not alone, or have none or two obstacles."""
    values = result.parameters_of(task)
    if values["orbit.motion"] != "forced" or not is_alone(result):
        return None
    numbers = {name: np.ravel(values.get(f"model.{name}", 0)) for name in ("mass", "stiffness", "damping")}
    bent = [np.ravel(values.get(f"model.{name}", 0)) for name in ("quadratic", "cubic")]
    places = np.concatenate([*obstacles(result, task).values()])
    places = places[np.isfinite(places)]
    if np.any(np.concatenate(bent)) or len(places) != 1 or values.get("model.hertz") is not None:
        return None
    mass, stiffness, damping = (float(numbers[name][0]) for name in ("mass", "stiffness", "damping"))
    place = abs(float(places[0]))
    return lambda frequency: place * np.hypot(stiffness - mass * frequency**2, damping * frequency)


def distance(result: Result, task: int, parameters: dict[str, Array]) -> float:
    """Largest relative distance of a curve of grazing points {parameter: its values} from the closed form, NaN if there
    is none in the plane of these parameters."""
    form = grazing_force(result, task)
    if form is None or parameters.keys() != {"model.force", "model.frequency"}:
        return np.nan
    force, exact = np.abs(parameters["model.force"]), form(parameters["model.frequency"])
    return float(np.max(np.abs(force - exact) / np.maximum(exact, 1e-300), initial=0))
