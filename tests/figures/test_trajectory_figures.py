"""Figures of results of kind `trajectory`, synthetic ones but for Lyapunov exponents, and animations. What the reader
takes from a result is compared with what was written."""

import h5py
import numpy as np
import pytest
import synthetic_motion
from drawing import (
    FAMILY, Shelf, absent, altered, assert_among, beginning_of, cases, column, computed, draws, foreign, no_hdf5,
    refuses, refuses_places,
)  # fmt: skip
from PIL import Image

DRIVEN = """kind: trajectory
title: driven between floor and wall
model: {{type: chain, particles: {n}, ends: free, gamma: 0.1, stiffness: 0, damping: 0.1, floor: -1, wall: 1,
        restitution: 0.8, force: {force}, frequency: 2.6}}
start: {{v: 0}}
time: {{duration: 100, samples: 2, lyapunov: true}}
sweep: {{parameter: "model.force[0]", {sweep}}}
"""

STUDIES = {
    "family": FAMILY,
    "exponents": DRIVEN.format(n=1, force="[7]", sweep="from: 7, to: 12, points: 6"),
    "many_exponents": DRIVEN.format(n=4, force="[7, 0, 0, 0]", sweep="from: 7, to: 8, points: 3"),
    "resting": DRIVEN.format(n=1, force="[7]", sweep="values: [7, 5.5, 4.5]")
    .replace("stiffness: 0", "stiffness: 1")
    .replace("wall: 1", "wall: null"),
}


def synthetic(write, **options):
    return lambda shelf, path: write(path, **options)


def unknown_floors(file):
    file.attrs["study"] = file.attrs["study"].replace("floor: [-0.6, null, -0.8]", "floor: {like: nothing known}")


def only_contacts(file):
    """Impacts turned into contacts with compliant obstacles."""
    group = file["trajectory"]
    for name in list(group):
        if name.startswith("event_"):
            del group[name]
    for name in ("offset", "time", "particle", "side"):
        group["event_" + name] = group["impact_" + name]
    kinds = synthetic_motion.KINDS
    kind = np.full(len(group["impact_time"]), kinds.index("contact"), "i1")
    group.create_dataset("event_kind", data=kind, dtype=synthetic_motion.enum(kinds))
    for name in list(group):
        if name.startswith("impact_"):
            del group[name]


GROUPS = ("trajectory", "sweep")
MADE = {
    "localised": synthetic(synthetic_motion.localised, samples=801),
    "crowd": synthetic(synthetic_motion.crowd, samples=601, duration=20.0),
    "many": synthetic(synthetic_motion.crowd, particles=400, samples=201, duration=10.0, scale=1.5),
    "three": synthetic(synthetic_motion.three),
    "unreached": synthetic(synthetic_motion.unreached),
    "strange": altered("three", unknown_floors, GROUPS),
    "contacts": altered("three", only_contacts, GROUPS),
    "speedless": altered("three", lambda file: file["trajectory"].pop("v"), GROUPS),
    "absent": absent,
    "text": no_hdf5,
    "truncated": beginning_of("three"),
    "orbits": foreign("orbits/outcome"),
}

# script, result, options
FIGURES = [
    (script, name, options)
    for script in ("plot_trajectory.py", "plot_spacetime.py", "plot_phase.py")
    for name, options in (
        ("localised", []),
        ("crowd", []),
        ("three", []),
        ("three", ["--task", "1"]),
        ("three", ["--task", "2"]),
        ("strange", ["--from", "2.5", "--to", "20"]),
        ("contacts", []),
    )
] + [
    ("plot_trajectory.py", "many", []),
    ("plot_spacetime.py", "many", ["--root"]),
    ("plot_spacetime.py", "many", ["--limit", "0.2", "--particles", "100", "140"]),
    ("plot_phase.py", "localised", ["--particles", "15", "14", "0", "15"]),
    ("plot_lyapunov.py", "exponents", []),
    ("plot_lyapunov.py", "exponents", ["--task", "5"]),
    ("plot_lyapunov.py", "many_exponents", []),
    ("plot_lyapunov.py", "many_exponents", ["--task", "1"]),
    ("plot_lyapunov.py", "resting", []),
]

# script, file, options, words of the message
REFUSALS = [
    ("plot_trajectory.py", "absent.h5", [], "no such file"),
    ("plot_spacetime.py", "text.h5", [], "not a readable result"),
    ("plot_phase.py", "truncated.h5", [], "not a readable result"),
    ("animate_trajectory.py", "orbits.h5", [], "not a result of kind trajectory"),
    ("plot_trajectory.py", "three.h5", ["--task", "3"], "no task 3, it has tasks 0 to 2"),
    ("plot_phase.py", "three.h5", ["--task", "-1"], "no task -1"),
    ("plot_phase.py", "three.h5", ["--particles", "3"], "no particle 3, it has particles 0 to 2"),
    ("plot_phase.py", "many.h5", ["--particles", *map(str, range(13))], "at most 12"),
    ("plot_spacetime.py", "three.h5", ["--particles", "1", "3"], "no particles 1 to 3"),
    ("plot_spacetime.py", "unreached.h5", [], "0 samples to draw (blow_up: force is not finite)"),
    ("animate_trajectory.py", "three.h5", ["--from", "31"], "0 samples"),
    ("plot_phase.py", "speedless.h5", [], "no /trajectory/v"),
    ("plot_lyapunov.py", "family.h5", [], "not a result of kind trajectory"),
]

