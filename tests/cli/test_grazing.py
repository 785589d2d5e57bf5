"""Grazing motions through the command line: what is refused, what closed forms say of them, how they are stored, and
that they do not depend on ranks or on stops."""

import csv
import io

import h5py
import numpy as np
import pytest
import xarray
from branches import equal_for_all_ranks_and_after_stops, refuse, rows, run
from program import STOPPED, USAGE, study, words_of, write

ONE = """kind: grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 3, force: 1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 1, to: 50}
grazing: {section: 0.25}
"""
SWEPT = ONE + "sweep: {parameter: model.frequency, values: [6, 4, 1.5]}\n"
TRACED = """kind: grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 0.8}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 20, scale: log,
         trace: {parameter: model.frequency, low: 0.3, high: 3, step_most: 0.01, points: 2000}}
grazing: {coefficients: 4, windows: 0}
"""
OMEGA_D = np.sqrt(1 - 0.05**2)


def read(path):
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file["grazing"].items()}
        words = {name for name, data in file["grazing"].items() if h5py.check_enum_dtype(data.dtype)}
        return found | {name: words_of(file["grazing"][name]) for name in words if found[name].ndim == 1}


# --- refusals ---


def test_keys_and_values_are_refused_by_place_and_value(ricochet, folder):
    section = "section: 0.25"
    even = "orbit.motion = even, but kind: grazing needs forced, conservative or autonomous motions"
    refuse(ricochet, folder, [
        ("motion: forced", "motion: even", 3, even),
        ("motion: forced", "period: 6", 0, even),
        (section, "section: 1", 5, "grazing.section = 1 is out of range, expected a number"),
        (section, "section: -0.1", 5, "grazing.section = -0.1 is out of range"),
        (section, "coefficients: 0", 5, "grazing.coefficients = 0 is out of range, expected an integer from 1 to 64"),
        (section, "coefficients: 65", 5, "grazing.coefficients = 65 is out of range"),
        (section, "coefficients: 2.5", 5, "grazing.coefficients = 2.5"),
        (section, "windows: 65", 5, "grazing.windows = 65 is out of range, expected an integer from 0 to 64"),
        (section, "windows: -1", 5, "grazing.windows = -1 is out of range"),
        (section, "sectoin: 0.25", 5, "unknown key 'sectoin' in grazing; did you mean 'section'?"),
        ("grazing: {section: 0.25}", "grazing: 3", 5, "grazing = 3, expected a mapping of the keys section, coefficients"),
        ("to: 50", "to: 50, cross: true", 4, "branch.cross is a key of kind: branch, and this is kind: grazing"),
        ("to: 50", "to: 50, multipliers: all", 4, "branch.multipliers is a key of kind: branch"),
        ("to: 50", "to: 1", 4, "branch.to = 1 is the start of the branch"),
        ("model.force,", "model.forse,", 4, "unknown branch parameter 'model.forse'; did you mean 'model.force'?"),
        ("grazing: {section", "restart: {file: s.h5, point: 0}\ngrazing: {section", 5, "restart.file is a key of kind: branch"),
        (section + "}", "windows: 3}\nsweep: {parameter: grazing.windows, values: [1, 2]}", 6,
         "grazing.windows cannot be swept: it changes the shape of the result"),
        ("motion: forced", "motion: conservative, period: 6", 2, "model.damping = 3, but orbit.motion: conservative"),
        ("model: {type: chain", "model: {type: chain, gama: 1", 2, "unknown key 'gama' in model"),
    ], ONE)
    write(folder, "s.yaml", study() + "grazing: {section: 0.5}\n")
    ricochet("check", "s.yaml", cwd=folder).expect_refused(
        USAGE, "s.yaml:4: grazing.section is a key of kind: grazing, and this is kind: orbits")
    write(folder, "s.yaml", TRACED.replace("points: 2000", "kinds: [fold]"))
    ricochet("check", "s.yaml", cwd=folder).expect_refused(
        USAGE, "s.yaml:6: branch.trace.kinds is a key of kind: branch, and this is kind: grazing")
    write(folder, "s.yaml", ONE)
    ricochet("check", "s.yaml", "--set", "grazing.section=1", cwd=folder).expect_refused(
        USAGE, "--set grazing.section=1: grazing.section = 1 is out of range")


# --- what they are ---


