#!/usr/bin/python3
"""Draws a sweep over one parameter: outcome, impulses, energy and smallest gap against the parameter.

Datasets: /orbits/outcome (strip), /orbits/impulse, /orbits/energy, /orbits/clearance, and the table /special
where the study asked for it (vertical lines). Full lines are sound orbits, dashed ones inadmissible. A line
ends at values that are not finite and at singular points, where the amplitude passes through infinity.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import figures

SPECIAL_LOOK = {
    "resonance": ("resonance: a mode carries the orbit, or is free", (0, (1, 1.6)), figures.GREEN),
    "idle resonance": ("resonance of a mode that the impacts hold", None, figures.FAINT),
    "singular": ("singular point: amplitudes blow up", (0, (5, 2)), figures.RED),
    "free impulses": ("singular but solvable: not unique", None, figures.PINK),
    "pair at +1": ("multipliers leave or join the circle at +1", None, figures.BLUE),
    "pair at \u22121": ("multipliers leave or join the circle at \u22121", None, figures.SKY),
    "collision": ("pairs of multipliers collide on the circle", None, figures.ORANGE),
}
RARE = ("grazing", "resonant", "singular", "not_converged", "failed")


class Curve:
    """One quantity along the sorted parameter, cut where it must not be joined."""

    def __init__(self, at, values, sound, cuts):
        self.at, self.values, self.sound, self.cuts = at, values, sound, cuts

    def pieces(self, sound):
        """Runs of joined points, as index arrays: full lines join sound points, dashed ones take the rest."""
        here = np.isfinite(self.values)
        joined = here[:-1] & here[1:] & ~self.cuts
        full = self.sound[:-1] & self.sound[1:]
        wanted = joined & (full if sound else ~full)
        return [np.arange(first, last + 2) for first, last in runs(wanted)]

    def lone(self):
        """Finite points joined to no neighbour, which no line would show."""
        here = np.isfinite(self.values)
        joined = here[:-1] & here[1:] & ~self.cuts
        return here & ~np.append(joined, False) & ~np.insert(joined, 0, False)

    def draw(self, axes, colour, width=1.6):
        for sound, look in (
            (True, {"linewidth": width}),
            (False, {"linewidth": 0.75 * width, "alpha": 0.55, "linestyle": (0, (4, 1.6))}),
        ):
            for piece in self.pieces(sound):
                axes.plot(self.at[piece], self.values[piece], color=colour, zorder=3, **look)
        lone = self.lone()
        few = len(self.at) <= 80
        dots = np.isfinite(self.values) if few else lone
        axes.plot(
            self.at[dots & self.sound],
            self.values[dots & self.sound],
            ".",
            color=colour,
            markersize=5,
            zorder=3,
        )
        axes.plot(
            self.at[dots & ~self.sound],
            self.values[dots & ~self.sound],
            ".",
            color=colour,
            markersize=5,
            markerfacecolor="white",
            zorder=3,
        )


def runs(flags):
    """First and last index of every run of true values."""
    edges = np.diff(np.concatenate([[0], flags.astype(int), [0]]))
    return list(zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1))


def find_cuts(at, impulses, special):
    """Intervals between neighbours that hold a singular point.

    Listed, or inferred from an impulse that changes its sign and grows towards the interval from both sides.
    """
    cuts = np.zeros(max(len(at) - 1, 0), bool)
    for where in special.get("singular", []):
        i = np.searchsorted(at, where) - 1
        if 0 <= i < len(cuts):
            cuts[i] = True
    if len(at) >= 4:
        size = np.abs(impulses)
        grows = (size[1:-2] > size[:-3]) & (size[2:-1] > size[3:])
        flips = impulses[1:-2] * impulses[2:-1] < 0
        cuts[1:-1] |= (grows & flips).any(axis=1)
    return cuts


def group_impulses(result, impulses):
    """Impulses that are equal in every row as one curve: [(column, label)]."""
    particles = result.study.at_start + result.study.at_half
    named = len(particles) == impulses.shape[1]
    groups = []
    for column in range(impulses.shape[1]):
        scale = np.nanmax(np.abs(impulses), initial=1e-300, axis=1)
        for group in groups:
            if np.allclose(
                impulses[:, column] / scale, impulses[:, group[0]] / scale, atol=1e-9, equal_nan=True
            ):
                group.append(column)
                break
        else:
            groups.append([column])
    return [
        (group[0], label_impulses([particles[i] if named else i for i in group], named)) for group in groups
    ]


def label_impulses(members, named):
    shown = ", ".join(map(str, members if len(members) <= 6 else members[:3] + ["…", members[-1]]))
    word = "particle" if named else "impact"
    return f"{word}s {shown} (equal)" if len(members) > 1 else f"{word} {shown}"


def strip_edges(at, logarithmic):
    """Borders of the tasks in the strip: halfway between them, a hundredth of the range beyond the ends."""
    scaled = np.log(at) if logarithmic else at
    edges = np.concatenate([scaled[:1], 0.5 * (scaled[1:] + scaled[:-1]), scaled[-1:]])
    pad = 0.01 * np.ptp(scaled) or 0.05 * max(abs(scaled[0]), 1.0)
    edges[[0, -1]] += [-pad, pad]
    return np.exp(edges) if logarithmic else edges


def is_thin(where, edges):
    width = sum(edges[last + 1] - edges[first] for first, last in runs(where))
    return width < 0.02 * (edges[-1] - edges[0])


def draw_strip(axes, at, outcome, edges):
    """The outcomes as a coloured strip; the rare ones also as markers, since one task is a hair wide."""
    entries = []
    for name in figures.ordered(outcome):
        face, hatch, marker = figures.OUTCOME_LOOK.get(name, figures.OTHER_LOOK)
        where = outcome == name
        for first, last in runs(where):
            axes.axvspan(
                edges[first],
                edges[last + 1],
                facecolor=face,
                edgecolor=figures.FAINT,
                hatch=hatch,
                linewidth=0,
            )
        label = f"{name.replace('_', ' ')} ({where.sum()})"
        if name in RARE and is_thin(where, edges):
            axes.plot(
                at[where],
                np.full(where.sum(), 0.5),
                marker,
                color=face,
                markeredgecolor="white",
                markersize=9,
                clip_on=False,
                zorder=5,
            )
            entries.append(
                Line2D([], [], linestyle="", marker=marker, color=face, markersize=8, label=label)
            )
        else:
            entries.append(
                Patch(facecolor=face, edgecolor=figures.FAINT, hatch=hatch, linewidth=0, label=label)
            )
    axes.set(ylim=(0, 1), yticks=[0.5], yticklabels=["outcome"])
    return entries


def draw_special(panels, rug, result, edges):
    """Special points: ticks in the rug, and faint lines through the panels for those that change the orbit."""
    entries = []
    height = 1 / max(len(result.special), 1)
    for row, (kind, places) in enumerate(result.special.items()):
        text, dashes, colour = SPECIAL_LOOK[kind]
        inside = places[(places >= edges[0]) & (places <= edges[-1])]
        rug.vlines(
            inside, 1 - (row + 0.88) * height, 1 - (row + 0.12) * height, color=colour, linewidth=1.3
        )
        for axes in panels if dashes else []:
            axes.vlines(
                inside,
                0,
                1,
                transform=axes.get_xaxis_transform(),
                color=colour,
                linestyle=[dashes],
                linewidth=0.8,
                alpha=0.55,
                zorder=1,
            )
        if len(inside):
            entries.append(
                Line2D(
                    [], [], color=colour, linestyle=dashes or "-", linewidth=1.2, label=f"{text} ({len(inside)})"
                )
            )
    kinds = [kind for kind in result.special]
    rug.set(ylim=(0, 1), yticks=[1 - (row + 0.5) * height for row in range(len(kinds))], yticklabels=kinds)
    return entries


def frame(axes, values, sound, logarithmic):
    """Limits of the value axis that blow-ups cannot squeeze; a note where they leave it."""
    values = values.astype(float)
    if logarithmic:
        values = np.where(values > 0, values, np.nan)
        axes.set_yscale("log")
    shown = np.log10(values) if logarithmic else values
    low, high, clipped = figures.robust_limits(
        shown.ravel(), np.broadcast_to(sound, shown.T.shape).T.ravel()
    )
    axes.set_ylim(*(10.0 ** np.array([low, high]) if logarithmic else (low, high)))
    if clipped:
        axes.set_title(figures.clip_note(values), loc="right", fontsize=9, color=figures.FAINT, pad=2)


def draw_impulses(axes, result, order, at, cuts):
    impulses = result.columns["impulse"].reshape(len(order), -1)[order]
    groups = group_impulses(result, impulses)
    for i, (column, label) in enumerate(groups):
        colour = figures.CYCLE[i % len(figures.CYCLE)]
        Curve(at, impulses[:, column], result.sound[order], cuts).draw(
            axes, colour, 1.6 + 0.9 * (len(groups) - 1 - i)
        )
        axes.plot([], [], color=colour, label=label)
    if impulses.shape[1] > 1 and len(groups) <= 6:
        axes.legend(loc="best", handlelength=1.2)
    frame(axes, impulses, result.sound[order], False)
    axes.axhline(0, color=figures.FAINT, linewidth=0.7, zorder=1)
    axes.set_ylabel("impulse" if impulses.shape[1] == 1 else "impulses")


def draw_column(axes, result, name, order, at, cuts):
    values, sound = result.columns[name][order], result.sound[order]
    Curve(at, values, sound, cuts).draw(axes, figures.INK)
    spread = values[np.isfinite(values) & (values > 0)]
    frame(axes, values, sound, name == "energy" and spread.size > 0 and spread.max() > 20 * spread.min())
    if name == "energy":
        axes.set_ylabel("energy")
        if axes.get_yscale() == "log":
            figures.label_decades(axes.yaxis)
    else:
        axes.axhline(0, color=figures.FAINT, linewidth=0.7, zorder=1)
        axes.set_ylabel("smallest gap")


def lay_out(result):
    """Figure with the strip, a rug for special points, a panel for each column that holds numbers."""
    columns = [
        name
        for name in ("impulse", "energy", "clearance")
        if name in result.columns and np.isfinite(result.columns[name]).any()
    ]
    rug = [0.16 + 0.16 * len(result.special)] if result.special else []
    heights = [0.28] + rug + [1.75 if name == "impulse" else 1.4 for name in columns]
    figure, axes = plt.subplots(
        len(heights),
        1,
        sharex=True,
        figsize=(8.6, 2.0 + 1.15 * sum(heights)),
        squeeze=False,
        constrained_layout=True,
        gridspec_kw={"height_ratios": heights},
    )
    axes = axes[:, 0]
    for thin in axes[: 1 + len(rug)]:
        thin.tick_params(axis="both", length=0)
        thin.spines[["left", "bottom"]].set_visible(False)
    return figure, axes[0], axes[1] if rug else None, dict(zip(columns, axes[1 + len(rug) :])), axes[-1]


def draw(result, _options):
    result.need_sweep(1)
    order = np.argsort(result.values[0], kind="stable")
    at = result.values[0][order]
    edges = strip_edges(at, figures.is_geometric(at))
    cuts = find_cuts(at, result.columns.get("impulse", at).reshape(len(at), -1)[order], result.special)
    figure, strip, rug, panels, last = lay_out(result)
    outcome_entries = draw_strip(strip, at, result.detailed_outcome()[order], edges)
    special_entries = draw_special(panels.values(), rug, result, edges) if rug is not None else []
    for name, axes in panels.items():
        if name == "impulse":
            draw_impulses(axes, result, order, at, cuts)
        else:
            draw_column(axes, result, name, order, at, cuts)
    finish(figure, strip, last, result, edges, outcome_entries + special_entries)
    return figure


def finish(figure, strip, last, result, edges, entries):
    if figures.is_geometric(result.values[0]):
        last.set_xscale("log")
    last.set_xlim(edges[0], edges[-1])
    last.set_xlabel(figures.parameter_label(result.names[0]))
    if (~result.sound & np.isfinite(result.columns.get("energy", result.values[0]))).any():
        look = {"color": figures.INK, "linestyle": (0, (4, 1.6)), "alpha": 0.6}
        entries.append(Line2D([], [], label="inadmissible orbit", **look))
    figures.legend_below(last, 2 if len(entries) > 3 else 3, handles=entries)
    figure.align_ylabels()
    figures.put_title(figure, strip, result, 88)


if __name__ == "__main__":
    sys.exit(figures.run(draw, "sweep", __doc__))
