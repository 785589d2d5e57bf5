"""Figures of results of kind orbits: what they draw, and what they cannot draw."""

import numpy as np
import pytest
from album import assert_among, column, counts
from both import test_all_of_it_fits, test_refusals_say_what_is_missing  # noqa: F401  # of PICTURES and REFUSALS
from shelf import FAMILY, broken, over_gamma, ring

import ricochet
from ricochet.plot.orbits.resonance import wave_numbers

PERIODS = "  - {parameter: orbit.period, values: [6, 5.6, 5, 4.5, 4.2, 3.9, 3.4]}\n"
GRID = PERIODS + over_gamma("from: 0, to: 0.6, points: 15")
EXACT = "values: [0.18, 0.19, 0.194, 0.19444, 0.1944444, 0.1944444444444444444]"

CHAIN = """kind: orbits
title: a chain
model: {{type: chain, particles: {particles}, ends: {ends}, gamma: 0.1, floor: -1{model}}}
orbit: {{period: 1.5 pi, at_start: [1], method: {method}}}
sweep:
  - {{parameter: orbit.period, values: [4.5, 5]}}
  - {{parameter: model.gamma, values: [0, 0.5]}}
"""


def chain(particles, ends, model="", method="impulse"):
    return CHAIN.format(particles=particles, ends=ends, model=model, method=method)


EQUAL = ", mass: 2, stiffness: 1.5"
CHAINS = {
    "ring_6": chain(6, "periodic"),
    "ring_5": chain(5, "periodic"),
    "fixed_8": chain(8, "fixed"),
    "free_4": chain(4, "free"),
    "equal": chain(4, "fixed", EQUAL, "shooting"),
    "symmetric": chain(8, "fixed").replace("[1]", "[2, 5]"),
    "in_phase": chain(4, "periodic").replace("[1]", "[0, 1, 2, 3]"),
    "unequal": chain(3, "fixed", ", mass: [1, 2, 1]", "shooting"),
    "nonlinear": chain(3, "fixed", ", cubic: 0.1", "shooting"),
}
STUDIES = {
    "family": FAMILY,
    "poles": ring("costs 5 $ and 6 $", over_gamma("from: 0, to: 1.2, points: 121"), ", special_points: true"),
    "falling": ring("falling values", over_gamma("values: [0.15, 0.1, 0.12, 0]")),
    "one": ring("a single point", over_gamma("values: [0.1]")),
    "logarithmic": ring("equal ratios", over_gamma("from: 1e-4, to: 0.1, points: 7, scale: log")),
    "exact": ring("through gamma_c exactly", over_gamma(EXACT)),
    "stable": ring(
        "multipliers", over_gamma("from: 0, to: 0.25, points: 51"), ", multipliers: true, special_points: true"
    ),
    "spread": ring("far from the circle", "", ", multipliers: true, at_half: [2]").replace("sweep:", ""),
    "grid": ring("a grid", GRID),
    "stable_grid": ring("stability", GRID, ", stable: true"),
    "twice": ring("there and back", PERIODS + over_gamma("values: [0, 0.1, 0]")),
    "stateless": ring("no states", over_gamma("from: 0, to: 0.19, points: 3"), ", states: false"),
    "all_hit": ring("in phase", over_gamma("values: [0, 0.1, 0.2]")).replace("[3]", "[0, 1, 2], at_half: [3, 4, 5]"),
    "who_hits": ring("which particle", '  - {parameter: "orbit.at_start[0]", values: [0, 1, 2]}'),
    "obstacles": """kind: orbits
title: obstacles of their own
model: {type: chain, particles: 5, ends: free, gamma: 0.1, floor: [-1, -1, null, -1, -1.5], wall: [null, 2, 2, 1.5, 40]}
orbit:
  method: shooting
  period: 1.5 pi
  at_start:
    - 1
  at_half: [4]
sweep:
  - {parameter: "model.floor[3]", values: [-0.9, -0.8, -0.7]}
""",
    "ritz": """kind: orbits
title: Ritz
model: {type: duffing_chain, particles: 2, mass: 1, stiffness: [3, 1], cubic: [0, 0], wall: 2}
orbit: {period: 6.8, at_start: [1], method: ritz}
sweep:
  - {parameter: "model.cubic[1]", values: [0, 0.1]}
  - {parameter: orbit.functions, values: [2, 4, 8]}
""",
    "first_resonance": chain(8, "fixed").split("sweep:")[0].replace("impulse", "impulse, special_points: true")
    + "sweep:\n" + over_gamma("from: 0, to: 0.5, points: 3"),
    **CHAINS,
}  # fmt: skip
FAILURES = ("failed", "singular", "not_converged", "resonant")
MADE = {
    "broken": broken("poles", "orbits", [0, 5, 6, 40, 41, 80, 120], FAILURES),
    "nothing": broken("falling", "orbits", range(4), FAILURES),
    "broken_stable": broken("stable", "orbits", [0, 7, 20, 50], FAILURES),
    "unknown": broken("stable", "orbits", range(51), FAILURES),
    "broken_grid": broken("grid", "orbits", [3, 20, 21, 62], FAILURES),
}

