"""Results of kind `trajectory` read for drawing: one task, its samples, impacts and obstacles.

A script is `run(draw, ...)` of one function from a Motion to a figure. Columns are read as they are asked for:
phase portraits of five particles do not read ten thousand.
"""

import os
import re

import h5py
import numpy as np

import figures
from figures import FigureError

SIDES = {"floor": 1, "wall": -1}
LABEL = r"displacement $q$"


def number_of(word):
    """A number of a study, also a multiple of pi; NaN for anything else (null, none, an unknown form)."""
    found = re.fullmatch(r"([-+.\deE]*)\s*(pi)?", word or "")
    try:
        factor = float(found[1] + ("1" if found[2] and found[1] in ("", "-", "+") else ""))
    except (TypeError, ValueError):
        return np.nan
    return factor * (np.pi if found[2] else 1)


class Impacts:
    """Impacts in the order of time: `time`, `particle`, `side` (+1 floor, -1 wall), `gap_rate`, `impulse`."""

    def __init__(self, **columns):
        self.__dict__.update(columns)

    def __len__(self):
        return len(self.time)

    def pick(self, mask):
        return Impacts(**{name: column[mask] for name, column in self.__dict__.items()})


class Motion:
    """One task of a result, from `start` to `end` (None: whole)."""

    def __init__(self, file, task, start=None, end=None):
        if "trajectory/outcome" not in file:
            raise FigureError("no /trajectory/outcome in it: not a result of kind trajectory")
        self._group = file["trajectory"]
        for name in ("t", "q"):
            self._need(name)
        outcomes = figures.names_of(self._group["outcome"])
        self.tasks, self.task = len(outcomes), task
        if not 0 <= task < self.tasks:
            raise FigureError(f"no task {task}, it has tasks 0 to {self.tasks - 1}")
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        self.outcome = outcomes[task]
        self.reason = figures.text_of(self._group["reason"][task]) if "reason" in self._group else ""
        self.particles = self._group["q"].shape[2]
        self._read_sweep(file)
        self._read_times(start, end)
        self.impacts = self._read_impacts()
        self._contacts = self._read_contacts()

    def _need(self, name):
        if name not in self._group:
            raise FigureError(f"no /trajectory/{name} in it")
        return self._group[name]

    def _read_sweep(self, file):
        """The values of the swept parameters in this task."""
        sweep = file["sweep"] if "sweep" in file else None
        names = figures.text_of(sweep.attrs.get("parameters", "")).split() if sweep is not None else []
        self.swept = {name: sweep[name][self.task] for name in names if name in sweep}

    def _read_times(self, start, end):
        """Samples reached in the window; `stopped` is the last one of a run that did not come to its end."""
        t = self._group["t"][self.task]
        reached = np.isfinite(t) & np.isfinite(self._group["q"][self.task, :, 0])
        self.stopped = None if reached.all() or not reached.any() else t[reached][-1]
        first, last = -np.inf if start is None else start, np.inf if end is None else end
        picked = reached & (t >= first) & (t <= last)
        rows = np.flatnonzero(picked)
        if len(rows) < 2:
            raise FigureError(f"task {self.task} has {len(rows)} samples to draw ({self.outcome}{self._why()})")
        self._rows = slice(rows[0], rows[-1] + 1)
        self.t = t[self._rows]
        finite = t[np.isfinite(t)]
        self.limits = (max(first, t[0]), min(last, finite[-1]))

    def _why(self):
        return f": {self.reason}" if self.reason else ""

    def _ragged(self, stem, names):
        """Rows of this task in a ragged table, within the window; None without the table."""
        if f"{stem}_offset" not in self._group:
            return None
        first, last = self._group[f"{stem}_offset"][self.task : self.task + 2]
        columns = {}
        for name in names:
            data = self._need(f"{stem}_{name}")
            enum = h5py.check_enum_dtype(data.dtype)
            columns[name] = (figures.names_of(data) if enum else data)[first:last]
        columns["side"] = np.array([SIDES.get(side, 0) for side in columns["side"]], int)
        rows = Impacts(**columns)
        inside = (rows.time >= self.t[0]) & (rows.time <= self.t[-1])
        rows = rows.pick(inside & (rows.particle >= 0) & (rows.particle < self.particles) & (rows.side != 0))
        return rows.pick(np.argsort(rows.time, kind="stable"))

    def _read_impacts(self):
        names = ("time", "particle", "side", "gap_rate", "impulse")
        rows = self._ragged("impact", names)
        empty = np.zeros(0)
        return rows if rows is not None else Impacts(**{name: empty for name in names})

    def _read_contacts(self):
        """Beginnings of contacts with compliant obstacles."""
        rows = self._ragged("event", ("time", "particle", "side", "kind"))
        return rows.pick(rows.kind == "contact") if rows is not None else None

    @property
    def hits(self):
        """Time, particle and side of impacts and of contacts with compliant obstacles."""
        parts = [part for part in (self.impacts, self._contacts) if part is not None]
        hits = Impacts(
            time=np.concatenate([part.time for part in parts]),
            particle=np.concatenate([part.particle for part in parts]).astype(int),
            side=np.concatenate([part.side for part in parts]).astype(int),
        )
        return hits.pick(np.argsort(hits.time, kind="stable"))

    def hitting(self):
        """Particles that hit, those with the most hits first, and how many hits each has."""
        particles, counts = np.unique(self.hits.particle, return_counts=True)
        order = np.argsort(-counts, kind="stable")
        return particles[order], counts[order]

    def q(self, particle=None):
        """Displacements [sample, particle] or of one particle [sample]."""
        return self._column("q", particle)

    def v(self, particle=None):
        if self._need("v").shape[2] != self.particles:
            raise FigureError("its speeds do not belong to its coordinates one by one")
        return self._column("v", particle)

    def _column(self, name, particle):
        which = slice(None) if particle is None else particle
        with figures.readable():
            return self._need(name)[self.task, self._rows, which]

    def obstacles(self, name):
        """Position of the obstacle `floor` or `wall` of each particle, NaN where there is none.

        As the study says it, or the sweep; where the study says it in a form unknown here, though the particle
        hit, from the motion: its displacement at the hit closest to a sample.
        """
        words = self.study.places(name, self.particles)
        positions = np.full(self.particles, np.nan)
        for i, word in enumerate(words[: self.particles]):
            positions[i] = number_of(word)
        for parameter, value in self.swept.items():
            found = re.fullmatch(rf"model\.{name}(?:\[(\d+)\])?", parameter)
            if found:
                positions[slice(None) if found[1] is None else int(found[1])] = value
        hits = self.hits.pick(self.hits.side == SIDES[name])
        for i in np.unique(hits.particle):
            if np.isnan(positions[i]):
                positions[i] = self._met(i, hits.time[hits.particle == i])
        return positions

    def _met(self, particle, times):
        """Displacement at one of the times, along the straight line of the nearest sample."""
        before = np.clip(np.searchsorted(self.t, times, side="right") - 1, 0, len(self.t) - 2)
        near = np.where(times - self.t[before] < self.t[before + 1] - times, before, before + 1)
        best = np.argmin(np.abs(times - self.t[near]))
        speed = self.v(particle)[near[best]] if "v" in self._group else 0.0
        return self.q(particle)[near[best]] + speed * (times[best] - self.t[near[best]])

    def met_obstacles(self):
        """The obstacles that were hit: {name: positions, NaN elsewhere}."""
        hits = self.hits
        met = {}
        for name, side in SIDES.items():
            met[name] = np.full(self.particles, np.nan)
            which = np.unique(hits.particle[hits.side == side])
            met[name][which] = self.obstacles(name)[which]
        return met

    def period(self):
        """The period of the orbit that the study starts on, None if it names none."""
        swept = self.swept.get("orbit.period")
        period = number_of(self.study.word("period")) if swept is None else swept
        return period if period > 0 else None

    def count_of_hits(self, particle=None):
        """How many impacts, and contacts with compliant obstacles, there were: "3 impacts", "no impact"."""
        words = []
        for name, rows in (("impact", self.impacts), ("contact", self._contacts)):
            count = 0 if rows is None else len(rows.particle if particle is None else
                                               rows.particle[rows.particle == particle])
            if count:
                words.append(f"{count} {name}{'s' if count > 1 else ''}")
        return ", ".join(words) or "no impact"

    def subtitle(self):
        """What is drawn in one line: model, parameters, task, outcome."""
        parts = figures.fixed_parameters(self.study, self.particles, self.swept)
        parts += [f"{figures.parameter_symbol(name)} = {value:.6g}" for name, value in self.swept.items()]
        if self.tasks > 1:
            parts.append(f"task {self.task}")
        if self.stopped is not None:
            parts.append(f"stopped at $t = {self.stopped:.4g}$ ({self.outcome.replace('_', ' ')})")
        parts.append(self.count_of_hits())
        return ", ".join(parts + ["all quantities dimensionless"])


