"""Figures of diagrams and basins. Windows are also printed: these numbers are checked."""

import numpy as np
import pytest
from drawing import (
    Shelf, absent, altered, assert_among, broken, cases, column, computed, draws, foreign, no_hdf5, refuses
)  # fmt: skip

MAP = """kind: {kind}
title: {title}
model: {{type: grazing_map, {model}}}
iterate: {{{iterate}}}
{sweep}
"""
OSCILLATOR = """kind: diagram
title: {title}
model: {{type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, {model}}}
{family}
iterate: {{{iterate}}}
sweep: {sweep}
"""
PUSHED = "orbit: {motion: forced}\nbranch: {parameter: model.force, from: 1, to: 50}"
EXAMPLE = "lambda: 0.5, omega: 0.3"


def of_map(title, iterate, sweep="", model=EXAMPLE, kind="diagram"):
    return MAP.format(kind=kind, title=title, model=model, iterate=iterate, sweep=sweep and "sweep:\n  - " + sweep)


def of_oscillator(title, model, iterate, sweep, family=""):
    return OSCILLATOR.format(title=title, model=model, iterate=iterate, sweep=sweep, family=family)


OF_D = "{parameter: model.d, from: 1e-5, to: 0.03, points: 60, scale: log"
STARTS = "{{parameter: 'iterate.start[{}]', from: -0.5, to: 0.5, points: 20}}"
GRID = "{parameter: model.lambda, values: [0.3, 0.5]}\n  - {parameter: model.d, from: 1e-4, to: 0.03, points: 20}"
SHORT = "transient: 500, keep: 100"
TWO = "lambda: 0.1, omega: 0.05"  # two attractors

STUDIES = {
    "plain": of_map("Figure 4", "transient: 2000, keep: 300, lyapunov: true, windows: true",
                    "{parameter: model.d, from: 5e-5, to: 0.03, points: 80}"),
    "ratios": of_map("Figure 5", "transient: 2000, keep: 300, windows: true", OF_D + "}"),
    "back": of_map("there and back", SHORT + ", follow: true", OF_D + ", back: true}", TWO),
    "falling": of_map("falling values", SHORT, "{parameter: model.d, values: [0.03, 0.02, 0.013, 0.001]}"),
    "one": of_map("a single value", SHORT, "{parameter: model.d, values: [0.02]}"),
    "grid": of_map("lines", SHORT + ", lyapunov: true", GRID),
    "listed": of_map("a map by its lists", SHORT, "{parameter: model.d, from: 0.001, to: 0.03, points: 20}",
                     "L: [0.5, 0, 0, 0.3], eta: [1, 0], xi: [1, 1]"),
    "attractor": of_map("Figure 6", "transient: 500, keep: 2000, states: true, lyapunov: true, exponents: 3", "",
                        EXAMPLE + ", d: 1.5e-4"),
    "dense": of_map("many states", "transient: 500, keep: 20000, states: true", "", EXAMPLE + ", d: 1.5e-4"),
    "periods": of_map("periods", "transient: 500, keep: 0, measure: 1",
                      "{parameter: model.lambda, from: 0.05, to: 0.95, points: 40}\n"
                      "  - {parameter: model.d, from: 1e-6, to: 0.1, points: 40, scale: log}", "omega: 0.04"),
    "basin": of_map("two attractors", "transient: 500, start: [0, 0, 0]",
                    STARTS.format(0) + "\n  - " + STARTS.format(2), TWO + ", d: 0.0156", "basin"),
    "basin_line": of_map("a line of starts", "transient: 500, start: [0, 0, 0]", STARTS.format(0),
                         TWO + ", d: 0.0156", "basin"),
    "beyond": of_oscillator("beyond grazing", "damping: 3, force: 1, frequency: 4",
                            SHORT + ", lyapunov: true, windows: true",
                            "{parameter: grazing.beyond, from: 1e-5, to: 1e-2, points: 24, scale: log}", PUSHED),
    "impacts": of_oscillator("at impacts", "damping: 0.3, frequency: 2.5", SHORT + ", section: impact, states: true",
                             "{parameter: model.force, from: 6, to: 9, points: 8}"),
}  # fmt: skip


def some_starts_lead_nowhere(file):
    """So that the first attractor is not the largest one."""
    attractor = file["basin/attractor"][()]
    attractor[np.flatnonzero(attractor == 0)[:30]] = -1
    file["basin/attractor"][()] = attractor
    file["basin/found_tasks"][()] = [(attractor == k).sum() for k in range(len(file["basin/found_tasks"]))]


FAILURES = ("failed", "diverged")
MADE = {
    "uneven": altered("basin", some_starts_lead_nowhere, ("basin", "sweep")),
    "broken": broken("plain", "diagram", [0, 5, 6, 40, 79], FAILURES),
    "nothing": broken("plain", "diagram", range(80), FAILURES),
    "broken_beyond": broken("beyond", "diagram", [0, 7, 23], FAILURES),
    "broken_periods": broken("periods", "diagram", range(100, 400), FAILURES),
    "absent": absent,
    "orbits": foreign("orbits/outcome"),
    "text": no_hdf5,
}