COLUMN = {"style": {"column": True}}
# figure, result, options
PICTURES = [
    ("modes", "family", {}),
    ("modes", "poles", {"all": True, "curves": 20}),
    ("modes", "obstacles", {}),
    ("modes", "one", {}),
    ("modes", "spread", {}),
    ("modes", "family", COLUMN),
    ("sweep", "one", {}),
    ("sweep", "logarithmic", {}),
    ("sweep", "nothing", {}),
    ("sweep", "stable", {}),
    ("sweep", "poles", COLUMN),
    ("map", "grid", {}),
    ("map", "grid", {"x": "gamma", "quantity": "clearance"}),
    ("map", "broken_grid", COLUMN),
    ("stability", "stable_grid", {"all": True, "x": "model.gamma", **COLUMN}),
    ("multipliers", "stable", {"task": 40}),
    ("multipliers", "spread", {}),
    ("multipliers", "broken_stable", COLUMN),
    ("approach", "exact", {}),
    ("approach", "exact", COLUMN),
    ("ritz", "ritz", {}),
]
# figure, result, options, words of the message
REFUSALS = [
    ("modes", "stateless", {}, "it has no orbits/q (the study did not ask for orbit.states)"),
    ("modes", "nothing", {}, "no orbit of it is admissible"),
    ("modes", "family", {"curves": 0}, "curves = 0, expected at least 1"),
    ("modes", "grid", {}, "2 swept parameters, this figure shows one at most"),
    ("sweep", "grid", {}, "2 swept parameters (orbit.period, model.gamma), this figure needs 1"),
    ("map", "family", {}, "1 swept parameter (model.gamma), this figure needs 2"),
    ("map", "twice", {}, "a value of model.gamma stands twice in the sweep"),
    ("map", "grid", {"x": "floor"}, "floor is not swept; the study sweeps orbit.period, model.gamma"),
    ("stability", "grid", {}, "it has no orbits/stable (the study did not ask for orbit.stable)"),
    ("stability", "stable", {}, "1 swept parameter (model.gamma), this figure needs 2"),
    ("multipliers", "family", {}, "it has no orbits/multipliers (the study did not ask for orbit.multipliers)"),
    ("multipliers", "unknown", {}, "no task of it has multipliers"),
    ("multipliers", "broken_stable", {"task": 7}, "the multipliers of task 7 are not known"),
    ("multipliers", "stable", {"task": 51}, "it has no task 51, only tasks 0 to 50"),
    ("approach", "family", {}, "0 tasks with the outcome grazing, this figure needs one"),
    ("ritz", "family", {}, "it has no orbits/ritz_functions (the study did not ask for orbit.method: ritz)"),
]


def natural(results, name):
    with ricochet.open(results[name]) as result:
        return [spec.name for spec in ricochet.plot.figures_of(result) if spec.natural(result)]


def test_natural_figures_are_those_that_one_wants(results):
    assert natural(results, "exact") == ["approach", "modes", "sweep"]
    assert natural(results, "family") == ["modes", "sweep"]
    assert natural(results, "grid") == ["map"]
    assert natural(results, "ritz") == ["ritz"]  # not a map over the number of functions


