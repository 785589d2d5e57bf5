#!/usr/bin/python3
"""Runs the scripts that draw trajectories on synthetic results: test_trajectory_figures.py SOURCE_DIR.

What a figure shows is for eyes; here it must exist, be large enough and not blank, and what the scripts cannot
draw must end with one line and exit code 2. What the reader takes from a result is compared with what was written.
"""

import os
import sys
import tempfile
import traceback
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np
from PIL import Image

import synthetic_motion
from test_figures import call, check_files

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
]


def altered(source, target, change):
    with h5py.File(source, "r") as old, h5py.File(target, "w") as new:
        for group in ("trajectory", "sweep"):
            old.copy(group, new)
        new.attrs.update(old.attrs)
        change(new)


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


def make_files(folder):
    at = lambda name: os.path.join(folder, name)  # noqa: E731
    synthetic_motion.localised(at("localised.h5"), samples=801)
    synthetic_motion.crowd(at("crowd.h5"), samples=601, duration=20.0)
    synthetic_motion.crowd(at("many.h5"), particles=400, samples=201, duration=10.0, scale=1.5)
    synthetic_motion.three(at("three.h5"))
    synthetic_motion.unreached(at("unreached.h5"))
    altered(at("three.h5"), at("strange.h5"), unknown_floors)
    altered(at("three.h5"), at("contacts.h5"), only_contacts)
    altered(at("three.h5"), at("speedless.h5"), lambda file: file["trajectory"].pop("v"))
    with open(at("text.h5"), "w", encoding="utf-8") as file:
        file.write("no HDF5\n")
    with open(at("three.h5"), "rb") as whole, open(at("truncated.h5"), "wb") as part:
        part.write(whole.read(3000))
    with h5py.File(at("orbits.h5"), "w") as file:
        file["orbits/outcome"] = np.arange(3)


def figure_is_drawn(scripts, folder, script, name, options):
    stem = os.path.join(folder, "_".join([script[:-3], name] + [option.strip("-") for option in options]))
    done = call(scripts, folder, script, name + ".h5", "-o", stem, *options)
    assert done.returncode == 0 and done.stderr == "", f"exit {done.returncode}: {done.stderr}"
    assert done.stdout.split() == [stem + ".png", stem + ".svg"], done.stdout
    check_files(stem)