def test_overdamped_oscillators_graze_where_their_closed_form_says(ricochet, folder):
    """x'' + 3 x' + x = a cos(w t) before a wall at 1: one frequency in each of the three regimes."""
    found = read(run(ricochet, folder, SWEPT))
    w = np.array([6, 4, 1.5])
    amplitude = np.hypot(1 - w**2, 3 * w)
    assert np.allclose(amplitude[:2], [39.35733730830885, 19.209372712298546], rtol=1e-15)
    assert found["outcome"] == 3 * ["grazing"] and not any(found["reason"])
    assert np.allclose(found["parameter"], amplitude, rtol=3e-14, atol=0)
    assert np.allclose(found["slope"], -1 / amplitude, rtol=1e-8) and np.allclose(found["A_g"], w**2, rtol=1e-12)
    assert np.allclose(found["period"], 2 * np.pi / w, rtol=1e-15)
    phase = np.arctan2(3 * w, 1 - w**2) / (2 * np.pi)  # of the response behind the force
    assert np.allclose(found["phase"], phase, atol=1e-9) and np.allclose(found["time"], phase * found["period"])
    assert found["side"] == 3 * ["wall"] and (found["particle"] == 0).all() and (found["obstacle"] == 0).all()
    assert np.allclose(found["restitution"], 0.8) and np.allclose(found["stretch"], np.sqrt(2) * w)
    assert np.allclose(found["q"], 1, atol=1e-13) and np.allclose(found["v"], 0, atol=1e-6)
    assert found["verdict"] == 3 * ["continuous"] and found["regime"] == ["chaos", "windows", "overlap"]
    assert (found["first_negative"] == -1).all() and (found["first_zero"] == -1).all() and (found["settled"] >= 0).all()
    assert np.isnan(found["departure"]).all()
    rates = (-3 + np.sqrt(5) * np.array([1, -1])) / 2
    multipliers = np.exp(rates * (2 * np.pi / w)[:, None])
    assert np.allclose(multipliers[:, 0], [0.67032, 0.549, 0.202], atol=5e-4)
    assert np.allclose(found["multipliers"], multipliers, rtol=1e-8) and np.allclose(found["second"], multipliers[:, 1])
    assert np.allclose(found["multiplier"], multipliers[:, 0]) and found["multiplier"].dtype == np.complex128
    powers = multipliers[:, None, :] ** np.arange(1, 25)[None, :, None]
    closed = 1.8 * (powers[..., 0] - powers[..., 1]) / np.sqrt(5)  # of an impact of unit speed, i + 1 periods later
    assert np.allclose(found["coefficient"], closed, rtol=1e-7, atol=1e-12)


def test_results_do_not_depend_on_the_section_or_the_scale(ricochet, folder):
    text = ONE.replace("section: 0.25", "section: 0, coefficients: 7, windows: 5").replace("force: 1}", "force: 1, frequency: 4}")
    sections = read(run(ricochet, folder, text + "sweep: {parameter: grazing.section, from: 0, to: 0.9, points: 10}\n"))
    log = read(run(ricochet, folder, text.replace("to: 50", "to: 50, scale: log"), name="log"))
    for name in ("coefficient", "window_low", "window_high", "alpha", "parameter"):
        assert np.allclose(sections[name], sections[name][0], rtol=1e-6, atol=1e-12), name
    for name in ("parameter", "slope", "coefficient", "window_low", "window_high", "window_high_d"):
        assert np.allclose(log[name][0], sections[name][0], rtol=1e-7, atol=1e-9), name
    assert not np.allclose(sections["eta"][0], sections["eta"][1], atol=0.01)
    for found in (sections, log):
        for k in range(len(found["parameter"])):  # the map itself gives the coefficients
            z, own = found["xi"][k], []
            for _ in range(7):
                own.append(found["eta"][k] @ z)
                z = found["L"][k] @ z
            assert np.allclose(own, found["coefficient"][k], rtol=1e-10)


