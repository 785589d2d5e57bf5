"""Diagrams and basins of maps through the command line: against an iteration of their own and against closed forms, how
attractors are stored, what is refused, and that nothing depends on ranks, on stops or on how tasks are put together."""

import csv
import io

import h5py
import numpy as np
import xarray
from branches import equal_for_all_ranks_and_after_stops, refuse, run
from diagram_studies import MAP, LISTED, OSCILLATOR, BEYOND, swept, read, found_by, iterates, border, flip
from program import STOPPED, USAGE, write

# --- refusals ---


def test_keys_and_values_are_refused_by_place_and_value(ricochet, folder):
    keep = "keep: 100"
    model = "is a key of model.type: chain or duffing_chain, and this is model.type: grazing_map"
    refuse(ricochet, folder, [
        ("transient", "trasient", 3, "unknown key 'trasient' in iterate; did you mean 'transient'?"),
        ("lambda: 0.5, ", "", 0, "missing key model.lambda: a map is given by lambda and omega, or by L, eta and xi"),
        (", omega: 0.3", "", 0, "missing key model.omega"),
        (", d: 0.01", "", 0, "missing key model.d (a number)"),
        ("iterate:", "start: {q: 1}\niterate:", 3, "start.q " + model),
        ("lambda", "particles: 3, lambda", 2, "model.particles " + model),
        (keep, "section: impact", 3, "iterate.section " + model),
        ("iterate:", "grazing: {beyond: 0.1}\niterate:", 3, "grazing.beyond " + model),
        (keep, "start: [0, 0]", 3, "iterate.start has 2 elements, expected 3, or a single number"),
        (keep, "observe: z4", 3, "iterate.observe = z4, expected z1 to z3"),
        (keep, "keep: 100, measure: 99", 3, "iterate.measure = 99, expected at least iterate.keep = 100"),
        (keep, "lyapunov: true, exponents: 4", 3, "iterate.exponents = 4, expected at most 3"),
        (keep, "exponents: 3", 3, "iterate.exponents = 3 needs iterate.lyapunov: true"),
        (keep, "windows: true", 3, "iterate.windows = true refers to the last sweep, but the study has none"),
        (keep, "follow: true", 3, "iterate.follow = true refers to the last sweep, but the study has none"),
        (keep + "}", keep + "}\nsweep: {parameter: iterate.keep, values: [1]}", 4,
         "iterate.keep cannot be swept: it changes the shape of the result"),
        (keep + "}", keep + "}\nsweep: {parameter: iterate.measure, values: [200, 99]}", 4,
         "swept iterate.measure = 99, expected at least iterate.keep = 100"),
        (keep + "}", "windows: true}\nsweep: {parameter: model.d, values: [1e-3, 2e-3, 1e-3]}", 3,
         "needs rising or falling values of the last sweep, and those of model.d are neither"),
        (keep + "}", keep + "}\norbit: {motion: forced}", 4,
         "the section 'orbit' of kind: diagram is for diagrams with grazing.beyond"),
    ], MAP)
    refuse(ricochet, folder, [
        ("damping: 3, ", "damping: 3, lambda: 0.5, ", 2, "model.lambda is a key of model.type: grazing_map"),
        ("keep: 60", "start: 0", 4, "iterate.start is a key of model.type: grazing_map"),
        ("keep: 60", "observe: q1", 4, "iterate.observe = q1, expected q0 to q0 or v0 to v0"),
        ("keep: 60", "observe: time", 4, "iterate.observe = time, expected q0 to q0 or v0 to v0"),
        ("wall: 1,", "wall: 1, floor: null,", 2, "duplicate key 'floor'"),
        ("keep: 60", "particle: 0", 4, "iterate.particle is a key of iterate.section: impact, and this is strobe"),
        ("keep: 60", "section: impact, particle: 1", 4, "iterate.particle = 1 is out of range"),
        ("keep: 60}", "section: impact, windows: true}\nsweep: {parameter: model.force, values: [20, 22]}", 4,
         "iterate.windows = true needs iterate.section: strobe, and this is impact"),
    ], OSCILLATOR)
    refuse(ricochet, folder, [
        ("motion: forced", "motion: conservative", 8, "grazing.beyond needs orbit.motion: forced, and this is conservative"),
        ("orbit: {motion: forced}\n", "", 7, "grazing.beyond needs orbit.motion: forced, and this is even"),
        ("keep: 100", "section: impact", 8, "grazing.beyond needs iterate.section: strobe, and this is impact"),
        ("grazing.beyond", "iterate.phase", 4, "the section 'branch' of kind: diagram is for diagrams with grazing.beyond"),
        ("to: 50", "to: 50, trace: {parameter: model.damping, low: 1, high: 4}", 4,
         "branch.trace.parameter is a key of kind: branch or grazing, and this is kind: diagram"),
    ], BEYOND)
    write(folder, "s.yaml", MAP)
    ricochet("check", "s.yaml", "--set", "iterate.observe=z9", cwd=folder).expect_refused(
        USAGE, "--set iterate.observe=z9: iterate.observe = z9, expected z1 to z3")


