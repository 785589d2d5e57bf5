"""Floquet multipliers: those of one orbit in the complex plane, and moduli and arguments along a sweep."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.ticker import MultipleLocator

from ricochet.plot import look, scale
from ricochet.plot.catalogue import figure
from ricochet.plot.orbits import outcomes
from ricochet.plot.pattern import pattern
from ricochet.plot.sheet import FigureError, Sheet, is_narrow
from ricochet.plot.words import complex_number, parameter_label, task_words
from ricochet.result import Result
from ricochet.sweep import Array

_BAND = 1e-6  # moduli this near to 1 are drawn as on the circle
# Where: colour, marker, its size in the plane, along the sweep. With mu comes 1/conj(mu) of the same argument: the three
# markers of one place lie within one another, in the order of _OVER.
_PLACES: dict[str, tuple[str, str, float, float]] = {
    "on the circle": (look.BLUE, "o", 6.0, 1.5),
    "outside": (look.RED, "D", 5.5, 3.0),
    "inside": (look.ORANGE, "s", 6.0, 4.8),
}
_OVER = {"inside": 3.0, "outside": 3.1, "on the circle": 3.2}
_MOST = 1.9  # of the plane, from the origin; multipliers beyond are named at its edge
_FAINT = 0.3  # of orbits that are not admissible
_CRITICAL_DASHES = ((0, (5, 2)), (0, (1, 1.6)), (0, (1, 1, 4, 1)))
_TASK = {"color": look.GREEN, "linewidth": 1.2, "alpha": 0.7}


def _reason(result: Result) -> str:
    return "" if _known(result).any() else "no task of it has multipliers"


@figure(
    "orbits",
    shows="Floquet multipliers of one orbit in the complex plane, moduli and arguments along the sweep",
    columns=("orbits/multipliers",),
    reason=_reason,
    natural=lambda result: len(result.swept) < 2,
    options={"task": "the orbit in the plane; by default the first unstable one, or the last one"},
)
def multipliers(result: Result, *, task: int | None = None) -> Figure:
    """Multipliers of one orbit against the unit circle; of a sweep over one parameter moduli and arguments of all,
    faint where the orbit is not admissible, with the critical parameters as lines."""
    chosen = _choose(result, task)
    sheet, plane, panels = _lay_out(result, len(result.swept) == 1)
    values = result["orbits"]["multipliers"]
    _draw_plane(plane, values[chosen])
    shown = values if panels else values[[chosen]]
    sheet.legend([_entry(name) for name, where in _places(shown).items() if where.any()])
    if panels:
        sheet.legend(_draw_sweep(panels, result, chosen))
    number = [f"task {chosen}"] if result.sweep.tasks > 1 else []
    verdict = [str(result["orbits"]["stable"][chosen])] + [outcomes.NOT_ADMISSIBLE] * (
        not outcomes.sound(result)[chosen]
    )
    return sheet.finish(words=[*pattern(result), *task_words(result, chosen), *number, *verdict])


def _known(result: Result) -> Array:
    """Tasks whose multipliers are known [tasks]."""
    return np.asarray(np.isfinite(result["orbits"]["multipliers"]).all(axis=1))


def _choose(result: Result, wanted: int | None) -> int:
    """The task in the plane: the one wanted, else the first unstable or the last one of those that are sound."""
    known = _known(result)
    if wanted is not None:
        result.parameters_of(wanted)  # refuses a task that there is not
        if not known[wanted]:
            raise FigureError(result.path, f"the multipliers of task {wanted} are not known")
        return wanted
    good = known & outcomes.sound(result)
    good = good if good.any() else known
    unstable = np.flatnonzero(good & (result["orbits"]["stable"] == "unstable"))
    return int(unstable[0]) if len(unstable) else int(np.flatnonzero(good)[-1])


def _lay_out(result: Result, whole: bool) -> tuple[Sheet, Axes, list[Axes]]:
    """The plane; of a whole sweep two panels over one another, beside it or below."""
    if not whole:
        sheet = Sheet(result, 6.4, 6.0)
        return sheet, sheet.panel(), []
    if is_narrow():
        sheet = Sheet(result, 6.4, 9.0, rows=3, heights=(1.9, 1, 1))
        plane, cells = sheet.panel(0), ((1, 0), (2, 0))
    else:
        sheet = Sheet(result, 11.8, 5.4, rows=2, columns=2)
        plane, cells = sheet.panel(slice(None), 0), ((0, 1), (1, 1))
    upper = sheet.panel(*cells[0])
    return sheet, plane, [upper, sheet.panel(*cells[1], sharex=upper)]


def _places(values: Array) -> dict[str, Array]:
    """Masks of the multipliers in the order of _PLACES."""
    modulus = np.abs(values)
    masks = np.abs(modulus - 1) <= _BAND, modulus > 1 + _BAND, modulus < 1 - _BAND
    return dict(zip(_PLACES, masks))


def _entry(name: str) -> Artist:
    return Line2D([], [], linestyle="", label=name, **_marks(name))


def _marks(name: str, small: bool = False) -> dict[str, object]:
    """Squares are open; others have white edges unless they are small. All are smaller where the text is."""
    colour, marker, size, less = _PLACES[name]
    size = (less if small else size) * mpl.rcParams["font.size"] / 10
    look_of = {"marker": marker, "markersize": size, "color": colour}
    if marker == "s":
        return {**look_of, "markerfacecolor": "none", "markeredgewidth": 0.16 * size}
    return {**look_of, "markeredgecolor": "white", "markeredgewidth": 0 if small else 0.1 * size}


# --- one task ---


def _draw_plane(axes: Axes, values: Array) -> None:
    limit = min(max(1.25, 1.12 * np.abs(values).max()), _MOST)
    axes.add_patch(Circle((0, 0), 1, facecolor="#f5f5f5", edgecolor=look.INK, linewidth=1.1, zorder=1))
    for line in (axes.axhline, axes.axvline):
        line(0, color="#d5d5d5", linewidth=0.7, zorder=1.5)
    for name, where in _places(values).items():
        some = values[where & (np.abs(values) <= limit)]
        axes.plot(some.real, some.imag, linestyle="", zorder=4, **_marks(name))
    _name_far_ones(axes, values, limit)
    axes.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal")
    axes.set(xlabel=r"real part of $\mu$", ylabel=r"imaginary part of $\mu$")


def _name_far_ones(axes: Axes, values: Array, limit: float) -> None:
    """Multipliers beyond the plane shown: a mark at its edge, and their values."""
    far = values[(np.abs(values) > limit) & (values.imag >= 0)]
    real = np.abs(far.imag) < 1e-9
    marks = {"color": look.RED, "zorder": 5, "clip_on": False}
    box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1}
    for side, marker, ha in ((1, ">", "right"), (-1, "<", "left")):
        some = far[real & (side * far.real > 0)]
        if len(some):
            axes.plot(side * limit, 0, marker, markersize=8, **marks)
            axes.text(0.97 * side * limit, 0.06 * limit, _far_words(some), ha=ha, va="bottom", bbox=box, **marks)
    if len(far[~real]):
        ends = limit * far[~real] / np.abs(far[~real])
        axes.plot(ends.real, ends.imag, "^", markersize=8, **marks)
        axes.text(0, 0.93 * limit, _far_words(far[~real]), ha="center", va="top", bbox=box, **marks)


def _far_words(values: Array) -> str:
    """Up to four different values as text, the largest first."""
    order = np.argsort(-np.abs(values), kind="stable")
    texts = (f"${complex_number(mu if abs(mu.imag) >= 1e-9 else mu.real)}$" for mu in values[order].tolist())
    words = list(dict.fromkeys(texts))
    return "\n".join(words[:4] + ["\u2026"] * (len(words) > 4))


# --- all tasks ---


def _draw_sweep(panels: Sequence[Axes], result: Result, chosen: int) -> list[Artist]:
    """Moduli over arguments against the swept parameter, with the chosen task marked; entries of the legend."""
    name = result.swept[0]
    at, values, sound = result.sweep.values[name], result["orbits"]["multipliers"], outcomes.sound(result)
    modulus = np.abs(values)
    _scatter(panels[0], at, values, modulus, sound)
    _scatter(panels[1], at, values, np.abs(np.angle(values)) / np.pi, sound)
    _frame_moduli(panels[0], modulus[sound] if sound.any() else modulus)
    panels[1].set_ylim(-0.04, 1.04)  # with each multiplier comes its complex conjugate
    panels[1].yaxis.set_major_locator(MultipleLocator(0.25))
    panels[1].set_ylabel(r"argument $|\arg\,\mu|\,/\,\pi$")
    for axes in panels:
        axes.axvline(at[chosen], zorder=1, **_TASK)
    scale.frame_parameter(panels[0], at)
    panels[0].tick_params(labelbottom=False)
    panels[1].set_xlabel(parameter_label(result, name))
    entries: list[Artist] = [Line2D([], [], label="the orbit in the plane", **_TASK)]
    if not sound.all():
        faint = {"marker": "o", "linestyle": "", "markeredgewidth": 0, "alpha": _FAINT}
        entries.append(Line2D([], [], color=look.BLUE, label="faint: orbit not admissible", **faint))
    return entries + _draw_criticals(panels, result, sound)


def _scatter(axes: Axes, at: Array, values: Array, heights: Array, sound: Array) -> None:
    places = np.broadcast_to(at[:, None], values.shape)
    for name, where in _places(values).items():
        for rows, alpha in ((sound, 1.0), (~sound, _FAINT)):
            some = where & rows[:, None] & np.isfinite(heights)
            marks = _marks(name, small=True)
            axes.plot(
                places[some], heights[some], linestyle="", alpha=alpha, zorder=_OVER[name], rasterized=True, **marks
            )


def _frame_moduli(axes: Axes, shown: Array) -> None:
    """A logarithmic axis with 1 in its middle."""
    finite = shown[np.isfinite(shown) & (shown > 0)]
    reach = max(1.5, finite.max(initial=1), 1 / finite.min(initial=1)) ** 1.08
    axes.set_yscale("log")
    axes.set_ylim(1 / reach, reach)
    scale.label_decades(axes.yaxis)
    axes.set_ylabel(r"modulus $|\mu|$")


def _draw_criticals(panels: Sequence[Axes], result: Result, sound: Array) -> list[Artist]:
    """Critical parameters of sound orbits as lines through the panels; their entries of the legend."""
    entries: list[Artist] = []
    special, at = outcomes.special_points(result), result.sweep.values[result.swept[0]]
    for label, dashes in zip(outcomes.CRITICAL.values(), _CRITICAL_DASHES):
        where = special.get(label, np.zeros(0))
        where = where[sound[np.abs(at[None, :] - where[:, None]).argmin(axis=1)]]
        line = {"color": look.INK, "linestyle": dashes, "linewidth": 0.9}
        for axes in panels:
            axes.vlines(where, 0, 1, transform=axes.get_xaxis_transform(), zorder=2, **line)
        if len(where):
            values = ", ".join(f"{value:.6g}" for value in where[:3]) + (", \u2026" if len(where) > 3 else "")
            entries.append(Line2D([], [], label=f"{label}: {values}", **line))
    return entries
