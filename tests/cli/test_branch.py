"""Branches through the command line: what is refused, what they find, how they are stored, and that they do not depend
on ranks or on stops."""

import csv
import io

import h5py
import numpy as np
import program
import xarray
from branches import BASE, WALL, equal_for_all_ranks_and_after_stops, read, refuse, rows, run
from program import STOPPED, USAGE, study, words_of, write

DUFFING = """kind: branch
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, cubic: 1, damping: 0.1, force: 0.3}
orbit: {motion: forced}
branch: {parameter: model.frequency, from: 0.5, to: 2.5, step_most: 0.05}
"""
HERTZ = """kind: branch
model: {type: chain, particles: 6, gamma: 0.1, floor: -1}
orbit: {period: 1.5 pi, at_start: [3]}
branch: {parameter: model.hertz, from: 100, to: 1e6, scale: log}
"""


# --- refusals ---


def test_parameters_are_refused_by_name_with_the_nearest_one(ricochet, folder):
    refuse(ricochet, folder, [
        ("model.gamma", "model.gama", 13, "unknown branch parameter 'model.gama'; did you mean 'model.gamma'?"),
        ("model.gamma", "model.colour", 13, "unknown branch parameter 'model.colour', expected a number of model"),
        ("model.gamma", "model.ends", 13, "branch.parameter = model.ends cannot be followed: it is a word"),
        ("model.gamma", "model.particles", 13, "branch.parameter = model.particles cannot be followed: it changes"),
        ("model.gamma", "start.q", 13, "branch.parameter = start.q cannot be followed, expected a number of model"),
        ("model.gamma", "branch.step", 13, "branch.parameter = branch.step cannot be followed"),
        ("model.gamma", "model.gamma[0]", 13, "model.gamma is a single number here: follow model.gamma without"),
        ("to: 0.15\n", "to: 0.15\nsweep: {parameter: model.gamma, values: [0, 1]}\n", 13,
         "branch.parameter = model.gamma is also swept"),
        ("  parameter: model.gamma\n", "", 0, "missing key branch.parameter (text)"),
        ("model.gamma\n  from: 0\n", "model.hertz\n", 13, "missing key branch.from (a number): model.hertz has no value"),
        ("model.gamma\n  from: 0\n  to: 0.15", "model.gamma\n  to: 0", 14, "branch.to = 0 is the start of the branch"),
    ])


def test_ranges_and_steps_are_refused_by_place_and_value(ricochet, folder):
    to = "to: 0.15\n"
    refuse(ricochet, folder, [
        ("to: 0.15", "to: 0", 15, "branch.to = 0 is the start of the branch, expected another value"),
        ("from: 0\n", "from: -0.1\n", 14, "branch.from (model.gamma) = -0.1 is out of range, expected a number >= 0"),
        (to, to + "  low: 0.1\n", 16, "branch.low = 0.1 is above the start, expected at most branch.from = 0"),
        ("from: 0\n  to: 0.15\n", "from: 0.1\n  to: 0\n  high: 0.05\n", 16,
         "branch.high = 0.05 is below the start, expected at least branch.from = 0.1"),
        (to, to + "  high: 0\n", 16, "branch.low and branch.high are both 0, expected low < high"),
        (to, to + "  low: -1\n", 16, "branch.low (model.gamma) = -1 is out of range, expected a number >= 0"),
        (to, to + "  scale: log\n", 14, "branch.from = 0 with scale: log, expected a number > 0"),
        (to, to + "  step: 0.1\n  step_most: 0.01\n", 16, "branch.step = 0.1, expected at most branch.step_most = 0.01"),
        (to, to + "  step_most: 1e-3\n  step_least: 0.5\n", 17,
         "branch.step_least = 0.5, expected at most branch.step_most = 0.001"),
        (to, to + "  step: 0\n", 16, "branch.step = 0 is out of range, expected a number > 0 or null"),
        (to, to + "  points: 0\n", 16, "branch.points = 0 is out of range, expected an integer from 1 to 10000000"),
        (to, to + "  multipliers: some\n", 16, "branch.multipliers = some, expected one of true, false, all"),
        (to, to + "  stepp: 1\n", 16, "unknown key 'stepp' in branch; did you mean 'step'?"),
        (to, to + "sweep: {parameter: branch.step, values: [1]}\n", 16, "branch.step cannot be swept: it says how"),
    ])


