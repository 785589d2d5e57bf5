"""Parameters, columns, coordinates, grids and selections, on small results whose numbers are known."""

import numpy as np
import pytest
import ricochet as package
import small_results
from small_results import GAMMAS, PERIODS


@pytest.fixture
def result(folder):
    with package.open(small_results.grid(folder / "grid.h5")) as opened:
        yield opened


@pytest.fixture
def orbits(result):
    return result["orbits"]


# --- parameters ---


def test_parameters_have_the_types_of_their_keys(result):
    p = result.parameters
    assert p.keys() == small_results.PARAMETERS.keys()
    assert p["model.particles"] == 2 and type(p["model.particles"]) is int
    assert p["model.restitution"] == 0.8 and type(p["model.restitution"]) is float
    assert p["orbit.states"] is True
    assert p["model.type"] == "chain" and p["title"] == "" == result.title
    assert p["branch.trace.kinds"] == ["grazing", "fold"]
    assert p["orbit.at_start"].tolist() == [1] and p["orbit.at_start"].dtype == np.int64
    assert p["orbit.at_half"].shape == (0,)


def test_null_is_none_and_nan_in_a_list(result):
    assert result.parameters["model.wall"] is None
    np.testing.assert_array_equal(result.parameters["model.floor"], [-1, np.nan])


def test_swept_and_given_keys_are_named_in_order(result):
    assert result.swept == ("orbit.period", "model.gamma")
    assert result.given == ("kind", "model.particles")
    assert result.kind == "orbits"


def test_units_are_no_parameters(folder):
    path = small_results.grid(folder / "units.h5", **{"model.restitution:units": "m"})
    with package.open(path) as result:
        assert result.units == {"model.restitution": "m"}
        assert "model.restitution:units" not in result.parameters


def test_parameters_of_a_task_have_its_swept_values(result):
    p = result.parameters_of(6)
    assert (p["orbit.period"], p["model.gamma"]) == (4.0, 0.2)
    assert result.parameters["model.gamma"] == 0.0
    with pytest.raises(package.ResultError, match="no task 12, only tasks 0 to 11"):
        result.parameters_of(12)


def test_an_element_of_a_list_is_swept_by_its_index(folder):
    with package.open(small_results.there_and_back(folder / "back.h5")) as result:
        assert result.parameters_of(2)["model.floor"].tolist() == [-1, -2]
        assert np.isnan(result.parameters["model.floor"][1])


# --- columns ---


def test_tables_are_those_of_the_groups_and_the_ragged_ones(result):
    assert set(result.tables) == {"orbits", "orbits/impact", "special"}
    assert result["orbits"].columns == ("energy", "multipliers", "outcome", "q", "reason")
    assert "orbits" in result and "run" not in result


def test_columns_have_rows_first(orbits):
    assert len(orbits) == 12
    assert orbits["energy"].tolist() == [i + 0.5 for i in range(12)]
    assert orbits["q"].shape == (12, 2) and orbits["q"][3].tolist() == [3, 103]
    assert orbits["multipliers"].dtype == np.complex128 and orbits["multipliers"][2].tolist() == [2 + 1j, 2 - 1j]


def test_enums_are_words_and_codes_on_request(orbits):
    assert orbits["outcome"][:4].tolist() == ["admissible", "inadmissible", "failed", "admissible"]
    assert orbits["outcome"].dtype.kind == "U"
    assert orbits.codes("outcome")[:4].tolist() == [0, 1, 2, 0]
    assert orbits.words("outcome") == ("admissible", "inadmissible", "failed")
    assert orbits.words("energy") == ()


def test_texts_are_str(orbits):
    assert orbits["reason"][:2].tolist() == ["", "grün"]


def test_columns_cannot_be_written_to(orbits):
    with pytest.raises(ValueError):
        orbits["energy"][0] = 1
    assert orbits["energy"].copy().flags.writeable


def test_attributes_of_columns_are_python_values(orbits):
    assert orbits.attributes("energy") == {"axes": "task", "long_name": "the orbits/energy"}
    assert orbits.axes_of("q") == ("task", "particle")


def test_special_points_are_a_table_with_words(result):
    special = result.special_points
    assert special["kind"].tolist() == ["wall", "floor"] and special["parameter"].tolist() == [0.05, 0.25]
    assert special.tasks is None and special.coordinates == {} and not special.is_grid
    assert special.where(kind="wall")["parameter"].tolist() == [0.05]


# --- ragged tables ---


def test_rows_of_a_ragged_table_know_their_task_and_swept_values(result):
    impacts = result["orbits/impact"]
    assert impacts.columns == ("particle", "q", "side")
    assert impacts.tasks.tolist() == [0, 0, 2]
    assert impacts["model.gamma"].tolist() == [0, 0, 0.2]
    assert impacts.coordinates["orbit.period"].tolist() == [3, 3, 3]
    assert not impacts.is_grid


def test_a_ragged_table_falls_into_tasks(result):
    impacts = result["orbits/impact"]
    assert [len(rows) for rows in impacts.by_task()] == small_results.ROWS
    assert impacts.task(2)["side"].tolist() == ["wall"]
    assert impacts.task(0)["q"].tolist() == [[0, 1], [2, 3]]
    empty = impacts.task(1)
    assert empty["side"].tolist() == [] and empty["q"].shape == (0, 2)
    with pytest.raises(package.ResultError, match="no task 12"):
        impacts.task(12)


def test_a_ragged_table_is_selected_by_swept_values(result):
    assert result["orbits/impact"].select({"model.gamma": 0.19})["particle"].tolist() == [1]
    assert len(result["orbits/impact"].select(period=4)) == 0


