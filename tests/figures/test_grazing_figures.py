"""Figures of grazing bifurcations, of synthetic results of kind `grazing`."""

import numpy as np
import pytest
import synthetic_grazing
from drawing import Shelf, absent, assert_among, cases, column, draws, foreign, refuses


def written(*words, **options):
    return lambda shelf, path: synthetic_grazing.write(path, *words, **options)


MADE = {
    "regimes": written(3, [6, 4, 1.5]),
    "light": written(0.1, [2, 2.6, 20], curve=np.linspace(0.4, 3, 301)),
    "heavy": written(3, [4], curve=np.linspace(2, 6, 41)),
    "alone": written(3, [4], periods=0),
    "none": written(3, [4], outcomes=["none"]),
    "absent": absent,
    "orbits": foreign("orbits/outcome"),
}

# script, result, options, endings of the stems that it writes
FIGURES = [
    ("plot_grazing.py", "regimes", [], ["_0", "_1", "_2"]),
    ("plot_grazing.py", "light", ["--tasks", "1", "2"], ["_1", "_2"]),
    ("plot_grazing.py", "alone", [], [""]),
    ("plot_grazing_windows.py", "regimes", [], [""]),
    ("plot_grazing_windows.py", "regimes", ["--tasks", "2"], [""]),
    ("plot_grazing_curve.py", "light", [], [""]),
    ("plot_grazing_curve.py", "heavy", [], [""]),
]

# script, file, options, words of the message
REFUSALS = [
    ("plot_grazing.py", "absent.h5", [], "no such file"),
    ("plot_grazing.py", "orbits.h5", [], "not a result of kind grazing"),
    ("plot_grazing.py", "none.h5", [], "no grazing point in it (none)"),
    ("plot_grazing.py", "regimes.h5", ["--tasks", "3"], "no task 3, it has tasks 0 to 2"),
    ("plot_grazing_windows.py", "light.h5", [], "no verdict continuous in it (discontinuous)"),
    ("plot_grazing_windows.py", "alone.h5", [], "grazing.windows of the study is 0"),
    ("plot_grazing_curve.py", "regimes.h5", [], "the study did not ask for branch.trace"),
]


@pytest.fixture(scope="module")
def results(shared):
    return Shelf(shared, MADE)


@pytest.mark.parametrize("script, name, options, endings", cases(FIGURES))
def test_figure_is_drawn(scripts, results, folder, script, name, options, endings):
    draws(scripts, results, folder, script, name, options, endings)


@pytest.mark.parametrize("script, name, options, words", cases(REFUSALS))
def test_refusal_is_one_line(scripts, results, folder, script, name, options, words):
    refuses(scripts, results, folder, script, name, options, words)


def test_default_name_stands_beside_the_result(scripts, results):
    """As a process of its own."""
    path = results["alone"]
    scripts.start("plot_grazing.py", path, cwd="/").expect_files(path.with_name("alone_grazing"))


# --- numbers in figures ---


@pytest.mark.parametrize("task", [0, 1, 2])
def test_criterion_has_the_coefficients_over_the_powers_of_the_multiplier(scripts, results, task):
    path = results["regimes"]
    (figure,) = scripts.look("plot_grazing.py", path, "--tasks", task)
    right = figure.axes[2]
    heads = next(marks.get_offsets() for marks in right.collections if len(marks.get_offsets()) > 1)
    i, size = np.arange(len(heads)), np.abs(column(path, "grazing/multiplier")[task])
    assert len(heads) == 13 and (heads[:, 0] == i).all()
    assert np.allclose(heads[:, 1], column(path, "grazing/coefficient")[task, :13] / size**i, rtol=1e-12)
    alpha = column(path, "grazing/alpha")[task]
    assert any(set(line.get_ydata()) == {alpha} for line in right.lines)


def test_windows_are_bars_between_their_edges(scripts, results):
    path = results["regimes"]
    (figure,) = scripts.look("plot_grazing_windows.py", path)
    panels = [axes for axes in figure.axes if axes.get_ylabel() == "period $n$"]
    names = ("period", "exists", "low_d", "high_d")
    tasks = zip(*(column(path, f"grazing/window_{name}") for name in names))
    shown = 0
    for axes, (period, exists, low, high) in zip(panels, tasks):
        bars = [line.get_xydata() for line in axes.lines if line.get_linewidth() == 7]
        wanted = [[[a, n], [b, n]] for a, b, n in zip(low[exists], high[exists], period[exists])]
        assert np.array(bars).tolist() == wanted
        shown += len(bars)
    assert len(panels) == 3 and shown > 10


@pytest.mark.parametrize("name", ["light", "heavy"])
def test_curve_goes_through_all_points(scripts, results, name):
    path = results[name]
    (figure,) = scripts.look("plot_grazing_curve.py", path)
    wanted = np.column_stack([column(path, f"grazing/curve_{of}") for of in ("second", "parameter")])
    drawn = [line.get_xydata() for line in figure.axes[0].lines if line.get_linewidth() == 3]
    assert_among(wanted, *np.concatenate(drawn).T)
    assert_among(np.concatenate(drawn), *wanted.T)