def test_motions_that_do_not_fit_the_model_are_refused(ricochet, folder):
    period = "  period: 1.5 pi\n"
    refuse(ricochet, folder, [
        ("hertz: null", "damping: 0.1", 8, "model.damping = 0.1, but orbit.motion: even needs model.damping = 0"),
        ("hertz: null", "restitution: 0.8", 8, "model.restitution = 0.8, but orbit.motion: even needs"),
        ("hertz: null", "phase: 1", 8, "model.phase = 1, but orbit.motion: even needs model.phase = 0"),
        ("model.gamma", "model.damping", 13, "branch.parameter = model.damping, but orbit.motion: even needs"),
        ("to: 0.15\n", "to: 0.15\nsweep: {parameter: model.damping, values: [0, 0.1]}\n", 16,
         "swept model.damping = 0.1, but orbit.motion: even needs model.damping = 0"),
        (period, period + "  motion: forced\n", 12, "orbit.at_start, but orbit.motion is forced: expected the impacts"),
        (period, period + "  motion: sideways\n", 11, "orbit.motion = sideways, expected one of even, forced"),
        (period, "", 0, "missing key orbit.period (a number > 0)"),
        (period, period + "  forcing_periods: 2\n", 11, "orbit.forcing_periods and orbit.period both give the period"),
        (period, period + "  sequence: [2]\n", 11, "orbit.times has 0 elements, expected 1"),
        (period, period + "  sequence: [6]\n  times: [1]\n", 11, "orbit.sequence[0] = 6 is out of range"),
        (period, period + "  sequence: [1, 2]\n  times: [1, 0.5]\n", 12, "orbit.times[1] is smaller than orbit.times[0]"),
        (period, period + "  excited: [2]\n", 11, "orbit.excited gives a first guess, and so do the impacts"),
        ("  at_start: [3]\n", "", 0, "kind: branch has no first guess, expected the section start, orbit.excited"),
        ("at_start: [3]", "at_start: [6]", 11, "orbit.at_start[0] = 6 is out of range, expected a particle from 0 to 5"),
        ("at_start: [3]", "at_start: [3]\n  at_half: [3]", 12, "orbit.at_half[0] = 3 is in the pattern twice"),
        ("particles: 6", "particles: 201", 0, "branch.multipliers = true with 201 particles, expected at most 200"),
    ])


def test_keys_of_branches_belong_to_them(ricochet, folder):
    write(folder, "s.yaml", study() + "branch: {from: 1}\n")
    ricochet("check", "s.yaml", cwd=folder).expect_refused(
        USAGE, "s.yaml:4: branch.from is a key of kind: branch or grazing or diagram, and this is kind: orbits")
    write(folder, "s.yaml", BASE)
    ricochet("check", "s.yaml", "--set", "branch.high=-1", cwd=folder).expect_refused(
        USAGE, "--set branch.high=-1: branch.high (model.gamma) = -1 is out of range")
    assert "kind branch" in ricochet("check", "s.yaml", cwd=folder).expect_done().out


# --- what they find ---


def test_points_are_the_orbits_of_the_pattern(ricochet, folder):
    """Solved for themselves, by impulse response."""
    found = read(run(ricochet, folder, BASE))
    assert found["outcome"] == ["bound"] and found["point_parameter"][[0, -1]].tolist() == [0, 0.15]
    values = ", ".join(f"{x:.17g}" for x in found["point_parameter"])
    text = study(6, at_start="[3]", orbit="stable: true", sweep=f"{{parameter: model.gamma, values: [{values}]}}")
    with h5py.File(run(ricochet, folder, text, name="o")) as file:
        orbits = file["orbits"]
        for name in ("energy", "clearance", "multiplier_max"):
            assert np.allclose(found[f"point_{name}"], orbits[name], rtol=1e-9, atol=1e-7), name
        assert found["point_outcome"] == words_of(orbits["outcome"])
        assert found["point_stable"] == words_of(orbits["stable"])
    assert np.allclose(found["point_period"], 1.5 * np.pi, rtol=1e-15) and (np.diff(found["point_arclength"]) > 0).all()
    assert found["point_residual"].max() < 1e-9


