"""Curves of special points in two parameters through the command line: what is refused, and what they are."""

import csv
import io

import h5py
import numpy as np
import xarray
from branches import BASE, WALL, read, refuse, rows, run
from program import USAGE, assert_same, study, write

TRACE = """kind: branch
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 0.8}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 1, cross: true,
         trace: {parameter: model.frequency, low: 0.3, high: 3}}
"""


def test_curves_are_refused_by_place_and_value(ricochet, folder):
    range_ = "low: 0.3, high: 3"
    refuse(ricochet, folder, [
        ("model.frequency,", "model.frequencie,", 6, "unknown trace parameter 'model.frequencie'; did you mean"),
        ("model.frequency,", "model.ends,", 6, "branch.trace.parameter = model.ends cannot be followed: it is a word"),
        ("model.frequency,", "start.q,", 6, "branch.trace.parameter = start.q cannot be followed, expected"),
        ("model.frequency,", "model.force,", 6, "branch.trace.parameter = model.force is already branch.parameter"),
        ("model.frequency,", "model.hertz,", 6, "branch.trace.parameter = model.hertz is null in the study"),
        ("model.frequency,", "orbit.period,", 6, "branch.trace.parameter = orbit.period, but forced determines"),
        (f"{range_}}}}}", f"{range_}}}}}\nsweep: {{parameter: model.frequency, values: [0.8]}}", 6,
         "branch.trace.parameter = model.frequency is also swept"),
        ("parameter: model.frequency, ", "", 0, "missing key branch.trace.parameter (text)"),
        ("low: 0.3, ", "", 0, "missing key branch.trace.low (a number)"),
        ("low: 0.3", "low: 0.9", 6, "branch.trace.low = 0.9 is above the start of curves, expected at most"),
        ("high: 3", "high: 0.7", 6, "branch.trace.high = 0.7 is below the start of curves, expected at least"),
        (range_, "low: 0.8, high: 0.8", 6, "branch.trace.low = 0.8, expected less than branch.trace.high = 0.8"),
        ("low: 0.3", "low: -1", 6, "branch.trace.low (model.frequency) = -1 is out of range, expected a number >"),
        ("high: 3", "high: 3, first_low: 2, first_high: 1", 6, "branch.trace.first_low = 2, expected less than"),
        ("high: 3", "high: 3, step: 0.1, step_most: 0.01", 6, "branch.trace.step = 0.1, expected at most"),
        ("high: 3", "high: 3, points: 0", 6, "branch.trace.points = 0 is out of range"),
        ("high: 3", "high: 3, kinds: []", 6, "branch.trace.kinds is empty"),
        ("high: 3", "high: 3, kinds: fold", 6, "branch.trace.kinds = fold, expected a list of words, each one of"),
        ("high: 3", "high: 3, kinds: [fold, torus]", 6, "branch.trace.kinds[1] = torus, expected one of grazing, fold"),
        ("high: 3", "hihg: 3", 6, "unknown key 'hihg' in branch.trace; did you mean 'high'?"),
        ("trace: {parameter: model.frequency, low: 0.3, high: 3}", "trace: 3", 6,
         "branch.trace = 3, expected a mapping of the keys parameter, low, high"),
        ("trace: {", "trce: {", 6, "unknown key 'trce' in branch; did you mean 'trace'?"),
        ("trace: {parameter: model.frequency, low: 0.3, high: 3}", "trace.low: 3", 6, "unknown key 'trace.low'"),
    ], TRACE)
    even = BASE.replace("to: 0.15\n", "to: 0.15\n  trace: {parameter: model.damping, low: 0, high: 1}\n")
    but = "branch.trace.parameter = model.damping, but orbit.motion: even needs model.damping"
    refuse(ricochet, folder, [("title: a ring of six", "title: six", 16, but)], even)
    write(folder, "s.yaml", study() + "branch: {trace: {low: 1}}\n")
    ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, "s.yaml:4: branch.trace.low is a key of kind: branch")
    write(folder, "s.yaml", TRACE)
    ricochet("check", "s.yaml", "--set", "branch.trace.low=1", cwd=folder).expect_refused(
        USAGE, "--set branch.trace.low=1: branch.trace.low = 1 is above the start of curves")
    ricochet("check", "s.yaml", "--set", "branch.trace={}", cwd=folder).expect_done()


def curve_of(found, kind, part, task=0):
    """Rows of one way of the first curve of a kind, and how it ended."""
    kinds = found["special_kind"][rows(found, "special", task)]
    picks = []
    for what in ("curve", "curve_end"):
        own = np.arange(len(found[f"{what}_special"]))[rows(found, what, task)]
        picks.append(own[(found[f"{what}_special"][own] == kinds.index(kind)) & (found[f"{what}_part"][own] == part)])
    return picks[0], found["curve_end_outcome"][picks[1][0]]


