"""Results of kind `trajectory` for the tests of the figures, written without the program.

A ring of unit masses moves exactly, mode by mode, between impacts; the impacts are bisected and reflect the
velocity. Good enough for pictures, no reference for the program.
"""

import h5py
import numpy as np

OUTCOMES = ("completed", "event_limit", "blow_up", "callback_failed", "ended")
KINDS = (
    "transversal", "grazing", "simultaneous", "coupled", "chatter", "rest", "release", "contact", "parting",
)  # fmt: skip


class Ring:
    def __init__(self, particles, gamma):
        self.particles = particles
        phase = 2 * np.pi * np.arange(particles // 2 + 1) / particles
        self.omega = np.sqrt(1 + 4 * gamma * np.sin(phase / 2) ** 2)

    def course(self, q, v):
        """Displacements after some time without impacts, as a function of it, one or several; and velocities."""
        a, b = np.fft.rfft(q), np.fft.rfft(v)
        angle = lambda dt: np.multiply.outer(dt, self.omega)  # noqa: E731
        back = lambda x: np.fft.irfft(x, self.particles)  # noqa: E731
        return (
            lambda dt: back(np.cos(angle(dt)) * a + np.sin(angle(dt)) / self.omega * b),
            lambda dt: back(np.cos(angle(dt)) * b - np.sin(angle(dt)) * self.omega * a),
        )

    def localised(self, period, particle, floor=-1.0):
        """Start of the orbit on which one particle hits its floor once per period."""
        delta = np.zeros(self.particles)
        delta[particle] = 1
        half = self.omega * period / 2
        shape = np.fft.irfft(np.fft.rfft(delta) / (2 * self.omega * np.tan(half)), self.particles)
        return shape * floor / shape[particle], delta / 2 * floor / shape[particle]


def is_inside(q, floor, wall):
    """Whether any particle has passed its floor or wall; NaN stands for none."""
    return ((q < floor) | (q > wall)).any(axis=-1)


def next_impact(place, dt, floor, wall):
    """Time of the first penetration within dt, found in steps of a fifth and bisected; None without."""
    times = np.linspace(0, dt, 6)
    inside = np.flatnonzero(is_inside(place(times[1:]), floor, wall))
    if len(inside) == 0:
        return None
    low, high = times[inside[0]], times[inside[0] + 1]
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_inside(place(middle), floor, wall) else (middle, high)
    return low


def reflect(t, q, v, floor, wall, restitution, impacts):
    for side, gap in ((1, q - floor), (-1, wall - q)):
        for i in np.flatnonzero((gap < 1e-9) & (side * v < 0)):
            impacts.append((t, i, side * v[i], -side * v[i] * (1 + restitution), side))
            v[i] *= -restitution


def move(ring, q, v, times, floor, wall, restitution=1.0):
    """States at the times, and impacts as (time, particle, gap rate, impulse, side)."""
    impacts, states = [], [(q, v)]
    t = times[0]
    for target in times[1:]:
        while t < target:
            place, speed = ring.course(q, v)
            dt = next_impact(place, target - t, floor, wall)
            q, v = (of(target - t if dt is None else dt) for of in (place, speed))
            t = target if dt is None else t + dt
            if dt is not None:
                reflect(t, q, v, floor, wall, restitution, impacts)
        states.append((q, v))
    return np.array([state[0] for state in states]), np.array([state[1] for state in states]), impacts


def enum(names, values=None):
    return h5py.enum_dtype({name: i for i, name in enumerate(names)} if values is None else values, "i1")


def write_ragged(group, stem, columns):
    """`columns`: {name: (lists per task, type)}."""
    lengths = [len(rows) for rows in next(iter(columns.values()))[0]]
    group[stem + "_offset"] = np.concatenate([[0], np.cumsum(lengths)])
    for name, (rows, dtype) in columns.items():
        flat = np.concatenate([np.asarray(row, float) for row in rows])
        group.create_dataset(f"{stem}_{name}", data=flat.astype("i8" if dtype != "f8" else "f8").astype(dtype))


def write(path, study, title, tasks, sweep=None):
    """`tasks`: (t, q, v, impacts, outcome, reason) each; `sweep`: {parameter: values}."""
    columns = [np.array(column) for column in list(zip(*tasks))[:3]]
    impacts = [task[3] for task in tasks]
    picked = lambda k: [[impact[k] for impact in rows] for rows in impacts]  # noqa: E731
    side = enum(None, {"floor": 1, "wall": -1})
    nothing = [[] for _ in tasks]
    with h5py.File(path, "w") as file:
        file.attrs.update(title=title, study=study)
        group = file.create_group("trajectory")
        outcome = [OUTCOMES.index(task[4]) for task in tasks]
        group.create_dataset("outcome", data=np.array(outcome, "i1"), dtype=enum(OUTCOMES))
        group["reason"] = np.array([task[5].encode() for task in tasks], "S80")
        group["t"], group["q"], group["v"] = columns
        zeros = [[0] * len(rows) for rows in impacts]
        write_ragged(group, "impact", {
            "time": (picked(0), "f8"), "particle": (picked(1), "i8"), "gap_rate": (picked(2), "f8"),
            "impulse": (picked(3), "f8"), "side": (picked(4), side), "kind": (zeros, enum(KINDS)),
        })  # fmt: skip
        write_ragged(group, "event", {
            "time": (nothing, "f8"), "particle": (nothing, "i8"), "side": (nothing, side),
            "kind": (nothing, enum(KINDS)), "depth": (nothing, "f8"), "accumulation": (nothing, "f8"),
        })  # fmt: skip
        sweep = sweep or {}
        group = file.create_group("sweep")
        group.attrs.update(parameters=" ".join(sweep), grid=[len(values) for values in sweep.values()])
        for name, values in sweep.items():
            group[name] = np.asarray(values, float)


STUDY = """kind: trajectory
title: {title}
model: {{type: chain, particles: {n}, ends: periodic, gamma: {gamma}, floor: {floor}, wall: {wall}}}
{start}
time: {{duration: {duration}, samples: {samples}}}
"""


def task_of(n, gamma, state, duration, samples, floor=-1.0, wall=np.nan, restitution=1.0, stop=None):
    """One task; after the sample `stop` the motion was not reached."""
    t = np.linspace(0, duration, samples)
    q, v, impacts = move(Ring(n, gamma), *state, t, floor, wall, restitution)
    if stop is None:
        return t, q, v, impacts, "completed", ""
    q[stop:], v[stop:] = np.nan, np.nan
    impacts = [impact for impact in impacts if impact[0] <= t[stop - 1]]
    return t, q, v, impacts, "event_limit", "more than 10 events within a unit of time"


def number(x):
    return "null" if np.isnan(x) else repr(float(x))


def text(title, n, gamma, duration, samples, floor="-1", wall="null", start="start: {}"):
    return STUDY.format(
        title=title, n=n, gamma=gamma, floor=floor, wall=wall, start=start, duration=duration, samples=samples
    )


def localised(path, particles=30, samples=2001, kick=0.0, periods=20):
    """[JAP]'s localised orbit over 20 periods; with a kick it wanders off."""
    gamma, period = 0.149153131912, 4.69756390941
    q, v = Ring(particles, gamma).localised(period, particles // 2)
    v[particles // 2 - 1] += kick
    title = "one impacting particle of 30 over 20 periods" if not kick else "the same start with a kick"
    start = f"orbit: {{period: {period}, at_start: [{particles // 2}]}}"
    study = text(title, particles, gamma, 20 * period, samples, start=start)
    write(path, study, title, [task_of(particles, gamma, (q, v), periods * period, samples)])


def crowd(path, particles=40, samples=1501, duration=60.0, scale=1.0, wall=1.2):
    """Random starts: nearly every particle hits its floor or wall."""
    random = np.random.default_rng(7)
    q = np.clip(scale * random.normal(size=particles), -0.9, 0.9)
    v = scale * random.normal(size=particles)
    title = f"{particles} particles between floor and wall"
    study = text(title, particles, 0.3, duration, samples, wall=wall)
    task = task_of(particles, 0.3, (q, v), duration, samples, wall=wall, restitution=0.98)
    write(path, study, title, [task])


def wave(path, particles=10000, samples=2001, duration=400.0):
    """A pulse that spreads in a long ring and hits on its way."""
    i = np.arange(particles) - particles / 2
    q = 3.0 * np.exp(-((i / (0.01 * particles)) ** 2)) * np.cos(0.5 * i)
    q = np.maximum(q, -0.99)
    title = f"a pulse in a ring of {particles} particles"
    study = text(title, particles, 2.0, duration, samples)
    write(path, study, title, [task_of(particles, 2.0, (q, 0 * q), duration, samples)])


def three(path):
    """A sweep over gamma with floors of their own; task 1 ended early, task 2 never moved nor hit."""
    floor = np.array([-0.6, np.nan, -0.8])
    start = np.array([0.9, 0.2, -0.5]), np.array([0.0, 0.4, 0.0])
    gammas, stops = [0.1, 0.3, 0.0], [None, 120, None]
    tasks = [
        task_of(3, gamma, start if gamma else (np.zeros(3), np.zeros(3)), 30.0, 401, floor, stop=stop)
        for gamma, stop in zip(gammas, stops)
    ]
    study = text("three $ particles", 3, 0.1, 30.0, 401, floor="[-0.6, null, -0.8]")
    write(path, study, "three $ particles", tasks, {"model.gamma": gammas})


def unreached(path):
    """A task that failed at once: no sample."""
    t = np.linspace(0, 1, 5)
    empty = np.full((5, 3), np.nan)
    write(path, text("none", 3, 0.1, 1, 5), "none", [(t, empty, empty, [], "blow_up", "force is not finite")])
