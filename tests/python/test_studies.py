"""Results of shipped studies of every kind as the package reads them, beside what h5py reads in the same file."""

import h5py
import numpy as np
import pytest
import ricochet as package
from program import write

# Shipped studies, with fewer points where they are made for pictures.
STUDIES = {
    "table": (),
    "grid": ("sweep[0].points=12", "sweep[1].points=9"),
    "multipliers": (),
    "lyapunov": ("sweep.points=3", "time.duration=200"),
    "vibro_impact_5": (),
    "grazing_curve": (),
    "grazing_two_masses": (),
    "diagram_map": (),
    "basin": ("sweep[0].points=8", "sweep[1].points=6"),
}


@pytest.fixture(scope="module")
def paths(ricochet):
    """{study: its result}."""
    folder = ricochet.new_folder()
    for name, settings in STUDIES.items():
        words = [word for setting in settings for word in ("--set", setting)]
        ricochet.run(ricochet.studies / f"{name}.yaml", *words, cwd=folder).expect_done()
    return {name: folder / f"{name}.h5" for name in STUDIES}


@pytest.fixture(params=STUDIES)
def both(request, paths):
    """A result as the package and as h5py read it."""
    with package.open(paths[request.param]) as result, h5py.File(paths[request.param]) as file:
        yield result, file


@pytest.fixture
def opened(paths):
    """Opens the result of a study by its name; all are closed afterwards."""
    results = []

    def open_one(name):
        results.append(package.open(paths[name]))
        return results[-1]

    yield open_one
    for result in results:
        result.close()


def raw(data):
    """A data set as it should read: words of enums, texts in UTF-8."""
    words = h5py.check_enum_dtype(data.dtype)
    if words:
        by_code = {code: word for word, code in words.items()}
        return np.array([by_code[code] for code in data[()].ravel().tolist()], dtype=str).reshape(data.shape)
    if data.dtype.kind == "S":
        return np.array([text.decode() for text in data[()].tolist()], dtype=str)
    return data[()]


# --- columns ---


def data_set_of(file, table, column):
    group, _, what = table.partition("/")
    return file[f"{group}/{what}_{column}" if what else f"{group}/{column}"]


def test_every_data_set_is_a_column_with_the_values_that_h5py_reads(both):
    result, file = both
    found = set()
    for table in result.tables:
        for column in result[table].columns:
            data = data_set_of(file, table, column)
            values = result[table][column]
            np.testing.assert_array_equal(values, raw(data), err_msg=data.name)
            assert values.dtype.kind == raw(data).dtype.kind or values.size == 0, data.name
            found.add(data.name)
    groups = [
        file[name] for name in file if isinstance(file[name], h5py.Group) and name not in ("sweep", "run", "study")
    ]
    stored = {data.name for group in groups for data in group.values()}
    assert stored - found == {name for name in stored if name.endswith("_offset")} and found <= stored


def test_ragged_tables_fall_into_the_tasks_that_their_offsets_bound(both):
    result, file = both
    for table in result.tables:
        if f"{table}_offset" in file:
            offset = file[f"{table}_offset"][()]
            column = result[table].columns[0]
            data = raw(data_set_of(file, table, column))
            parts = list(result[table].by_task())
            assert len(parts) == result.sweep.tasks == len(offset) - 1
            for task, part in enumerate(parts):
                np.testing.assert_array_equal(part[column], data[offset[task] : offset[task + 1]])
                np.testing.assert_array_equal(part.tasks, task)


def test_coordinates_are_the_swept_values_of_each_row(both):
    result, file = both
    for table in result.tables:
        rows = result[table]
        assert (rows.tasks is None) == (table in ("special", "basin/found"))
        for name in result.swept if rows.tasks is not None else ():
            np.testing.assert_array_equal(rows[name], file["sweep"][name][()][rows.tasks])


def test_grids_have_the_shape_of_the_sweeps(both):
    result, file = both
    shape = tuple(file["sweep"].attrs.get("grid", ()))
    rows = result[result.kind]
    assert result.sweep.shape == shape and len(rows.axes) == len(shape)
    np.testing.assert_array_equal(rows.grid("outcome"), raw(file[result.kind]["outcome"]).reshape(shape))
    data = result.to_xarray(result.kind)
    assert data.outcome.dims == result.swept and data.outcome.shape == shape
    for name in result.swept:
        np.testing.assert_array_equal(data[name], rows.axes[name])


def test_every_table_is_a_dataset(both):
    result, _ = both
    for table in result.tables:
        assert len(result.to_xarray(table).data_vars) >= len(result[table].columns) - 1  # task of windows: a coordinate


# --- what the numbers are ---


def test_a_line_of_a_grid_is_the_nearest_one(opened):
    orbits = opened("grid")["orbits"]
    periods, gammas = np.linspace(3.2, 6.2, 12), np.linspace(0, 0.6, 9)
    line = orbits.select({"orbit.period": 4.6})
    nearest = int(np.argmin(abs(periods - 4.6)))
    assert line.tasks.tolist() == list(range(9 * nearest, 9 * nearest + 9))
    np.testing.assert_allclose(line["model.gamma"], gammas, rtol=1e-14, atol=1e-16)
    point = line.select(gamma=gammas[3], exact=True)
    assert len(point) == 1 and point["energy"][0] == orbits.grid("energy")[nearest, 3]


def test_special_points_of_orbits_have_words_and_complex_multipliers(opened):
    special = opened("multipliers").special_points
    assert special["kind"].tolist() == ["plus_one"] and special["change"].tolist() == ["outwards"]
    assert abs(special["parameter"][0] - 0.13208) < 1e-5 and abs(special["multiplier"][0] - 1) < 1e-3


