"""The frequency-energy plot of nonlinear modes: the frequency of periodic motions against their energy."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from ricochet.plot.branches import family
from ricochet.plot.branches.plane import Plane
from ricochet.plot.catalogue import figure
from ricochet.plot.words import count
from ricochet.result import Result


@figure(
    "branch",
    shows="frequency of the motions against their energy: of nonlinear modes",
    reason=family.none_begins,
    source="[VID] Figure 2, left",
    natural=family.is_modes,
    options={
        "tasks": "draw these tasks only, from 0",
        "all": "solutions of the equations that are not admissible, too",
        "resonances": "mark resonances, too",
    },
)
def frequency_energy(
    result: Result, *, tasks: Sequence[int] | None = None, all: bool = False, resonances: bool = False
) -> Figure:
    """The frequency 2 pi / period of the motions against their energy, on a logarithmic axis. Resonances, of which
    there are many and which do not change the shape of a family, are marked on request only."""
    chosen = family.chosen_tasks(result, tasks)
    plane = Plane(result, "energy", "frequency", chosen, all, () if resonances else ("resonance",))
    hidden = count(plane.hidden, "resonance") + " not marked: --resonances marks them" if plane.hidden else ""
    return plane.picture(logarithmic=True, notes=[hidden])
