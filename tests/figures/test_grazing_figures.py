#!/usr/bin/python3
"""Runs the scripts that draw grazing bifurcations on synthetic results: test_grazing_figures.py SOURCE_DIR.

What a figure shows is for eyes; here it must exist, be large enough and not blank, and what the scripts cannot
draw must end with one line and exit code 2.
"""

import os
import sys
import tempfile
import traceback

import h5py
import numpy as np

import synthetic_grazing
from test_figures import call, check_files

# script, file, options, endings of the stems that it writes
FIGURES = [
    ("plot_grazing.py", "regimes", [], ["_0", "_1", "_2"]),
    ("plot_grazing.py", "light", ["--tasks", "1", "2"], ["_1", "_2"]),
    ("plot_grazing.py", "alone", [], [""]),
    ("plot_grazing_windows.py", "regimes", [], [""]),
    ("plot_grazing_windows.py", "regimes", ["--tasks", "2"], [""]),
    ("plot_grazing_curve.py", "light", [], [""]),
    ("plot_grazing_curve.py", "heavy", [], [""]),
]

# script, file, options, words of the message
REFUSALS = [
    ("plot_grazing.py", "absent.h5", [], "no such file"),
    ("plot_grazing.py", "orbits.h5", [], "not a result of kind grazing"),
    ("plot_grazing.py", "none.h5", [], "no grazing point in it (none)"),
    ("plot_grazing.py", "regimes.h5", ["--tasks", "3"], "no task 3, it has tasks 0 to 2"),
    ("plot_grazing_windows.py", "light.h5", [], "no verdict continuous in it (discontinuous)"),
    ("plot_grazing_windows.py", "alone.h5", [], "grazing.windows of the study is 0"),
    ("plot_grazing_curve.py", "regimes.h5", [], "the study did not ask for branch.trace"),
]


def make_results(folder):
    path = lambda name: os.path.join(folder, name + ".h5")  # noqa: E731
    synthetic_grazing.write(path("regimes"), 3, [6, 4, 1.5])
    synthetic_grazing.write(path("light"), 0.1, [2, 2.6, 20], curve=np.linspace(0.4, 3, 301))
    synthetic_grazing.write(path("heavy"), 3, [4], curve=np.linspace(2, 6, 41))
    synthetic_grazing.write(path("alone"), 3, [4], periods=0)
    synthetic_grazing.write(path("none"), 3, [4], outcomes=["none"])
    with h5py.File(path("orbits"), "w") as file:
        file["orbits/outcome"] = np.arange(3)


def figure_is_drawn(scripts, folder, script, name, options, endings):
    stem = os.path.join(folder, "_".join([script[:-3], name] + options[1:]))
    done = call(scripts, folder, script, name + ".h5", "-o", stem, *options)
    assert done.returncode == 0 and done.stderr == "", f"exit {done.returncode}: {done.stderr}"
    assert done.stdout.split() == [stem + ending + suffix for ending in endings for suffix in (".png", ".svg")], done.stdout
    for ending in endings:
        check_files(stem + ending)


def refusal_is_one_line(scripts, folder, script, name, options, words):
    done = call(scripts, folder, script, name, "-o", "refused", *options)
    assert done.returncode == 2, f"exit {done.returncode}"
    assert done.stderr.count("\n") == 1 and done.stderr.startswith(f"{script}: {name}: "), done.stderr
    assert words in done.stderr, done.stderr
    assert not [new for new in os.listdir(folder) if new.startswith("refused")]


def main():
    scripts, failed = os.path.join(sys.argv[1], "scripts"), 0
    with tempfile.TemporaryDirectory() as folder:
        make_results(folder)
        cases = [(figure_is_drawn, *case) for case in FIGURES] + [(refusal_is_one_line, *case) for case in REFUSALS]
        for check, *case in cases:
            try:
                check(scripts, folder, *case)
            except Exception:
                failed += 1
                print(f"{check.__name__} {case}\n{traceback.format_exc()}")
    print(f"{len(cases) - failed} of {len(cases)} passed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
