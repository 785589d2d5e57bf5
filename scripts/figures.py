"""Results of kind `orbits` read for drawing, and the look that all figures share.

Every plot_*.py script is `run(draw, ...)` of one function from a result to a figure. What the file cannot
give (no states, another number of swept parameters) is a FigureError: one line on stderr, exit code 2.
"""

import argparse
import contextlib
import os
import re
import sys
import textwrap

import h5py
import matplotlib

matplotlib.use("Agg")  # no display where sweeps run
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.colors import ListedColormap  # noqa: E402
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter  # noqa: E402
from matplotlib.transforms import ScaledTranslation  # noqa: E402

DPI = 160
INK = "#222222"
FAINT = "#6b6b6b"
# Okabe and Ito's colours: distinct for every kind of colour vision.
BLUE, ORANGE, GREEN, PINK, SKY, RED = "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"
CYCLE = [BLUE, RED, GREEN, PINK, ORANGE, SKY]

# Outcome: face colour, hatch, marker of single points. Lightness, hatch and marker tell them apart in grey.
OUTCOME_LOOK = {
    "admissible": (BLUE, "", "o"),
    "inadmissible": ("#F3E3C6", "", "."),
    "inadmissible: floor passed": ("#F6EBD6", "", "."),
    "inadmissible: impulse not positive": ("#E2B982", "////", "."),
    "grazing": (GREEN, "\\\\\\\\", "D"),
    "resonant": (PINK, "xxxx", "s"),
    "singular": (RED, "++++", "X"),
    "not_converged": ("#999999", "----", "v"),
    "failed": ("#000000", "", "x"),
}
OTHER_LOOK = ("#c8c8c8", "||||", "^")

STABILITY_LOOK = {
    "stable": (BLUE, "", "o"),
    "unstable": (ORANGE, "", "X"),
    "undecided": (GREEN, "", "D"),
    "unknown": ("#8a8a8a", "", "v"),
}

# Why a column is not there.
ABSENT = {
    "q": " (the study stored no states)",
    "v": " (the study stored no states)",
    "multipliers": " (the study did not ask for orbit.multipliers)",
    "multiplier_max": " (the study did not ask for orbit.stable)",
}

PARAMETER_LABEL = {
    "model.gamma": r"coupling $\gamma$",
    "orbit.period": r"period $T$",
    "model.hertz": r"stiffness $k$ of the Hertz contacts",
    "model.frequency": r"frequency $\omega$ of the force",
    "model.force": "amplitude of the force",
    "model.lambda": r"multiplier $\lambda$ of the map",
    "model.omega": r"multiplier $\omega$ of the map",
    "model.d": "$d$, by which the motion would pass the obstacle",
    "grazing.beyond": "$\\mu$ = parameter / its value at grazing \u2212 1",
}
PARAMETER_SYMBOL = {
    "model.gamma": r"\gamma",
    "orbit.period": "T",
    "model.lambda": r"\lambda",
    "model.omega": r"\omega",
    "model.d": "d",
    "grazing.beyond": r"\mu",
}


class FigureError(Exception):
    """The file does not hold what the figure needs; the text says what is missing."""


def names_of(dataset):
    """The values of an HDF5 enum dataset as an array of their names."""
    kinds = h5py.check_enum_dtype(dataset.dtype)
    if kinds is None:
        raise FigureError(f"{dataset.name} is no enum")
    name = {value: key for key, value in kinds.items()}
    values = dataset[()]
    words = [name.get(value, "unknown") for value in values.ravel().tolist()]
    return np.array(words, dtype=object).reshape(values.shape)


def text_of(value):
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