def sound(path):
    return np.isin(column(path, "orbits/outcome"), ("admissible", "grazing"))


# --- modes ---


def curves(drawn, panel):
    """States of each curve, and the parameters that colour them."""
    lines = drawn.axes[panel].collections[0]
    return np.array(lines.get_segments())[:, :, 1], lines.get_array()


def test_modes_are_the_stored_states_against_the_particle(picture, results):
    drawn = picture("modes", "family")
    for panel, name in enumerate(("q", "v")):
        states = column(results["family"], f"orbits/{name}")
        wanted = np.column_stack([np.tile(np.arange(6), len(states)), states.ravel()])
        assert_among(wanted, drawn.offsets(panel))
    assert drawn.heading == ["a family", "ring of 6 particles, floor at $-1$, $T = 1.5\\,\\pi$"]
    assert drawn.labels(1) == ("particle", "velocity $v$ at $t = 0^+$")
    assert drawn.legend == ["hits at $t = 0$", "floor"] and drawn.notes == ""


def test_modes_are_those_of_admissible_orbits(picture, results):
    path, drawn = results["poles"], picture("modes", "poles", curves=200)
    rows = np.flatnonzero(sound(path))
    assert 10 < len(rows) < 121
    for panel, name in enumerate(("q", "v")):
        states, at = curves(drawn, panel)
        assert (states == column(path, f"orbits/{name}")[rows]).all()
        assert (at == column(path, "sweep/model.gamma")[rows]).all()
    assert f"{121 - len(rows)} orbits not admissible (drawn with --all)" in drawn.notes
    assert "7 tasks without an orbit" in picture("modes", "broken").notes


def test_modes_are_thinned_evenly(picture, results):
    drawn = picture("modes", "poles", all=True, curves=20)
    at, shown = column(results["poles"], "sweep/model.gamma"), curves(drawn, 0)[1]
    assert len(shown) == 20 and shown[0] == at[0] and shown[-1] == at[-1] and np.ptp(np.diff(shown)) < 0.025
    assert "20 of 121 orbits, evenly picked" in drawn.notes and "admissible" not in drawn.notes


def test_every_particle_has_its_own_floor_and_wall(picture):
    drawn = picture("modes", "obstacles")
    lines = [segment for lines in drawn.axes[0].collections[1:] for segment in getattr(lines, "get_segments", list)()]
    surfaces = sorted((segment[0][1], segment[0][0], segment[-1][0]) for segment in lines)
    # The floor of particle 3 is swept; particle 2 has none; the wall of particle 4 lies far away.
    assert surfaces == [(-1.5, 3.5, 4.5), (-1, -0.5, 1.5), (1.5, 2.5, 3.5), (2, 0.5, 2.5)]
    assert drawn.legend == ["hits at $t = 0$", "hits at $t = T/2$", "floor", "wall"]


# --- sweeps ---


def panels(drawn):
    return {axes.get_ylabel() or axes.get_yticklabels()[0].get_text(): axes for axes in drawn.axes}


def points_of(axes):
    drawn = np.concatenate(
        [line.get_xydata() for line in axes.lines if len(line.get_xdata()) != 2 or line.get_marker() == "."]
    )
    return drawn[np.isfinite(drawn).all(axis=1)]


@pytest.mark.parametrize("name", ["poles", "falling", "broken"])
def test_sweep_has_every_task_that_has_numbers(picture, results, name):
    path, found = results[name], panels(picture("sweep", name))
    at = column(path, "sweep/model.gamma")
    for label, data in (("impulse", "impulse"), ("energy $E$", "energy"), ("smallest gap", "clearance")):
        values = column(path, f"orbits/{data}").reshape(len(at))
        known = np.isfinite(values)
        drawn = points_of(found[label])
        assert_among(np.column_stack([at, values])[known], drawn)
        assert_among(drawn, np.column_stack([at, values])[known])