# script, result, options, endings of the stems that it writes
FIGURES = [
    ("plot_diagram.py", "plain", [], [""]),
    ("plot_diagram.py", "ratios", [], [""]),
    ("plot_diagram.py", "ratios", ["--scaled"], [""]),
    ("plot_diagram.py", "ratios", ["--values"], [""]),
    ("plot_diagram.py", "listed", ["--scaled", "--lambda", "0.5"], [""]),
    ("plot_diagram.py", "back", [], [""]),
    ("plot_diagram.py", "falling", [], [""]),
    ("plot_diagram.py", "one", [], [""]),
    ("plot_diagram.py", "grid", [], ["_0", "_1"]),
    ("plot_diagram.py", "grid", ["--lines", "1"], ["_1"]),
    ("plot_diagram.py", "beyond", [], [""]),
    ("plot_diagram.py", "impacts", [], [""]),
    ("plot_diagram.py", "broken", [], [""]),
    ("plot_diagram.py", "broken_beyond", [], [""]),
    ("plot_attractor.py", "attractor", [], [""]),
    ("plot_attractor.py", "attractor", ["--plane", "z3", "z1"], [""]),
    ("plot_attractor.py", "dense", [], [""]),
    ("plot_attractor.py", "impacts", ["--task", "3"], [""]),
    ("plot_attractor.py", "impacts", ["--task", "3", "--plane", "time", "v0"], [""]),
    ("plot_periods.py", "periods", [], [""]),
    ("plot_periods.py", "periods", ["--swap"], [""]),
    ("plot_periods.py", "broken_periods", [], [""]),
    ("plot_basin.py", "basin", [], [""]),
    ("plot_basin.py", "basin", ["--swap"], [""]),
    ("plot_windows.py", "ratios", [], [""]),
    ("plot_windows.py", "beyond", ["--lambda", "0.549"], [""]),
]

# script, file, options, words of the message
REFUSALS = [
    ("plot_diagram.py", "absent.h5", [], "no such file"),
    ("plot_diagram.py", "orbits.h5", [], "not a result of kind diagram"),
    ("plot_diagram.py", "basin.h5", [], "not a result of kind diagram"),
    ("plot_diagram.py", "attractor.h5", [], "no swept parameter in it"),
    ("plot_diagram.py", "periods.h5", [], "no /diagram/values in it (iterate.keep of the study is 0)"),
    ("plot_diagram.py", "grid.h5", ["--lines", "2"], "no line 2, it has lines 0 to 1"),
    ("plot_diagram.py", "beyond.h5", ["--scaled"], "--scaled is for maps along positive model.d"),
    ("plot_diagram.py", "listed.h5", ["--scaled"], "give --lambda"),
    ("plot_diagram.py", "nothing.h5", [], "no iterate of it is finite"),
    ("plot_attractor.py", "plain.h5", [], "the study did not ask for iterate.states"),
    ("plot_attractor.py", "impacts.h5", [], "8 tasks in it, this figure needs --task"),
    ("plot_attractor.py", "attractor.h5", ["--task", "1"], "no task 1, it has tasks 0 to 0"),
    ("plot_attractor.py", "attractor.h5", ["--plane", "z1", "z4"], "no number z4 in a state, it has z1, z2, z3"),
    ("plot_periods.py", "plain.h5", [], "1 swept parameters (model.d), this figure needs 2"),
    ("plot_basin.py", "plain.h5", [], "not a result of kind basin"),
    ("plot_basin.py", "basin_line.h5", [], "this figure needs 2"),
    ("plot_windows.py", "grid.h5", [], "the study did not ask for iterate.windows"),
    ("plot_windows.py", "text.h5", [], "not a readable result"),
]


@pytest.fixture(scope="module")
def results(ricochet, shared):
    return Shelf(shared, computed(ricochet, STUDIES) | MADE)


@pytest.mark.parametrize("script, name, options, endings", cases(FIGURES))
def test_figure_is_drawn(scripts, results, folder, script, name, options, endings):
    table = script == "plot_windows.py"
    draws(scripts, results, folder, script, name, options, endings, suffix=".png", table=table)


@pytest.mark.parametrize("script, name, options, words", cases(REFUSALS))
def test_refusal_is_one_line(scripts, results, folder, script, name, options, words):
    refuses(scripts, results, folder, script, name, options, words)


def test_table_has_the_exact_edges(scripts, results, folder):
    """The flip and the border of the orbits with one impact of the example map, whose z1 does not depend on z2, z3. In
    a process of its own."""
    done = scripts.start("plot_windows.py", results["plain"], "-o", folder / "table", cwd=folder)
    done.expect_files(folder / "table", table=True)
    lines = [line.split() for line in done.out.splitlines()]
    rows = {int(words[0]): words for words in lines if words and words[0].isdigit()}
    for n in (5, 6, 7):
        c, size = 0.5 ** (n - 1), 0.5
        s = c / 2 / (1 - 3 * c)
        low = (s**2 * (1 + 3 * c) + c * s) / (1 - c * size)
        high = (1 - size) * size ** (2 * (n - 2)) / (1 - size ** (n - 2) * (3 - 2 * size)) ** 2
        assert abs(float(rows[n][2]) / low - 1) < 1e-8 and rows[n][3] == "flip", rows[n]
        assert abs(float(rows[n][5]) / high - 1) < 1e-8 and rows[n][6] == "border", rows[n]


