"""The figure of any column: what is on its axes, what its curves are, and what it cannot draw."""

import numpy as np
import pytest
from album import assert_among, column
from matplotlib.colors import to_hex
from shelf import FAMILY, altered, over_gamma, ring

import ricochet
from ricochet.plot.quantities import numeric_columns, quantity

GRID = """  - {parameter: orbit.period, values: [4, 4.1, 5]}
  - {parameter: model.gamma, from: 0.01, to: 0.15, points: 8}"""
WIDE = GRID.replace("[4, 4.1, 5]", "[3.9, 4, 4.1, 4.2, 4.3, 4.4, 4.5]").replace("0.15", "0.6")
TRAJECTORY = """kind: trajectory
title: bouncing
model: {type: chain, particles: 3, ends: fixed, gamma: 0.1, damping: 0.05, floor: -0.2, restitution: 0.6}
start: {q: [1, 0.5, 0.8]}
time: {duration: 6, samples: 121}
sweep: {parameter: model.damping, values: [0.05, 0.2]}
"""
BRANCH = """kind: branch
title: hardening
model: {type: duffing_chain, particles: 1, cubic: 0.5, wall: null, restitution: 1, damping: 0.1, force: 0.3, frequency: 0.6}
orbit: {motion: forced}
branch: {parameter: model.frequency, from: 0.6, to: 1.6}
sweep:
  - {parameter: model.damping, values: [0.1, 0.2]}
  - {parameter: model.force, values: [0.3, 0.2]}
"""
DIAGRAM = """kind: diagram
title: beyond grazing
model: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}
iterate: {transient: 200, keep: 40}
sweep: {parameter: model.d, from: 0.0001, to: 0.1, points: 30, scale: log}
"""


def without_values(file):
    file["orbits/energy"][...] = np.nan


def blown_up(file):
    file["orbits/energy"][5] = 1e4
    file["orbits/energy"][0] = -1


def in_metres(file):
    file["orbits/q"].attrs["units"] = "m"


STUDIES = {
    "family": FAMILY,
    "dense": ring("many orbits", over_gamma("from: 0, to: 0.19, points: 200")),
    "grid": ring("three periods", GRID),
    "wide": ring("seven periods", WIDE),
    "single": ring("one orbit", over_gamma("values: [0.1]"), ", stable: true, multipliers: true"),
    "bouncing": TRAJECTORY,
    "branch": BRANCH,
    "diagram": DIAGRAM,
}
MADE = {
    "empty": altered("family", without_values),
    "metres": altered("family", in_metres),
    "pole": altered("dense", blown_up),
}

# result, options
PICTURES = [
    ("family", {}),
    ("family", {"y": "q", "x": "energy"}),
    ("grid", {"y": "clearance", "style": {"column": True}}),
    ("wide", {}),
    ("single", {"y": "multipliers"}),
    ("bouncing", {"y": "q[1]"}),
    ("bouncing", {"y": "v", "tasks": [0], "style": {"column": True}}),
    ("bouncing", {"table": "trajectory/impact", "y": "impulse"}),
    ("branch", {"table": "branch/point", "y": "amplitude"}),
    ("diagram", {"y": "values"}),
]
# result, options, words of the message
REFUSALS = [
    ("family", {"y": "energi"}, "energi is no column of orbits; its columns of numbers are q, v, impulse, energy"),
    ("family", {"x": "gamma"}, "gamma is no column of orbits"),
    ("family", {"y": "outcome"}, "outcome holds words of orbits"),
    ("family", {"y": "q[6]"}, "q[6]: the axis particle of q has 6 elements, from 0"),
    ("family", {"y": "energy[0]"}, "energy[0]: energy has the axes [row] only"),
    ("family", {"x": "q", "y": "energy"}, "q has the axis particle, energy has not: pick an element"),
    ("family", {"table": "orbit"}, "it has no table orbit; it has orbits"),
    ("family", {"tasks": [99]}, "it has no task 99, only tasks 0 to 11"),
    ("empty", {}, "energy has no finite value"),
    ("bouncing", {"table": "trajectory/event", "tasks": [0]}, "trajectory/event has no rows of these tasks"),
]