class Study:
    """The few words of the study text that figures show.

    The text is YAML, for whose reading Debian's Python needs a further package; what these patterns do not
    find is not shown.
    """

    def __init__(self, text):
        lines = re.sub(r"(^|\s)#.*", "", text).splitlines()
        body = "\n".join(line for line in lines if not line.startswith("title:")) + "\n"
        self.body = re.split(r"^sweep:", body, flags=re.M)[0]
        self.at_start, self.at_half = (
            [int(item) for item in self.items(key) if item.isdigit()] for key in ("at_start", "at_half")
        )
        self.in_series = self.word("type") == "duffing_chain"
        self.is_map = self.word("type") == "grazing_map"
        self.floors = self.items("floor") or [self.word("floor") or self.no_place("floor")]

    def word(self, key):
        """The value of a key that holds one word or number, None if there is none."""
        found = re.search(rf"\b{key}:[ \t]*([^,\[\]{{}}\n]+)", self.body)
        return found.group(1).strip() if found else None

    def items(self, key):
        """The items of a key that holds a list, in either of YAML's forms; empty if there is none."""
        found = re.search(rf"\b{key}:\s*(?:\[([^\]]*)\]|((?:\s*-\s+\S+[ \t]*\n)+))", self.body)
        return re.findall(r"[^\s,]+", re.sub(r"\s-\s", " ", found[1] or found[2] or "")) if found else []

    def no_place(self, side):
        """Where the floor or the wall stands that the study does not name."""
        return "-1" if side == "floor" and not self.in_series else "null"

    def places(self, side, particles):
        """Words for the floor or the wall of every particle; one for all is that of the last one of masses in series."""
        named = re.search(rf"\b{side}:", self.body)
        words = self.items(side) or [self.word(side) if named else self.no_place(side)]
        if len(words) > 1:
            return words
        return ["null"] * (particles - 1) + words if self.in_series else words * particles

    def series(self, particles):
        """Masses in series, and what stands before them, in words."""
        parts = [f"{particles} masses in series"]
        for key, words in (("stiffness", "stiffness"), ("wall", "wall at"), ("floor", "floor at")):
            value = ", ".join(self.items(key)) or self.word(key)
            if value:
                parts.append(f"{words} {value}")
        return ", ".join(parts)

    def chain(self, particles):
        """The kind of chain and its number of particles in words."""
        if self.in_series:
            return self.series(particles)
        if self.is_map:
            return "map (5.11) of [FN97]" if self.items("eta") else "map (6.1)\u2013(6.5) of [FN97]"
        ends = {
            "periodic": "ring of {} particles",
            "fixed": "{} particles, fixed ends",
            "free": "{} particles, free ends",
        }
        words = ends.get(self.word("ends"), "{} particles").format(particles)
        return words.replace("particles", "particle") if str(particles) == "1" else words

    def number(self, key):
        """A number, also as a multiple of pi, as mathematical text; None if the key holds anything else."""
        found = re.fullmatch(r"([-+.\deE]*)\s*(pi)?", self.word(key) or "")
        if not found or not found[0]:
            return None
        number = re.sub(r"e[+]?(-?)0*(\d+)$", r"\\times10^{\1\2}", found[1])
        return number + (r"\,\pi" if found[2] else "")


CRITICAL_LABELS = {"plus_one": "pair at +1", "minus_one": "pair at \u22121", "collision": "collision"}
SPECIAL_LABELS = ("resonance", "idle resonance", "singular", "free impulses", *CRITICAL_LABELS.values())


def special_label(kind, outcome):
    """What a special point does to the orbit, one of SPECIAL_LABELS."""
    if kind in CRITICAL_LABELS:
        return CRITICAL_LABELS[kind]
    if kind == "resonance":
        return "resonance" if outcome in ("grazing", "resonant") else "idle resonance"
    return "free impulses" if outcome == "resonant" else "singular"