# --- the example map of the source ---


def test_iterates_are_those_of_the_printed_map(ricochet, folder):
    """Periodic ones and the first ones of chaotic ones, before rounding has grown."""
    text = swept(MAP.replace("keep: 100", "states: true, keep: 40, start: [0.02, -0.1, 0.3]"),
                 "iterate.transient, values: [0, 3, 500]", "model.d, values: [0.03, 0.01, 1.5e-4, 0, -0.1]")
    found = found_by(ricochet, folder, text)
    assert found["values"].shape == (15, 40) and found["state"].shape == (15, 40, 3)
    assert (found["values"] == found["state"][:, :, 0]).all() and (found["end"] == found["state"][:, -1]).all()
    for task, (transient, d) in enumerate((t, d) for t in (0, 3, 500) for d in (0.03, 0.01, 1.5e-4, 0, -0.1)):
        if transient == 500 and d == 1.5e-4:
            continue
        own = iterates(d, transient, 40, (0.02, -0.1, 0.3))
        assert np.allclose(found["state"][task], own, rtol=1e-9, atol=1e-13), (transient, d)
    second = found_by(ricochet, folder, text.replace("keep: 40", "keep: 40, observe: z3"), name="z3")
    assert (second["values"] == found["state"][:, :, 2]).all()


def test_windows_and_chaos_lie_where_the_source_has_them(ricochet, folder):
    values = [0.03, 0.0277, 0.0138, 0.009, 0.0044, 0.0042, 1.5e-4]
    found = found_by(ricochet, folder, swept(MAP.replace("keep: 100", "keep: 100, lyapunov: true").replace("2000", "9000"),
                                             f"model.d, values: {values}"))
    assert found["attractor_period"].tolist() == [4, 0, 5, 5, 5, 0, 0]
    assert found["outcome"] == ["aperiodic" if p == 0 else "periodic" for p in found["attractor_period"]]
    assert (np.sign(found["lyapunov"]) == [-1, 1, -1, -1, -1, 1, 1]).all() and not any(found["reason"])
    assert np.allclose(found["impacts"][[0, 2, 3, 4]], [0.25, 0.2, 0.2, 0.2])
    with h5py.File(folder / "s.h5") as file:
        assert file["diagram/attractor_period"].attrs["period_limit"] == 64
        assert file["diagram/values"].attrs["observed"] == b"z1"
    long = found_by(ricochet, folder, MAP.replace("keep: 100", "keep: 100, period_limit: 4"), name="long")
    assert long["attractor_period"].tolist() == [0] and long["outcome"] == ["aperiodic"]


def test_periods_beside_a_flip_are_not_doubled(ricochet, folder):
    """Attractors are approached there from both sides in turn: iterates come back after 8 long before after 4."""
    text = swept(MAP.replace("keep: 100", "keep: 0, measure: 10").replace("2000", "9000"), "model.d, from: 0.0282, to: 0.0286, points: 17")
    assert found_by(ricochet, folder, text)["attractor_period"].tolist() == 17 * [4]


