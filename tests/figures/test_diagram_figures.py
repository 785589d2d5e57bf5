#!/usr/bin/python3
"""Runs the scripts that draw diagrams and basins on small studies: test_diagram_figures.py RICOCHET_BINARY SOURCE_DIR.

What a figure shows is for eyes; here it must exist, be large enough and not blank, and what the scripts cannot draw must
end with one line and exit code 2. Windows are also printed: these numbers are checked.
"""

import os
import sys
import tempfile
import traceback
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

from test_figures import call, check_files, run_studies

MAP = """kind: {kind}
title: {title}
model: {{type: grazing_map, {model}}}
iterate: {{{iterate}}}
{sweep}
"""
OSCILLATOR = """kind: diagram
title: {title}
model: {{type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, {model}}}
{family}
iterate: {{{iterate}}}
sweep: {sweep}
"""
FAMILY = "orbit: {motion: forced}\nbranch: {parameter: model.force, from: 1, to: 50}"
EXAMPLE = "lambda: 0.5, omega: 0.3"


def of_map(title, iterate, sweep="", model=EXAMPLE, kind="diagram"):
    return MAP.format(kind=kind, title=title, model=model, iterate=iterate, sweep=sweep and "sweep:\n  - " + sweep)


def of_oscillator(title, model, iterate, sweep, family=""):
    return OSCILLATOR.format(title=title, model=model, iterate=iterate, sweep=sweep, family=family)


OF_D = "{parameter: model.d, from: 1e-5, to: 0.03, points: 60, scale: log"
STARTS = "{{parameter: 'iterate.start[{}]', from: -0.5, to: 0.5, points: 20}}"
GRID = "{parameter: model.lambda, values: [0.3, 0.5]}\n  - {parameter: model.d, from: 1e-4, to: 0.03, points: 20}"
SHORT = "transient: 500, keep: 100"

STUDIES = {
    "plain": of_map("Figure 4", "transient: 2000, keep: 300, lyapunov: true, windows: true",
                    "{parameter: model.d, from: 5e-5, to: 0.03, points: 80}"),
    "ratios": of_map("Figure 5", "transient: 2000, keep: 300, windows: true", OF_D + "}"),
    "back": of_map("there and back", SHORT + ", follow: true", OF_D + ", back: true}", "lambda: 0.1, omega: 0.05"),
    "falling": of_map("falling values", SHORT, "{parameter: model.d, values: [0.03, 0.02, 0.013, 0.001]}"),
    "one": of_map("a single value", SHORT, "{parameter: model.d, values: [0.02]}"),
    "grid": of_map("lines", SHORT + ", lyapunov: true", GRID),
    "listed": of_map("a map by its lists", SHORT, "{parameter: model.d, from: 0.001, to: 0.03, points: 20}",
                     "L: [0.5, 0, 0, 0.3], eta: [1, 0], xi: [1, 1]"),
    "attractor": of_map("Figure 6", "transient: 500, keep: 2000, states: true, lyapunov: true, exponents: 3", "",
                        EXAMPLE + ", d: 1.5e-4"),
    "dense": of_map("many states", "transient: 500, keep: 20000, states: true", "", EXAMPLE + ", d: 1.5e-4"),
    "periods": of_map("periods", "transient: 500, keep: 0, measure: 1",
                      "{parameter: model.lambda, from: 0.05, to: 0.95, points: 40}\n"
                      "  - {parameter: model.d, from: 1e-6, to: 0.1, points: 40, scale: log}", "omega: 0.04"),
    "basin": of_map("two attractors", "transient: 500, start: [0, 0, 0]",
                    STARTS.format(0) + "\n  - " + STARTS.format(2), "lambda: 0.1, omega: 0.05, d: 0.0156", "basin"),
    "basin_line": of_map("a line of starts", "transient: 500, start: [0, 0, 0]", STARTS.format(0),
                         "lambda: 0.1, omega: 0.05, d: 0.0156", "basin"),
    "beyond": of_oscillator("beyond grazing", "damping: 3, force: 1, frequency: 4", SHORT + ", lyapunov: true, windows: true",
                            "{parameter: grazing.beyond, from: 1e-5, to: 1e-2, points: 24, scale: log}", FAMILY),
    "impacts": of_oscillator("at impacts", "damping: 0.3, frequency: 2.5", SHORT + ", section: impact, states: true",
                             "{parameter: model.force, from: 6, to: 9, points: 8}"),
}  # fmt: skip