def test_multipliers_of_an_orbit_come_in_reciprocal_pairs(opened):
    multipliers = opened("multipliers")["orbits"]["multipliers"]
    assert multipliers.dtype == np.complex128 and multipliers.shape == (96, 60)
    np.testing.assert_allclose(abs(np.prod(multipliers, axis=1)), 1, rtol=1e-6)


def test_special_points_of_branches_have_words_and_states(opened):
    result = opened("vibro_impact_5")
    grazing = result.special_points.where(kind="grazing")
    assert len(grazing) > 0 and grazing["q"].shape == (len(grazing), 5)
    assert np.all(abs(grazing["clearance"]) < 1e-8)
    points = result["branch/point"]
    assert points.attributes("parameter")["parameter"] == result.parameters["branch.parameter"] == "orbit.energy"
    mode = points.select({"orbit.mode": 1})
    np.testing.assert_array_equal(mode["energy"], points.task(1)["energy"])


def test_curves_of_a_trace_name_both_parameters(opened):
    result = opened("grazing_curve")
    curve = result["branch/curve"]
    assert curve.attributes("parameter")["parameter"] == result.parameters["branch.parameter"]
    assert curve.attributes("second")["parameter"] == result.parameters["branch.trace.parameter"]
    ends = result["branch/curve_end"]
    for special, part, points in zip(ends["special"], ends["part"], ends["points"]):
        assert len(curve.where(special=special, part=part)) == points


def test_windows_name_their_tasks_and_periods(opened):
    windows = opened("diagram_map")["window"]
    assert windows["period"].tolist() == [8, 7, 6, 5, 4]
    np.testing.assert_array_equal(windows["model.d"], windows["parameter"])
    assert set(windows["low_kind"]) | set(windows["high_kind"]) <= set(windows.words("low_kind"))
    assert windows.attributes("low")["parameter"] == "model.d"


def test_flags_are_bools(opened):
    exists = opened("grazing_two_masses")["grazing"]["window_exists"]
    assert exists.dtype == bool and exists.shape == (20, 12)


def test_attractors_of_a_basin_count_its_tasks(opened):
    result = opened("basin")
    attractor, found = result["basin"]["attractor"], result["basin/found"]
    assert [np.sum(attractor == i) for i in range(len(found))] == found["tasks"].tolist()
    assert result["basin"].grid("attractor").shape == (8, 6)


# --- parameters ---


def test_parameters_hold_what_is_given_and_the_defaults(opened):
    result = opened("table")
    p = result.parameters
    assert (result.kind, p["kind"], p["model.type"]) == ("orbits", "orbits", "chain")
    assert result.title == p["title"] and "table" in result.title
    assert p["model.particles"] == 30 and type(p["model.particles"]) is int
    assert p["orbit.period"] == pytest.approx(1.5 * np.pi, rel=1e-15)
    assert p["orbit.at_start"].tolist() == [15] and p["orbit.at_half"].shape == (0,)
    assert p["model.floor"] == -1 and p["orbit.method"] == "impulse" and p["orbit.states"] is True
    assert result.swept == ("model.gamma",) and p["model.gamma"] == 0
    assert "model.floor" in result.given and "orbit.method" not in result.given
    assert result.parameters_of(14)["model.gamma"] == 0.187


def test_a_swept_element_of_a_list_has_the_value_of_its_task(opened):
    result = opened("grazing_two_masses")
    assert result.swept == ("model.damping[1]", "model.frequency")
    assert result.parameters["model.damping"].tolist() == [3, 1]
    last = result.parameters_of(19)
    assert last["model.damping"].tolist() == [3, 3] and last["model.frequency"] == 5


def same(a, b):
    return np.array_equal(a, b, equal_nan=np.asarray(a).dtype.kind == "f") and type(a) is type(b)


FLOW = """kind: trajectory
model: {type: chain, particles: 2, gamma: 0.1, floor: [-1, null], wall: null, restitution: 0.8}
start: {q: [0, 0.5], v: 2}
time: {duration: 5, samples: 3}
"""
BLOCK = """kind: trajectory
model:
  type: chain
  particles: 2
  gamma: 0.1
  floor:
    - -1
    -
      null
  wall: null
  restitution: 0.8
start:
  q:
    - 0
    - 0.5
  v: 2
time:
  duration: 5
  samples: 3
"""


def test_flow_style_block_style_and_set_give_the_same_parameters(ricochet, folder):
    write(folder, "flow.yaml", FLOW)
    write(folder, "block.yaml", BLOCK)
    write(folder, "set.yaml", FLOW.replace("gamma: 0.1", "gamma: 0.3").replace("duration: 5", "duration: 6"))
    ricochet.run("flow.yaml", cwd=folder).expect_done()
    ricochet.run("block.yaml", cwd=folder).expect_done()
    ricochet.run("set.yaml", "--set", "model.gamma=0.1", "--set", "time.duration=5", cwd=folder).expect_done()
    flow, block, changed = (package.open(folder / f"{name}.h5").parameters for name in ("flow", "block", "set"))
    assert flow.keys() == block.keys() == changed.keys()
    for name, value in flow.items():
        assert same(value, block[name]) and same(value, changed[name]), name
    np.testing.assert_array_equal(flow["model.floor"], [-1, np.nan])
    assert flow["model.wall"] is None and flow["start.q"].tolist() == [0, 0.5] and flow["start.v"] == 2