def test_exponents_are_those_of_the_closed_form(ricochet, folder):
    """z1 decouples, and the rest turns and shrinks by omega."""
    text = MAP.replace("d: 0.01", "d: 1.5e-4").replace("keep: 100", "keep: 10, measure: 100000, lyapunov: true, exponents: 3")
    found = found_by(ricochet, folder, text)
    z, total = 0.0, 0.0
    for i in range(102000):
        depth = 1.5e-4 - z
        total += (i >= 2000) * np.log(abs(0.5 if depth < 0 else -0.5 / np.sqrt(depth) - 3))
        z = 0.5 * z if depth < 0 else np.sqrt(depth) + 0.5 * 1.5e-4 + 3 * depth
    assert found["exponents"].shape == (1, 3) and found["exponents"][0, 0] == found["lyapunov"][0]
    assert abs(found["lyapunov"][0] - total / 100000) < 0.01 and found["lyapunov"][0] > 0.05
    assert np.allclose(found["exponents"][0, 1:], np.log(0.3), atol=1e-4)
    cycle = found_by(ricochet, folder, MAP.replace("keep: 100", "keep: 10, lyapunov: true, measure: 1000"), name="cycle")
    own = iterates(0.01, 2000, 5)[:, 0]
    slopes = [0.5 if z > 0.01 else 0.5 / np.sqrt(0.01 - z) + 3 for z in own]
    assert abs(cycle["lyapunov"][0] - np.log(slopes).mean()) < 1e-6 and "exponents" not in cycle


def test_edges_of_windows_meet_the_closed_forms(ricochet, folder):
    text = MAP.replace("keep: 100", "keep: 0, measure: 100, windows: true").replace("2000", "9000")
    text = swept(text, "model.d, from: 1e-5, to: 0.02, points: 300, scale: log")
    for decay, turn in ((0.5, 0.3), (0.4, 0.1), (0.6, 0.2)):
        name = f"w{decay}"
        path = run(ricochet, folder, text, "--set", f"model.lambda={decay}", "--set", f"model.omega={turn}", name=name)
        found = read(path, "window")
        one = (found["impacts"] == 1) & (found["task"] > 0) & (found["period"] > 3)
        assert one.sum() >= 3 and len(set(found["period"][one])) == one.sum()
        for k in np.flatnonzero(one):
            n = found["period"][k]
            assert abs(found["low"][k] / flip(n, decay) - 1) < 1e-9, (decay, n)
            assert abs(found["map_low"][k] / flip(n, decay) - 1) < 1e-9, (decay, n)
            if found["high_kind"][k] != "open":
                assert abs(found["high"][k] / border(n, decay) - 1) < 1e-9 and found["high_kind"][k] == "border", (decay, n)
            assert found["low_kind"][k] == "flip" and not found["reason"][k] and abs(found["multiplier"][k]) < 1
            assert found["low"][k] < found["parameter"][k] < found["high"][k]
            assert not found["low_outside"][k] > found["low"][k] * 1.1 and not found["high_outside"][k] < found["high"][k] * 0.9
    assert abs(border(5, 0.5) - 1 / 72) < 1e-15 and abs(flip(4, 0.5) - 0.028) < 1e-15


def test_no_window_follows_above_two_thirds(ricochet, folder):
    text = swept(MAP.replace("keep: 100", "keep: 0, measure: 1000, lyapunov: true, windows: true").replace("2000", "9000"),
                 "model.d, from: 1e-5, to: 1e-2, points: 120, scale: log")
    path = run(ricochet, folder, text, "--set", "model.lambda=0.7", "--set", "model.omega=0.15")
    found, windows = read(path), read(path, "window")
    assert (found["attractor_period"] == 0).all() and (found["lyapunov"] > 0.05).all()
    assert len(windows["period"]) == 0
    ricochet("show", path, cwd=folder).expect_done()


def test_attractors_repeat_under_the_square_of_lambda(ricochet, folder):
    """Periods rise by one and exponents per return stay, better so as d falls: the limit map."""
    d = np.geomspace(1e-6, 4e-6, 41)[:-1]
    text = MAP.replace("keep: 100", "keep: 20, measure: 1000").replace("2000", "20000")
    found = [found_by(ricochet, folder, swept(text, f"model.d, values: {(k * d).tolist()}"), name=f"s{i}")
             for i, k in enumerate((1, 0.25, 0.0625))]
    periods = [f["attractor_period"] for f in found]
    assert (periods[0] > 0).sum() > 10
    for low, high in ((1, 0), (2, 1)):
        both = (periods[low] > 0) & (periods[high] > 0)
        one = both & np.isclose(found[high]["impacts"] * periods[high], 1, atol=0.02)
        assert one.sum() > 10 and (periods[low][one] == periods[high][one] + 1).all()
        assert (periods[low][~both] == periods[high][~both]).mean() > 0.7
        size = found[low]["values"].max(axis=1)[one] / found[high]["values"].max(axis=1)[one]
        assert np.allclose(size, 0.5, rtol=0.01)


