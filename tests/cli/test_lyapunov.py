"""Lyapunov exponents through the command line: values, convergence, outcomes, and how they open.

The particles are uncoupled and damped; restitution e < 1 takes ln(e^2) of a phase volume at every impact."""

import csv
import io

import h5py
import numpy as np
import xarray
from program import USAGE, study, trajectory, words_of, write

DRIVEN = """kind: trajectory
model: {type: chain, particles: 1, ends: free, gamma: 0, stiffness: 0, damping: 0.1, floor: -1, wall: 1,
        restitution: 0.8, force: 7, frequency: 2.6}
start: {v: 0}
time: {duration: 200, samples: 101, lyapunov: true}
sweep: {parameter: model.force, values: [9, 9.875, 10.5]}
"""


def run(ricochet, folder, text, *words, name="s"):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder).expect_done()
    return folder / f"{name}.h5"


def read(path):
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file["trajectory"].items()}
        return found | {"words": words_of(file["trajectory/outcome"])}


def history(found, task):
    first, last = found["lyapunov_offset"][task : task + 2]
    return found["lyapunov_time"][first:last], found["lyapunov_history"][first:last]


def test_exponents_are_there_only_when_asked_for(ricochet, folder):
    for text in (DRIVEN.replace(", lyapunov: true", ""), DRIVEN.replace("true", "false")):
        path = run(ricochet, folder, text, "--force")
        with h5py.File(path) as file:
            assert not [name for name in file["trajectory"] if "lyapunov" in name] and "exponent" not in file


def test_damping_alone_gives_its_own_exponents(ricochet, folder):
    text = trajectory(2, floor="null", model="damping: 0.3", duration=300, time="samples: 2, lyapunov: true")
    found = read(run(ricochet, folder, text))["lyapunov"][0]
    assert np.allclose(found, -0.15, atol=0.02), found  # with the remainder of a turn over the time
    assert abs(found.sum() + 2 * 0.3) < 1e-10, found


def test_the_sum_of_the_exponents_is_the_loss_of_phase_volume(ricochet, folder):
    found = read(run(ricochet, folder, DRIVEN))
    for task in range(3):
        impacts = np.diff(found["impact_offset"])[task]
        expected = -0.1 + impacts * np.log(0.8**2) / 200
        assert impacts > 50 and abs(found["lyapunov"][task].sum() - expected) < 1e-9, (task, impacts)
    assert found["lyapunov"][0, 0] < -0.2 and (found["lyapunov"][1:, 0] > 0.1).all(), found["lyapunov"]


def test_the_motion_is_that_of_a_run_without_them(ricochet, folder):
    """Up to rounding, which a periodic motion forgets."""
    text = DRIVEN.replace("[9, 9.875, 10.5]", "[9]")
    found = read(run(ricochet, folder, text))
    plain = read(run(ricochet, folder, text.replace(", lyapunov: true", ""), name="plain"))
    assert np.array_equal(found["impact_offset"], plain["impact_offset"])
    for name in ("t", "q", "v", "impact_time", "impact_gap_rate", "impact_impulse", "energy_end", "impact_loss"):
        assert np.allclose(found[name], plain[name], rtol=1e-9, atol=1e-9), name


def test_convergence_is_kept_at_growing_times_up_to_the_last(ricochet, folder):
    found = read(run(ricochet, folder, DRIVEN.replace("lyapunov: true", "lyapunov: true, lyapunov_interval: 0.5")))
    for task in range(3):
        times, values = history(found, task)
        assert times[0] == 0.5 and times[-1] == 200 and 60 < len(times) < 140, times
        assert (times[1:-1] >= 1.05 * times[:-2]).all() and times[-1] > times[-2]
        assert values.shape == (len(times), 2) and np.array_equal(values[-1], found["lyapunov"][task])
        assert np.isfinite(values).all()
    assert found["lyapunov_offset"][-1] == len(found["lyapunov_time"])


