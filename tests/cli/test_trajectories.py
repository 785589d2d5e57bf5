"""Trajectories through the command line: ragged tables of impacts and events, samples, outcomes, and verified orbits.

The particles are uncoupled, so that between impacts each is a sine wave: what is expected is in closed form."""

import csv
import io

import h5py
import numpy as np
import xarray
from program import USAGE, study, sweep, trajectory, words_of, write

SPEEDS = np.linspace(0.5, 3, 6)
SPEED_SWEEP = sweep(6, 0.5, 3, "start.v")


def run(ricochet, folder, text, *words, name="s", **options):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder, **options).expect_done()
    return folder / f"{name}.h5"


def read(path, group="trajectory"):
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file[group].items()}
        return found | {f"{n}_words": words_of(d) for n, d in file[group].items() if h5py.check_enum_dtype(d.dtype)}


def share(found, task, what="impact"):
    """The rows of a task in a ragged table."""
    begin, end = found[f"{what}_offset"][task : task + 2]
    return {name: values[begin:end] for name, values in found.items() if name.startswith(f"{what}_")}


def impact_times(speed, end):
    """Of the particle that starts at 0 with a speed, over a floor at -1, without losses."""
    if speed <= 1:
        return np.empty(0)
    phase = np.arcsin(1 / speed)
    return np.arange(np.pi + phase, end, np.pi + 2 * phase)


def test_impacts_meet_the_closed_form_in_every_task(ricochet, folder):
    found = read(run(ricochet, folder, trajectory(duration=50, sweep=SPEED_SWEEP)))
    assert found["outcome_words"] == ["completed"] * 6
    for task, speed in enumerate(SPEEDS):
        if speed == 1:
            continue  # touches its floor with speed 0
        impacts, expected = share(found, task), impact_times(speed, 50)
        assert np.allclose(impacts["impact_time"], expected, rtol=0, atol=1e-10), (speed, impacts["impact_time"])
        hit = np.sqrt(speed**2 - 1) if speed > 1 else 0
        assert np.allclose(impacts["impact_gap_rate"], -hit, rtol=0, atol=1e-10)
        assert np.allclose(impacts["impact_impulse"], 2 * hit, rtol=0, atol=1e-10)
        assert set(impacts["impact_kind_words"]) <= {"transversal"} and set(impacts["impact_side_words"]) <= {"floor"}


def test_offsets_count_the_impacts_of_tasks_with_very_different_numbers(ricochet, folder):
    text = trajectory(3, start="v: [0.5, 1.5, 0.2]", model="wall: [null, null, 0.1]",
                      sweep="{parameter: time.duration, values: [1, 400, 3, 0.1, 90, 2000, 1, 7]}")
    found = read(run(ricochet, folder, text))
    offset = found["impact_offset"]
    assert offset[0] == 0 and offset[-1] == len(found["impact_time"]) and (np.diff(offset) >= 0).all()
    assert offset.dtype == np.int64 and len(offset) == 9
    assert np.diff(offset)[5] > 500 and np.diff(offset)[3] == 0
    for task in range(8):
        impacts = share(found, task)
        assert (np.diff(impacts["impact_time"]) >= 0).all()
        assert set(impacts["impact_particle"]) <= {1, 2}
        assert {s for p, s in zip(impacts["impact_particle"], impacts["impact_side_words"]) if p == 2} <= {"wall"}
        alone = impacts["impact_time"][impacts["impact_particle"] == 1]
        assert np.allclose(alone, impact_times(1.5, found["time"][task]), rtol=0, atol=1e-8)


def test_samples_are_states_at_equal_times(ricochet, folder):
    text = trajectory(2, start="q: [0.5, 0], v: [0.5, 2]", duration="10 pi", time="samples: 101")
    found = read(run(ricochet, folder, text))
    t = found["t"][0]
    assert found["q"].shape == found["v"].shape == (1, 101, 2)
    assert t[0] == 0 and t[-1] == 10 * np.pi and np.allclose(t, np.linspace(0, 10 * np.pi, 101), rtol=1e-15)
    assert np.allclose(found["q"][0, :, 0], 0.5 * (np.cos(t) + np.sin(t)), rtol=0, atol=1e-10)
    assert np.allclose(found["v"][0, :, 0], 0.5 * (np.cos(t) - np.sin(t)), rtol=0, atol=1e-10)
    phase = np.arcsin(0.5)  # the second goes on as if from below its floor after each impact
    turned = (t + phase) % (np.pi + 2 * phase) - phase
    assert np.allclose(found["q"][0, :, 1], 2 * np.sin(turned), rtol=0, atol=1e-9)
    energy = 0.5 * (found["q"] ** 2 + found["v"] ** 2).sum(axis=2)
    assert np.allclose(energy, found["energy_start"][0], rtol=1e-10) and abs(found["impact_loss"][0]) < 1e-10
    assert found["steps"][0] > 0 and found["force_evaluations"][0] > 0