# --- two attractors ---


def test_attractors_coexist_between_the_flip_and_the_next_border(ricochet, folder):
    """lambda below 1/4: period n comes up as far as its border, and goes down as far as its flip."""
    decay, turn = 0.1, 0.05
    text = MAP.replace("lambda: 0.5, omega: 0.3", f"lambda: {decay}, omega: {turn}").replace("keep: 100", "keep: 0, follow: true")
    d = np.geomspace(2e-6, 0.03, 500)
    text = swept(text, "model.d, from: 2e-6, to: 0.03, points: 500, scale: log, back: true")
    path = run(ricochet, folder, text)
    period = read(path)["attractor_period"]
    with h5py.File(path) as file:
        values = file["sweep/model.d"][()]
    assert np.allclose(values[:500], d) and (values[500:] == values[:500][::-1]).all()
    up, down = period[:500], period[500:][::-1]
    for n in (2, 3):
        low, high = flip(n, decay), border(n + 1, decay)
        assert low < high
        inside = (values[:500] > 1.02 * low) & (values[:500] < 0.94 * high)
        assert inside.sum() > 5 and (up[inside] == n + 1).all() and (down[inside] == n).all(), n
        upper = flip(n - 1, decay) if n > 2 else 0.03
        alone = (values[:500] > 1.02 * high) & (values[:500] < 0.98 * upper)
        assert alone.any() and (up[alone] == n).all() and (down[alone] == n).all(), n
    middle = np.sqrt(flip(2, decay) * border(3, decay))
    text = MAP.replace("lambda: 0.5, omega: 0.3, d: 0.01", f"lambda: {decay}, omega: {turn}, d: {middle}")
    found = found_by(ricochet, folder, swept(text.replace("keep: 100", "keep: 0, start: [0, 0, 0]"),
                                             "'iterate.start[0]', values: [0, 0.01]"), name="two")
    assert found["attractor_period"].tolist() == [3, 2]


BASIN = """kind: basin
model: {type: grazing_map, lambda: 0.1, omega: 0.05, d: 0.0155}
iterate: {transient: 1000, measure: 10, start: [0, 0, 0]}
"""


