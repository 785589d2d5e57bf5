"""The impact pattern of a study in words: which particles hit, and when."""

from __future__ import annotations

from collections.abc import Sequence

from ricochet.result import Result

_KEYS = ("orbit.at_start", "orbit.at_half")
_MOST_ITEMS = 6  # of a row of particles that is written out


def hitting(result: Result) -> tuple[list[int], list[int]]:
    """The particles that hit at t = 0, and those that hit half a period later; without those that are swept."""
    start, half = (
        [particle for i, particle in enumerate(result.parameters[key].tolist()) if f"{key}[{i}]" not in result.swept]
        for key in _KEYS
    )
    return start, half


def pattern(result: Result) -> list[str]:
    """The pattern in words, for headings; [] if there is none, if it is swept, or if it goes without saying."""
    start, half = hitting(result)
    count = sum(len(result.parameters[key]) for key in _KEYS)
    if not count or len(start) + len(half) < count or result.parameters["model.particles"] == 1:
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