def test_windows_shrink_by_the_square_of_the_multiplier(ricochet, folder):
    """In mu = a / a_grazing - 1, at w = 4: the border edges of periods 7 to 13 lie between 1e-2 and 2e-6."""
    found = {name: value[1] for name, value in read(run(ricochet, folder, SWEPT)).items() if len(value) == 3}
    assert found["window_exists"].dtype == bool and found["window_exists"].all()
    assert found["window_period"].tolist() == list(range(1, 17))
    low, high = found["window_low_d"], found["window_high_d"]
    mu = found["window_high"] / found["parameter"] - 1
    assert np.allclose(mu[1:], high[1:], rtol=1e-6) and (low < high).all()
    assert np.allclose(found["window_low"] / found["parameter"] - 1, low, rtol=1e-6, atol=1e-14)
    inside = found["window_period"][(high < 1e-2) & (high > 1e-6)]
    assert inside.tolist() == list(range(7, 15))
    ratio = high[1:] / high[:-1]
    assert np.allclose(ratio[9:], found["multiplier"].real ** 2, rtol=2e-3) and abs(found["multiplier"].real - 0.549) < 1e-3
    assert np.allclose(high[8:], found["predicted_border_d"][8:], rtol=6e-3)
    assert np.allclose(low[8:], found["predicted_flip_d"][8:], rtol=8e-3)
    assert np.isnan([found["predicted_border_d"][0], found["predicted_flip_d"][0]]).all()
    with h5py.File(folder / "s.h5") as file:
        kinds = h5py.check_enum_dtype(file["grazing/window_low_kind"].dtype)
        assert set(found["window_low_kind"]) == {kinds["flip"]} and set(found["window_high_kind"][1:]) == {kinds["border"]}


def test_stable_cycles_of_the_map_lie_in_the_windows(ricochet, folder):
    """Iterates of the map that the result holds, in the middle of windows."""
    found = {name: value[1] for name, value in read(run(ricochet, folder, SWEPT)).items() if len(value) == 3}
    for period in (5, 7):
        d = np.sqrt(found["window_low_d"][period - 1] * found["window_high_d"][period - 1])
        z, hits = np.zeros(2), []
        for step in range(3000):
            depth = d - found["eta"] @ z
            z = found["L"] @ z + (found["stretch"] * np.sqrt(depth) * found["xi"] + depth * found["kappa"] if depth >= 0 else 0)
            hits += [step] if depth >= 0 else []
        assert set(np.diff(hits[-20:])) == {period}


def test_an_underdamped_oscillator_departs(ricochet, folder):
    text = ONE.replace("damping: 3, force: 1", "damping: 0.1, force: 1, frequency: 2").replace("section: 0.25", "windows: 0")
    found = read(run(ricochet, folder, text))
    assert abs(found["parameter"][0] - 3.006659275674582) < 1e-12
    assert found["verdict"] == ["discontinuous"] and found["first_negative"][0] == 1 and found["regime"] == ["none"]
    assert found["verdict_reason"][0].startswith(b"c_1 = ") and found["settled"][0] == -1
    assert not [name for name in found if name.startswith(("window", "predicted", "curve"))]
    departure = found["L"][0] @ found["xi"][0]
    assert np.allclose(found["departure"][0], departure / np.linalg.norm(departure))
    i = np.arange(24)
    ratio = found["coefficient"][0] / (np.exp(-0.05 * np.pi * (i + 1)) * np.sin(np.pi * (i + 1) * OMEGA_D))
    assert np.allclose(ratio, ratio[0], rtol=1e-7)


def test_conservative_motions_are_mapped_across_their_flow(ricochet, folder):
    """x'' + x + x^3 = 0 turns at 1 with the energy 3/4; its map has the multiplier 1."""
    text = """kind: grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, cubic: 1}
orbit: {motion: conservative, mode: 0}
branch: {parameter: orbit.energy, from: 0.05, to: 2}
grazing: {windows: 2}
"""
    found = read(run(ricochet, folder, text))
    assert found["outcome"] == ["grazing"] and abs(found["parameter"][0] - 0.75) < 1e-12
    assert found["L"].shape == (1, 1, 1) and abs(found["L"][0, 0, 0] - 1) < 1e-6
    assert found["verdict"] == ["undecided"] and found["verdict_reason"][0] and abs(found["A_g"][0] - 2) < 1e-9


OWN = """kind: grazing
model: {type: chain, particles: 2, ends: free, gamma: 0, floor: null, wall: [1, 2], restitution: 0.8, damping: [0.1, 3],
        force: [0.2, 0.5]}
orbit: {motion: forced, sequence: [0], times: [1.5]}
start: {q: [1, 0.1], v: [-0.3, 0.1]}
branch: {parameter: "model.force[1]", from: 0.5, to: 10}
grazing: {windows: 0}
"""