# --- grids and selections ---


def test_a_grid_has_one_axis_per_sweep_in_order(orbits):
    assert list(orbits.axes) == ["orbit.period", "model.gamma"]
    assert orbits.axes["orbit.period"].tolist() == PERIODS.tolist()
    assert orbits.axes["model.gamma"].tolist() == GAMMAS.tolist()
    assert orbits.grid("energy").tolist() == (np.arange(12).reshape(3, 4) + 0.5).tolist()
    assert orbits.grid("q").shape == (3, 4, 2) and orbits.grid("q")[1, 2].tolist() == [6, 106]
    assert orbits.grid("outcome")[0, 2] == "failed"


def test_the_nearest_value_of_a_sweep_is_selected(orbits):
    line = orbits.select({"model.gamma": 0.14})
    assert line.tasks.tolist() == [1, 5, 9] and line["model.gamma"].tolist() == [0.1] * 3
    assert list(line.axes) == ["orbit.period"] and line.grid("q").shape == (3, 2)
    assert orbits.select(period=4.4).tasks.tolist() == [4, 5, 6, 7]
    point = orbits.select({"model.gamma": 0.3, "orbit.period": 5})
    assert point.tasks.tolist() == [11] and point.grid("energy") == 11.5


def test_an_exact_value_allows_for_rounding_only(orbits):
    assert orbits.select({"model.gamma": 0.1 + 1e-14}, exact=True).tasks.tolist() == [1, 5, 9]
    with pytest.raises(package.ResultError, match="model.gamma = 0.11 is not in the sweep; the nearest value is 0.1"):
        orbits.select({"model.gamma": 0.11}, exact=True)


@pytest.mark.parametrize("value", (-0.01, 0.31, float("nan")))
def test_a_value_outside_the_sweep_is_refused(orbits, value):
    with pytest.raises(package.ResultError, match="lies outside the sweep, 0 to 0.3"):
        orbits.select({"model.gamma": value})


def test_a_parameter_that_is_not_swept_is_refused(orbits):
    with pytest.raises(package.ResultError, match="model.floor is not swept; the study sweeps orbit.period, model.ga"):
        orbits.select({"model.floor": 1})


def test_a_value_that_stands_twice_gives_both(folder):
    with package.open(small_results.there_and_back(folder / "back.h5")) as result:
        both = result["orbits"].select({"model.floor[1]": -3})
        assert both.tasks.tolist() == [0, 3]
        assert both.grid("energy").tolist() == [0.5, 3.5]


def test_rows_are_chosen_by_columns_and_conditions(orbits):
    assert orbits.where(outcome="failed").tasks.tolist() == [2, 5, 8, 11]
    assert orbits.where(orbits["energy"] > 7, outcome=["failed", "admissible"]).tasks.tolist() == [8, 9, 11]
    chosen = orbits.where(outcome="failed").select(gamma=0.2)
    assert chosen.tasks.tolist() == [2] and not chosen.is_grid
    assert len(orbits.where(energy=-1)) == 0
    assert orbits.where(**{"orbit.period": [3, 5], "model.gamma": 0.2}).tasks.tolist() == [2, 10]


def test_what_is_no_condition_is_refused(orbits):
    with pytest.raises(package.ResultError, match="a condition on orbits is an array of 12 bools"):
        orbits.where(orbits["energy"])
    with pytest.raises(package.ResultError, match="outcome is never 'fialed'; its words are admissible, inadmissible"):
        orbits.where(outcome="fialed")


def test_rows_that_were_chosen_are_no_grid(orbits):
    with pytest.raises(package.ResultError, match="no grid"):
        orbits.where(outcome="failed").grid("energy")


def test_a_result_without_a_sweep_has_one_row(folder):
    with package.open(small_results.single(folder / "one.h5")) as result:
        assert result.swept == () and result.sweep.tasks == 1
        orbits = result["orbits"]
        assert len(orbits) == 1 and orbits.axes == {} and orbits.grid("q").tolist() == [0, 100]
        with pytest.raises(package.ResultError, match="the study sweeps nothing"):
            orbits.select(gamma=1)


# --- xarray ---


def test_a_grid_is_a_dataset_over_the_swept_parameters(result):
    data = result.to_xarray("orbits")
    assert data.energy.dims == ("orbit.period", "model.gamma")
    assert data.q.dims == ("orbit.period", "model.gamma", "particle")
    chosen = data.sel({"orbit.period": 4, "model.gamma": 0.2})
    assert chosen.energy == 6.5 and chosen.outcome == "admissible" and chosen.task == 6
    assert data.energy.attrs["long_name"] == "the orbits/energy" and data.attrs["kind"] == "orbits"


def test_a_line_of_a_grid_keeps_the_value_that_was_selected(orbits):
    data = orbits.select(gamma=0.2).to_xarray()
    assert data.energy.dims == ("orbit.period",) and data["model.gamma"] == 0.2
    assert data.sel({"orbit.period": 5}).energy == 10.5


def test_a_ragged_dataset_has_tasks_and_swept_values_along_its_rows(result):
    data = result.to_xarray("orbits/impact")
    assert data.q.dims == ("impact_row", "particle") and data.task.values.tolist() == [0, 0, 2]
    assert data["impact_particle"].values.tolist() == [1, 0, 1]  # beside the axis particle
    assert data["model.gamma"].dims == ("impact_row",)
    assert result.to_xarray("special").kind.dims == ("special_point",)


def test_without_xarray_the_message_names_the_package(orbits, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "xarray", None)
    with pytest.raises(package.ResultError, match="python3-xarray"):
        orbits.to_xarray()