def hatch(axes, position, side, left=None, right=None, depth=None):
    """An obstacle: its surface, and hatching on the side where no particle may go, to the edge of the axes or as a
    strip of some depth. The limits of the axes stay."""
    limits = axes.get_ylim()
    beyond = limits[0 if side > 0 else 1] if depth is None else position - side * depth
    left, right = axes.get_xlim() if left is None else (left, right)
    look = {"facecolor": "#f4f4f4", "edgecolor": "#9a9a9a", "hatch": "//////", "linewidth": 0}
    axes.fill_between([left, right], position, beyond, zorder=0.5, **look)
    axes.hlines(position, left, right, color=figures.INK, linewidth=1.1, zorder=1.5)
    axes.set_ylim(limits)


def put_title(figure, axes, motion, width, pad=None):
    """Title above the figure and subtitle above `axes`, wrapped; `pad` leaves room for a line of the panel's own."""
    figures.put_title(figure, axes, motion, width)
    lines = [""]
    for part in motion.subtitle().split(", "):
        seen = len(re.sub(r"[$\\ ]|gamma", "", lines[-1] + part))  # of mathematics, less than is written
        if seen < width or not lines[-1]:
            lines[-1] += (", " if lines[-1] else "") + part
        else:
            lines[-1:] = [lines[-1] + ",", part]
    axes.set_title("\n".join(lines), loc="left", color=figures.FAINT, pad=pad)