def test_curves_of_a_sweep_end_at_singular_points(picture, results):
    path, axes = results["poles"], panels(picture("sweep", "poles"))["energy $E$"]
    at = column(path, "special/parameter")[column(path, "special/kind") == "singular"]
    assert len(at) > 1
    for x in (line.get_xdata() for line in axes.lines if len(line.get_xdata()) > 2):
        assert not any(((x[:-1] < pole) & (pole < x[1:])).any() for pole in at)


def test_sweep_counts_outcomes_and_special_points(picture, results):
    path, drawn = results["broken"], picture("sweep", "broken")
    for outcome, count in counts(column(path, "orbits/outcome")).items():
        if outcome != "inadmissible":  # told in two parts
            assert f"{outcome.replace('_', ' ')} ({count})" in drawn.legend
    singular = (column(path, "special/kind") == "singular").sum()
    assert f"singular point: amplitudes blow up ({singular})" in drawn.legend
    assert "orbit that is not admissible" in drawn.legend
    assert "impulse: axis clipped, values from $-" in drawn.notes


def test_sweep_has_a_strip_of_stability(picture, results):
    path, drawn = results["stable"], picture("sweep", "stable")
    bands = panels(drawn)["stability"].patches
    stable = counts(column(path, "orbits/stable")[sound(path)])
    assert stable.keys() == {"stable", "unstable"}
    assert {f"{word} ({count})" for word, count in stable.items()} <= set(drawn.legend)
    edge = bands[0].get_xy()[:, 0].max()  # of the band of stable orbits, the first
    at = column(path, "sweep/model.gamma")
    last = at[sound(path) & (column(path, "orbits/stable") == "stable")].max()
    assert last < edge < last + 0.005
    assert f"stability of {(~sound(path)).sum()} orbits that are not admissible is left out" in drawn.notes
    shown = picture("sweep", "stable", all=True)
    assert "left out" not in shown.notes
    whole = counts(column(path, "orbits/stable"))
    assert {f"{word} ({count})" for word, count in whole.items()} <= set(shown.legend)
    assert "stability" not in panels(picture("sweep", "family"))


def test_sweep_names_who_hits(picture):
    drawn = picture("sweep", "all_hit")
    assert drawn.heading[1].endswith("particles 0, 1, 2 hit at $t = 0$, 3, 4, 5 at $t = T/2$")
    assert picture("sweep", "family").heading[1].endswith("particle 3 hits")
    named = {label for label in drawn.legend if label.startswith(("impulse", "equal"))}
    assert named == {"equal impulses of particles 0, 2, 3, 5", "equal impulses of particles 1, 4"}
    drawn = picture("sweep", "who_hits")
    assert "hits" not in drawn.heading[1] and drawn.axes[2].get_xlabel() == "particle that hits at $t = 0$"


def test_sweep_takes_limits_of_its_axes(picture):
    drawn = picture("sweep", "poles", style={"xlim": (0, 0.19), "ylim": (0, 3)})
    assert {axes.get_xlim() for axes in drawn.axes} == {(0, 0.19)} and panels(drawn)["impulse"].get_ylim() == (0, 3)


# --- maps ---


def matrix(path, values):
    """Over rising periods across and rising gamma upwards."""
    period, gamma = column(path, "sweep/orbit.period"), column(path, "sweep/model.gamma")
    return values[np.lexsort((period, gamma))]


def cells(drawn, panel):
    return np.ma.filled(drawn.axes[panel].collections[0].get_array(), np.nan).ravel()


def test_map_has_the_outcomes_and_energies_of_the_grid(picture, results):
    path, drawn = results["grid"], picture("map", "grid")
    left, right = cells(drawn, 0), cells(drawn, 1)
    outcome = column(path, "orbits/outcome")
    assert len(left) == len(outcome) == 105
    # One colour for each outcome, besides the inadmissible ones, which have two.
    for word in set(outcome) - {"inadmissible"}:
        where = matrix(path, outcome == word)
        assert len(set(left[where])) == 1 and not set(left[where]) & set(left[~where]), word
    energy = matrix(path, np.where(sound(path), column(path, "orbits/energy"), np.nan))
    assert np.isfinite(energy).sum() > 10 and np.array_equal(right, energy, equal_nan=True)
    assert drawn.labels() == ("period $T$", r"coupling $\gamma$") and "right panel: not admissible" in drawn.legend