class Result:
    """What figures use of a result: swept parameters, outcomes, columns of /orbits, the table /special."""

    def __init__(self, file):
        if "orbits/outcome" not in file or "sweep" not in file:
            raise FigureError("no /orbits/outcome and /sweep in it: not a result of kind orbits")
        self.title = text_of(file.attrs.get("title", ""))
        self.outcome = names_of(file["orbits/outcome"])
        self.columns = {
            name: file["orbits"][name][()]
            for name in ("q", "v", "impulse", "energy", "clearance", "multiplier_max", "multipliers")
            if name in file["orbits"]
        }
        self.stable = names_of(file["orbits/stable"]) if "orbits/stable" in file else None
        self._read_sweep(file["sweep"])
        self.special = self._read_special(file)
        self.study = Study(text_of(file.attrs.get("study", "")))

    def _read_sweep(self, sweep):
        self.names = text_of(sweep.attrs.get("parameters", "")).split()
        self.grid = [int(points) for points in np.atleast_1d(sweep.attrs.get("grid", []))]
        if len(self.grid) != len(self.names) or not all(name in sweep for name in self.names):
            raise FigureError("the parameters and the grid of /sweep do not belong together")
        self.values = [sweep[name][()] for name in self.names]
        sizes = {len(column) for column in self.values + list(self.columns.values())}
        if len(self.outcome) != np.prod(self.grid, dtype=int) or sizes - {len(self.outcome)}:
            raise FigureError("the rows of /orbits do not fill the grid of /sweep")

    @staticmethod
    def _read_special(file):
        """Special points by what they do to the orbit: {label: sorted different parameters}.

        A resonance matters where the outcome exactly there is grazing or resonant; a zero of the determinant is
        singular unless its equations are solvable. Empty without the group.
        """
        if "special/kind" not in file or "special/parameter" not in file:
            return {}
        kinds, at = names_of(file["special/kind"]), file["special/parameter"][()]
        outcomes = names_of(file["special/outcome"])
        labels = np.array([special_label(kind, outcome) for kind, outcome in zip(kinds, outcomes)], dtype=object)
        # Modes p and n - p of a ring resonate together: one line.
        return {
            label: np.unique(np.round(at[labels == label], 13)) for label in SPECIAL_LABELS if (labels == label).any()
        }

    def need(self, name):
        if name not in self.columns:
            raise FigureError(f"no /orbits/{name} in it{ABSENT.get(name, '')}")
        return self.columns[name]

    def need_stable(self):
        if self.stable is None:
            raise FigureError(f"no /orbits/stable in it{ABSENT['multiplier_max']}")
        return self.stable

    def need_sweep(self, count):
        if len(self.names) != count:
            held = ", ".join(self.names) or "none"
            raise FigureError(f"{len(self.names)} swept parameters ({held}), this figure needs {count}")

    def _pulls(self):
        """Whether an impulse is not positive."""
        return ~(self.columns["impulse"].reshape(len(self.outcome), -1) > 0).all(axis=1)

    @property
    def sound(self):
        """Tasks whose orbit breaks no condition, drawn with full lines.

        Of a resonant task the file holds one of many orbits, which need not be admissible.
        """
        resonant = self.outcome == "resonant"
        if "impulse" in self.columns and "clearance" in self.columns:
            resonant &= ~self._pulls() & ~(self.columns["clearance"] < 0)
        return (self.outcome == "admissible") | (self.outcome == "grazing") | resonant

    def detailed_outcome(self):
        """Outcomes, `inadmissible` split by what fails: an impulse that is not positive, else a floor."""
        detailed = self.outcome.copy()
        bad = self.outcome == "inadmissible"
        if "impulse" in self.columns:
            pulls = self._pulls()
            detailed[bad & pulls] = "inadmissible: impulse not positive"
            detailed[bad & ~pulls] = "inadmissible: floor passed"
        return detailed

    def floor_of(self, count):
        """Floor under each of `count` particles, NaN where there is none or where it is swept."""
        floors = self.study.floors
        floors = floors * count if len(floors) == 1 else floors
        numbers = np.full(count, np.nan)
        for i, floor in enumerate(floors[:count]):
            swept = "model.floor" in self.names or f"model.floor[{i}]" in self.names
            if not swept and re.fullmatch(r"[-+.\deE]+", floor):
                numbers[i] = float(floor)
        return numbers

    def subtitle(self):
        """The fixed parameters in one line, from the study."""
        parts = fixed_parameters(self.study, self.study.word("particles") or "?", self.names)
        return ", ".join(parts + ["all quantities dimensionless"])


