#!/usr/bin/python3
"""Draws the criterion of a grazing bifurcation: one figure for each task with a grazing point.

Datasets: /grazing/outcome, verdict, regime, first_negative, settled, parameter, A_g, multiplier, alpha, coefficient, eta,
xi, L. Left the geometry of [FN97], Figure 3: after an impact the state lies along xi and comes back along L xi, L^2 xi,
...; the motion grazes on the plane eta z = 0 and has an impact behind it. The criterion asks that all point out of
that plane. Across is the distance from it, upwards the direction within it along which the iterates spread most.
Right the c_i = eta L^i xi over the i-th power of the dominant multiplier's modulus, which tend to alpha.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import figures
import grazings

FEWEST_ARROWS, MOST_ARROWS = 5, 9
SHORTEST = 0.3   # of the arrows, over the longest
BEYOND = 100  # outside of every frame
NEGATIVE, LATER_NEGATIVE = figures.RED, "#c98a6b"
IMPACT_LOOK = {"facecolor": "#ececec", "edgecolor": "#d2d2d2", "hatch": "///", "linewidth": 0}
AXIS_LOOK = {"color": figures.FAINT, "linewidth": 0.9, "linestyle": (0, (5, 3))}
LIMIT_LOOK = {"color": figures.GREEN, "linewidth": 1.3, "linestyle": (0, (5, 2.5))}
PROVED_LOOK = {"facecolor": grazings.faint(figures.GREEN, 0.12)}


# --- the geometry ---


def iterates(result, task, count):
    """xi, L xi, ... [count, coordinates], and what each was divided by in all: they may sink below any number."""
    L, x = result.need("L")[task], result.need("xi")[task].astype(float)
    rows, scale, logarithm = [], [], 0.0
    for _ in range(count):
        size = np.linalg.norm(x)
        if not 0 < size < np.inf:
            break
        logarithm += np.log(size)
        x = x / size
        rows.append(x)
        scale.append(logarithm)
        x = L @ x
    return np.array(rows), np.array(scale)


def shown_iterates(first_negative, available):
    """Which i have arrows: the first ones, or, where the first negative one is late, some before it as well."""
    if first_negative < MOST_ARROWS - 1:
        return np.arange(min(max(FEWEST_ARROWS, first_negative + 2), MOST_ARROWS, available))
    chosen = [*range(5), *range(first_negative - 2, first_negative + 1)]
    return np.array([i for i in chosen if i < available])


def plane_directions(eta, units):
    """Unit vectors across the plane eta z = 0, and within it along which the unit vectors spread most; the second is 0
    where there is one coordinate."""
    across = eta / np.linalg.norm(eta)
    within = units - np.outer(units @ across, across)
    direction = np.linalg.svd(within)[2][0]
    if np.linalg.norm(within) < 1e-12:
        return across, np.zeros_like(across)
    direction = direction - (direction @ across) * across
    direction /= np.linalg.norm(direction)
    return across, direction * (1 if within[0] @ direction >= 0 else -1)


class Fan:
    """The arrows of the left panel in its two directions."""

    def __init__(self, result, task):
        self.first_negative = int(result.columns["first_negative"][task])
        units, logarithm = iterates(result, task, max(self.first_negative + 1, MOST_ARROWS))
        if len(units) == 0:
            raise figures.FigureError(f"xi of task {task} has no direction")
        self.shown = shown_iterates(self.first_negative, len(units))
        units, logarithm = units[self.shown], logarithm[self.shown]
        across, within = plane_directions(result.need("eta")[task], units)
        flat = np.column_stack([units @ across, units @ within])
        self.steepness = self._steepness(flat)
        flat[:, 0] *= self.steepness
        # The power of the length that leaves the shortest arrow at SHORTEST of the longest.
        span = np.ptp(logarithm + np.log(np.linalg.norm(flat, axis=1)))
        self.power = min(1.0, -np.log(SHORTEST) / span) if span > 0 else 1.0
        size = np.linalg.norm(flat, axis=1)
        length = np.exp(self.power * (logarithm + np.log(size) - (logarithm + np.log(size)).max()))
        self.tips = flat / size[:, None] * length[:, None]
        self.axis = self._eigenvector(result, task, across, within)

    @staticmethod
    def _steepness(flat):
        """By how much the distance from the plane is stretched: arrows that all but lie in it would hide their sign."""
        out, within = np.median(np.abs(flat), axis=0)
        return float(f"{within / out:.1g}") if 0 < 2.5 * out < within else 1.0

    def _eigenvector(self, result, task, across, within):
        """Direction of zeta, where the dominant multiplier is real; pointing out of the plane."""
        if result.columns["multiplier"][task].imag != 0:
            return None
        values, vectors = np.linalg.eig(result.columns["L"][task])
        zeta = vectors[:, np.argmax(np.abs(values))].real
        flat = np.array([zeta @ across * self.steepness, zeta @ within])
        flat *= 1 if flat[0] >= 0 else -1
        return flat / np.linalg.norm(flat) if np.linalg.norm(flat) > 1e-9 else None

    def note(self):
        parts = ["directions true"]
        if self.steepness != 1:
            parts = [f"distance from the plane stretched {self.steepness:g} times"]
        if self.power < 1:
            parts.append(f"lengths to the power {self.power:.2g}, so that later arrows stay visible")
        return ", ".join(parts)


def arrow_label(i):
    return rf"$\xi$" if i == 0 else rf"$L\xi$" if i == 1 else rf"$L^{{{i}}}\xi$"


def distance_to_segments(point, tips):
    """Of a point from the arrows."""
    along = np.clip(tips @ point / np.maximum((tips**2).sum(axis=1), 1e-30), 0, 1)
    return np.linalg.norm(point - along[:, None] * tips, axis=1).min()


def label_places(tips):
    """A free place beside each tip: of some around it the one farthest from arrows, and from labels placed before."""
    placed = []
    for tip in tips:
        outward = tip / np.linalg.norm(tip)
        turn = np.arctan2(outward[1], outward[0]) + np.radians([0, 35, -35, 70, -70, 100, -100])
        reach = np.where(np.arange(7) == 0, 0.085, 0.09)
        places = tip + reach[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
        room = [min(1, distance_to_segments(place, tips) / 0.07) - 0.02 * k for k, place in enumerate(places)]
        for k, place in enumerate(places):
            apart = np.linalg.norm(np.array(placed or [place + 9]) - place, axis=1).min()
            room[k] = min(room[k], apart / 0.16)
        placed.append(places[int(np.argmax(room))])
    return placed


def frame_fan(axes, fan):
    """Limits around the arrows, the region of impacts, the plane."""
    points = np.vstack([fan.tips, [[0, 0]]])
    low, high = points.min(axis=0) - 0.2, points.max(axis=0) + 0.2
    low[0] = min(low[0], -0.32)
    axes.axvspan(-BEYOND, 0, zorder=0, **IMPACT_LOOK)
    axes.axvline(0, color=figures.INK, linewidth=1.2, zorder=2)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xticks=[], yticks=[])
    axes.set_aspect("equal", adjustable="datalim")


def draw_fan(axes, fan):
    if fan.axis is not None:
        axes.plot(*np.outer(fan.axis, [0, BEYOND]), zorder=1, **AXIS_LOOK)
    frame_fan(axes, fan)
    places = label_places(fan.tips)
    for i, tip, place in zip(fan.shown, fan.tips, places):
        colour = NEGATIVE if i == fan.first_negative else figures.BLUE if tip[0] > 0 else LATER_NEGATIVE
        axes.annotate("", tip, (0, 0), zorder=4,
                      arrowprops={"arrowstyle": "-|>,head_width=0.28,head_length=0.55", "color": colour,
                                  "linewidth": 1.9, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 13})  # fmt: skip
        text = axes.text(*place, arrow_label(i), ha="center", va="center", fontsize=10.5, color=colour, zorder=6)
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.75})
    axes.plot(0, 0, "o", color=figures.INK, markersize=5, zorder=5)
    axes.set_xlabel(r"distance from the plane $\eta z = 0$")
    axes.set_ylabel("direction within the plane")
    axes.set_title(fan.note(), loc="left", color=figures.FAINT, fontsize=8.5)
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)


# --- the coefficients ---


def scaled_coefficients(result, task):
    """c_i over |lambda|^i for the stored i."""
    c, size = result.need("coefficient")[task], abs(result.columns["multiplier"][task])
    i = np.arange(len(c))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        scaled = c / size**i if size > 0 else c
    keep = np.isfinite(scaled)
    return i[keep], scaled[keep], c[keep]


def shown_coefficients(result, task, count):
    """So many that the negative one, or the proof of the tail, is among them."""
    wanted = max(13, int(result.columns["first_negative"][task]) + 4, int(result.columns["settled"][task]) + 3)
    return min(count, wanted, 40)


def draw_coefficients(axes, result, task):
    i, scaled, c = scaled_coefficients(result, task)
    shown = shown_coefficients(result, task, len(i))
    i, scaled, c = i[:shown], scaled[:shown], c[:shown]
    first, settled = int(result.columns["first_negative"][task]), int(result.columns["settled"][task])
    alpha = result.columns["alpha"][task]
    colour = np.where(c > 0, figures.BLUE, LATER_NEGATIVE).astype(object)
    colour[i == first] = NEGATIVE
    axes.vlines(i, 0, scaled, colors=list(colour), linewidth=1.6, zorder=3)
    axes.scatter(i, scaled, c=list(colour), s=30, zorder=4, edgecolors="white", linewidths=0.6)
    if np.isfinite(alpha):
        axes.axhline(alpha, zorder=2, **LIMIT_LOOK)
    if 0 <= settled <= i[-1]:
        axes.axvspan(settled - 0.5, i[-1] + 0.8, zorder=0, **PROVED_LOOK)
    frame_coefficients(axes, i, scaled, alpha, result.columns["multiplier"][task])


def frame_coefficients(axes, i, scaled, alpha, multiplier):
    low, high = min(scaled.min(), 0), max(scaled.max(), 0, alpha if np.isfinite(alpha) else 0)
    span = (high - low) or 1
    axes.set_ylim(low - (0.1 if low < 0 else 0.03) * span, high + 0.1 * span)
    axes.set_xlim(-0.6, i[-1] + 0.8)
    axes.axhline(0, color=figures.INK, linewidth=0.9, zorder=2)
    if low < 0:
        axes.axhspan(axes.get_ylim()[0], 0, zorder=0, **IMPACT_LOOK)
    axes.xaxis.get_major_locator().set_params(integer=True)
    size = r"\lambda" if multiplier.imag == 0 and multiplier.real > 0 else r"|\lambda|"
    axes.set_xlabel("$i$")
    axes.set_ylabel(rf"$c_i\,/\,{size}^i$,   $c_i = \eta L^i \xi$")


def short_number(value):
    """A number as mathematical text, with its power of ten."""
    mantissa, _, power = f"{value:.3g}".partition("e")
    return mantissa + (rf"\cdot 10^{{{int(power)}}}" if power else "")


# --- the figure ---


def facts(result, task):
    """The line of text: verdict, regime, multiplier, parameter and A_g."""
    columns = result.columns
    parts = [columns["verdict"][task]]
    regime = grazings.REGIME_WORDS.get(columns["regime"][task])
    if regime:
        parts[0] += f", then {regime}" if columns["regime"][task] != "border" else f", {regime}"
    if columns["verdict"][task] == "undecided":
        parts[0] += f": {figures.text_of(columns['verdict_reason'][task])}" if "verdict_reason" in columns else ""
    multiplier = columns["multiplier"][task]
    parts.append(rf"$\lambda = {grazings.number_text(multiplier)}$")
    if multiplier.imag != 0:
        parts[-1] += rf" ($|\lambda| = {abs(multiplier):.4g}$)"
    parts.append(f"{figures.parameter_label(result.followed) if result.followed else 'parameter'} {columns['parameter'][task]:.6g}")
    parts.append(rf"$A_g = {columns['A_g'][task]:.4g}$")
    return parts


def entries_of(result, task, fan):
    alpha, settled = result.columns["alpha"][task], int(result.columns["settled"][task])
    entries = [Patch(label="impact", **IMPACT_LOOK)]
    if fan.axis is not None:
        entries.append(Line2D([], [], label=r"eigenvector $\zeta$ of $\lambda$", **AXIS_LOOK))
    if np.isfinite(alpha):
        entries.append(Line2D([], [], label=rf"$\alpha = {short_number(alpha)}$, the limit", **LIMIT_LOOK))
    if settled >= 0:
        entries.append(Patch(label=f"proved positive from $i = {settled}$ on", **PROVED_LOOK))
    if fan.first_negative >= 0:
        c, i = result.columns["coefficient"][task], fan.first_negative
        value = f" = {short_number(c[i])}" if i < len(c) else ""
        entries.append(Line2D([], [], color=NEGATIVE, linewidth=1.9, marker="o", markersize=5,
                              label=f"first negative one, $c_{{{i}}}{value}$"))  # fmt: skip
    return entries


def draw(result, task):
    figure = plt.figure(figsize=(10.6, 5.9), constrained_layout=True)
    cells = figure.add_gridspec(3, 2, height_ratios=[0.1, 1, 0.1], width_ratios=[1, 1.12])
    words, left, right = figure.add_subplot(cells[0, :]), figure.add_subplot(cells[1, 0]), figure.add_subplot(cells[1, 1])
    fan = Fan(result, task)
    draw_fan(left, fan)
    draw_coefficients(right, result, task)
    figures.legend_row(figure.add_subplot(cells[2, :]), entries_of(result, task, fan), 5)
    words.axis("off")
    name = result.task_name(task)
    verdict, *rest = facts(result, task)
    colour = grazings.verdict_colour(result.columns["verdict"][task], 1)
    words.text(0, 0.9, verdict, color=colour, weight="bold", fontsize=11.5, transform=words.transAxes, va="top")
    words.text(0, 0.2, ",   ".join(rest), transform=words.transAxes, va="top")
    figures.put_title(figure, words, result, 100)
    if name:
        words.set_title(f"{result.subtitle()}; {name}", loc="left", color=figures.FAINT)
    return figure


def run():
    parser = figures.make_parser("grazing", __doc__, "STEM.png and STEM.svg, of several tasks STEM_K.png and STEM_K.svg")
    grazings.task_options(parser)
    options = parser.parse_args()
    stem = figures.stem_of(options, "grazing")

    def action():
        result = figures.open_result(options.result, grazings.Grazings)
        tasks = grazings.choose_tasks(result, options.tasks)
        for task in tasks:
            figures.save(draw(result, task), stem if len(result.outcome) == 1 else f"{stem}_{task}")

    return figures.exit_code(options, action)


if __name__ == "__main__":
    sys.exit(run())