# script, study, options, endings of the stems that it writes
FIGURES = [
    ("plot_diagram.py", "plain", [], [""]),
    ("plot_diagram.py", "ratios", [], [""]),
    ("plot_diagram.py", "ratios", ["--scaled"], [""]),
    ("plot_diagram.py", "ratios", ["--values"], [""]),
    ("plot_diagram.py", "listed", ["--scaled", "--lambda", "0.5"], [""]),
    ("plot_diagram.py", "back", [], [""]),
    ("plot_diagram.py", "falling", [], [""]),
    ("plot_diagram.py", "one", [], [""]),
    ("plot_diagram.py", "grid", [], ["_0", "_1"]),
    ("plot_diagram.py", "grid", ["--lines", "1"], ["_1"]),
    ("plot_diagram.py", "beyond", [], [""]),
    ("plot_diagram.py", "impacts", [], [""]),
    ("plot_diagram.py", "broken", [], [""]),
    ("plot_diagram.py", "broken_beyond", [], [""]),
    ("plot_attractor.py", "attractor", [], [""]),
    ("plot_attractor.py", "attractor", ["--plane", "z3", "z1"], [""]),
    ("plot_attractor.py", "dense", [], [""]),
    ("plot_attractor.py", "impacts", ["--task", "3"], [""]),
    ("plot_attractor.py", "impacts", ["--task", "3", "--plane", "time", "v0"], [""]),
    ("plot_periods.py", "periods", [], [""]),
    ("plot_periods.py", "periods", ["--swap"], [""]),
    ("plot_periods.py", "broken_periods", [], [""]),
    ("plot_basin.py", "basin", [], [""]),
    ("plot_basin.py", "basin", ["--swap"], [""]),
    ("plot_windows.py", "ratios", [], [""]),
    ("plot_windows.py", "beyond", ["--lambda", "0.549"], [""]),
]

# script, file, options, words of the message
REFUSALS = [
    ("plot_diagram.py", "absent.h5", [], "no such file"),
    ("plot_diagram.py", "orbits.h5", [], "not a result of kind diagram"),
    ("plot_diagram.py", "basin.h5", [], "not a result of kind diagram"),
    ("plot_diagram.py", "attractor.h5", [], "no swept parameter in it"),
    ("plot_diagram.py", "periods.h5", [], "no /diagram/values in it (iterate.keep of the study is 0)"),
    ("plot_diagram.py", "grid.h5", ["--lines", "2"], "no line 2, it has lines 0 to 1"),
    ("plot_diagram.py", "beyond.h5", ["--scaled"], "--scaled is for maps along positive model.d"),
    ("plot_diagram.py", "listed.h5", ["--scaled"], "give --lambda"),
    ("plot_diagram.py", "nothing.h5", [], "no iterate of it is finite"),
    ("plot_attractor.py", "plain.h5", [], "the study did not ask for iterate.states"),
    ("plot_attractor.py", "impacts.h5", [], "8 tasks in it, this figure needs --task"),
    ("plot_attractor.py", "attractor.h5", ["--task", "1"], "no task 1, it has tasks 0 to 0"),
    ("plot_attractor.py", "attractor.h5", ["--plane", "z1", "z4"], "no number z4 in a state, it has z1, z2, z3"),
    ("plot_periods.py", "plain.h5", [], "1 swept parameters (model.d), this figure needs 2"),
    ("plot_basin.py", "plain.h5", [], "not a result of kind basin"),
    ("plot_basin.py", "basin_line.h5", [], "this figure needs 2"),
    ("plot_windows.py", "grid.h5", [], "the study did not ask for iterate.windows"),
    ("plot_windows.py", "text.h5", [], "not a readable result"),
]


