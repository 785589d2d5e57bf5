"""Branches: a quantity of the periodic motions against the parameter that is followed, with every special point."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from ricochet.plot.branches import family
from ricochet.plot.branches.plane import Plane
from ricochet.plot.catalogue import figure
from ricochet.result import Result

_NAMES = ", ".join(family.QUANTITIES)


@figure(
    "branch",
    shows="a quantity of the motions along their branches, with every special point",
    reason=family.none_begins,
    natural=lambda result: not family.is_modes(result),
    options={
        "x": f"against what: {_NAMES}; default: parameter",
        "y": "what is drawn, likewise; default: amplitude of forced motions, frequency along the energy, else energy",
        "tasks": "draw these tasks only, from 0",
        "all": "solutions of the equations that are not admissible, too",
    },
)
def branch(
    result: Result, *, x: str | None = None, y: str | None = None, tasks: Sequence[int] | None = None, all: bool = False
) -> Figure:
    """A quantity of the motions against the parameter that is followed. Full lines are stable, dashed ones unstable;
    where special points lie on one another, an inset shows them larger."""
    along = family.quantity(result, x, family.PARAMETER)
    up = family.quantity(result, y, family.usual_quantity(result))
    plane = Plane(result, along, up, family.chosen_tasks(result, tasks), all)
    logarithmic = along == family.PARAMETER and result.parameters["branch.scale"] == "log"
    return plane.picture(logarithmic)