def test_a_stiff_floor_is_nearly_a_rigid_one(ricochet, folder):
    found = read(run(ricochet, folder, HERTZ))
    assert found["outcome"] == ["bound"] and found["point_parameter"][[0, -1]].tolist() == [100, 1e6]
    with h5py.File(run(ricochet, folder, study(6, at_start="[3]"), name="o")) as file:
        rigid = file["orbits/energy"][0]
    away = np.abs(found["point_energy"] - rigid)
    assert (np.diff(away) < 0).all() and away[-1] < 0.02 * rigid, away


def test_a_driven_duffing_oscillator_has_two_folds(ricochet, folder):
    found = read(run(ricochet, folder, DUFFING))
    assert found["special_kind"] == ["fold", "fold"] and found["outcome"] == ["bound"]
    upper, lower = found["special_parameter"]
    assert 1.7 < upper < 1.85 and 1.25 < lower < 1.4
    assert np.allclose(found["special_multiplier_max"], 1, atol=1e-6)
    first, second = found["special_point"]
    stable = np.array(found["point_stable"])
    assert set(stable[: first + 1]) == set(stable[second + 1 :]) == {"stable"}
    assert set(stable[first + 1 : second + 1]) == {"unstable"}
    assert np.allclose(found["point_period"], 2 * np.pi / found["point_parameter"], rtol=1e-13)


def test_an_oscillator_at_resonance_grazes_where_its_amplitude_says(ricochet, folder):
    """Its amplitude is the force over the damping; it is crossed to the family with one impact."""
    found = read(run(ricochet, folder, WALL))
    grazing = found["special_kind"].index("grazing")
    assert abs(found["special_parameter"][grazing] - 0.1) < 1e-9 and found["special_particle"][grazing] == 0
    assert abs(found["special_time"][grazing] - np.pi / 2) < 1e-6  # sin t
    first = found["point_segment"] == 0
    below = found["point_parameter"] < 0.1
    outcome = np.array(found["point_outcome"])
    assert set(outcome[first & below]) == {"admissible"} and set(outcome[first & ~below]) == {"inadmissible"}
    assert np.allclose(found["point_clearance"][first], 1 - 10 * found["point_parameter"][first], atol=1e-9)
    assert np.allclose(found["point_amplitude"][first], 10 * found["point_parameter"][first], rtol=1e-9)  # at T/4
    assert found["segment_origin"] == ["start", "grazing"] and found["segment_special"].tolist() == [-1, grazing]
    assert found["segment_impacts"].tolist() == [0, 1] and found["segment_outcome"] == ["bound", "bound"]
    impacts = outcome[~first & (found["point_parameter"] > 0.101)]
    assert len(impacts) > 5 and set(impacts) == {"admissible"}


def test_histories_are_states_over_the_period(ricochet, folder):
    """Of the oscillator at resonance: the force over the damping, times the sine; after the impact where it hits."""
    path = run(ricochet, folder, WALL, "--set", "branch.samples=9")
    found = read(path)
    with h5py.File(path) as file:
        q, v = file["branch/point_history_q"][..., 0], file["branch/point_history_v"][..., 0]
    times = np.linspace(0, 2 * np.pi, 9)
    smooth = found["point_segment"] == 0
    amplitude = 10 * found["point_parameter"][smooth, None]
    assert np.allclose(q[smooth], amplitude * np.sin(times), atol=1e-9)
    assert np.allclose(v[smooth], amplitude * np.cos(times), atol=1e-9)
    assert np.allclose(q[~smooth][:, [0, -1]], 1, atol=1e-9)  # from the wall to the wall
    assert np.allclose(v[~smooth][:, 0], -0.8 * v[~smooth][:, -1], atol=1e-9)