def test_map_can_have_the_other_parameter_across(picture, results):
    path, drawn = results["grid"], picture("map", "grid", x="gamma", quantity="clearance")
    assert drawn.labels() == (r"coupling $\gamma$", "period $T$")
    gap = column(path, "orbits/clearance")
    gap = matrix(path, np.where(sound(path) & (gap > 0), gap, np.nan)).reshape(15, 7).T.ravel()
    assert np.array_equal(cells(drawn, 1), gap, equal_nan=True)


def test_map_says_that_lone_cells_are_no_islands(picture):
    left = picture("map", "grid").axes[0].collections[0].get_array().reshape(15, 7)
    padded = np.pad(left.astype(float), 1, constant_values=-1)
    around = (padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:])
    lone = np.all([side != left for side in around], axis=0).sum()
    assert lone > 0
    assert f"{lone} of 7 × 15 points differ from all four neighbours" in picture("map", "grid").notes
    assert "neighbours" not in picture("map", "ring_6", quantity="none").notes


def test_rare_outcomes_of_a_map_are_marked(results, picture):
    path = results["broken_grid"]
    drawn = picture("map", "broken_grid", **COLUMN)
    failed = np.flatnonzero(column(path, "orbits/outcome") == "failed")
    assert len(failed) == 1 and "failed (1)" in drawn.legend
    place = column(path, "sweep/orbit.period")[failed[0]], column(path, "sweep/model.gamma")[failed[0]]
    assert any(np.array_equal(line.get_xydata(), [place]) for line in drawn.axes[0].lines)
    rare = sum(count == 1 for count in counts(column(path, "orbits/outcome")).values())
    assert len(drawn.points()) == 2 * 400 + rare  # those of the curve, drawn twice, and no others


def test_stability_has_the_words_of_the_grid(picture, results):
    path, drawn = results["stable_grid"], picture("stability", "stable_grid", all=True)
    stable, largest = column(path, "orbits/stable"), column(path, "orbits/multiplier_max")
    assert sorted(counts(cells(drawn, 0)).values()) == sorted(counts(stable).values())
    shown = matrix(path, np.where((stable == "unstable") & np.isfinite(largest), largest, np.nan))
    assert np.array_equal(cells(drawn, 1), shown, equal_nan=True)


def test_stability_leaves_out_what_is_not_admissible(picture, results):
    path, drawn = results["stable_grid"], picture("stability", "stable_grid")
    left_out = ~sound(path)
    assert f"not admissible ({left_out.sum()})" in drawn.legend and "--all" in drawn.notes
    assert len(set(cells(drawn, 0)[matrix(path, left_out)])) == 1
    assert np.isnan(cells(drawn, 1)[matrix(path, left_out)]).all()
    assert "--all" not in picture("stability", "stable_grid", all=True).notes


# --- the first resonance ---


def coupling_matrix(particles, ends):
    found = 2 * np.eye(particles) - np.eye(particles, k=1) - np.eye(particles, k=-1)
    if ends == "free":
        found[0, 0] = found[-1, -1] = 1
    if ends == "periodic":
        found[0, -1] -= 1
        found[-1, 0] -= 1
    return found


def resonance(drawn):
    """The dashed curve of a map: [point, (period, coupling)]."""
    lines = [line for line in drawn.axes[0].lines if line.get_color() == "black"]
    return lines[0].get_xydata() if lines else None


@pytest.mark.parametrize("ends", ["periodic", "fixed", "free"])
def test_wave_numbers_give_the_eigenvalues_of_the_coupling_matrix(ends):
    for particles in range(3, 13):
        wanted = np.unique(np.linalg.eigvalsh(coupling_matrix(particles, ends)).round(9))[::-1]
        assert 4 * np.sin(wave_numbers(particles, ends) / 2) ** 2 == pytest.approx(wanted, abs=2e-9)


