#!/usr/bin/python3
"""Draws the frequency-energy plot of nonlinear modes: the frequency 2 pi / period of periodic motions against their
energy.

Datasets: /branch/outcome and the others of plot_branch.py, with point_energy and point_period. A sweep over a cubic coefficient, epsilon, gives the colours:
blue where it is 0, brown from dark to bright where it grows. Full lines are stable motions, dashed ones unstable or
undecided, dotted grey ones solutions of the equations that are not admissible, whose special points are left out.
Resonances and extremes of the energy are marked with --resonances only.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D

import figures
import plot_branch

BROWNS = LinearSegmentedColormap.from_list("browns", ["#3b1f0b", "#8a4b16", "#e39a4f"])
LINEAR = figures.BLUE
RARE = ("resonance", "energy_extreme")  # many, and without effect on the shape of a family


def cubic_sweep(result):
    """Values of the swept cubic coefficient of all tasks, and its name; None without one."""
    for name, values in zip(result.names, result.swept):
        if "cubic" in name:
            return name, values
    return None, None


def colours(result, tasks):
    """The colour of a task and segment, and legend entries that tell them."""
    name, values = cubic_sweep(result)
    if name is None:
        return lambda task, segment: LINEAR, []
    different = np.unique(values[tasks])
    bright = [value for value in different if value != 0]
    look = {value: BROWNS(k / max(1, len(bright) - 1)) for k, value in enumerate(bright)} | {0.0: LINEAR}
    entries = [
        Line2D([], [], color=look[value], linewidth=2, label=rf"$\varepsilon = {value:.4g}$") for value in different
    ]
    return lambda task, segment: look[values[task]], entries


def limits(axes, result, tasks, options):
    """Of the motions that are ones: families blow up on their way to others."""
    rows = np.concatenate([result.rows("point", task) for task in tasks])
    sound = np.isin(result.columns["point_outcome"][rows], ("admissible", "grazing"))
    rows = rows[sound] if sound.any() else rows
    energy, frequency = (result.columns[f"point_{name}"][rows] for name in ("energy", "frequency"))
    high = options.energy_high or energy.max()
    shown = (energy > 0) & (energy <= high)
    low, top = frequency[shown].min(), frequency[shown].max()
    axes.set_xlim(energy[shown].min() / 1.1, high * 1.1)
    pad = 0.06 * (top - low) or 0.05 * top
    axes.set_ylim(low - pad, top + pad)


def hide(result, options):
    """Special points of what are no motions, and those of no concern here."""
    columns = result.columns
    kinds, offsets = columns["special_kind"], columns["special_offset"]
    for task in range(len(result.outcome)):
        own = slice(*offsets[task : task + 2])
        near = columns["special_point"][own] + columns["point_offset"][task]
        bad = columns["point_outcome"][np.maximum(near, 0)] == "inadmissible"
        kinds[own] = np.where(bad & (kinds[own] != "grazing"), "", kinds[own])
    return ("",) if options.resonances else ("", *RARE)


def draw(result, options):
    tasks = plot_branch.choose_tasks(result, options.tasks)
    figure = plt.figure(figsize=(8.6, 6.4), constrained_layout=True)
    cells = figure.add_gridspec(2, 1)
    axes, seen = figure.add_subplot(cells[0]), set()
    plot_branch.frame(axes, result, "energy", "frequency", tasks)
    colour_of, entries = colours(result, tasks)
    for task in tasks:
        plot_branch.draw_task(axes, result, task, "energy", "frequency", colour_of, seen)
    axes.set_xscale("log")
    limits(axes, result, tasks, options)
    entries = entries + plot_branch.line_entries(seen)
    entries += plot_branch.draw_special(axes, result, tasks, "energy", "frequency", hide(result, options))
    cells.set_height_ratios([1, 0.02 + 0.045 * -(-len(entries) // plot_branch.COLUMNS)])
    figures.legend_row(figure.add_subplot(cells[1]), entries, plot_branch.COLUMNS)
    figures.put_title(figure, axes, result, 88)
    return figure


def options(parser):
    parser.add_argument(
        "--tasks", type=int, nargs="+", metavar="K", help="draw these tasks only, from 0; default: all"
    )
    parser.add_argument("--energy-high", type=float, metavar="E", help="largest energy; default: that of all motions")
    parser.add_argument("--resonances", action="store_true", help="mark resonances and extremes of the energy, too")


if __name__ == "__main__":
    sys.exit(figures.run(draw, "frequency_energy", __doc__, options, plot_branch.Branches))