def test_branches_go_one_way_or_the_other_and_by_natural_steps(ricochet, folder):
    text = DUFFING.replace("from: 0.5, to: 2.5", "from: 2.5, to: 0.5")
    found = read(run(ricochet, folder, text))
    assert found["special_kind"] == ["fold", "fold"] and found["point_parameter"][-1] == 0.5
    text = DUFFING.replace("step_most: 0.05", "natural: true, to: 2.5").replace("to: 2.5, ", "", 1)
    found = read(run(ricochet, folder, text, name="natural"))
    assert found["outcome"] == ["not_converged"] and found["reason"][0] and found["point_parameter"].max() < 1.78


def test_bounds_may_be_wider_than_the_way(ricochet, folder):
    text = BASE.replace("from: 0\n", "from: 0.05\n").replace("to: 0.15\n", "to: 0.1\n  low: 0\n  high: 0.15\n")
    assert read(run(ricochet, folder, text))["point_parameter"][[0, -1]].tolist() == [0.05, 0.15]
    found = read(run(ricochet, folder, text + "  points: 3\n", "--force"))
    assert found["outcome"] == ["points"] and found["points"].tolist() == [4]


def test_periods_and_energies_can_be_followed(ricochet, folder):
    along_period = BASE.replace("model.gamma", "orbit.period").replace("gamma: 0\n", "gamma: 0.05\n")
    along_period = along_period.replace("from: 0\n  to: 0.15", "from: 1.5 pi\n  to: 5").replace("  period: 1.5 pi\n", "")
    found = read(run(ricochet, folder, along_period))
    assert np.allclose(found["point_period"], found["point_parameter"]) and found["point_parameter"][-1] == 5
    energy = found["point_energy"][0]
    along_energy = BASE.replace("model.gamma", "orbit.energy").replace("gamma: 0\n", "gamma: 0.05\n")
    along_energy = along_energy.replace("from: 0\n  to: 0.15", f"from: {energy:.17g}\n  to: {energy - 0.1:.17g}")
    found = read(run(ricochet, folder, along_energy, name="e"))
    assert found["outcome"] == ["bound"] and np.allclose(found["point_energy"], found["point_parameter"], rtol=1e-9)
    assert abs(found["point_period"][0] - 1.5 * np.pi) < 1e-8


def test_breathers_begin_with_one_particle(ricochet, folder):
    text = """kind: branch
model: {type: chain, particles: 8, gamma: 0, floor: null, cubic: 1}
orbit: {period: 4.5, excited: [2]}
branch: {parameter: model.gamma, from: 0, to: 0.05, states: true, multipliers: all}
"""
    found = read(run(ricochet, folder, text))
    assert found["outcome"] == ["bound"]
    first, last = found["point_q"][[0, -1]]
    assert np.allclose(np.delete(first, 2), 0, atol=1e-12) and np.argmax(np.abs(last)) == 2
    assert np.allclose(last[1], last[3]) and np.allclose(found["point_v"], 0, atol=1e-12)
    assert found["point_multipliers"].shape == (found["points"][0], 16)
    largest = np.abs(found["point_multipliers"]).max(axis=1)
    assert np.allclose(largest, found["point_multiplier_max"])


# --- tasks ---

GRID = HERTZ.replace("from: 100, to: 1e6, scale: log", "from: 1e3, to: 1e5, scale: log") + (
    "sweep: {parameter: model.gamma, from: 0, to: 0.15, points: 24}\n")