def break_rows(source, target, rows):
    """A copy in which some tasks failed or diverged: their numbers are NaN."""
    with h5py.File(source, "r") as old, h5py.File(target, "w") as new:
        for group in ("diagram", "sweep"):
            old.copy(group, new)
        new.attrs.update(old.attrs)
        columns = new["diagram"]
        kinds = h5py.check_enum_dtype(columns["outcome"].dtype)
        for i, row in enumerate(rows):
            columns["outcome"][row] = kinds[("failed", "diverged")[i % 2]]
            for column in columns.values():
                if column.dtype.kind == "f":
                    column[row] = np.nan
            columns["attractor_period"][row] = 0


def make_files(folder):
    at = lambda name: os.path.join(folder, name + ".h5")  # noqa: E731
    break_rows(at("plain"), at("broken"), [0, 5, 6, 40, 79])
    break_rows(at("plain"), at("nothing"), range(80))
    break_rows(at("beyond"), at("broken_beyond"), [0, 7, 23])
    break_rows(at("periods"), at("broken_periods"), range(100, 400))
    with h5py.File(at("orbits"), "w") as file:
        file["orbits/outcome"] = np.arange(3)
    with open(at("text"), "w", encoding="utf-8") as file:
        file.write("no HDF5\n")


def figure_is_drawn(scripts, folder, script, name, options, endings):
    stem = os.path.join(folder, "_".join([script[:-3], name] + [option.strip("-") for option in options]))
    done = call(scripts, folder, script, name + ".h5", "-o", stem + ".png", *options)
    assert done.returncode == 0 and done.stderr == "", f"exit {done.returncode}: {done.stderr}"
    written = [stem + ending + suffix for ending in endings for suffix in (".png", ".svg")]
    assert done.stdout.split()[-len(written) :] == written, done.stdout
    for ending in endings:
        check_files(stem + ending)
        assert os.path.getsize(stem + ending + ".svg") < 2e6, "more points than a file should hold"


def refusal_is_one_line(scripts, folder, script, name, options, words):
    done = call(scripts, folder, script, name, "-o", "refused", *options)
    assert done.returncode == 2, f"exit {done.returncode}: {done.stderr}"
    assert done.stderr.count("\n") == 1 and done.stderr.startswith(f"{script}: {name}: "), done.stderr
    assert words in done.stderr, done.stderr
    assert not [new for new in os.listdir(folder) if new.startswith("refused")]


def table_has_the_exact_edges(scripts, folder):
    """The flip and the border of the orbits with one impact of the example map, whose z1 does not depend on z2, z3."""
    done = call(scripts, folder, "plot_windows.py", "plain.h5", "-o", os.path.join(folder, "table"))
    assert done.returncode == 0 and done.stderr == "", done.stderr
    lines = [line.split() for line in done.stdout.splitlines()]
    rows = {int(words[0]): words for words in lines if words and words[0].isdigit()}
    for n in (5, 6, 7):
        c, size = 0.5 ** (n - 1), 0.5
        s = c / 2 / (1 - 3 * c)
        low = (s**2 * (1 + 3 * c) + c * s) / (1 - c * size)
        high = (1 - size) * size ** (2 * (n - 2)) / (1 - size ** (n - 2) * (3 - 2 * size)) ** 2
        assert abs(float(rows[n][2]) / low - 1) < 1e-8 and rows[n][3] == "flip", rows[n]
        assert abs(float(rows[n][5]) / high - 1) < 1e-8 and rows[n][6] == "border", rows[n]


def passes(case):
    check, *rest = case
    try:
        check(*rest)
    except Exception:  # a test that breaks is a test that fails; the others still run
        print(f"FAILED {check.__name__} {rest[2:]}\n{traceback.format_exc()}", flush=True)
        return False
    return True


def main():
    binary, scripts = os.path.abspath(sys.argv[1]), os.path.abspath(os.path.join(sys.argv[2], "scripts"))
    with tempfile.TemporaryDirectory() as folder:
        run_studies(binary, folder, STUDIES)
        make_files(folder)
        cases = [(figure_is_drawn, scripts, folder, *case) for case in FIGURES]
        cases += [(refusal_is_one_line, scripts, folder, *case) for case in REFUSALS]
        cases.append((table_has_the_exact_edges, scripts, folder))
        with ThreadPoolExecutor(2) as pool:
            outcomes = list(pool.map(passes, cases))
    print(f"{sum(outcomes)} of {len(outcomes)} passed")
    return not all(outcomes)


if __name__ == "__main__":
    sys.exit(main())