@pytest.fixture(scope="module")
def drawn(picture):
    return lambda name, **options: picture("columns", name, **options)


@pytest.mark.parametrize("name, options", PICTURES)
def test_all_of_it_fits(drawn, name, options):
    drawn(name, **options).expect_whole()


@pytest.mark.parametrize("name, options, words", REFUSALS)
def test_refusals_say_what_is_missing(drawn, name, options, words):
    with pytest.raises(ricochet.ResultError) as refused:
        drawn(name, **options)
    assert words in refused.value.reason


def curves(picture):
    """Points of every curve: [point, 2]."""
    return [
        path for lines in picture.axes[0].collections if hasattr(lines, "get_segments") for path in lines.get_segments()
    ]


def test_the_default_is_the_first_number_against_the_swept_parameter(drawn, results):
    picture = drawn("family")
    gamma, energy = (column(results["family"], name) for name in ("sweep/model.gamma", "orbits/energy"))
    (curve,) = curves(picture)
    assert (curve == np.column_stack([gamma, energy])).all()
    assert picture.labels() == (r"coupling $\gamma$", "total energy")
    assert picture.heading[1] == "energy of orbits against model.gamma"
    assert_among(curve, picture.offsets())


def test_grids_have_a_curve_for_each_value_of_the_other_parameter(drawn, results):
    picture = drawn("grid")
    energy = column(results["grid"], "orbits/energy").reshape(3, 8)
    assert [curve[:, 1].tolist() for curve in curves(picture)] == energy.tolist()
    assert picture.legend == ["$T = 4$", "$T = 4.1$", "$T = 5$"]
    across = drawn("grid", x="orbit.period")
    assert sorted(curve[:, 1].tolist() for curve in curves(across)) == sorted(energy.T.tolist())
    assert len(across.axes) == 2 and across.axes[1].get_ylabel() == r"coupling $\gamma$"


def test_many_values_have_a_colour_bar(drawn):
    picture = drawn("wide")
    assert len(curves(picture)) == 7 and picture.legend == []
    assert picture.axes[1].get_ylabel() == "period $T$"


def test_columns_against_columns_run_along_the_last_parameter(drawn, results):
    energy, clearance = (column(results["grid"], f"orbits/{name}").reshape(3, 8) for name in ("energy", "clearance"))
    drawn_curves = curves(drawn("grid", x="clearance", y="energy"))
    assert [curve.tolist() for curve in drawn_curves] == np.stack([clearance, energy], axis=2).tolist()


def test_elements_are_curves_of_their_own_or_one_that_is_picked(drawn, results):
    q = column(results["family"], "orbits/q")
    every, one = drawn("family", y="q"), drawn("family", y="q[3]")
    assert [curve[:, 1].tolist() for curve in curves(every)] == q.T.tolist()
    assert every.legend == [f"particle {k}" for k in range(6)]
    assert [curve[:, 1].tolist() for curve in curves(one)] == [q[:, 3].tolist()]
    assert one.labels()[1] == "position at t = 0+, particle 3" and one.legend == []


def test_many_elements_are_dots(drawn, results):
    picture = drawn("diagram", y="values")
    values, d = column(results["diagram"], "diagram/values"), column(results["diagram"], "sweep/model.d")
    assert curves(picture) == []
    assert_among(np.column_stack([np.repeat(d, 40), values.ravel()]), picture.offsets())
    assert picture.labels()[1] == "$z_{1}$" and picture.axes[0].get_xscale() == "log"


def test_samples_are_drawn_against_their_times(drawn, results):
    q, t = (column(results["bouncing"], f"trajectory/{name}") for name in ("q", "t"))
    one = drawn("bouncing", y="q[1]")
    assert [curve.tolist() for curve in curves(one)] == np.stack([t, q[:, :, 1]], axis=2).tolist()
    assert one.heading[1] == "q[1] of trajectory against t" and len(one.legend) == 2
    assert len(curves(drawn("bouncing", y="v", tasks=[0]))) == 3