def add_options(parser):
    parser.add_argument("--task", type=int, default=0, metavar="K", help="task of the sweep, from 0 (default 0)")
    parser.add_argument("--from", type=float, dest="start", metavar="T", help="first time (default: the first sample)")
    parser.add_argument("--to", type=float, dest="end", metavar="T", help="last time (default: the last sample)")


def stem_of(options, suffix):
    """The default name of another task than the first has its number, so that pictures stay apart."""
    return figures.stem_of(options, suffix + (f"_{options.task}" if options.task else ""))


def with_motion(options, action):
    """Calls `action(motion)` while the file is open."""
    if not os.path.isfile(options.result):
        raise FigureError("no such file")
    with figures.readable():
        file = h5py.File(options.result, "r")
    with file:
        with figures.readable():
            motion = Motion(file, options.task, options.start, options.end)
        return action(motion)


def run(draw, suffix, description, add_own=None):
    """The main function of a script: options, motion, `draw(motion, options)`, both files."""
    parser = figures.make_parser(suffix, description)
    add_options(parser)
    if add_own:
        add_own(parser)
    options = parser.parse_args()

    def action():
        figure = with_motion(options, lambda motion: draw(motion, options))
        figures.save(figure, stem_of(options, suffix))

    return figures.exit_code(options, action)