def test_the_grazing_curve_is_the_closed_form(ricochet, folder):
    """x'' + c x' + x = A cos(w t) beside a wall at 1: A^2 = (1 - w^2)^2 + c^2 w^2."""
    path = run(ricochet, folder, TRACE)
    found = read(path)
    for part, bound in ((0, 3), (1, 0.3)):
        curve, end = curve_of(found, "grazing", part)
        w, force = found["curve_second"][curve], found["curve_parameter"][curve]
        assert end == "bound" and len(curve) > 10 and w[0] == 0.8 and w[-1] == bound
        assert np.abs(force - np.hypot(1 - w**2, 0.1 * w)).max() < 1e-8
        assert np.allclose(found["curve_period"][curve], 2 * np.pi / w, rtol=1e-14)
        assert {found["curve_outcome"][k] for k in curve} == {"grazing"}
    with h5py.File(path) as file:
        assert file["branch/curve_parameter"].attrs["parameter"] == b"model.force"
        assert file["branch/curve_second"].attrs["parameter"] == b"model.frequency"
    ricochet("show", path, "--verify", cwd=folder).expect_done()
    with xarray.open_dataset(path, engine="h5netcdf", group="branch") as opened:
        assert opened.curve_second.dims == ("curve_row",) and opened.curve_end_part.dims == ("curve_end_row",)
    out = ricochet("show", path, "--csv=branch/curve_end_row", cwd=folder).expect_done().out
    ends = list(csv.DictReader(io.StringIO(out)))
    assert [row["curve_end_part"] for row in ends] == ["0", "1", "0", "1"]
    assert [int(row["curve_end_points"]) for row in ends] == [
        int(((found["curve_special"] == k) & (found["curve_part"] == p)).sum()) for k in (0, 1) for p in (0, 1)]


def test_curves_of_folds_and_doublings_meet_the_points_of_other_branches(ricochet, folder):
    """Each curve is found again by branches at other frequencies, on which it is a special point."""
    for name, kind, at, beside in (("doubling", "period_doubling", 0.8, 0.85), ("fold", "fold", 1, 1.2)):
        text = TRACE.replace("frequency: 0.8", f"frequency: {at}").replace("high: 3}", f"high: {beside}}}")
        found = read(run(ricochet, folder, text, name=name))
        curve, end = curve_of(found, kind, 0)
        assert end == "bound" and found["curve_second"][curve[-1]] == beside
        plain = WALL.replace("force: 0.05", f"force: 0.05, frequency: {beside}").replace("to: 0.2", "to: 1")
        other = read(run(ricochet, folder, plain, name="plain", *["--force"]))
        special = other["special_parameter"][other["special_kind"].index(kind)]
        assert abs(found["curve_parameter"][curve[-1]] - special) < 1e-8
    assert abs(found["special_parameter"][found["special_kind"].index("fold")] - 0.0999707536283) < 1e-10


def test_a_branch_is_the_same_with_curves_and_without(ricochet, folder):
    traced = read(run(ricochet, folder, TRACE))
    plain = read(run(ricochet, folder, TRACE, "--set", "branch.trace={}", name="plain"))
    assert {name for name in traced if name not in plain} == {name for name in traced if name.startswith("curve_")}
    for name in plain:
        if name not in ("iterations", "jacobians"):
            assert np.asarray(plain[name]).tobytes() == np.asarray(traced[name]).tobytes(), name
    assert traced["iterations"] > plain["iterations"]


def test_curves_follow_the_kinds_and_end_where_the_study_says(ricochet, folder):
    found = read(run(ricochet, folder, TRACE, "--set", "branch.trace.kinds=[period_doubling]", name="kinds"))
    assert [found["special_kind"][k] for k in set(found["curve_end_special"])] == ["period_doubling"]
    found = read(run(ricochet, folder, TRACE, "--set", "branch.trace.points=3", name="points"))
    assert found["curve_end_outcome"] == 4 * ["points"] and set(found["curve_end_points"]) == {4}
    found = read(run(ricochet, folder, TRACE, "--set", "branch.trace.first_high=0.5", name="first"))
    up, end = curve_of(found, "grazing", 0)
    assert end == "ended" and 0.45 < found["curve_parameter"][up].max() <= 0.5
    assert b"model.force = 0.5" in found["curve_end_reason"][0] and b"would be above 0.5" in found["curve_end_reason"][0]
    lost = read(run(ricochet, folder, TRACE.replace("high: 3}", "high: 3, kinds: [impulse_sign]}"), name="none"))
    assert len(lost["curve_special"]) == len(lost["curve_end_special"]) == 0 and lost["curve_offset"].tolist() == [0, 0]


def test_curves_are_equal_for_all_ranks(ricochet, folder):
    text = TRACE + "sweep: {parameter: model.damping, values: [0.05, 0.1, 0.15, 0.2]}\n"
    paths = []
    for ranks in (1, 2):
        own = folder / str(ranks)
        own.mkdir()
        write(own, "s.yaml", text)
        ricochet.run("s.yaml", cwd=own, ranks=ranks).expect_done()
        paths.append(own / "s.h5")
    assert_same(*paths)
    found = read(paths[0])
    for task, damping in enumerate((0.05, 0.1, 0.15, 0.2)):
        curve, _ = curve_of(found, "grazing", 0, task)
        w = found["curve_second"][curve]
        assert len(w) > 10 and np.abs(found["curve_parameter"][curve] - np.hypot(1 - w**2, damping * w)).max() < 1e-8