WRITERS = ["animate_trajectory.py", "plot_phase.py", "plot_spacetime.py", "plot_trajectory.py"]


@pytest.fixture(scope="module")
def results(ricochet, shared):
    return Shelf(shared, computed(ricochet, STUDIES) | MADE)


@pytest.mark.parametrize("script, name, options", cases(FIGURES))
def test_figure_is_drawn(scripts, results, folder, script, name, options):
    draws(scripts, results, folder, script, name, options)


@pytest.mark.parametrize("script, name, options, words", cases(REFUSALS))
def test_refusal_is_one_line(scripts, results, folder, script, name, options, words):
    refuses(scripts, results, folder, script, name, options, words)


@pytest.mark.parametrize("script", WRITERS)
def test_unwritable_output_is_one_line(scripts, results, script):
    refuses_places(scripts, results, script, "three.h5", *(["--frames", "2"] if script.startswith("animate") else []))


def test_default_name_stands_beside_the_result(scripts, results):
    """As a process of its own."""
    path = results["three"]
    scripts.start("plot_trajectory.py", path, cwd="/").expect_files(path.with_name("three_trajectory"))


def test_default_name_has_the_task(scripts, results):
    path = results["three"]
    drawn = scripts.draw("plot_trajectory.py", path, "--task", "1", cwd="/")
    drawn.expect_files(path.with_name("three_trajectory_1"))


# --- animations ---