@pytest.mark.parametrize(
    "name, particles, ends, mass, stiffness",
    [("ring_6", 6, "periodic", 1, 1), ("ring_5", 5, "periodic", 1, 1), ("fixed_8", 8, "fixed", 1, 1),
     ("free_4", 4, "free", 1, 1), ("equal", 4, "fixed", 2, 1.5)],
)  # fmt: skip
def test_on_its_curve_the_highest_mode_has_the_period(picture, name, particles, ends, mass, stiffness):
    period, gamma = resonance(picture("map", name, quantity="none")).T
    assert np.isfinite(gamma).sum() > 100
    for T, coupling in zip(period[::40], gamma[::40]):
        stiff = stiffness * np.eye(particles) + coupling * coupling_matrix(particles, ends)
        assert np.sqrt(np.linalg.eigvalsh(stiff)[-1] / mass) == pytest.approx(2 * np.pi / T, rel=1e-12)


def test_the_curve_is_where_the_program_finds_the_first_resonance(picture, results):
    path = results["first_resonance"]
    first = column(path, "special/parameter")[column(path, "special/kind") == "resonance"].min()
    period, gamma = resonance(picture("map", "fixed_8", quantity="none")).T
    at_first = np.interp(1.5 * np.pi, period, gamma)
    assert first == pytest.approx(0.20049, abs=1e-5) and at_first == pytest.approx(first, abs=1e-5)


def test_a_symmetric_pattern_has_the_curve_of_the_highest_symmetric_mode(picture):
    period, gamma = resonance(picture("map", "symmetric", quantity="none")).T
    for T, coupling in zip(period[::40], gamma[::40]):
        squares, shapes = np.linalg.eigh(np.eye(8) + coupling * coupling_matrix(8, "fixed"))
        symmetric = squares[np.isclose(shapes[2], shapes[5])]
        assert np.sqrt(symmetric[-1]) == pytest.approx(2 * np.pi / T, rel=1e-12) and symmetric[-1] < squares[-1]


def test_impacts_of_all_particles_at_once_have_no_curve(picture):
    assert resonance(picture("map", "in_phase", quantity="none")) is None


def test_the_curve_of_an_even_ring_is_that_of_the_paper(picture):
    period, gamma = resonance(picture("map", "ring_6", quantity="none")).T
    assert gamma == pytest.approx(((2 * np.pi / period) ** 2 - 1) / 4, rel=1e-12)  # [JAP] (13)


@pytest.mark.parametrize("name", ["unequal", "nonlinear"])
def test_other_chains_have_no_curve(picture, name):
    drawn = picture("map", name, quantity="none")
    assert resonance(drawn) is None and not any("gamma_c" in label for label in drawn.legend)


# --- multipliers ---


def test_multipliers_are_those_of_the_result(picture, results):
    path, drawn = results["stable"], picture("multipliers", "stable", task=40)
    plane, modulus, argument = drawn.axes[:3]
    at, multipliers = column(path, "sweep/model.gamma"), column(path, "orbits/multipliers")
    inside = multipliers[40][np.abs(multipliers[40]) <= plane.get_xlim()[1]]
    marks = np.concatenate([line.get_xydata() for line in plane.lines if line.get_marker() in "osD"])
    assert sorted(map(tuple, marks.tolist())) == sorted(zip(inside.real.tolist(), inside.imag.tolist()))
    known = np.isfinite(multipliers)
    for axes, heights in ((modulus, np.abs(multipliers)), (argument, np.abs(np.angle(multipliers)) / np.pi)):
        marks = np.concatenate([line.get_xydata() for line in axes.lines if line.get_marker() in "osD"])
        assert len(marks) == known.sum()
        assert_among(marks, np.column_stack([np.repeat(at, multipliers.shape[1])[known.ravel()], heights[known]]))
    assert drawn.heading[1].endswith(
        f"$\\gamma = {at[40]:g}$, task 40, {column(path, 'orbits/stable')[40]}, not admissible"
    )


