"""Outcomes of orbits, and the special points along their sweep, in the words of figures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ricochet.result import Result
from ricochet.sweep import Array

CRITICAL = {"plus_one": "pair at +1", "minus_one": "pair at \u22121", "collision": "collision"}
_MOST_ITEMS = 6  # particles that are written out
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


# --- the pattern ---


def hitting(result: Result) -> tuple[list[int], list[int]]:
    """The particles that hit at t = 0, and those that hit half a period later; without those that are swept."""
    start, half = (
        [particle for i, particle in enumerate(result.parameters[key].tolist()) if f"{key}[{i}]" not in result.swept]
        for key in ("orbit.at_start", "orbit.at_half")
    )
    return start, half


def impacts(result: Result) -> tuple[str, list[int]]:
    """("particle", those of the impulses [impacts]); ("impact", 0, 1, ...) if one of them is swept."""
    particles = [particle for when in hitting(result) for particle in when]
    count = result["orbits"]["impulse"].shape[1]
    return ("particle", particles) if len(particles) == count else ("impact", list(range(count)))


def pattern(result: Result) -> list[str]:
    """The pattern in words, for headings; [] if it is swept, or goes without saying."""
    start, half = hitting(result)
    if impacts(result)[0] == "impact" or result.parameters["model.particles"] == 1:
        return []
    if start and half:
        return [f"{_hits(result, start)} at $t = 0$", f"{list_text(half)} at $t = T/2$"]
    return [_hits(result, start or half)]


def _hits(result: Result, particles: Sequence[int]) -> str:
    if len(particles) == result.parameters["model.particles"]:
        return "all particles hit"
    return f"particle {particles[0]} hits" if len(particles) == 1 else f"particles {list_text(particles)} hit"


def list_text(particles: Sequence[int]) -> str:
    """Particles in a row, long rows shortened."""
    texts = [str(particle) for particle in particles]
    if len(texts) > _MOST_ITEMS:
        texts = [*texts[: _MOST_ITEMS - 2], "\u2026", texts[-1]]
    return ", ".join(texts)