def test_rows_without_an_order_are_dots(drawn, results):
    picture = drawn("bouncing", table="trajectory/impact", y="impulse")
    wanted = np.column_stack([column(results["bouncing"], f"trajectory/impact_{name}") for name in ("time", "impulse")])
    assert curves(picture) == [] and len(wanted) > 5
    assert_among(wanted, picture.offsets())


def test_ragged_tables_have_a_curve_for_each_task(drawn, results):
    picture = drawn("branch", table="branch/point", y="amplitude")
    parameter, amplitude = (column(results["branch"], f"branch/point_{name}") for name in ("parameter", "amplitude"))
    edges = column(results["branch"], "branch/point_offset")
    wanted = [np.column_stack([parameter, amplitude])[a:b].tolist() for a, b in zip(edges, edges[1:])]
    assert [curve.tolist() for curve in curves(picture)] == wanted
    assert picture.legend == ["task 0", "task 1", "task 2", "task 3"]
    assert picture.labels()[0] == r"frequency $\omega$ of the force" and "omega" not in picture.heading[-1]
    assert len(curves(drawn("branch", table="branch/point", y="amplitude", tasks=[1, 3]))) == 2


def test_uneven_values_of_a_legend_have_different_colours(drawn):
    """By their places, not by their size."""
    picture = drawn("grid")
    lines = next(lines for lines in picture.axes[0].collections if hasattr(lines, "get_segments"))
    of_curves = [to_hex(colour) for colour in lines.to_rgba(lines.get_array())]
    (legend,) = picture.figure.legends
    assert of_curves == [to_hex(entry.get_color()) for entry in legend.get_lines()] and len(set(of_curves)) == 3


def test_complex_numbers_are_drawn_by_their_modulus(drawn, results):
    picture = drawn("single", y="multipliers")
    assert_among(np.abs(column(results["single"], "orbits/multipliers")).T, picture.offsets()[:, 1:])
    assert picture.labels()[1] == "Floquet multipliers, modulus"


def test_units_stand_behind_the_label(drawn):
    assert drawn("metres", y="q[0]").labels()[1] == "position at t = 0+, particle 0 [m]"


def test_rows_of_several_outcomes_are_noted(drawn, results):
    words, numbers = np.unique(column(results["wide"], "orbits/outcome").astype(str), return_counts=True)
    assert drawn("family").notes == "" and len(words) == 2
    assert f"56 rows of all outcomes: {numbers[0]} {words[0]}, {numbers[1]} {words[1]}" in drawn("wide").notes


def test_a_blow_up_does_not_squeeze_the_others(drawn, results):
    picture = drawn("pole")
    assert picture.axes[0].get_ylim()[1] < 100 and "axis clipped, values from" in picture.notes
    assert len(curves(picture)[0]) == 200 and "clipped" not in drawn("dense").notes


def test_every_column_of_numbers_has_a_label(results):
    for name in ("grid", "bouncing", "branch", "diagram"):
        with ricochet.open(results[name]) as result:
            for table in (result[each] for each in result.tables):
                for each in numeric_columns(table):
                    label = quantity(result, table, each).label
                    assert 0 < len(label) < 100 and ";" not in label and not label.startswith(("its", "the same"))


def test_it_is_drawn_unasked_only_if_no_other_figure_is(results, monkeypatch):
    spec = ricochet.plot.CATALOGUE["columns"]
    with ricochet.open(results["family"]) as result:
        assert not spec.missing(result) and not spec.natural(result)
        others = [each for each in ricochet.plot.figures_of(result) if each.name != "columns"]
        assert any(each.natural(result) for each in others)
        monkeypatch.setattr("ricochet.plot.catalogue.CATALOGUE", {"columns": spec})
        assert spec.natural(result)
