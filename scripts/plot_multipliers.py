#!/usr/bin/python3
"""Draws Floquet multipliers: those of one task in the complex plane, and, beside it, moduli and arguments of all.

Datasets: /orbits/multipliers and /orbits/stable (a study with orbit.multipliers); /orbits/outcome (orbits that are not
admissible are faint); the swept parameter of /sweep; the table /special where the study asked for it (critical
parameters as vertical lines). Multipliers come in pairs mu, 1/mu and mu, conj(mu): on the unit circle as long as the
orbit is stable. Without --task: the first unstable orbit, or the last one. Results without a sweep over one parameter
give the plane alone.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.ticker import MultipleLocator

import figures

BAND = 1e-6  # moduli this near to 1 are drawn as on the circle
PLACES = {
    "outside the circle": (figures.RED, "X"),
    "on it": (figures.BLUE, "o"),
    "inside": (figures.ORANGE, "s"),
}
MOST = 1.9  # of the plane, from the origin; multipliers beyond are named at its edge


def places(multipliers):
    """Masks of the multipliers outside the circle, on it and inside, in the order of PLACES."""
    modulus = np.abs(multipliers)
    return modulus > 1 + BAND, np.abs(modulus - 1) <= BAND, modulus < 1 - BAND


def choose(result, wanted):
    """The task in the plane: the one wanted, else the first unstable or the last one of those that are sound."""
    known = np.isfinite(result.need("multipliers")).all(axis=1)
    if wanted is not None:
        if not 0 <= wanted < len(known):
            raise figures.FigureError(f"no task {wanted}, it has tasks 0 to {len(known) - 1}")
        if not known[wanted]:
            raise figures.FigureError(f"the multipliers of task {wanted} are not known")
        return wanted
    if not known.any():
        raise figures.FigureError("no task of it has multipliers")
    good = known & result.sound if (known & result.sound).any() else known
    unstable = np.flatnonzero(good & (result.need_stable() == "unstable"))
    return int(unstable[0]) if len(unstable) else int(np.flatnonzero(good)[-1])


# --- one task ---


def far_words(multipliers):
    """Up to four different values as text, the largest first."""
    order = np.argsort(-np.abs(multipliers), kind="stable")
    texts = (
        f"{mu.real:.4g}" if abs(mu.imag) < 1e-9 else f"{mu.real:.3g} ± {mu.imag:.3g}i" for mu in multipliers[order]
    )
    words = list(dict.fromkeys(texts))
    return "\n".join(words[:4] + ["…"] * (len(words) > 4))


def name_far_ones(axes, multipliers, limit):
    """Multipliers beyond the plane shown: a mark at its edge, and their values."""
    far = multipliers[(np.abs(multipliers) > limit) & (multipliers.imag >= 0)]
    real = np.abs(far.imag) < 1e-9
    look = {"color": figures.RED, "zorder": 5, "clip_on": False}
    box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1}
    for side, marker in ((1, ">"), (-1, "<")):
        some = far[real & (side * far.real > 0)]
        if len(some):
            axes.plot(side * limit, 0, marker, markersize=8, **look)
            ha = "right" if side > 0 else "left"
            axes.text(side * limit, 0.05 * limit, far_words(some), ha=ha, va="bottom", bbox=box, **look)
    if len(far[~real]):
        ends = limit * far[~real] / np.abs(far[~real])
        axes.plot(ends.real, ends.imag, "^", markersize=8, **look)
        axes.text(0, 0.93 * limit, far_words(far[~real]), ha="center", va="top", bbox=box, **look)


def describe(result, task):
    """The task in words: its parameters, and the verdict."""
    parts = [
        f"{figures.parameter_symbol(name)} = {values[task]:.6g}" for name, values in zip(result.names, result.values)
    ]
    return ", ".join(parts + [f"task {task}" if parts else "", result.need_stable()[task]]).strip(", ")


def draw_plane(axes, result, task):
    multipliers = result.columns["multipliers"][task]
    modulus = np.abs(multipliers)
    limit = min(max(1.25, 1.12 * modulus.max()), MOST)
    axes.add_patch(Circle((0, 0), 1, facecolor="#f5f5f5", edgecolor=figures.INK, linewidth=1.1, zorder=1))
    axes.axhline(0, color="#d5d5d5", linewidth=0.7, zorder=1.5)
    axes.axvline(0, color="#d5d5d5", linewidth=0.7, zorder=1.5)
    for (colour, marker), where in zip(PLACES.values(), places(multipliers)):
        inside = where & (modulus <= limit)
        axes.scatter(
            multipliers.real[inside], multipliers.imag[inside], s=34, c=colour, marker=marker, edgecolors="white",
            linewidths=0.6, zorder=4,
        )  # fmt: skip
    name_far_ones(axes, multipliers, limit)
    axes.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal")
    axes.set(xlabel=r"real part of $\mu$", ylabel=r"imaginary part of $\mu$")
    axes.text(0, 1.015, describe(result, task), weight="bold", va="bottom", transform=axes.transAxes)


# --- all tasks ---


def scatter(axes, result, heights):
    """A point per multiplier of all tasks, faint where the orbit is not admissible."""
    multipliers = result.columns["multipliers"]
    for (colour, _), where in zip(PLACES.values(), places(multipliers)):
        for tasks, alpha in ((result.sound, 1.0), (~result.sound, 0.16)):
            rows, columns = np.nonzero(where & tasks[:, None])
            axes.scatter(result.values[0][rows], heights[rows, columns], s=5, c=colour, alpha=alpha, linewidths=0,
                         zorder=3, rasterized=True)  # fmt: skip


def draw_moduli(axes, result):
    modulus = np.abs(result.columns["multipliers"])
    scatter(axes, result, modulus)
    shown = modulus[result.sound] if result.sound.any() else modulus
    finite = shown[np.isfinite(shown) & (shown > 0)]
    reach = max(1.5, finite.max(initial=1), 1 / finite.min(initial=1)) ** 1.08
    axes.set_yscale("log")
    axes.set_ylim(1 / reach, reach)
    figures.label_decades(axes.yaxis)
    axes.set_ylabel(r"modulus $|\mu|$")


def draw_arguments(axes, result):
    """In [0, pi]: with each multiplier comes its complex conjugate."""
    scatter(axes, result, np.abs(np.angle(result.columns["multipliers"])) / np.pi)
    axes.set_ylim(-0.04, 1.04)
    axes.yaxis.set_major_locator(MultipleLocator(0.25))
    axes.set_ylabel(r"argument $|\arg\,\mu|\,/\,\pi$")


def near_sound(result, where):
    """The parameters whose nearest task is sound."""
    nearest = np.abs(result.values[0][None, :] - where[:, None]).argmin(axis=1)
    return where[result.sound[nearest]]


def draw_criticals(panels, result, span):
    """Critical parameters of sound orbits as lines through the panels; their legend entries."""
    entries = []
    styles = ((0, (5, 2)), (0, (1, 1.6)), (0, (1, 1, 4, 1)))
    for label, dashes in zip(figures.CRITICAL_LABELS.values(), styles):
        where = result.special.get(label, np.zeros(0))
        where = near_sound(result, where[(where >= span[0]) & (where <= span[1])])
        for axes in panels:
            axes.vlines(where, 0, 1, transform=axes.get_xaxis_transform(), color=figures.INK, linestyle=[dashes],
                        linewidth=0.9, zorder=2)  # fmt: skip
        if len(where):
            values = ", ".join(f"{value:.6g}" for value in where[:3]) + (", …" if len(where) > 3 else "")
            look = {"color": figures.INK, "linestyle": dashes, "linewidth": 0.9}
            entries.append(Line2D([], [], label=f"{label}: {values}", **look))
    return entries


def draw_sweep(panels, result, task):
    """Moduli over arguments against the swept parameter, with the chosen task marked."""
    at = result.values[0]
    draw_moduli(panels[0], result)
    draw_arguments(panels[1], result)
    for axes in panels:
        axes.axvline(at[task], color=figures.GREEN, linewidth=1.2, alpha=0.7, zorder=1)
        if figures.is_geometric(at):
            axes.set_xscale("log")
        else:
            pad = 0.02 * np.ptp(at) or 0.05 * max(abs(at[0]), 1.0)
            axes.set_xlim(at.min() - pad, at.max() + pad)
    panels[0].tick_params(labelbottom=False)
    panels[1].set_xlabel(figures.parameter_label(result.names[0]))
    entries = [Line2D([], [], color=figures.GREEN, linewidth=1.2, alpha=0.7, label="the task on the left")]
    if not result.sound.all():
        look = {"marker": "o", "linestyle": "", "markeredgewidth": 0, "alpha": 0.3}
        entries.append(Line2D([], [], color=figures.BLUE, label="faint: orbit not admissible", **look))
    return entries + draw_criticals(panels, result, (at.min(), at.max()))


def lay_out(whole):
    """The plane, on its right two panels over one another if `whole`, below a row for the legend."""
    figure = plt.figure(figsize=(11.8, 6.3) if whole else (6.4, 7.0), constrained_layout=True)
    cells = figure.add_gridspec(3, 2 if whole else 1, height_ratios=[1, 1, 0.16])
    plane = figure.add_subplot(cells[:2, 0])
    panels = [figure.add_subplot(cells[row, 1]) for row in (0, 1)] if whole else []
    return figure, plane, panels, figure.add_subplot(cells[2, :])


def draw(result, options):
    task = choose(result, options.task)
    figure, plane, panels, legend = lay_out(len(result.names) == 1)
    draw_plane(plane, result, task)
    entries = [
        Line2D([], [], linestyle="", marker=marker, color=colour, markeredgecolor="white", markersize=8, label=name)
        for (name, (colour, marker)), where in zip(PLACES.items(), places(result.columns["multipliers"]))
        if where.any()
    ]
    if panels:
        entries += draw_sweep(panels, result, task)
    figures.legend_row(legend, entries, 3 if panels else 2)
    figures.put_title(figure, plane, result, 112 if panels else 60)
    plane.set_title(plane.get_title(loc="left"), loc="left", color=figures.FAINT, pad=22)
    return figure


def options(parser):
    parser.add_argument("--task", type=int, metavar="K", help="task to draw in the plane, from 0")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "multipliers", __doc__, options))