def test_groups_open_in_xarray_with_their_axes(ricochet, folder):
    path = run(ricochet, folder, trajectory(2, time="samples: 5", start="v: 2", sweep=SPEED_SWEEP))
    with xarray.open_dataset(path, engine="h5netcdf", group="trajectory") as opened:
        impacts = len(opened.impact_time)
        assert opened.q.dims == opened.v.dims == ("task", "sample", "particle") and opened.t.dims == ("task", "sample")
        assert opened.impact_offset.dims == opened.event_offset.dims == ("task_edge",)
        assert opened.impact_time.dims == opened.impact_kind.dims == ("impact_row",)
        sizes = {k: v for k, v in opened.sizes.items() if k != "event_row"}
        assert sizes == {"task": 6, "sample": 5, "particle": 2, "task_edge": 7, "impact_row": impacts}
        opened.load()


def test_no_impact_at_all_is_an_empty_table(ricochet, folder):
    for name, text in (("one", trajectory(start="v: 0.5")), ("many", trajectory(sweep=sweep(5, 0, 0.9, "start.v"))),
                       ("free", trajectory(floor="null", start="v: 9"))):
        path = run(ricochet, folder, text, name=name)
        found = read(path)
        assert not found["impact_offset"].any() and len(found["impact_time"]) == len(found["event_time"]) == 0
        assert set(found["outcome_words"]) == {"completed"}
        with h5py.File(path) as file:
            groups = [group for group in file if isinstance(file[group], h5py.Group)]
        for group in groups:
            with xarray.open_dataset(path, engine="h5netcdf", group=group) as opened:
                opened.load()
        for words in ([], ["--csv"], ["--csv=trajectory/impact_row"], ["--verify"]):
            ricochet("show", path, *words, cwd=folder).expect_done()


def test_impacts_with_losses_end_in_rest(ricochet, folder):
    """The floor lies above the equilibrium of the spring, which presses the particle onto it."""
    found = read(run(ricochet, folder, trajectory(floor=0.5, model="restitution: 0.5", start="q: 1")))
    events, impacts = share(found, 0, "event"), share(found, 0)
    assert "rest" in events["event_kind_words"]
    rests = events["event_time"][events["event_kind_words"].index("rest")]
    assert impacts["impact_time"][0] == min(impacts["impact_time"]) and impacts["impact_time"][-1] <= rests < 20
    assert abs(impacts["impact_time"][0] - np.pi / 3) < 1e-10
    after = found["t"][0] > rests
    assert np.allclose(found["q"][0, after, 0], 0.5, rtol=0, atol=1e-10)
    assert np.allclose(found["v"][0, after, 0], 0, rtol=0, atol=1e-10)
    for task in np.flatnonzero(np.array(events["event_kind_words"]) == "chatter"):
        assert events["event_time"][task] <= events["event_accumulation"][task] <= rests


def test_restitution_can_be_given_per_particle(ricochet, folder):
    text = trajectory(2, model="restitution: [1, 0.5]", start="v: [2, 1.5]", duration=5)
    found = read(run(ricochet, folder, text))
    impacts = share(found, 0)
    jumps = {int(p): i for p, i in zip(impacts["impact_particle"], impacts["impact_impulse"])}
    assert abs(jumps[0] - 2 * np.sqrt(3)) < 1e-10 and abs(jumps[1] - 1.5 * np.sqrt(1.25)) < 1e-10, jumps
    assert abs(found["impact_loss"][0] - 0.5 * 1.25 * 0.75) < 1e-9


# --- outcomes ---


def test_a_start_below_its_floor_is_a_row_of_a_sweep(ricochet, folder):
    path = run(ricochet, folder, trajectory(sweep="{parameter: start.q, values: [0, -1.5, 0.5]}"))
    found = read(path)
    assert found["outcome_words"] == ["completed", "refused", "completed"]
    assert found["reason"][1] and not found["reason"][0]
    assert np.isnan(found["q"][1]).all() and np.isfinite(found["q"][[0, 2]]).all() and np.isfinite(found["t"]).all()
    assert found["impact_offset"][1] == found["impact_offset"][2]


def test_a_start_below_its_floor_is_refused_alone(ricochet, folder):
    write(folder, "s.yaml", trajectory(start="q: -1.5"))
    for command in ("check", "run"):
        ricochet(command, "s.yaml", cwd=folder).expect_refused(USAGE, "s.yaml: ")


def test_too_many_events_end_a_trajectory(ricochet, folder):
    found = read(run(ricochet, folder, trajectory(duration=200, time="events_per_time: 0.01, samples: 201")))
    assert found["outcome_words"] == ["event_limit"] and found["reason"][0]
    reached = found["t"][0] <= found["time"][0]
    assert 0 < found["time"][0] < 200
    assert np.isfinite(found["q"][0, reached]).all() and np.isnan(found["q"][0, ~reached]).all()


