"""Outcomes of orbits, and the special points along their sweep, in the words of figures."""

from __future__ import annotations

import numpy as np

from ricochet.plot.pattern import hitting
from ricochet.result import Result
from ricochet.sweep import Array

CRITICAL = {"plus_one": "pair at +1", "minus_one": "pair at \u22121", "collision": "collision"}
NOT_ADMISSIBLE = "not admissible"
LABELS = ("resonance", "idle resonance", "singular", "free impulses", *CRITICAL.values())


def pulls(result: Result) -> Array:
    """Tasks with an impulse that is not positive [tasks]."""
    impulses = result["orbits"]["impulse"]
    return np.asarray(~(impulses > 0).all(axis=1))


def sound(result: Result) -> Array:
    """Tasks whose orbit breaks no condition, drawn with full lines [tasks].

    Of a resonant task the file holds one of many orbits, which need not be admissible.
    """
    orbits = result["orbits"]
    resonant = (orbits["outcome"] == "resonant") & ~pulls(result) & ~(orbits["clearance"] < 0)
    return np.asarray(np.isin(orbits["outcome"], ("admissible", "grazing")) | resonant)


def detailed(result: Result) -> Array:
    """Outcomes, `inadmissible` split by what fails: an impulse that is not positive, else an obstacle that is passed."""
    outcome = result["orbits"]["outcome"].astype(object)
    bad = outcome == "inadmissible"
    outcome[bad & pulls(result)] = "inadmissible: impulse not positive"
    outcome[bad & ~pulls(result)] = "inadmissible: obstacle passed"
    return outcome


def stability(result: Result, all: bool) -> Array:
    """Words of the stability [tasks], NOT_ADMISSIBLE of orbits that are not, unless all are asked for."""
    return np.where(sound(result) | all, result["orbits"]["stable"], NOT_ADMISSIBLE)


def special_label(kind: str, outcome: str) -> str:
    """What a special point does to the orbit, one of LABELS.

    A resonance matters where the outcome exactly there is grazing or resonant; a zero of the determinant is singular
    unless its equations are solvable.
    """
    if kind in CRITICAL:
        return CRITICAL[kind]
    if kind == "resonance":
        return "resonance" if outcome in ("grazing", "resonant") else "idle resonance"
    return "free impulses" if outcome == "resonant" else "singular"


def special_points(result: Result) -> dict[str, Array]:
    """{label: parameters in rising order, each once}; empty if the study did not ask for special points."""
    if "special" not in result:
        return {}
    table = result["special"]
    labels = np.array([special_label(*row) for row in zip(table["kind"], table["outcome"])], dtype=object)
    # Modes p and n - p of a ring resonate together: one line.
    return {
        label: np.unique(np.round(table["parameter"][labels == label], 13))
        for label in LABELS
        if (labels == label).any()
    }


# --- the impacts ---


def impacts(result: Result) -> tuple[str, list[int]]:
    """("particle", those of the impulses [impacts]); ("impact", 0, 1, ...) if one of them is swept."""
    particles = [particle for when in hitting(result) for particle in when]
    count = result["orbits"]["impulse"].shape[1]
    return ("particle", particles) if len(particles) == count else ("impact", list(range(count)))