@pytest.mark.parametrize("name, frames, pace", [("localised", 60, 20), ("three", 12, 10)])
def test_animation_moves(scripts, results, folder, name, frames, pace):
    path = folder / "film.gif"
    words = ["-o", folder / "film", "--frames", frames, "--fps", pace]
    drawn = scripts.draw("animate_trajectory.py", f"{name}.h5", *words, cwd=results.folder_of(f"{name}.h5"))
    assert drawn.expect_silence().out.split() == [str(path)]
    with Image.open(path) as film:
        assert film.n_frames == frames
        assert film.width >= 800 and film.height >= 350
        assert film.info["duration"] == 1000 // pace
        first = np.array(film.convert("RGB"))
        film.seek(film.n_frames // 2)
        assert (np.array(film.convert("RGB")) != first).sum() > 100, "it does not move"
    assert path.stat().st_size < 15000 * frames


def test_film_without_ffmpeg_is_refused(scripts, results, folder):
    """Or made, where ffmpeg is there."""
    path = folder / "film.mp4"
    drawn = scripts.draw("animate_trajectory.py", results["three"], "--frames", "8", "-o", path, cwd=folder)
    if drawn.code == 0:
        assert path.stat().st_size > 1000
    else:
        drawn.expect_refused(f"animate_trajectory.py: {results['three']}: ", "ffmpeg")
        assert not path.exists()


# --- what the reader takes from a result ---


@pytest.fixture
def motion_of(scripts, results):
    """Reads a task, of an open result."""
    reader, opened = scripts.load("trajectories"), []

    def read(name, task=0):
        opened.append(h5py.File(results[name], "r"))
        return reader.Motion(opened[-1], task)

    yield read
    for file in opened:
        file.close()


# From the motion: the straight line of a sample 0.04 away at most misses by half the acceleration times 0.04^2.
@pytest.mark.parametrize("name, tolerance", [("three", 0), ("strange", 2e-3), ("contacts", 0)])
def test_obstacles_are_those_of_the_study(motion_of, name, tolerance):
    met, hit = motion_of(name).met_obstacles(), np.unique(motion_of(name).hits.particle)
    expected = np.array([-0.6, np.nan, -0.8])
    assert len(hit) > 0 and np.isnan(met["wall"]).all()
    assert (np.abs(met["floor"][hit] - expected[hit]) <= tolerance).all(), met
    assert np.isnan(np.delete(met["floor"], hit)).all(), met


def test_numbers_of_studies_are_read(scripts):
    number_of = scripts.load("trajectories").number_of
    for word, value in (("-1", -1), ("1.5 pi", 1.5 * np.pi), ("-pi", -np.pi), ("2e-3", 0.002), ("+0.5", 0.5)):
        assert number_of(word) == value, word
    for word in ("null", None, "", "e", "1 2", "{a", "nan"):
        assert np.isnan(number_of(word)), word


@pytest.mark.parametrize("name, particle, restitution", [("localised", 15, 1.0), ("crowd", 9, 0.98)])
@pytest.mark.parametrize("mass", [1, 3])
def test_portrait_breaks_at_impacts(scripts, motion_of, name, particle, restitution, mass):
    """No piece crosses an impact, and the pieces meet the law of reflection, also for another mass than one."""
    motion = motion_of(name)
    motion.impacts.impulse = motion.impacts.impulse * mass  # as if masses were such
    portrait = scripts.load("plot_phase").Portrait(motion, particle, motion.met_obstacles())
    assert len(portrait.impacts) > 3
    # The mass comes from a straight line through two samples: twice the step squared, with speeds near 1.
    bound = 1e-9 if mass == 1 else 4 * np.diff(motion.t).max() ** 2
    assert np.abs(portrait.after + restitution * portrait.before).max() < bound
    pieces = list(portrait.pieces())
    assert len(pieces) == len(portrait.impacts) + 1
    # Within a piece speeds change by no more than the largest acceleration, 1 + 4 gamma or so, lets them.
    for t, _q, v in pieces:
        assert (np.abs(np.diff(v)) <= 5 * np.diff(t) + 1e-6).all()


# --- numbers in figures ---


def impacts_of(path, task):
    """(time, particle, side) of a task: [impact, 3]."""
    first, last = column(path, "trajectory/impact_offset")[task : task + 2]
    rows = [column(path, f"trajectory/impact_{name}")[first:last] for name in ("time", "particle")]
    side = np.where(column(path, "trajectory/impact_side")[first:last] == "floor", 1, -1)
    return np.column_stack([*rows, side])


def test_trajectory_has_every_sample_and_impact(scripts, results):
    path = results["localised"]
    (figure,) = scripts.look("plot_trajectory.py", path)
    axes = figure.axes[0]
    t, q, impacts = column(path, "trajectory/t")[0], column(path, "trajectory/q")[0], impacts_of(path, 0)
    assert set(impacts[:, 1]) == {15} and len(impacts) == 19
    drawn = axes.lines[0].get_xydata()
    assert len(drawn) == len(t) + len(impacts)
    assert_among(np.column_stack([t, q[:, 15]]), *drawn.T)
    assert_among(np.column_stack([impacts[:, 0], np.full(len(impacts), -1.0)]), *drawn.T)
    others = np.array(axes.collections[0].get_segments())
    assert (others[:, :, 1] == np.delete(q, 15, axis=1).T).all() and (others[:, :, 0] == t).all()
    marks = [marks for marks in axes.collections if len(marks.get_offsets()) == len(impacts)]
    assert len(marks) == 1 and (marks[0].get_offsets()[:, 0] == impacts[:, 0]).all()


@pytest.mark.parametrize("task", [0, 1])
def test_spacetime_is_the_displacements_and_impacts(scripts, results, task):
    """Task 1 ended early."""
    path = results["three"]
    (figure,) = scripts.look("plot_spacetime.py", path, "--task", task)
    axes, impacts = figure.axes[0], impacts_of(path, task)
    q = column(path, "trajectory/q")[task]
    assert (axes.images[0].get_array() == q[np.isfinite(q[:, 0])].T).all()
    dots = np.concatenate([dots.get_offsets() for dots in axes.collections])
    assert 0 < len(dots) == len(impacts) and (dots == impacts[:, :2]).all()


def test_phase_portrait_has_every_impact_and_sample(scripts, results):
    path = results["localised"]
    (figure,) = scripts.look("plot_phase.py", path, "--particles", "15", "14")
    times, t = impacts_of(path, 0)[:, 0], column(path, "trajectory/t")[0]
    at_sample = (np.abs(t - times[:, None]) < 1e-9 * (1 + times[:, None])).any(axis=1).sum()  # they are left out
    for axes, impacts, left_out in zip(figure.axes, (len(times), 0), (at_sample, 0)):
        # Pieces of a curve have a stroke less than points; impacts are the last and the first points of pieces.
        assert len(axes.collections[0].get_segments()) == len(t) - left_out - 1 + impacts
        assert [len(marks.get_offsets()) for marks in axes.collections[1:]] == [impacts] * (2 if impacts else 0)


def test_exponents_are_those_of_the_result(scripts, results):
    path = results["exponents"]
    values, at = column(path, "trajectory/lyapunov"), column(path, "sweep/model.force[0]")
    (figure,) = scripts.look("plot_lyapunov.py", path)
    lines = [line.get_xydata() for line in figure.axes[0].lines if line.get_linestyle() == "-"]
    assert values.shape == (6, 2)
    for k in range(2):
        assert (lines[k] == np.column_stack([at, values[:, k]])).all()


def test_convergence_of_exponents_is_that_of_the_task(scripts, results):
    path = results["exponents"]
    first, last = column(path, "trajectory/lyapunov_offset")[5:7]
    time, history = (column(path, f"trajectory/lyapunov_{name}")[first:last] for name in ("time", "history"))
    (figure,) = scripts.look("plot_lyapunov.py", path, "--task", "5")
    for k in range(2):
        assert (figure.axes[0].lines[k].get_xydata() == np.column_stack([time, history[:, k]])).all()
    assert (history[-1] == column(path, "trajectory/lyapunov")[5]).all() and len(history) > 5