def test_motions_with_impacts_of_their_own_graze(ricochet, folder):
    """Beside a particle that hits its wall once in a period: the determinant of its saltation is e^2."""
    found = read(run(ricochet, folder, OWN))
    assert abs(found["parameter"][0] - 6) < 1e-12 and found["particle"][0] == 1 and abs(found["phase"][0] - 0.25) < 1e-9
    pair, alone = found["multipliers"][0, :2], found["multipliers"][0, 2]
    assert np.allclose(np.prod(pair), 0.64 * np.exp(-0.2 * np.pi), rtol=1e-8)
    assert np.allclose(alone, np.exp((np.sqrt(5) - 3) * np.pi), rtol=1e-8)
    assert found["verdict"] == ["undecided"] and b"is complex" in found["verdict_reason"][0]


def test_touches_of_motions_that_pass_a_wall_do_not_count(ricochet, folder):
    """The impact of this family would push the particle through its wall."""
    text = OWN.replace("gamma: 0,", "gamma: 0.3,").replace("[1, 2]", "[0.5, 1.2]").replace("[0.1, 3]", "0.3")
    text = text.replace("[0.2, 0.5]}", "[0.8, 0], frequency: 1.3}").replace("[1, 0.1], v: [-0.3, 0.1]", "[0.5, 0], v: [-0.5, 0]")
    found = read(run(ricochet, folder, text.replace("force[1]", "force[0]").replace("from: 0.5", "from: 1")))
    assert found["outcome"] == ["none"] and b"ends: bound" in found["reason"][0]


def test_the_verdict_is_the_same_on_all_sections(ricochet, folder):
    """x'' + x = a cos 2t: an elastic contact at its turning point changes nothing on the section there, so that xi is 0
    but for rounding; its multiplier is -1."""
    text = """kind: grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, force: 1, frequency: 2}
orbit: {motion: forced}
branch: {parameter: model.force, from: 1, to: 10}
sweep: {parameter: grazing.section, from: 0, to: 0.95, points: 20}
"""
    found = read(run(ricochet, folder, text))
    assert found["verdict"] == ["undecided"] * 20 and all(b"multiplier" in reason for reason in found["verdict_reason"])


def test_rows_without_a_grazing_point_say_why(ricochet, folder):
    """Two particles alike, without coupling: the walls at one place are touched at once."""
    text = ONE.replace("particles: 1", "particles: 2").replace("wall: 1", "wall: [1, 2]") + (
        'sweep: {parameter: "model.wall[1]", values: [2, 1, 3]}\n')
    text = text.replace("force: 1}", "force: 1, frequency: 4}")
    found = read(run(ricochet, folder, text))
    assert found["outcome"] == ["grazing", "degenerate", "grazing"]
    assert b"two grazing points at once" in found["reason"][1] and not found["reason"][0]
    assert abs(found["parameter"][1] - 19.209372712298546) < 1e-6 and found["phase"][1] > 0
    far = read(run(ricochet, folder, text.replace("[2, 1, 3]", "[2]").replace("[1, 2]", "[100, 2]"), name="far"))
    assert far["outcome"] == ["grazing"] and far["particle"][0] == 1 and far["obstacle"][0] == 1
    none = read(run(ricochet, folder, text.replace("[2, 1, 3]", "[200, 300]").replace("[1, 2]", "[100, 2]"), name="none"))
    assert none["outcome"] == 2 * ["none"]
    assert none["reason"][0].startswith(b"no obstacle is touched from model.force = 1 to 50, where the family ends: bound")
    for rows_of, task in ((found, 1), (none, 0)):
        for name in ("slope", "A_g", "alpha", "stretch", "eta", "L", "coefficient", "multipliers", "q", "window_low"):
            assert np.isnan(rows_of[name][task]).all(), name
        assert rows_of["regime"][task] == "none"
        assert (rows_of["window_period"][task] == -1).all() and not rows_of["window_exists"][task].any()
        assert rows_of["first_negative"][task] == rows_of["settled"][task] == rows_of["first_zero"][task] == -1
    assert found["verdict"][1] == "undecided" and found["verdict_reason"][1] == found["reason"][1]
    assert none["verdict"] == 2 * ["none"] and not any(none["verdict_reason"])
    assert np.isnan(none["parameter"]).all() and (none["particle"] == -1).all() and none["side"] == 2 * ["none"]