def test_a_branch_that_does_not_begin_is_a_row(ricochet, folder):
    text = """kind: branch
model: {type: chain, particles: 2, gamma: 0, floor: null, cubic: 1}
orbit: {period: 4, excited: [0]}
branch: {parameter: model.gamma, from: 0, to: 0.1}
sweep: {parameter: orbit.period, values: [4.5, 7, 5]}
"""
    path = run(ricochet, folder, text)
    found = read(path)
    assert found["outcome"] == ["bound", "failed_start", "bound"]
    assert b"at no amplitude" in found["reason"][1] and found["points"][1] == 0
    assert np.array_equal(np.diff(found["point_offset"]), found["points"])
    assert np.array_equal(np.diff(found["segment_offset"]), found["segments"])
    for task in (0, 2):
        assert found["point_parameter"][rows(found, "point", task)][0] == 0
    ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_groups_open_in_xarray_and_as_csv(ricochet, folder):
    path = run(ricochet, folder, WALL)
    with xarray.open_dataset(path, engine="h5netcdf", group="branch") as opened:
        assert opened.point_energy.dims == ("point_row",) and opened.special_q.dims == ("special_row", "particle")
        assert opened.point_parameter.attrs["parameter"] == "model.force"
        opened.load()
    out = ricochet("show", path, "--csv=branch/special_row", cwd=folder).expect_done().out
    table = list(csv.DictReader(io.StringIO(out)))
    assert [row["special_kind"] for row in table] == read(path)["special_kind"] and table[0]["task"] == "0"


# --- restarts ---


def test_a_branch_goes_on_from_a_point_of_a_result(ricochet, folder):
    """Of the family with an impact, backwards, down to its fold; the result says itself where it started."""
    path = run(ricochet, folder, WALL.replace("cross: true", "cross: true, states: true"))
    found = read(path)
    point = found["points"][0] - 3
    text = WALL.replace("from: 0.05, to: 0.2, cross: true", "to: 0.09, high: 0.2")
    again = run(ricochet, folder, text + f"restart: {{file: s.h5, point: {point}}}\n", name="again")
    went = read(again)
    assert went["point_parameter"][0] == found["point_parameter"][point]
    assert abs(went["point_energy"][0] - found["point_energy"][point]) < 1e-12 and went["segment_impacts"][0] == 1
    folds = [one["special_parameter"][one["special_kind"].index("fold")] for one in (found, went)]
    assert abs(folds[0] - folds[1]) < 1e-9
    own = folder / "own"
    own.mkdir()
    with h5py.File(again) as file:
        write(own, "again.yaml", file.attrs["study"])
    ricochet.run("again.yaml", cwd=own, ranks=2).expect_done()
    program.assert_same_data(again, own / "again.h5")


def test_a_branch_restarts_from_a_result_of_an_earlier_version(ricochet, folder):
    """There the long name of a data set is that of the parameter, and the group of the study is missing."""
    path = run(ricochet, folder, WALL.replace("cross: true", "cross: true, states: true"))
    text = WALL.replace("from: 0.05, to: 0.2, cross: true", "to: 0.09, high: 0.2") + "restart: {file: s.h5, point: 3}\n"
    again = run(ricochet, folder, text, name="again")
    with h5py.File(path, "r+") as file:
        attributes = file["branch/point_parameter"].attrs
        attributes["long_name"] = attributes["parameter"]
        del attributes["parameter"], file["study"], file.attrs["study_values_checksum"]
    assert "model.force" in ricochet("show", path, cwd=folder).expect_done().out
    program.assert_same(again, run(ricochet, folder, text, name="later"))


def test_restarts_take_impacts_and_numbers_along(ricochet, folder):
    """A point of a family along the coupling goes on along the period, of the task with that floor."""
    text = BASE.replace("at_start: [3]", "at_start: [0]\n  at_half: [3]").replace("to: 0.15\n", "to: 0.05\n  states: true\n")
    found = read(run(ricochet, folder, text + "sweep: {parameter: model.floor, values: [-1, -0.5]}\n"))
    point = found["points"][1] - 1
    text = BASE.replace("  at_start: [3]\n", "").replace("model.gamma\n  from: 0\n  to: 0.15", "orbit.period\n  to: 5")
    text = text.replace("  period: 1.5 pi\n", "  motion: even\n") + f"restart: {{file: s.h5, task: 1, point: {point}}}\n"
    write(folder, "p.yaml", text)
    assert "kind branch" in ricochet("check", "p.yaml", cwd=folder).expect_done().out
    went = read(run(ricochet, folder, text, "--set", "title=set", name="p"))
    assert abs(went["point_parameter"][0] - 1.5 * np.pi) < 1e-15 and went["point_parameter"][-1] == 5
    energy = found["point_energy"][rows(found, "point", 1)][point]
    assert abs(went["point_energy"][0] - energy) < 1e-12 and went["segment_impacts"].tolist() == [2]


