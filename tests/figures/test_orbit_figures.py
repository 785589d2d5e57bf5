"""Figures of results of kind `orbits`: sweeps of every shape that the scripts take, and what they cannot draw."""

import numpy as np
import pytest
from drawing import (
    FAMILY, Shelf, absent, assert_among, beginning_of, broken, cases, column, computed, counts, draws, foreign,
    no_hdf5, over_gamma, points, refuses, refuses_places, ring,
)  # fmt: skip

PERIODS = "  - {parameter: orbit.period, values: [6, 5.6, 5, 4.5, 4.2, 3.9, 3.4]}\n"
GRID = PERIODS + over_gamma("from: 0, to: 0.6, points: 9")
EXACT = "values: [0.18, 0.19, 0.194, 0.19444, 0.1944444, 0.1944444444444444444]"

STUDIES = {
    "family": FAMILY,
    "poles": ring("costs 5 $ and 6 $", over_gamma("from: 0, to: 1.2, points: 121"), ", special_points: true"),
    "falling": ring("falling values", over_gamma("values: [0.15, 0.1, 0.12, 0]")),
    "one": ring("a single point", over_gamma("values: [0.1]")),
    "logarithmic": ring("equal ratios", over_gamma("from: 1e-4, to: 0.1, points: 7, scale: log")),
    "exact": ring("through gamma_c exactly", over_gamma(EXACT)),
    "grid": ring("a grid", GRID),
    "stable": ring(
        "multipliers", over_gamma("from: 0, to: 0.25, points: 51"), ", multipliers: true, special_points: true"
    ),
    "spread": ring("far from the circle", "", ", multipliers: true, at_half: [2]").replace("sweep:", ""),
    "stable_grid": ring("stability", GRID, ", stable: true"),
    "ritz": """kind: orbits
title: Ritz
model: {type: duffing_chain, particles: 2, mass: 1, stiffness: [3, 1], cubic: [0, 0], wall: 2}
orbit: {period: 6.8, at_start: [1], method: ritz}
sweep:
  - {parameter: "model.cubic[1]", values: [0, 0.1]}
  - {parameter: orbit.functions, values: [2, 4, 8]}
""",
    "stateless": ring("no states", over_gamma("from: 0, to: 0.19, points: 3"), ", states: false"),
    "floors": """kind: orbits
title: the floor of one particle
model: {type: chain, particles: 5, ends: free, gamma: 0.1, floor: [-1, -1, null, -1, -1]}
orbit:
  period: 1.5 pi
  at_start:
    - 1
  at_half: [4]
sweep:
  - {parameter: "model.floor[3]", values: [-0.9, -0.1, -0.001, -0.5]}
""",
}

FAILURES = ("failed", "singular", "not_converged", "resonant")
MADE = {
    "broken": broken("poles", "orbits", [0, 5, 6, 40, 41, 80, 120], FAILURES),
    "nothing": broken("falling", "orbits", range(4), FAILURES),
    "broken_stable": broken("stable", "orbits", [0, 7, 20, 50], FAILURES),
    "broken_grid": broken("grid", "orbits", [3, 20, 21, 62], FAILURES),
    "absent": absent,
    "text": no_hdf5,
    "truncated": beginning_of("family"),
    "foreign": foreign("numbers"),
}

# script, result, options
FIGURES = [
    ("plot_modes.py", "family", []),
    ("plot_modes.py", "poles", ["--all", "--curves", "20"]),
    ("plot_modes.py", "floors", []),
    ("plot_modes.py", "one", []),
    ("plot_modes.py", "logarithmic", []),
    ("plot_modes.py", "broken", []),
    ("plot_sweep.py", "family", []),
    ("plot_sweep.py", "poles", []),
    ("plot_sweep.py", "falling", []),
    ("plot_sweep.py", "one", []),
    ("plot_sweep.py", "logarithmic", []),
    ("plot_sweep.py", "stateless", []),
    ("plot_sweep.py", "broken", []),
    ("plot_sweep.py", "nothing", []),
    ("plot_sweep.py", "stable", []),
    ("plot_map.py", "grid", []),
    ("plot_map.py", "grid", ["--swap", "--quantity", "clearance"]),
    ("plot_map.py", "grid", ["--quantity", "none"]),
    ("plot_map.py", "broken_grid", []),
    ("plot_approach.py", "exact", []),
    ("plot_multipliers.py", "stable", []),
    ("plot_multipliers.py", "stable", ["--task", "40"]),
    ("plot_multipliers.py", "spread", []),
    ("plot_multipliers.py", "broken_stable", []),
    ("plot_stability.py", "stable_grid", []),
    ("plot_stability.py", "stable_grid", ["--all", "--swap"]),
    ("plot_ritz.py", "ritz", []),
    ("plot_ritz.py", "ritz", ["--stalled", "ritz.h5"]),
]

