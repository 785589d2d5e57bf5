#!/usr/bin/python3
"""Compares mode shapes under Hertz's law with those under the impact law: displacements at t = 0 against the particle.

RESULT.h5 is a branch along model.gamma with Hertz floors and `branch.states: true`; --impacts names the branch of the same
chain with rigid floors, with states, too. Shapes are drawn at couplings that both have, evenly picked; between neighbouring
points they are interpolated linearly. Datasets: /branch/point_parameter, point_outcome, point_q of both.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

import figures


class Shapes:
    """The shapes of a branch: couplings in increasing order, displacements there."""

    def __init__(self, file):
        if "branch/point_q" not in file:
            raise figures.FigureError("no /branch/point_q in it: not a branch with branch.states: true")
        group = file["branch"]
        attributes = group["point_parameter"].attrs
        if figures.text_of(attributes.get("parameter", attributes["long_name"])) != "model.gamma":
            raise figures.FigureError("not a branch along model.gamma")
        self.title = figures.text_of(file.attrs.get("title", ""))
        self.study = figures.Study(figures.text_of(file.attrs.get("study", "")))
        sound = figures.names_of(group["point_outcome"]) == "admissible"
        if not sound.any():
            raise figures.FigureError("no point of it is admissible")
        order = np.argsort(group["point_parameter"][()][sound], kind="stable")
        self.gamma = group["point_parameter"][()][sound][order]
        self.q = group["point_q"][()][sound][order]

    def at(self, gamma):
        return np.array([np.interp(gamma, self.gamma, column) for column in self.q.T])

    def subtitle(self):
        stiffness = self.study.number("hertz")
        parts = figures.fixed_parameters(self.study, self.q.shape[1], ["model.gamma"])
        return ", ".join(parts + ([f"$k = {stiffness}$"] if stiffness else []) + ["all quantities dimensionless"])


def draw(soft, options):
    hard = figures.open_result(options.impacts, Shapes)
    if hard.q.shape[1] != soft.q.shape[1]:
        raise figures.FigureError(f"{soft.q.shape[1]} particles, but {hard.q.shape[1]} in {options.impacts}")
    low, high = max(soft.gamma[0], hard.gamma[0]), min(soft.gamma[-1], hard.gamma[-1])
    if not low < high:
        raise figures.FigureError(f"no couplings in common with {options.impacts}")
    figure, panels = plt.subplots(2, 1, sharex=True, figsize=(8.6, 7.2), constrained_layout=True, height_ratios=(3, 2))
    entries = [
        Line2D([], [], color=figures.INK, marker="o", markersize=4, linewidth=1.2, label="impact law"),
        Line2D([], [], color=figures.INK, linestyle=(0, (4, 1.6)), label="Hertz's law"),
    ]
    for k, gamma in enumerate(np.linspace(low, high, options.couplings)):
        colour = figures.CYCLE[k % len(figures.CYCLE)]
        a, b = hard.at(gamma), soft.at(gamma)
        panels[0].plot(a, "o-", color=colour, markersize=4, linewidth=1.2)
        panels[0].plot(b, linestyle=(0, (4, 1.6)), color=colour, linewidth=1.6)
        panels[1].plot(b - a, color=colour, linewidth=1.5)
        entries.append(Line2D([], [], color=colour, label=rf"$\gamma = {gamma:.4g}$"))
    panels[0].axhline(-1, color=figures.FAINT, linewidth=0.8, linestyle=":")
    panels[0].text(0, -1, "floor", va="bottom", fontsize=9, color=figures.FAINT)
    panels[0].set_ylabel("displacement $q$ at $t = 0$")
    panels[1].axhline(0, color=figures.FAINT, linewidth=0.6)
    panels[1].set_ylabel("Hertz minus impact law")
    panels[1].set_xlabel("particle")
    panels[1].xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12))
    figures.legend_below(panels[1], 4, handles=entries)
    figures.put_title(figure, panels[0], soft, 88)
    return figure


def options(parser):
    parser.add_argument("--impacts", required=True, metavar="RIGID.h5", help="the branch under the impact law")
    parser.add_argument("--couplings", type=int, default=4, metavar="N", help="how many shapes (default 4)")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "laws", __doc__, options, Shapes))