def test_restarts_that_cannot_be_are_refused(ricochet, folder):
    run(ricochet, folder, WALL)
    run(ricochet, folder, study(), name="o")
    text = WALL.replace("from: 0.05, ", "") + "restart: {file: s.h5, special: 0}\n"
    write(folder, "r.yaml", text)
    ricochet("check", "r.yaml", cwd=folder).expect_done()
    cases = [
        (["restart.special=7"], USAGE, "s.h5: ", "restart.special = 7, but task 0 has 2 of them"),
        (["restart.task=1"], USAGE, "s.h5: ", "restart.task = 1, expected a task from 0 to 0"),
        (["restart.special=null"], USAGE, "r.yaml:6: ", "restart has neither special nor point"),
        (["restart.point=1"], USAGE, "r.yaml:6: ", "restart has both special and point"),
        (["restart.special=null", "restart.point=1"], USAGE, "s.h5: ", "the points have no states", "branch.states: true"),
        (["restart.file=no.h5"], program.FILES, "no.h5: ", "No such file"),
        (["restart.file=r.yaml"], program.FILES, "r.yaml: "),
        (["restart.file=o.h5"], program.FILES, "o.h5: ", "not a result of kind branch"),
        (["branch.high=0.05"], USAGE, "--set branch.high=0.05: branch.high = 0.05 is below the start"),
        (["model.particles=2"], USAGE, "restart from s.h5: ", "start.q has 1 elements, expected 2"),
    ]
    for sets, code, place, *phrases in cases:
        words = [word for one in sets for word in ("--set", one)]
        for command in ("check", "run"):
            ricochet(command, "r.yaml", *words, cwd=folder).expect_refused(code, place, *phrases)
    write(folder, "k.yaml", study() + "restart: {file: s.h5, special: 0}\n")
    ricochet("check", "k.yaml", cwd=folder).expect_refused(USAGE, "k.yaml:4: restart.file is a key of kind: branch")


def test_impacts_double_their_period_again_and_again(ricochet, folder):
    """The shipped study: q'' + q = cos w t over a floor at 0 with restitution 0.8."""
    text = (ricochet.studies / "impact_oscillator.yaml").read_text()
    found = read(run(ricochet, folder, text))
    doubled = [found["special_parameter"][i] for i, kind in enumerate(found["special_kind"]) if kind == "period_doubling"]
    assert abs(doubled[0] - 2.6533477) < 1e-6 and found["segment_origin"] == ["start"] + 2 * ["period_doubling"]
    assert found["segment_impacts"].tolist() == [1, 2, 4]
    segments = found["special_segment"][np.array(found["special_kind"]) == "period_doubling"]
    first = [doubled[np.flatnonzero(segments == k)[0]] for k in range(3)]
    assert 3 < (first[1] - first[0]) / (first[2] - first[1]) < 7  # towards Feigenbaum's 4.67
    stable, at = np.array(found["point_stable"]), found["point_parameter"]
    alone = found["point_segment"] == 0
    assert set(stable[alone & (at < first[0])]) == {"stable"} and set(stable[alone & (at > first[0])]) == {"unstable"}


def test_branches_are_equal_for_all_ranks_and_after_stops(ricochet, folder):
    equal_for_all_ranks_and_after_stops(ricochet, folder, GRID, (1, 3))


def test_a_long_branch_stops_in_time(ricochet, folder):
    text = BASE.replace("particles: 6", "particles: 100").replace("to: 0.15\n", "to: 0.15\n  step_most: 1e-5\n"
                                                                   "  points: 100000\n")
    write(folder, "s.yaml", text)
    result = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, ranks=2)
    result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "0 of 1 tasks", "--resume")