def test_basins_say_which_attractor_every_start_comes_to(ricochet, folder):
    text = swept(BASIN, "'iterate.start[1]', values: [-0.2, 0.3]", "'iterate.start[0]', from: -0.5, to: 0.5, points: 40")
    path = run(ricochet, folder, text)
    found = read(path, "basin")
    starts = np.linspace(-0.5, 0.5, 40)
    own = [iterates(0.0155, 1100, 6, (z, 0, 0), 0.1, 0.05)[:, 0] for z in starts]
    periods = np.array([3 if abs(z[-1] - z[-4]) < 1e-12 else 2 for z in own])
    assert set(periods) == {2, 3} and (found["attractor_period"] == np.tile(periods, 2)).all()  # z2 does not count
    assert found["found_period"].tolist() == [periods[0], 5 - periods[0]]
    assert (found["found_period"][found["attractor"]] == found["attractor_period"]).all()
    for k in range(2):
        at = np.flatnonzero(found["attractor"] == k)
        assert found["found_tasks"][k] == len(at) and found["found_first"][k] == at[0]
        assert np.allclose(found["lowest"][at], found["found_lowest"][k], rtol=1e-6, atol=1e-9)
        assert (found["lowest"][at[0]] == found["found_lowest"][k]).all()
        lowest = min(iterates(0.0155, 1100, 6, (starts[at[0] % 40], (-0.2, 0.3)[at[0] // 40], 0), 0.1, 0.05), key=lambda z: z[0])
        assert np.allclose(found["found_lowest"][k], lowest, rtol=1e-9)
    assert not {"values", "state", "lyapunov", "exponents"} & set(found) and found["outcome"] == 80 * ["periodic"]


def test_starts_that_diverge_belong_to_no_attractor(ricochet, folder):
    found = found_by(ricochet, folder, swept(BASIN.replace("lambda: 0.1", "lambda: 2"), "'iterate.start[0]', values: [0.5, 1, 2]"),
                     group="basin")
    assert found["outcome"] == 3 * ["diverged"] and (found["attractor"] == -1).all() and len(found["found_period"]) == 0
    mixed = found_by(ricochet, folder, swept(BASIN, "'iterate.start[0]', values: [0, 1e200, 0.01]"), group="basin", name="mixed")
    assert mixed["outcome"] == ["periodic", "diverged", "periodic"] and mixed["attractor"].tolist() == [0, -1, 1]
    assert b"1e+100" in mixed["reason"][1] and np.isnan(mixed["lowest"][1]).all()


def test_a_few_starts_are_swept_and_given_as_one_number(ricochet, folder):
    text = MAP.replace("keep: 100", "keep: 3, start: 0").replace("2000", "0")
    found = found_by(ricochet, folder, swept(text, "iterate.start, values: [0, 0.3]"))
    for task, start in enumerate((0, 0.3)):
        assert np.allclose(found["values"][task], iterates(0.01, 0, 3, 3 * [start])[:, 0], rtol=1e-13)


# --- other maps, other numbers ---


def test_general_maps_give_the_bits_of_the_example(ricochet, folder):
    """Also one of one number alone: z1 decouples."""
    line = "model.d, values: [0.03, 0.0277, 0.01, 1.5e-4, -1]"
    named = found_by(ricochet, folder, swept(MAP, line))
    listed = found_by(ricochet, folder, swept(LISTED, line), name="listed")
    for name in named:
        assert np.asarray(named[name]).tobytes() == np.asarray(listed[name]).tobytes(), name
    alone = LISTED.replace("[0.5, 0, 0, 0, 0, -0.3, 0, 0.3, 0]", "[0.5]").replace("[1, 0, 0]", "[1]").replace("[1, 1, 1]", "[1]")
    alone = found_by(ricochet, folder, swept(alone.replace("[3.5, -5, 7]", "[3.5]"), line), name="alone")
    assert alone["end"].shape == (5, 1) and np.allclose(alone["values"][[0, 2]], named["values"][[0, 2]], rtol=1e-12)
    # xi and kappa on another scale: s xi sqrt(depth) + depth kappa
    scaled = LISTED.replace("xi: [1, 1, 1]", "xi: [0.5, 0.5, 0.5], stretch: 2".replace(", s", "\n  s"))
    scaled = found_by(ricochet, folder, swept(scaled, line), name="scaled")
    assert np.allclose(scaled["values"][[0, 2]], named["values"][[0, 2]], rtol=1e-12)
    refuse(ricochet, folder / "r" if (folder / "r").mkdir() is None else folder, [
        ("[0.5, 0, 0, 0, 0, -0.3, 0, 0.3, 0]", "[0.5, 0, 0, 0]", 4, "model.L has 4 elements, expected 9: model.eta has 3"),
        ("xi: [1, 1, 1]", "xi: [1, 1]", 6, "model.xi has 2 elements, expected 3: model.eta has 3"),
        ("[3.5, -5, 7]", "[3.5, -5]", 7, "model.kappa has 2 elements, expected 3"),
        ("eta: [1, 0, 0]", "eta: [1, 0, 0]\n  lambda: 0.5", 6, "model.lambda and model.L both give the map"),
        ("eta: [1, 0, 0]", "eta: []", 4, "model.eta is empty, expected the vector of the map"),
        ("eta: [1, 0, 0]", "eta: 1", 5, "model.eta = 1, expected a list of numbers"),
    ], LISTED)


def test_numbers_of_the_map_and_of_the_run_are_swept(ricochet, folder):
    decays, turns = [0.4, 0.5], [0.1, 0.25]
    found = found_by(ricochet, folder, swept(MAP, f"model.lambda, values: {decays}", f"model.omega, values: {turns}"))
    for task, (decay, turn) in enumerate((a, b) for a in decays for b in turns):
        own = iterates(0.01, 2000, 100, (0, 0, 0), decay, turn)
        assert np.allclose(found["values"][task], own[:, 0], rtol=1e-9), (decay, turn)
        assert np.allclose(found["end"][task], own[-1], rtol=1e-9, atol=1e-13)
    listed = found_by(ricochet, folder, swept(LISTED, "'model.L[0]', values: [0.3, 0.5]"), name="listed")
    assert np.allclose(listed["values"][1], iterates(0.01, 2000, 100)[:, 0], rtol=1e-9)
    short = found_by(ricochet, folder, swept(MAP.replace("keep: 100", "keep: 10"), "iterate.measure, values: [10, 15, 1000]"),
                     name="measure")
    assert np.allclose(short["impacts"], 0.2) and (short["values"] == short["values"][0]).all()


def test_divergence_and_rest_are_outcomes(ricochet, folder):
    found = found_by(ricochet, folder, swept(MAP.replace("keep: 100", "keep: 5, states: true"), "model.lambda, values: [0.5, 3, -0.5]"))
    assert found["outcome"] == ["periodic", "diverged", "diverged"]
    assert found["attractor_period"].tolist() == [5, 0, 0] and np.isnan(found["impacts"][1:]).all()
    for task in (1, 2):
        assert np.isnan(found["values"][task]).all() and np.isnan(found["state"][task]).all()
        assert found["reason"][task].startswith(b"a number of the state exceeded 1e+100 by iterate ")
        assert np.isfinite(found["end"][task]).all()
    rest = found_by(ricochet, folder, swept(MAP.replace("keep: 100", "keep: 5, lyapunov: true"), "model.d, values: [-0.1, -1]"), name="rest")
    assert rest["outcome"] == 2 * ["periodic"] and rest["attractor_period"].tolist() == [1, 1]
    assert (rest["values"] == 0).all() and (rest["impacts"] == 0).all() and np.allclose(rest["lyapunov"], np.log(0.5))


# --- how they are stored ---


def test_only_what_was_asked_for_is_there(ricochet, folder):
    bare = found_by(ricochet, folder, MAP.replace("keep: 100", "keep: 0, states: true"), name="bare")
    assert set(bare) == {"outcome", "reason", "attractor_period", "impacts", "end", "lowest"}
    full = found_by(ricochet, folder, MAP.replace("keep: 100", "keep: 7, states: true, lyapunov: true, exponents: 2"), name="full")
    assert set(full) == set(bare) | {"values", "state", "lyapunov", "exponents"}
    with h5py.File(folder / "bare.h5") as file:
        assert "window" not in file and "iterate" not in file and "exponent" not in file
    with h5py.File(folder / "full.h5") as file:
        for name, axes in {"values": ["task", "iterate"], "state": ["task", "iterate", "coordinate"],
                           "exponents": ["task", "exponent"], "end": ["task", "coordinate"], "outcome": ["task"]}.items():
            assert [axis[0].name for axis in file["diagram"][name].dims] == ["/" + a for a in axes], name


def test_groups_open_in_xarray_and_as_csv(ricochet, folder):
    text = swept(MAP.replace("keep: 100", "keep: 5, states: true, lyapunov: true, exponents: 3, windows: true"),
                 "model.lambda, values: [0.5, 0.4]", "model.d, from: 1e-3, to: 0.01, points: 30")
    diagram = run(ricochet, folder, text)
    basin = run(ricochet, folder, swept(BASIN, "'iterate.start[0]', values: [0, 0.01, 0]"), name="basin")
    for path, groups in ((diagram, ("diagram", "window", "sweep")), (basin, ("basin", "sweep"))):
        for group in groups:
            with xarray.open_dataset(path, engine="h5netcdf", group=group) as opened, h5py.File(path) as file:
                assert set(opened.variables) == set(file[group]) and not [d for d in opened.sizes if "phantom" in d]
                opened.load()
        ricochet("show", path, "--verify", cwd=folder).expect_done()
    with xarray.open_dataset(diagram, engine="h5netcdf", group="diagram") as opened:
        assert opened.state.dims == ("task", "iterate", "coordinate") and opened.exponents.dims == ("task", "exponent")
    windows = read(diagram, "window")
    out = ricochet("show", diagram, "--csv=window/window_row", cwd=folder).expect_done().out
    table = list(csv.DictReader(io.StringIO(out)))
    assert [row["low_kind"] for row in table] == windows["low_kind"] and len(table) >= 2
    assert [float(row["multiplier.r"]) for row in table] == windows["multiplier"].real.tolist()
    out = ricochet("show", basin, "--csv=basin/attractor_row", cwd=folder).expect_done().out
    assert [row["found_tasks"] for row in csv.DictReader(io.StringIO(out))] == ["2", "1"]
    out = ricochet("show", basin, "--csv", cwd=folder).expect_done().out
    assert [row["attractor"] for row in csv.DictReader(io.StringIO(out))] == ["0", "1", "0"]


def test_cards_say_what_was_found_in_sentences(ricochet, folder):
    text = MAP.replace("keep: 100", "keep: 0, measure: 100, windows: true")
    path = run(ricochet, folder, swept(text, "model.d, values: [0.0277, 0.0135, 0.01, 0.005]"))
    out = ricochet("show", path, cwd=folder).expect_done().out
    assert "\nperiods: 5 in 3; none in 1 of 4 tasks\n" in out
    assert "  task 2: period 5, 1 impact: 0.00429471273 (flip) to 0.0138888889 (border)\n" in out
    path = run(ricochet, folder, swept(BASIN, "'iterate.start[0]', values: [0, 0.01, 0]"), name="basin")
    out = ricochet("show", path, cwd=folder).expect_done().out
    assert "  attractor 0, of period 3: 2 starts, the first of them task 0\n" in out
    assert "  attractor 1, of period 2: 1 starts, the first of them task 1\n" in out
    out = ricochet("check", "basin.yaml", cwd=folder).expect_done().out
    assert "kind basin" in out and "tasks   3" in out and "memory" in out and "result" in out


# --- tasks ---


def test_results_are_equal_for_all_ranks_and_after_stops(ricochet, folder):
    text = MAP.replace("keep: 100", "keep: 20, lyapunov: true, windows: true").replace("2000", "30000")
    equal_for_all_ranks_and_after_stops(ricochet, folder, swept(text, "model.d, from: 1e-4, to: 0.03, points: 700"), (1, 2, 3))


def test_lines_that_are_followed_are_equal_for_all_ranks_and_after_stops(ricochet, folder):
    text = MAP.replace("keep: 100", "keep: 20, follow: true").replace("2000", "6000")
    text = swept(text, "model.lambda, from: 0.1, to: 0.6, points: 25", "model.d, from: 1e-4, to: 0.03, points: 40, back: true")
    equal_for_all_ranks_and_after_stops(ricochet, folder, text, (1, 3))


def test_basins_are_equal_for_all_ranks_and_after_stops(ricochet, folder):
    text = swept(BASIN.replace("1000", "20000"), "'iterate.start[1]', values: [0, 0.1]",
                 "'iterate.start[0]', from: -0.5, to: 0.5, points: 300")
    equal_for_all_ranks_and_after_stops(ricochet, folder, text, (1, 2))


def test_a_task_does_not_depend_on_the_tasks_around_it(ricochet, folder):
    """In lanes side by side, whatever the neighbours' numbers are."""
    d = np.geomspace(1e-4, 0.03, 130)
    text = MAP.replace("keep: 100", "keep: 30, states: true, lyapunov: true, exponents: 3")
    there = found_by(ricochet, folder, swept(text, f"model.d, values: {d.tolist()}"))
    back = found_by(ricochet, folder, swept(text, f"model.d, values: {d[::-1].tolist()}"), name="back")
    alone = found_by(ricochet, folder, swept(text, f"model.d, values: [{d[77]}]"), name="alone")
    mixed = found_by(ricochet, folder, swept(text, f"model.d, values: [{d[77]}]", "iterate.transient, values: [5, 2000, 17]"), name="mixed")
    for name, values in there.items():
        values = np.asarray(values)
        assert values.tobytes() == np.asarray(back[name])[::-1].tobytes(), name
        assert values[77].tobytes() == np.asarray(alone[name])[0].tobytes() == np.asarray(mixed[name])[1].tobytes(), name


def test_a_long_task_stops_in_time(ricochet, folder):
    write(folder, "s.yaml", MAP.replace("keep: 100", "keep: 1").replace("2000", "1e13").replace("0.01", "1.5e-4"))
    result = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, ranks=2)
    result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "0 of 1 tasks", "--resume")