def test_multipliers_of_one_argument_do_not_hide_one_another(picture):
    looks = {}
    for line in picture("multipliers", "stable").axes[2].lines:
        if line.get_marker() in "osD" and len(line.get_xdata()):
            open_ = line.get_markerfacecolor() == "none"
            looks[line.get_marker()] = (line.get_zorder(), line.get_markersize(), open_)
    assert looks.keys() == {"o", "s", "D"}
    below_first = [looks[marker] for marker in sorted(looks, key=looks.get)]
    sizes = [size for _, size, _ in below_first]
    assert sizes == sorted(sizes, reverse=True) and len(set(sizes)) == 3 and looks["s"][2]


def test_the_plane_has_the_first_unstable_admissible_orbit(picture, results):
    path = results["stable"]
    wanted = np.flatnonzero(sound(path) & (column(path, "orbits/stable") == "unstable"))[0]
    assert f"task {wanted}, unstable" in picture("multipliers", "stable").heading[1]
    legend = picture("multipliers", "stable").legend
    critical = column(path, "special/parameter")[column(path, "special/kind") == "plus_one"]
    assert any(label.startswith(f"pair at +1: {critical[0]:.6g}") for label in legend)


def test_multipliers_far_from_the_circle_are_named(picture, results):
    drawn = picture("multipliers", "spread")
    multipliers = column(results["spread"], "orbits/multipliers")[0]
    limit = drawn.axes[0].get_xlim()[1]
    largest = multipliers[np.abs(multipliers) > limit]
    assert len(largest)
    texts = " ".join(text.get_text() for text in drawn.axes[0].texts)
    assert all(f"{abs(mu.real):.4g}" in texts for mu in largest[:4])
    assert "task" not in drawn.heading[1]  # there is one


# --- approach ---


def test_approach_has_impulses_over_the_distance(picture, results):
    path, drawn = results["exact"], picture("approach", "exact")
    at, impulse = column(path, "sweep/model.gamma"), column(path, "orbits/impulse").reshape(-1)
    assert (column(path, "orbits/outcome") == "grazing").tolist() == [False] * 5 + [True]
    first, second = (line.get_xydata() for line in drawn.axes[1].lines[:2])
    assert (first == np.column_stack([at[-1] - at[:-1], impulse[:-1]])).all()
    q = column(path, "orbits/q")
    assert (second == np.column_stack([at[-1] - at[:-1], np.abs(q[:-1] - q[-1]).max(axis=1)])).all()
    assert drawn.labels(1)[0] == r"$\gamma_c - \gamma$" and "slopes over the 3 nearest points" in drawn.notes
    slope = np.polyfit(np.log10(first[-3:, 0]), np.log10(first[-3:, 1]), 1)[0]
    assert f"impulse, slope {slope:.4f}" in drawn.legend


# --- ritz ---


def test_ritz_has_the_errors_of_the_result(picture, results):
    path, drawn = results["ritz"], picture("ritz", "ritz")
    functions = column(path, "orbits/ritz_functions")
    for axes, name in zip(drawn.axes, ("ritz_error", "ritz_error_v", "ritz_defect")):
        lines = [line.get_xydata() for line in axes.lines if line.get_marker() != "None"]
        assert [len(line) for line in lines] == [3, 3]
        assert (np.concatenate(lines) == np.column_stack([functions, column(path, f"orbits/{name}")])).all()
    title, system = drawn.heading
    assert title == "Ritz" and system.startswith("2 masses in series, stiffness") and system.endswith("$T = 6.8$")
    assert drawn.legend == ["cubic term of spring 1 = $0$", "cubic term of spring 1 = $0.1$"] and drawn.notes == ""


def test_ritz_compares_with_a_result_without_constants(picture, results):
    drawn = picture("ritz", "ritz", stalled=str(results["ritz"]))
    dotted = [line.get_ydata() for line in drawn.axes[0].lines if line.get_linestyle() == ":"]
    assert (np.concatenate(dotted) == column(results["ritz"], "orbits/ritz_error")).all()
    assert drawn.legend[-1] == "displacements without constants"
    with pytest.raises(ricochet.plot.FigureError) as refused:
        picture("ritz", "ritz", stalled=str(results["family"]))
    assert "family.h5: it has no orbits/ritz_error" in str(refused.value)
