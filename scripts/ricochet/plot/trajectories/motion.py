"""One task of a result of kind trajectory: its samples, impacts and obstacles in a window of time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ricochet.plot import words
from ricochet.plot.sheet import FigureError, is_narrow
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

UPWARDS = {"floor": 1, "wall": -1}  # sign of the velocity away from an obstacle
LABEL = "displacement $q$"
OPTIONS = {
    "task": "task of the sweep, from 0; default: the first, the middle and the last one",
    "start": "first time",
    "end": "last time",
}
_FEWEST_SAMPLES = 20  # of a study that wants a motion to be seen
_MOST_TASKS = 3  # of a sweep, of which pictures are drawn
_REACH = 0.5  # how far outside the displacements, over their range, an obstacle is in sight


def pen() -> float:
    """Width of lines over that in wide figures; areas of marks go with its square."""
    return 0.65 if is_narrow() else 1.0


def moving(result: Result) -> Array:
    """Tasks whose motion has two samples or more; refused ones have none."""
    table = result["trajectory"]
    return np.flatnonzero(table["time"] >= table["t"][:, 1])


def picked_tasks(result: Result) -> list[int]:
    """Some of the tasks that move, evenly picked."""
    tasks = moving(result)
    picked = np.linspace(0, len(tasks) - 1, min(len(tasks), _MOST_TASKS)).round().astype(int)
    return [int(task) for task in tasks[picked]]


def is_sampled(result: Result) -> bool:
    """Whether there are samples enough for curves: studies of exponents have two."""
    return bool(result.parameters["time.samples"] >= _FEWEST_SAMPLES)


@dataclass(frozen=True)
class Hits:
    """Impacts, and contacts with compliant obstacles, in the order of time: columns [hits]."""

    time: Array
    particle: Array
    side: Array  # "floor" or "wall"

    def __len__(self) -> int:
        return len(self.time)

    def where(self, mask: Array) -> Hits:
        return Hits(self.time[mask], self.particle[mask], self.side[mask])


class Motion:
    """One task between two times.

    t, q, v    states that the run reached: [samples], [samples, particles]
    impacts    rows of the table trajectory/impact in that time
    contacts   beginnings of contacts with compliant obstacles: rows of trajectory/event
    hits       both of them
    obstacles  {"floor": places [particles], "wall": ...}, NaN where there is none
    limits     the times of the window that the run reached
    stopped    the time at which a run ended early; None of one that is complete
    """

    def __init__(self, result: Result, task: int | None = None, start: float | None = None, end: float | None = None):
        self.result = result
        self.task = task if task is not None else next(iter(moving(result).tolist()), 0)
        self._table = result["trajectory"].task(self.task)
        self.parameters = result.parameters_of(self.task)
        self.obstacles = words.obstacles(result, self.task)
        self.outcome, self.reason = str(self._table["outcome"][0]), str(self._table["reason"][0])
        self.stopped = None if self.outcome == "completed" else float(self._table["time"][0])
        self._read_samples(start, end)
        self.particles = self.q.shape[1]
        self.impacts = self._events("impact")
        self.contacts = self._events("event").where(kind="contact")

    def _read_samples(self, start: float | None, end: float | None) -> None:
        t, q = self._table["t"][0], self._table["q"][0]
        first, last = max(t[0] if start is None else start, t[0]), min(t[-1] if end is None else end, t[-1])
        rows = np.flatnonzero(np.isfinite(q[:, 0]) & (t >= first) & (t <= last))
        if len(rows) < 2:
            why = ": ".join(filter(None, (self.outcome, self.reason)))
            span = "" if start is None and end is None else f" from t = {first:g} to {last:g}"
            raise FigureError(self.result.path, f"task {self.task} has {len(rows)} samples to draw{span} ({why})")
        last = last if self.stopped is None else min(last, self.stopped)
        self._rows = slice(rows[0], rows[-1] + 1)
        self.t, self.q = t[self._rows], q[self._rows]
        self.limits = (float(first), float(last))

    @cached_property
    def v(self) -> Array:
        return np.asarray(self._table["v"][0, self._rows])

    def _events(self, name: str) -> Table:
        table = self.result[f"trajectory/{name}"].task(self.task)
        return table.where((table["time"] >= self.t[0]) & (table["time"] <= self.t[-1]))

    @cached_property
    def hits(self) -> Hits:
        parts = (self.impacts, self.contacts)
        time, particle, side = (np.concatenate([part[name] for part in parts]) for name in ("time", "particle", "side"))
        return Hits(time, particle, side).where(np.argsort(time, kind="stable"))

    @property
    def hitting(self) -> Array:
        """Particles that hit, in the order of their numbers."""
        return np.unique(self.hits.particle)

    @property
    def period(self) -> float | None:
        """The period of the orbit that the study starts on."""
        found: float | None = self.parameters.get("orbit.period")
        return found

    def in_sight(self, low: float, high: float) -> dict[str, Array]:
        """Obstacles that are hit, or near displacements from `low` to `high`: {side: [particles]}, NaN for others."""
        reach = _REACH * (high - low)
        found = {}
        for side, places in self.obstacles.items():
            hit = np.isin(np.arange(self.particles), self.hits.particle[self.hits.side == side])
            near = (places >= low - reach) & (places <= high + reach)
            found[side] = np.where(hit | near, places, np.nan)
        return found

    # --- in words ---

    def words(self) -> list[str]:
        """What the heading says of the task: its parameters, its number, how many impacts."""
        found = words.task_words(self.result, self.task)
        if self.result.sweep.tasks > 1:
            found.append(f"task {self.task}")
        if self.stopped is not None:
            found.append(f"stopped at $t = {words.number(self.stopped, 4)}$")
        return [*found, self.count_of_hits()]

    def notes(self) -> list[str]:
        """Why a run ended early."""
        if self.stopped is None:
            return []
        return [f"{self.outcome.replace('_', ' ')}: {self.reason}".rstrip(": ")]

    def count_of_hits(self, particle: int | None = None) -> str:
        """How many impacts, and contacts with compliant obstacles, there were: "3 impacts", "no impact"."""
        found = []
        for noun, rows in (("impact", self.impacts), ("contact", self.contacts)):
            number = len(rows) if particle is None else int((rows["particle"] == particle).sum())
            if number:
                found.append(words.count(number, noun))
        return ", ".join(found) or words.count(0, "impact")