def test_families_that_do_not_begin_or_break_off_are_rows(ricochet, folder):
    text = """kind: grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, cubic: 1}
orbit: {motion: conservative, excited: [0], period: 4}
branch: {parameter: orbit.period, from: 4, to: 6}
sweep: {parameter: model.cubic, values: [1, -1]}
"""
    found = read(run(ricochet, folder, text))
    assert found["outcome"] == 2 * ["failed_start"]
    assert b"is singular" in found["reason"][0] and b"at no amplitude" in found["reason"][1]
    folded = """kind: grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 10, cubic: 1, damping: 0.1, force: 0.3}
orbit: {motion: forced}
branch: {parameter: model.frequency, from: 0.5, to: 2.5, natural: true}
"""
    found = read(run(ricochet, folder, folded, name="folded"))
    assert found["outcome"] == ["failed"] and b"where the family ends: not_converged" in found["reason"][0]
    short = ONE.replace("to: 50", "to: 50, points: 1, step_most: 0.5")
    found = read(run(ricochet, folder, short, name="short"))
    assert found["outcome"] == ["none"] and found["reason"][0].endswith(b"the family ends: points")


# --- in two parameters ---


def test_changes_of_sign_lie_where_the_closed_form_says(ricochet, folder):
    """c_i is proportional to sin(2 pi (i + 1) omega_d / w)."""
    path = run(ricochet, folder, TRACED)
    found = read(path)
    w, change = found["curve_second"], found["curve_change"]
    assert np.allclose(found["curve_parameter"], np.hypot(1 - w**2, 0.1 * w), rtol=1e-9)
    assert np.allclose(found["curve_period"], 2 * np.pi / w, rtol=1e-13) and np.allclose(found["curve_A_g"], w**2)
    assert found["curve_end_outcome"] == 2 * ["bound"] and found["curve_end_part"].tolist() == [0, 1]
    assert found["curve_end_points"].sum() == len(w) == found["curve_offset"][1] and not any(found["curve_end_reason"])
    for part, bound in ((0, 3), (1, 0.3)):
        way = w[found["curve_part"] == part]
        assert way[0] == 0.8 and way[-1] == bound
    for i in range(4):
        expected = 2 * OMEGA_D * (i + 1) / np.arange(1, 100)
        expected = expected[(expected > 0.45) & (expected < 3)]  # below, some lie within one step
        located = w[(change == i) & (w > 0.45)]
        assert len(located) == len(expected) and np.allclose(np.sort(located), np.sort(expected), rtol=1e-8), i
        beside = change == -1
        sign = np.sin(2 * np.pi * (i + 1) * OMEGA_D / w[beside])
        clear = np.abs(sign) > 1e-3
        assert (np.sign(found["curve_coefficient"][beside, i]) == np.sign(sign))[clear].all()
    verdicts, first = np.array(found["curve_verdict"]), found["curve_first_negative"]
    discontinuous = verdicts == "discontinuous"
    assert discontinuous.sum() > 0.9 * len(w) and (first[discontinuous] >= 0).all() and (first[~discontinuous] == -1).all()
    low = discontinuous & (first < 4) & (change == -1)
    assert (found["curve_coefficient"][low, first[low]] < 0).all()
    modulus = np.abs(found["curve_multiplier"])
    assert np.allclose(modulus, np.exp(-0.1 * np.pi / w), rtol=1e-7)
    ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_curves_end_where_the_study_says(ricochet, folder):
    found = read(run(ricochet, folder, TRACED, "--set", "branch.trace.points=5"))
    assert found["curve_end_outcome"] == 2 * ["points"]
    found = read(run(ricochet, folder, TRACED, "--set", "branch.trace.first_high=0.5", name="first"))
    assert found["curve_end_outcome"][0] == "bound" or b"would be above 0.5" in found["curve_end_reason"][0]
    assert found["curve_parameter"].max() <= 0.5 and b"would be above 0.5" in b"".join(found["curve_end_reason"])


# --- tasks ---