def test_groups_open_in_xarray_with_their_axes(ricochet, folder):
    path = run(ricochet, folder, DRIVEN)
    with xarray.open_dataset(path, engine="h5netcdf", group="trajectory") as opened:
        assert opened.lyapunov.dims == ("task", "exponent") and opened.sizes["exponent"] == 2
        assert opened.lyapunov_history.dims == ("lyapunov_row", "exponent")
        assert opened.lyapunov_time.dims == ("lyapunov_row",) and opened.lyapunov_offset.dims == ("task_edge",)
        opened.load()
    ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_csv_of_the_convergence_tells_the_task(ricochet, folder):
    path = run(ricochet, folder, DRIVEN)
    out = ricochet("show", path, "--csv=trajectory/lyapunov_row", cwd=folder).expect_done().out
    rows = list(csv.DictReader(io.StringIO(out)))
    found = read(path)
    assert [int(row["task"]) for row in rows] == np.repeat(np.arange(3), np.diff(found["lyapunov_offset"])).tolist()
    assert [float(row["lyapunov_time"]) for row in rows] == found["lyapunov_time"].tolist()
    assert "lyapunov_history" in ricochet("show", path, cwd=folder).expect_done().out


def test_a_motion_that_grazes_ends_with_what_was_known_by_then(ricochet, folder):
    """It touches its floor with speed 0 at 3 pi / 2."""
    text = trajectory(start="v: 1", time="samples: 21, lyapunov: true",
                      sweep="{parameter: time.lyapunov_interval, values: [1, 30]}")
    found = read(run(ricochet, folder, text))
    assert found["words"] == ["grazing", "grazing"] and all(found["reason"])
    assert np.allclose(found["time"], 1.5 * np.pi, atol=1e-5)
    assert np.isfinite(found["lyapunov"]).all()
    known = [history(found, task)[0] for task in (0, 1)]
    assert known[0][:4].tolist() == [1, 2, 3, 4]  # at the ends of intervals, and where the last factorisation was
    assert len(known[1]) == 1 and 0 < known[1][0] < 1.5 * np.pi
    reached = found["t"] <= found["time"][:, None]
    assert np.isfinite(found["q"][reached]).all() and np.isnan(found["q"][~reached]).all()


def test_a_contact_that_rests_puts_its_directions_out(ricochet, folder):
    text = trajectory(floor=0.5, model="restitution: 0.5", start="q: 1", time="samples: 2, lyapunov: true")
    found = read(run(ricochet, folder, text))
    assert found["words"] == ["completed"] and np.isneginf(found["lyapunov"]).all(), found["lyapunov"]


def test_the_largest_exponent_of_an_orbit_is_that_of_its_largest_multiplier(ricochet, folder):
    """By the slope of the convergence, when the first periods are forgotten. The first tangent vector is that of
    particle 0, and the orbit is localised there."""
    model = "model: {type: chain, particles: 30, gamma: 0.17, floor: -1}\n"
    orbit = "orbit: {period: 1.5 pi, at_start: [0]"
    write(folder, "o.yaml", f"kind: orbits\n{model}{orbit}, stable: true}}\n")
    ricochet.run("o.yaml", cwd=folder).expect_done()
    with h5py.File(folder / "o.h5") as file:
        growth = np.log(file["orbits/multiplier_max"][0])
    time = "time: {duration: 18 pi, samples: 2, lyapunov: true, lyapunov_interval: 1.5 pi}\n"
    found = read(run(ricochet, folder, f"kind: trajectory\n{model}{orbit}}}\n{time}"))
    times, values = history(found, 0)
    slopes = np.diff(times * values[:, 0])[:11]
    assert abs(slopes[-1] - growth) < 1e-5 * growth, (slopes, growth)


def test_a_task_without_a_motion_has_no_exponents(ricochet, folder):
    text = trajectory(time="samples: 2, lyapunov: true", sweep="{parameter: start.q, values: [0, -1.5, 0.5]}")
    found = read(run(ricochet, folder, text))
    assert found["words"] == ["completed", "refused", "completed"]
    assert np.isnan(found["lyapunov"][1]).all() and np.isfinite(found["lyapunov"][[0, 2]]).all()
    assert len(history(found, 1)[0]) == 0


def test_what_cannot_be_is_refused(ricochet, folder):
    write(folder, "s.yaml", trajectory(1000000, time="lyapunov: true"))
    write(folder, "t.yaml", trajectory(time="lyapunov: true, lyapunov_interval: 0"))
    write(folder, "o.yaml", study() + "time: {lyapunov: true}\n")
    for command in ("check", "run"):
        refused = ricochet(command, "s.yaml", cwd=folder)
        refused.expect_refused(USAGE, "s.yaml:2: model.particles: ", "tangent vectors", "memory")
        refused = ricochet(command, "t.yaml", cwd=folder)
        refused.expect_refused(USAGE, "t.yaml:4: time.lyapunov_interval = 0 ", ">= 1e-06")
        ricochet(command, "o.yaml", cwd=folder).expect_refused(USAGE, "o.yaml:", "time.lyapunov", "kind: trajectory")