def fixed_parameters(study, particles, swept):
    """The chain, and what of coupling and period the study holds fixed, in words."""
    parts = [study.chain(particles)]
    for name, symbol in PARAMETER_SYMBOL.items():
        number = study.number(name.split(".")[1])
        if number and name not in swept:
            parts.append(f"${symbol} = {number}$")
    return parts


def ordered(names, looks=OUTCOME_LOOK):
    """The different names in the order of their looks, those of later versions behind."""
    known = list(looks)
    return sorted(set(names), key=lambda name: (known.index(name) if name in known else len(known), name))


def parameter_label(name):
    if name in PARAMETER_LABEL:
        return PARAMETER_LABEL[name]
    path, _, item = name.partition("[")
    if path == "iterate.start" and item:
        return f"start $z_{{{int(item.rstrip(']')) + 1}}}$"
    word = path.split(".")[-1].replace("_", " ")
    return f"{word} of particle {item.rstrip(']')}" if item else word


def parameter_symbol(name):
    return f"${PARAMETER_SYMBOL[name]}$" if name in PARAMETER_SYMBOL else parameter_label(name)


def is_geometric(values):
    """Whether values were swept on a logarithmic scale: equal ratios, unequal differences."""
    values = np.unique(values)
    if len(values) < 3 or values[0] <= 0 or values[-1] < 3 * values[0]:
        return False
    ratios = np.diff(np.log(values))
    return np.ptp(ratios) < 1e-6 * ratios.max()


def cell_edges(values):
    """Borders halfway between sorted values, the outer ones as far outside as the inner ones are inside."""
    if len(values) == 1:
        half = 0.5 * max(abs(values[0]), 1.0) * 0.1
        return np.array([values[0] - half, values[0] + half])
    middle = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def robust_limits(values, sound):
    """Limits that show the sound values whole unless blow-ups squeeze them, and whether anything is outside.

    A blow-up is a range beyond four times that of the inner 80 % (of all values) or 96 % (of the sound ones).
    """
    finite = np.isfinite(values)
    if not finite.any():
        return 0.0, 1.0, False
    whole = values[finite]
    low, high = whole.min(), whole.max()
    if high - low > 4 * np.ptp(np.percentile(whole, [10, 90])):
        core = values[finite & sound] if (finite & sound).any() else whole
        near = np.percentile(core, [2, 98])
        near = near if np.ptp(core) > 4 * np.ptp(near) else np.array([core.min(), core.max()])
        low, high = max(low, near[0] - 0.7 * np.ptp(near)), min(high, near[1] + 0.7 * np.ptp(near))
    pad = 0.06 * (high - low) or 0.05 * max(abs(high), 1.0)
    low, high = low - pad, high + pad
    return low, high, bool(((whole < low) | (whole > high)).any())


def set_style():
    plt.rcParams.update(
        {
            "font.size": 10,
            "axes.titlesize": 10,
            "axes.labelsize": 10.5,
            "legend.fontsize": 9,
            "xtick.labelsize": 9.5,
            "ytick.labelsize": 9.5,
            "figure.titlesize": 12,
            "axes.edgecolor": FAINT,
            "axes.labelcolor": INK,
            "text.color": INK,
            "xtick.color": FAINT,
            "ytick.color": FAINT,
            "xtick.labelcolor": INK,
            "ytick.labelcolor": INK,
            "axes.linewidth": 0.8,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "legend.frameon": False,
            "hatch.linewidth": 0.6,
            "savefig.dpi": DPI,
            "mathtext.fontset": "dejavusans",
            "figure.constrained_layout.w_pad": 0.1,
            "svg.hashsalt": "ricochet",
        }
    )  # the salt makes equal data give equal files