GRID = TRACED.replace("low: 0.3, high: 3, step_most: 0.01", "low: 0.6, high: 1.2").replace("coefficients: 4", "coefficients: 2") + (
    "sweep: {parameter: model.damping, from: 0.05, to: 0.5, points: 24}\n")


@pytest.mark.parametrize("points", [6, pytest.param(24, marks=pytest.mark.long)])
def test_results_are_equal_for_all_ranks_and_after_stops(ricochet, folder, points):
    text = GRID.replace("points: 24", f"points: {points}")
    found = read(equal_for_all_ranks_and_after_stops(ricochet, folder, text, (1, 2)))
    for task, damping in enumerate(np.linspace(0.05, 0.5, points)):
        curve = rows(found, "curve", task)
        w = found["curve_second"][curve]
        assert np.allclose(found["curve_parameter"][curve], np.hypot(1 - w**2, damping * w), rtol=1e-8)


def test_a_long_task_stops_in_time(ricochet, folder):
    write(folder, "s.yaml", TRACED.replace("step_most: 0.01, points: 2000", "step_most: 1e-6, points: 1000000"))
    result = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, ranks=2)
    result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "0 of 1 tasks", "--resume")


# --- how they are shown ---


def test_groups_open_in_xarray_and_as_csv(ricochet, folder):
    path = run(ricochet, folder, SWEPT)
    with xarray.open_dataset(path, engine="h5netcdf", group="grazing") as opened:
        assert opened.coefficient.dims == ("task", "power") and opened.eta.dims == ("task", "coordinate")
        assert opened.L.dims == ("task", "coordinate", "column") and opened.multipliers.dims == ("task", "eigenvalue")
        assert opened.q.dims == ("task", "particle") and opened.window_low.dims == ("task", "window")
        assert opened.parameter.attrs["parameter"] == "model.force" and opened.multiplier.dims == ("task",)
        assert opened.isel(task=1, particle=0).q.item() == opened.q[1, 0].item()
        opened.load()
    out = ricochet("show", path, "--csv", cwd=folder).expect_done().out
    table = list(csv.DictReader(io.StringIO(out)))
    assert [row["regime"] for row in table] == ["chaos", "windows", "overlap"]
    assert [float(row["model.frequency"]) for row in table] == [6, 4, 1.5]
    assert np.allclose([float(row["multiplier.r"]) for row in table], [0.67032, 0.549, 0.202], atol=5e-4)
    path = run(ricochet, folder, TRACED, "--set", "branch.trace.points=3", name="t")
    out = ricochet("show", path, "--csv=grazing/curve_row", cwd=folder).expect_done().out
    table = list(csv.DictReader(io.StringIO(out)))
    assert len(table) == len(read(path)["curve_second"]) and {row["curve_verdict"] for row in table} == {"discontinuous"}


def test_cards_say_what_happens_in_sentences(ricochet, folder):
    out = ricochet("show", run(ricochet, folder, SWEPT), cwd=folder).expect_done().out
    for phrase in (
        "task 1: model.frequency = 4\n",
        "grazes at model.force = 19.2093727123: the wall of particle 0, at t = 0.616713, phase 0.392612",
        "A_g = 16, restitution 0.8\n", "multipliers of L: 0.548817, 0.0163685", "continuous: all coefficients c_i are positive",
        "c_0, c_1, ...: 0.428613, 0.242245, ", "regime windows: windows of rising periods follow, with chaos between",
        "regime chaos: chaos follows at once", "regime overlap: ", "windows of the return map along model.force",
        "period 4: 21.3669784", "(flip) to 24.592021", "; to leading order 21.668", "outcome: grazing 3",
    ):
        assert phrase in out, (phrase, out)
    out = ricochet("show", run(ricochet, folder, SWEPT, "--set", "branch.to=2", name="none"), cwd=folder).expect_done().out
    assert out.count("  none: no obstacle is touched from model.force = 1 to 2, where the family ends: bound") == 3
    many = SWEPT.replace("[6, 4, 1.5]", "[2, 2.5, 3, 3.5, 4, 4.5, 5]")
    out = ricochet("show", run(ricochet, folder, many, name="many"), cwd=folder).expect_done().out
    assert out.count("  grazes at ") == 5 and "... 2 more tasks" in out
    out = ricochet("check", "many.yaml", cwd=folder).expect_done().out
    assert "kind grazing" in out and "tasks   7" in out and "memory" in out and "result" in out
