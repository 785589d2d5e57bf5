"""Families of periodic motions as figures read them: what was followed, quantities, tasks, and segments as curves."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ricochet.plot.sheet import FigureError
from ricochet.plot.words import assignment, count, parameter_label, task_words, with_units
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

PARAMETER = "parameter"  # the quantity that is the parameter that is followed
QUANTITIES = {
    PARAMETER: "",
    "energy": "energy $E$",
    "amplitude": "amplitude, the largest $|q_i|$ over the period",
    "clearance": "smallest gap",
    "period": "period $T$",
    "frequency": r"frequency $2\pi/T$",
    "multiplier_max": "largest modulus of a multiplier",
}
INADMISSIBLE = "inadmissible"  # the look of a part of a segment whose solutions are no motions
_BORDERS = ("grazing", "impact_lost", "impulse_sign", "order")  # at which solutions cease to be motions, or begin
_CHANGES = ("fold", "branch_point", "symmetry_breaking", "energy_extreme", "period_doubling", "torus")  # of stability


# --- results ---


def followed(result: Result) -> str:
    """The key of the parameter that is followed."""
    return str(result["branch/point"].attributes("parameter")["parameter"])


def second(result: Result) -> str:
    """The key of the second parameter of curves."""
    return str(result["branch/curve"].attributes("second")["parameter"])


def is_modes(result: Result) -> bool:
    """Whether the motions are those of nonlinear modes: without force or losses, along energy or period."""
    conservative = result.parameters["orbit.motion"] in ("even", "conservative")
    return conservative and followed(result) in ("orbit.energy", "orbit.period")


def none_begins(result: Result) -> str:
    """Why nothing can be drawn; "" if there are points."""
    if len(result["branch/point"]):
        return ""
    return f"no branch of it begins ({', '.join(sorted(set(result['branch']['outcome'])))})"


def is_sound(table: Table) -> Array:
    """Whether the points of a table are motions [rows]."""
    return np.isin(table["outcome"], ("admissible", "grazing"))


# --- quantities ---


def quantity(result: Result, name: str | None, usual: str) -> str:
    """The name of a quantity that was asked for, or the usual one."""
    if name is None:
        return usual
    if name not in QUANTITIES:
        raise FigureError(result.path, f"there is no quantity {name}; there are {', '.join(QUANTITIES)}")
    if not np.isfinite(values(result["branch/point"], name)).any():
        raise FigureError(result.path, f"the {name} is not known of any point")
    return name


def usual_quantity(result: Result) -> str:
    """What is drawn against the parameter: of forced motions the energy of the first state says little."""
    if result.parameters["orbit.motion"] == "forced":
        return "amplitude"
    return "frequency" if followed(result) == "orbit.energy" else "energy"


def values(table: Table, name: str) -> Array:
    """A quantity of points or special points [rows]."""
    return 2 * np.pi / table["period"] if name == "frequency" else table[name]


def label(result: Result, name: str) -> str:
    """A quantity as the label of an axis."""
    if name == PARAMETER:
        return parameter_label(result, followed(result))
    units = None if name == "frequency" else result["branch/point"].attributes(name).get("units")
    return with_units(QUANTITIES[name], units)


def component(result: Result, states: Mapping[str, Array], name: str) -> Array:
    """A displacement or a velocity by its name, q0 or v1, of histories {"q", "v"} [point, sample, particle]:
    [point, sample]."""
    last = states["q"].shape[2] - 1
    kind, particle = name[:1], name[1:]
    if kind not in ("q", "v") or not particle.isdecimal() or int(particle) > last:
        raise FigureError(result.path, f"there is no component {name}; there are q0 to q{last} and v0 to v{last}")
    return states[kind][:, :, int(particle)]


# --- tasks ---


def _tasks(table: Table) -> Array:
    """The tasks that have rows in a table."""
    return np.asarray(np.unique(np.asarray(table.tasks)))


def check_task(result: Result, task: int) -> None:
    if not 0 <= task < result.sweep.tasks:
        raise FigureError(result.path, f"there is no task {task}; it has tasks 0 to {result.sweep.tasks - 1}")


def chosen_tasks(result: Result, wanted: Sequence[int] | None) -> list[int]:
    """The tasks to draw: those that have points."""
    for task in wanted or ():
        check_task(result, task)
    begun = set(_tasks(result["branch/point"]).tolist())
    tasks = [task for task in wanted or range(result.sweep.tasks) if task in begun]
    if not tasks:
        raise FigureError(result.path, "no branch of these tasks begins")
    return tasks


def task_with_motions(result: Result, wanted: int | None) -> int:
    """The task that was asked for, or the first one, that has an admissible motion."""
    points = result["branch/point"]
    sound = _tasks(points.where(is_sound(points)))
    if wanted is not None:
        check_task(result, wanted)
        if wanted not in sound:
            raise FigureError(result.path, f"no motion of task {wanted} is admissible")
        return wanted
    if len(sound) == 0:
        raise FigureError(result.path, "no motion of it is admissible")
    return int(sound[0])


def task_name(result: Result, task: int) -> str:
    """The swept values of a task, or the mode that the study names; "" without either."""
    if not result.swept and result.parameters["orbit.mode"] is not None:
        return assignment(result, "orbit.mode", result.parameters["orbit.mode"])
    return ", ".join(task_words(result, task))


# --- segments ---


class Segment:
    """One segment of a branch as a curve: nodes are its points and, between them, its special points.

    number, task  the segment of the task
    kinds         the kind of special point that a node is, "" of points [nodes]
    sound         whether a node belongs to a stretch of motions, or borders on one [nodes]
    looks         stable, unstable, undecided, unknown or inadmissible: of each part between neighbours [nodes - 1]
    """

    def __init__(self, task: int, number: int, points: Table, special: Table, first: int):
        """`first`: the place of its first point among the points of the task."""
        self.task, self.number = task, number
        self._tables = points, special
        places = np.concatenate([first + np.arange(len(points)), special["point"] + 0.5])
        self._order = np.argsort(places, kind="stable")
        self.kinds = np.concatenate([np.full(len(points), "", dtype=object), special["kind"]])[self._order]
        sound = _belongs(points["outcome"])
        self.looks = self._looks(sound, points["stable"])
        self.sound = self._sound(sound)

    def values(self, name: str) -> Array:
        """A quantity [nodes]."""
        return np.concatenate([values(table, name) for table in self._tables])[self._order]

    def pieces(self) -> Iterator[tuple[str, slice]]:
        """Runs of equal looks: the look, and the nodes."""
        changes = np.flatnonzero(self.looks[1:] != self.looks[:-1]) + 1
        for start, end in itertools.pairwise([0, *changes.tolist(), len(self.looks)]):
            if start < end:
                yield str(self.looks[start]), slice(start, end + 1)

    def lone(self) -> Array:
        """Motions that no part of the curve leads to [nodes]."""
        return np.asarray((self.kinds == "") & self.sound & ~self._touched())

    def _looks(self, sound: Array, stable: Array) -> Array:
        looks: list[str] = []
        at = np.flatnonzero(self.kinds == "")
        looks += [_look(sound[0], stable[0])] * at[0]
        for k, (a, b) in enumerate(itertools.pairwise(at)):
            looks += _between(self.kinds[a + 1 : b].tolist(), sound[k : k + 2], stable[k : k + 2])
        looks += [_look(sound[-1], stable[-1])] * (len(self.kinds) - 1 - at[-1])
        return np.array(looks, dtype=object)

    def _sound(self, points: Array) -> Array:
        sound = self._touched()
        sound[self.kinds == ""] = points
        return sound

    def _touched(self) -> Array:
        """Whether a part of motions ends at a node [nodes]."""
        drawn = np.concatenate([[False], self.looks != INADMISSIBLE, [False]])
        return np.asarray(drawn[1:] | drawn[:-1])


def _belongs(outcome: Array) -> Array:
    """Whether points of a segment belong to a stretch of motions: admissible ones, and grazing ones beside those."""
    admissible = outcome == "admissible"
    beside = np.concatenate([[False], admissible[:-1]]) | np.concatenate([admissible[1:], [False]])
    return np.asarray(admissible | ((outcome == "grazing") & beside))


def _look(sound: bool, stable: str) -> str:
    return str(stable) if sound else INADMISSIBLE


def _between(kinds: list[str], sound: Array, stable: Array) -> list[str]:
    """Looks of the parts between two points, with special points of these kinds in between.

    Admissibility changes at the first special point that is a border of it, stability at the first that may change it.
    At a grazing point stability is unknown: the part beside it has that of its other end.
    """
    known = [other if one == "unknown" else one for one, other in zip(stable, stable[::-1])]
    border, change = _place(kinds, _BORDERS), _place(kinds, _CHANGES)
    looks = []
    for part in range(len(kinds) + 1):
        is_motion = bool(sound.all() if border is None else sound[int(part > border)])
        looks.append(_look(is_motion, known[1 if change is None else int(part > change)]))
    return looks


def _place(kinds: list[str], wanted: Sequence[str]) -> int | None:
    """The place of the first one of the wanted kinds."""
    return next((place for place, kind in enumerate(kinds) if kind in wanted), None)


def segments(result: Result, tasks: Sequence[int]) -> list[Segment]:
    """All segments of some tasks."""
    found = []
    for task in tasks:
        points, special = result["branch/point"].task(task), result["branch/special"].task(task)
        for number in np.unique(points["segment"]):
            rows = np.flatnonzero(points["segment"] == number)
            own = points.where(segment=number), special.where(segment=number)
            found.append(Segment(task, int(number), *own, int(rows[0])))
    return found


def segment_names(result: Result, task: int) -> list[str]:
    """The segments of a task in words: impacts per period, numbered where that does not tell them apart."""
    impacts = result["branch/segment"].task(task)["impacts"].tolist()
    names = [f"{count(number, 'impact')} per period" for number in impacts]
    if len(set(names)) == len(names):
        return names
    return [f"segment {place}: {name}" for place, name in enumerate(names)]