# script, file, options, words of the message
NOT_ASKED = "in it (the study did not ask for orbit."
REFUSALS = [
    ("plot_modes.py", "absent.h5", [], "no such file"),
    ("plot_sweep.py", "text.h5", [], "not a readable result"),
    ("plot_map.py", "truncated.h5", [], "not a readable result"),
    ("plot_approach.py", "foreign.h5", [], "not a result of kind orbits"),
    ("plot_map.py", "family.h5", [], "1 swept parameters (model.gamma), this figure needs 2"),
    ("plot_sweep.py", "grid.h5", [], "2 swept parameters (orbit.period, model.gamma), this figure needs 1"),
    ("plot_modes.py", "stateless.h5", [], "no /orbits/q"),
    ("plot_approach.py", "family.h5", [], "0 tasks with the outcome grazing"),
    ("plot_multipliers.py", "family.h5", [], f"no /orbits/multipliers {NOT_ASKED}multipliers)"),
    ("plot_stability.py", "grid.h5", [], f"no /orbits/stable {NOT_ASKED}stable)"),
    ("plot_stability.py", "stable.h5", [], "1 swept parameters (model.gamma), this figure needs 2"),
    ("plot_ritz.py", "family.h5", [], "not a result of kind orbits with method: ritz"),
]


@pytest.fixture(scope="module")
def results(ricochet, shared):
    return Shelf(shared, computed(ricochet, STUDIES) | MADE)


@pytest.mark.parametrize("script, name, options", cases(FIGURES))
def test_figure_is_drawn(scripts, results, folder, script, name, options):
    draws(scripts, results, folder, script, name, options)


@pytest.mark.parametrize("script, name, options, words", cases(REFUSALS))
def test_refusal_is_one_line(scripts, results, folder, script, name, options, words):
    refuses(scripts, results, folder, script, name, options, words)


def test_unwritable_output_is_one_line(scripts, results):
    refuses_places(scripts, results, "plot_sweep.py", "family.h5")


# --- as processes of their own ---


def test_default_names_stand_beside_the_result(scripts, results):
    path = results["family"]
    scripts.start("plot_modes.py", path, cwd="/").expect_files(path.with_name("family_modes"))


def test_refusal_of_a_process_is_one_line(scripts, results):
    cwd = results.folder_of("truncated.h5")
    done = scripts.start("plot_map.py", "truncated.h5", "-o", "refused", cwd=cwd)
    done.expect_refused("plot_map.py: truncated.h5: ", "not a readable result")
    assert not list(cwd.glob("refused*"))


# --- numbers in figures ---


def curves(axes):
    """Displacements or velocities of each curve of plot_modes.py, and the parameters that colour them."""
    lines = axes.collections[0]
    return np.array(lines.get_segments())[:, :, 1], lines.get_array()


def sound(path):
    return np.isin(column(path, "orbits/outcome"), ("admissible", "grazing"))


def test_modes_are_the_states_of_admissible_orbits(scripts, results):
    path = results["poles"]
    (figure,) = scripts.look("plot_modes.py", path, "--curves", "200")
    rows = np.flatnonzero(sound(path))
    assert 10 < len(rows) < 121
    for axes, name in zip(figure.axes, ("q", "v")):
        states, at = curves(axes)
        assert (states == column(path, f"orbits/{name}")[rows]).all()
        assert (at == column(path, "sweep/model.gamma")[rows]).all()


def test_modes_are_thinned_evenly(scripts, results):
    (figure,) = scripts.look("plot_modes.py", results["poles"], "--all", "--curves", "20")
    finite = np.isfinite(column(results["poles"], "orbits/q")).all(axis=1)
    at = column(results["poles"], "sweep/model.gamma")[finite]
    shown = curves(figure.axes[0])[1]
    assert len(shown) == 20 and shown[0] == at[0] and shown[-1] == at[-1] and np.ptp(np.diff(shown)) < 0.025


@pytest.mark.parametrize("name", ["family", "falling", "broken"])
def test_sweep_has_every_task_that_has_numbers(scripts, results, name):
    path = results[name]
    (figure,) = scripts.look("plot_sweep.py", path)
    panels = {axes.get_ylabel(): axes for axes in figure.axes}
    at = column(path, "sweep/model.gamma")
    for label, data in (("impulse", "impulse"), ("energy", "energy"), ("smallest gap", "clearance")):
        values = column(path, f"orbits/{data}").reshape(len(at))
        known = np.isfinite(values)
        drawn = points(panels[label])
        assert_among(np.column_stack([at, values])[known], *drawn.T)
        assert_among(drawn, at[known], values[known])