def animation_moves(scripts, folder, name, options):
    stem = os.path.join(folder, f"film_{name}")
    done = call(scripts, folder, "animate_trajectory.py", name + ".h5", "-o", stem, *options)
    assert done.returncode == 0 and done.stderr == "", f"exit {done.returncode}: {done.stderr}"
    assert done.stdout.split() == [stem + ".gif"], done.stdout
    with Image.open(stem + ".gif") as film:
        assert film.n_frames == int(options[1]), film.n_frames
        assert film.width >= 800 and film.height >= 350, film.size
        assert film.info["duration"] == 1000 // int(options[3]), film.info
        first = np.array(film.convert("RGB"))
        film.seek(film.n_frames // 2)
        assert (np.array(film.convert("RGB")) != first).sum() > 100, "it does not move"
    size = os.path.getsize(stem + ".gif")
    assert size < 15000 * int(options[1]), f"{size} bytes"


def film_without_ffmpeg_is_refused(scripts, folder):
    """Or made, where ffmpeg is there."""
    done = call(scripts, folder, "animate_trajectory.py", "three.h5", "--frames", "8", "-o", "film.mp4")
    if done.returncode == 0:
        assert os.path.getsize(os.path.join(folder, "film.mp4")) > 1000
    else:
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and "ffmpeg" in done.stderr, done.stderr


def default_names_have_the_task(scripts, folder):
    for options, stem in (([], "three_trajectory"), (["--task", "1"], "three_trajectory_1")):
        done = call(scripts, "/", "plot_trajectory.py", os.path.join(folder, "three.h5"), *options)
        assert done.returncode == 0, done.stderr
        check_files(os.path.join(folder, stem))


def refusal_is_one_line(scripts, folder, script, name, options, words):
    before = set(os.listdir(folder))
    done = call(scripts, folder, script, name, "-o", "refused_" + script, *options)
    assert done.returncode == 2, f"exit {done.returncode}"
    assert done.stderr.count("\n") == 1 and done.stderr.startswith(f"{script}: {name}: "), done.stderr
    assert words in done.stderr, done.stderr
    assert not [new for new in set(os.listdir(folder)) - before if new.startswith("refused_" + script)]


def unwritable_output_is_one_line(scripts, folder, script):
    done = call(scripts, folder, script, "three.h5", "-o", "no/such/folder/figure")
    line = done.stderr.count("\n") == 1 and "cannot write" in done.stderr
    assert done.returncode == 2 and line, done.stderr


def help_names_the_datasets(scripts, folder, script):
    done = call(scripts, folder, script, "--help")
    told = all(word in done.stdout for word in ("/trajectory/q", "--output", "--task", "--from"))
    assert done.returncode == 0 and told, done.stdout


def obstacles_are_those_of_the_study(folder, name, tolerance):
    from trajectories import Motion

    with h5py.File(os.path.join(folder, name), "r") as file:
        met = Motion(file, 0).met_obstacles()
        hit = np.unique(Motion(file, 0).hits.particle)
    expected = np.array([-0.6, np.nan, -0.8])
    assert len(hit) > 0 and np.isnan(met["wall"]).all()
    assert (np.abs(met["floor"][hit] - expected[hit]) <= tolerance).all(), met
    assert np.isnan(np.delete(met["floor"], hit)).all(), met


def numbers_of_studies_are_read():
    from trajectories import number_of

    for word, value in (("-1", -1), ("1.5 pi", 1.5 * np.pi), ("-pi", -np.pi), ("2e-3", 0.002), ("+0.5", 0.5)):
        assert number_of(word) == value, word
    for word in ("null", None, "", "e", "1 2", "{a", "nan"):
        assert np.isnan(number_of(word)), word


def portrait_breaks_at_impacts(folder):
    """No piece crosses an impact, and the pieces meet the law of reflection, also for another mass than one."""
    from plot_phase import Portrait
    from trajectories import Motion

    for name, particle, restitution in (("localised.h5", 15, 1.0), ("crowd.h5", 9, 0.98)):
        with h5py.File(os.path.join(folder, name), "r") as file:
            motion = Motion(file, 0)
            obstacles = motion.met_obstacles()
            for scale in (1.0, 3.0):
                portrait = Portrait(motion, particle, obstacles)
                assert len(portrait.impacts) > 3
                # The mass comes from a straight line through two samples: twice the step squared, with speeds near 1.
                bound = 1e-9 if scale == 1 else 4 * np.diff(motion.t).max() ** 2
                wrong = np.abs(portrait.after + restitution * portrait.before).max()
                assert wrong < bound, wrong
                pieces = list(portrait.pieces())
                assert len(pieces) == len(portrait.impacts) + 1
                # Within a piece speeds change by no more than the largest acceleration, 1 + 4 gamma or so, lets them.
                for t, _q, v in pieces:
                    assert (np.abs(np.diff(v)) <= 5 * np.diff(t) + 1e-6).all()
                motion.impacts.impulse = motion.impacts.impulse * 3  # as if masses were 3


def cases(scripts, folder):
    yield from ((figure_is_drawn, scripts, folder, *figure) for figure in FIGURES)
    yield from ((refusal_is_one_line, scripts, folder, *refusal) for refusal in REFUSALS)
    yield (animation_moves, scripts, folder, "localised", ["--frames", "60", "--fps", "20"])
    yield (animation_moves, scripts, folder, "three", ["--frames", "12", "--fps", "10"])
    yield (film_without_ffmpeg_is_refused, scripts, folder)
    yield (default_names_have_the_task, scripts, folder)
    for script in sorted({refusal[0] for refusal in REFUSALS}):
        yield (help_names_the_datasets, scripts, folder, script)
        yield (unwritable_output_is_one_line, scripts, folder, script)


def reader_cases(folder):
    yield (obstacles_are_those_of_the_study, folder, "three.h5", 0)
    # From the motion: the straight line of a sample 0.04 away at most misses by half the acceleration times 0.04^2.
    yield (obstacles_are_those_of_the_study, folder, "strange.h5", 2e-3)
    yield (obstacles_are_those_of_the_study, folder, "contacts.h5", 0)
    yield (numbers_of_studies_are_read,)
    yield (portrait_breaks_at_impacts, folder)


def passes(case):
    try:
        case[0](*case[1:])
    except Exception:  # a test that breaks is a test that fails; the others still run
        print(f"FAILED {case[0].__name__} {case[1:]}\n{traceback.format_exc()}", flush=True)
        return False
    return True


def main():
    if len(sys.argv) != 2:
        print(__doc__.splitlines()[0], file=sys.stderr)
        return 2
    scripts = os.path.join(os.path.abspath(sys.argv[1]), "scripts")
    sys.path.insert(0, scripts)
    with tempfile.TemporaryDirectory() as folder:
        make_files(folder)
        with ThreadPoolExecutor(2) as pool:
            outcomes = list(pool.map(passes, [*cases(scripts, folder), *reader_cases(folder)]))
    print(f"{sum(outcomes)} passed, {len(outcomes) - sum(outcomes)} failed")
    return 0 if all(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