ON_ORBIT = """kind: trajectory
model: {type: chain, particles: 3, gamma: 0, floor: -1}
orbit: {period: 1.5 pi, at_start: [1]}
time: {duration: 5.25 pi, samples: 8}
"""


def test_a_trajectory_that_starts_on_an_orbit_follows_it(ricochet, folder):
    """Three and a half periods from t = 0+ on: an impact after each period, and half a period from the start at last."""
    found = read(run(ricochet, folder, ON_ORBIT))
    orbit = read(run(ricochet, folder, study(3, gamma=0, at_start="[1]"), name="orbit"), "orbits")
    assert np.allclose(found["q"][0, 0], orbit["q"][0], atol=1e-12)
    assert np.allclose(found["v"][0, 0], orbit["v"][0], atol=1e-12)
    impacts = share(found, 0)
    assert np.allclose(impacts["impact_time"], 1.5 * np.pi * np.arange(1, 4), rtol=0, atol=1e-9)
    assert set(impacts["impact_particle"]) == {1}
    assert np.allclose(impacts["impact_impulse"], orbit["impulse"][0, 0], rtol=0, atol=1e-9)


def test_a_pattern_without_an_orbit_is_a_row_of_its_sweep(ricochet, folder):
    text = ON_ORBIT.replace("[1]", "[0, 1]") + "sweep: {parameter: 'orbit.at_start[1]', values: [1, 0, 2]}\n"
    found = read(run(ricochet, folder, text))
    assert found["outcome_words"] == ["completed", "no_orbit", "completed"]
    assert found["reason"][1] and np.isnan(found["q"][1]).all()
    assert found["impact_offset"][1] == found["impact_offset"][2]


# --- orbits that are verified ---


def test_orbits_are_verified_when_the_study_asks_for_it(ricochet, folder):
    path = run(ricochet, folder, study(at_start="[15]", orbit="verify: true", sweep=sweep(40, 0, 0.4)))
    orbits = read(path, "orbits")
    assert {"admissible", "inadmissible"} <= set(orbits["outcome_words"])
    for outcome, verified, error in zip(orbits["outcome_words"], orbits["verified_words"], orbits["closure_error"]):
        if outcome == "admissible":
            assert verified == "verified" and 0 <= error < 1e-8, (verified, error)
        elif outcome != "grazing":
            assert verified == "not_run" and np.isnan(error), (outcome, verified, error)
    plain = read(run(ricochet, folder, study(at_start="[15]", sweep=sweep(40, 0, 0.4)), name="plain"), "orbits")
    assert "verified" not in plain and plain["q"].tobytes() == orbits["q"].tobytes()


# --- what is printed ---


def test_check_tells_that_events_come_on_top(ricochet, folder):
    write(folder, "s.yaml", trajectory(sweep=SPEED_SWEEP))
    assert "plus events" in ricochet("check", "s.yaml", cwd=folder).expect_done().out
    write(folder, "o.yaml", study())
    assert "plus events" not in ricochet("check", "o.yaml", cwd=folder).expect_done().out


def test_sizes_beyond_the_machine_are_refused(ricochet, folder):
    write(folder, "s.yaml", trajectory(1000000000, time="samples: 1000000000"))
    for command in ("check", "run"):
        ricochet(command, "s.yaml", cwd=folder).expect_refused(USAGE, "s.yaml:2: model.particles: ", "memory")


def test_csv_of_impacts_tells_the_task(ricochet, folder):
    path = run(ricochet, folder, trajectory(2, start="v: [2, 1.2]", sweep=sweep(9, 0.5, 3, "'start.v[0]'")))
    found = read(path)
    out = ricochet("show", path, "--csv=trajectory/impact_row", cwd=folder).expect_done().out
    rows = list(csv.DictReader(io.StringIO(out)))
    tasks = np.repeat(np.arange(9), np.diff(found["impact_offset"]))
    assert [int(row["task"]) for row in rows] == tasks.tolist()
    assert [float(row["impact_time"]) for row in rows] == found["impact_time"].tolist()
    assert [row["impact_kind"] for row in rows] == found["impact_kind_words"]
    ricochet("show", path, "--csv=trajectory/iterate", cwd=folder).expect_refused(USAGE, str(path), "iterate")


def test_show_lists_every_table_of_a_trajectory(ricochet, folder):
    path = run(ricochet, folder, trajectory(sweep=SPEED_SWEEP))
    out = ricochet("show", path, cwd=folder).expect_done().out
    for phrase in ("outcome: completed 6", "[task 6, sample 1001, particle 1]", "[task_edge 7]", "impact_kind:"):
        assert phrase in out, (phrase, out)