# --- numbers in figures ---


@pytest.mark.parametrize("name", ["falling", "listed"])
def test_diagram_is_dark_where_iterates_are(scripts, results, name):
    """In the cell of an iterate, and of periodic ones in its neighbours above and below; nowhere else."""
    path = results[name]
    (figure,) = scripts.look("plot_diagram.py", path)
    mesh = figure.axes[0].collections[0]
    corners = mesh.get_coordinates()
    x, y = corners[0, :, 0], corners[:, 0, 1]
    dark = ~np.ma.getmaskarray(mesh.get_array().reshape(len(y) - 1, len(x) - 1))
    at, values = column(path, "sweep/model.d"), column(path, "diagram/values")
    periodic = column(path, "diagram/attractor_period") > 0
    assert len(x) == len(at) + 1 and periodic.any()
    assert (np.searchsorted(x, np.sort(at)) == np.arange(1, len(x))).all()
    for cells, task in zip(dark.T, np.argsort(at)):
        filled = np.zeros(len(cells), bool)
        row = np.searchsorted(y, values[task], side="right") - 1
        if periodic[task]:
            near = row[:, None] + [-1, 0, 1]
        else:
            near = 3 * (row[:, None] // 3) + [0, 1, 2]
        filled[np.unique(near)] = True
        assert (cells == filled).all(), task


def test_diagram_has_the_exponents_of_its_line(scripts, results):
    path = results["grid"]
    (figure,) = scripts.look("plot_diagram.py", path, "--lines", "1")
    panel = next(axes for axes in figure.axes if axes.get_ylabel().startswith("exponent"))
    rows = slice(20, 40)
    wanted = np.column_stack([column(path, "sweep/model.d"), column(path, "diagram/lyapunov")])[rows]
    assert (panel.lines[0].get_xydata() == wanted).all()


@pytest.mark.parametrize("options, pairs", [([], [(0, 1), (0, 2), (1, 2)]), (["--plane", "z3", "z1"], [(2, 0)])])
def test_attractor_has_all_states(scripts, results, options, pairs):
    path = results["attractor"]
    (figure,) = scripts.look("plot_attractor.py", path, *options)
    states = column(path, "diagram/state")[0]
    assert states.shape == (2000, 3) and len(figure.axes) == len(pairs)
    for axes, pair in zip(figure.axes, pairs):
        assert (axes.lines[0].get_xydata() == states[:, pair]).all()


def test_periods_are_those_of_the_grid(scripts, results):
    """Those up to 16 as they are, 18 is none."""
    path = results["periods"]
    (figure,) = scripts.look("plot_periods.py", path)
    period = column(path, "diagram/attractor_period")
    assert set(column(path, "diagram/outcome")) == {"periodic", "aperiodic"} and period.max() <= 16
    wanted = np.where(period == 0, 18, period).reshape(40, 40).T
    assert (figure.axes[0].collections[0].get_array().reshape(40, 40) == wanted).all()


@pytest.mark.parametrize("options", [[], ["--swap"]], ids=["straight", "swap"])
def test_basins_are_those_of_the_grid(scripts, results, options):
    """Attractors by falling size, white is none."""
    path = results["uneven"]
    (figure,) = scripts.look("plot_basin.py", path, *options)
    attractor, sizes = column(path, "basin/attractor"), column(path, "basin/found_tasks")
    rank = np.argsort(np.argsort(-sizes, kind="stable"))
    assert sizes.tolist() == [170, 200] and (attractor < 0).sum() == 30
    wanted = np.where(attractor < 0, 7, rank[attractor]).reshape(20, 20)
    assert (figure.axes[0].collections[0].get_array().reshape(20, 20) == (wanted if options else wanted.T)).all()
    told = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    for size, text in zip(-np.sort(-sizes), told):
        assert f"({100 * size / 400:.3g} %)" in text


def test_windows_have_the_edges_of_the_table(scripts, results):
    path = results["ratios"]
    (figure,) = scripts.look("plot_windows.py", path)
    upper = next(axes for axes in figure.axes if axes.get_yscale() == "log")
    period, impacts = column(path, "window/period"), column(path, "window/impacts")
    for side, marker in (("low", "v"), ("high", "^")):
        edge, kind = column(path, f"window/{side}"), column(path, f"window/{side}_kind")
        (shown,) = [line.get_xydata() for line in upper.lines if line.get_marker() == marker and line.get_zorder() == 3]
        shown = shown[np.isfinite(shown[:, 1])]
        assert len(shown) > 3 and len(set(shown[:, 0])) == len(shown)
        located = (impacts == 1) & np.isfinite(edge) & ~np.isin(kind, ("open", "regular", "none"))
        assert_among(shown, period[located], edge[located])
        assert set(shown[:, 0]) == set(period[located])