def test_sweep_counts_the_outcomes(scripts, results):
    (figure,) = scripts.look("plot_sweep.py", results["broken"])
    words = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    words += [text.get_text() for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()]
    for outcome, count in counts(column(results["broken"], "orbits/outcome")).items():
        if outcome != "inadmissible":  # told in two parts
            assert f"{outcome.replace('_', ' ')} ({count})" in words, words


def matrix(path, values):
    """Over rising periods across and rising gamma upwards."""
    period, gamma = column(path, "sweep/orbit.period"), column(path, "sweep/model.gamma")
    return values[np.lexsort((period, gamma))]


def test_map_has_the_outcomes_and_energies_of_the_grid(scripts, results):
    path = results["grid"]
    (figure,) = scripts.look("plot_map.py", path)
    left, right = (axes.collections[0].get_array().ravel() for axes in figure.axes[:2])
    outcome = column(path, "orbits/outcome")
    assert len(left) == len(outcome) == 63
    # One colour for each outcome, besides the inadmissible ones, which have two.
    for word in set(outcome) - {"inadmissible"}:
        where = matrix(path, outcome == word)
        assert len(set(left[where])) == 1 and not set(left[where]) & set(left[~where]), word
    energy = matrix(path, np.where(sound(path), column(path, "orbits/energy"), np.nan))
    shown = np.ma.filled(right, np.nan)
    assert np.isfinite(energy).sum() > 10 and np.array_equal(shown, energy, equal_nan=True)


def test_stability_has_the_words_of_the_grid(scripts, results):
    path = results["stable_grid"]
    (figure,) = scripts.look("plot_stability.py", path, "--all")
    left, right = (axes.collections[0].get_array().ravel() for axes in figure.axes[:2])
    stable, largest = column(path, "orbits/stable"), column(path, "orbits/multiplier_max")
    assert sorted(counts(left).values()) == sorted(counts(stable).values())
    shown = matrix(path, np.where((stable == "unstable") & np.isfinite(largest), largest, np.nan))
    assert np.array_equal(np.ma.filled(right, np.nan), shown, equal_nan=True)


def test_multipliers_are_those_of_the_result(scripts, results):
    path = results["stable"]
    (figure,) = scripts.look("plot_multipliers.py", path, "--task", "40")
    plane, modulus, argument = figure.axes[:3]
    at, multipliers = column(path, "sweep/model.gamma"), column(path, "orbits/multipliers")
    inside = multipliers[40][np.abs(multipliers[40]) <= plane.get_xlim()[1]]
    drawn = np.concatenate([marks.get_offsets() for marks in plane.collections])
    assert sorted(map(tuple, drawn.tolist())) == sorted(zip(inside.real.tolist(), inside.imag.tolist()))
    known = np.isfinite(multipliers)
    for axes, heights in ((modulus, np.abs(multipliers)), (argument, np.abs(np.angle(multipliers)) / np.pi)):
        drawn = np.concatenate([np.ma.filled(marks.get_offsets(), np.nan) for marks in axes.collections[:6]])
        assert len(drawn) == known.sum()
        assert_among(drawn, np.repeat(at, multipliers.shape[1])[known.ravel()], heights[known])


def test_approach_has_impulses_over_the_distance(scripts, results):
    path = results["exact"]
    (figure,) = scripts.look("plot_approach.py", path)
    at, impulse = column(path, "sweep/model.gamma"), column(path, "orbits/impulse").reshape(-1)
    assert (column(path, "orbits/outcome") == "grazing").tolist() == [False] * 5 + [True]
    drawn = figure.axes[1].lines[0].get_xydata()
    assert (drawn == np.column_stack([at[-1] - at[:-1], impulse[:-1]])).all()


def test_ritz_has_the_errors_of_the_result(scripts, results):
    path = results["ritz"]
    (figure,) = scripts.look("plot_ritz.py", path)
    functions = column(path, "orbits/ritz_functions")
    for axes, name in zip(figure.axes, ("ritz_error", "ritz_error_v", "ritz_defect")):
        lines = [line.get_xydata() for line in axes.lines if line.get_marker() != "None"]
        assert [len(line) for line in lines] == [3, 3]
        assert (np.concatenate(lines) == np.column_stack([functions, column(path, f"orbits/{name}")])).all()