def put_title(figure, axes, result, width):
    """Title of the study above the figure, its fixed parameters above `axes`."""
    lines = textwrap.wrap(result.title.replace("$", r"\$"), width)  # no mathematics in a free text
    figure.suptitle("\n".join(lines), x=0.012, ha="left", weight="bold")
    axes.set_title(result.subtitle(), loc="left", color=FAINT)


def colour_map():
    """Light to dark, so that the last curves, drawn over the others, stand out; none too light for white."""
    return ListedColormap(plt.get_cmap("plasma")(np.linspace(0.86, 0, 256)))


def legend_below(axes, columns, **options):
    """The legend under the label of the horizontal axis, at the same distance whatever the panel's height."""
    down = axes.transAxes + ScaledTranslation(0, -0.52, axes.figure.dpi_scale_trans)
    axes.legend(loc="upper left", bbox_to_anchor=(-0.01, 0), bbox_transform=down, ncol=columns, **options)


def legend_row(axes, entries, columns, **options):
    """The legend in `axes`, a row of the layout kept free for it, so that it widens no panel."""
    axes.axis("off")
    axes.legend(handles=entries, loc="upper left", ncol=columns, borderaxespad=0, **options)


def label_decades(axis):
    """Ticks of a logarithmic axis: decades, and 2 and 5 in between where there are few of them."""
    low, high = axis.get_view_interval()
    if np.log10(high / low) <= 3:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FormatStrFormatter("%g"))
    else:
        axis.set_major_locator(LogLocator(numticks=7))
    axis.set_minor_formatter(NullFormatter())


def clip_note(values):
    low, high = np.nanmin(values) + 0.0, np.nanmax(values) + 0.0  # + 0.0 turns -0 into 0
    return f"axis clipped, values from {low:.3g} to {high:.3g}"


def save(figure, stem):
    for suffix, metadata in (".png", {}), (".svg", {"Date": None}):
        try:
            figure.savefig(stem + suffix, metadata=metadata)
        except OSError as trouble:
            raise FigureError(f"cannot write {stem + suffix}: {trouble.strerror}") from trouble
        print(stem + suffix)
    plt.close(figure)


@contextlib.contextmanager
def readable():
    """Turns what HDF5 says about a damaged or foreign file into one line."""
    try:
        yield
    except (OSError, KeyError, RuntimeError) as trouble:
        first_line = (str(trouble).splitlines() or [""])[0]
        raise FigureError(f"not a readable result: {first_line}") from trouble


def open_result(path, read=Result):
    if not os.path.isfile(path):
        raise FigureError("no such file")
    with readable(), h5py.File(path, "r") as file:
        return read(file)


def make_parser(suffix, description, files="STEM.png and STEM.svg"):
    """The options that all scripts have."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result", metavar="RESULT.h5", help="what `ricochet run` wrote")
    parser.add_argument(
        "-o",
        "--output",
        metavar="STEM",
        help=f"write {files}; default: RESULT_{suffix}, beside the result",
    )
    return parser


def stem_of(options, suffix):
    stem = options.output or os.path.splitext(options.result)[0] + "_" + suffix
    return re.sub(r"\.(png|svg)$", "", stem)


def exit_code(options, action):
    """Runs `action()` in the figures' style; a FigureError is one line on stderr."""
    set_style()
    try:
        action()
    except FigureError as trouble:
        print(f"{os.path.basename(sys.argv[0])}: {options.result}: {trouble}", file=sys.stderr)
        return 2
    return 0


def run(draw, suffix, description, add_options=None, read=Result):
    """The main function of a script: options, `read(file)`, `draw(result, options)`, both files."""
    parser = make_parser(suffix, description)
    if add_options:
        add_options(parser)
    options = parser.parse_args()
    stem = stem_of(options, suffix)
    return exit_code(options, lambda: save(draw(open_result(options.result, read), options), stem))
