#!/usr/bin/python3
"""Runs the plotting scripts on small studies: test_figures.py RICOCHET_BINARY SOURCE_DIR.

What a figure shows is for eyes; here it must exist as a large PNG with something on it and as a well-formed
SVG, for sweeps of every shape the scripts take, and what they cannot draw must end with one line and
exit code 2.
"""

import os
import subprocess
import sys
import tempfile
import traceback
import xml.etree.ElementTree
from concurrent.futures import ThreadPoolExecutor

import h5py
import matplotlib.image
import numpy as np

RING = """kind: orbits
title: {title}
model: {{type: chain, particles: 6, ends: periodic, gamma: 0.1, floor: -1}}
orbit: {{period: 1.5 pi, at_start: [3]{orbit}}}
sweep:
{sweep}
"""
DRIVEN = """kind: trajectory
title: driven between floor and wall
model: {{type: chain, particles: {n}, ends: free, gamma: 0.1, stiffness: 0, damping: 0.1, floor: -1, wall: 1,
        restitution: 0.8, force: {force}, frequency: 2.6}}
start: {{v: 0}}
time: {{duration: 100, samples: 2, lyapunov: true}}
sweep: {{parameter: "model.force[0]", {sweep}}}
"""
GAMMA = "  - {{parameter: model.gamma, {}}}"


def ring(title, sweep, orbit=""):
    return RING.format(title=title, sweep=sweep, orbit=orbit)


STUDIES = {
    "family": ring("a family", GAMMA.format("from: 0, to: 0.19, points: 12")),
    "poles": ring(
        "costs 5 $ and 6 $", GAMMA.format("from: 0, to: 1.2, points: 121"), ", special_points: true"
    ),
    "falling": ring("falling values", GAMMA.format("values: [0.15, 0.1, 0.12, 0]")),
    "one": ring("a single point", GAMMA.format("values: [0.1]")),
    "logarithmic": ring("equal ratios", GAMMA.format("from: 1e-4, to: 0.1, points: 7, scale: log")),
    "exact": ring(
        "through gamma_c exactly",
        GAMMA.format("values: [0.18, 0.19, 0.194, 0.19444, 0.1944444, " "0.1944444444444444444]"),
    ),
    "grid": ring(
        "a grid",
        "  - {parameter: orbit.period, values: [6, 5.6, 5, 4.5, 4.2, 3.9, 3.4]}\n"
        + GAMMA.format("from: 0, to: 0.6, points: 9"),
    ),
    "stable": ring(
        "multipliers", GAMMA.format("from: 0, to: 0.25, points: 51"), ", multipliers: true, special_points: true"
    ),
    "spread": ring("far from the circle", "", ", multipliers: true, at_half: [2]").replace("sweep:", ""),
    "stable_grid": ring(
        "stability",
        "  - {parameter: orbit.period, values: [6, 5.6, 5, 4.5, 4.2, 3.9, 3.4]}\n"
        + GAMMA.format("from: 0, to: 0.6, points: 9"),
        ", stable: true",
    ),
    "exponents": DRIVEN.format(n=1, force="[7]", sweep="from: 7, to: 12, points: 6"),
    "many_exponents": DRIVEN.format(n=4, force="[7, 0, 0, 0]", sweep="from: 7, to: 8, points: 3"),
    "resting": DRIVEN.format(n=1, force="[7]", sweep="values: [7, 5.5, 4.5]")
    .replace("stiffness: 0", "stiffness: 1")
    .replace("wall: 1", "wall: null"),
    "branch": """kind: branch
title: through grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 0.2, cross: true}
""",
    "curves": """kind: branch
title: grazing, a fold and a period doubling
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 1.1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 20, scale: log, cross: true,
         trace: {parameter: model.frequency, low: 0.3, high: 3}}
""",
    "modes": """kind: branch
title: two masses before a wall
model: {type: duffing_chain, particles: 2, mass: 1, stiffness: [3, 1], cubic: [0, 0], wall: 2}
orbit: {mode: 0}
branch: {parameter: orbit.energy, from: 0.1, to: 3, step_most: 0.2, cross: true, samples: 31}
sweep: {parameter: "model.cubic[1]", values: [0, 0.1, 0.2]}
""",
    "ritz": """kind: orbits
title: Ritz
model: {type: duffing_chain, particles: 2, mass: 1, stiffness: [3, 1], cubic: [0, 0], wall: 2}
orbit: {period: 6.8, at_start: [1], method: ritz}
sweep:
  - {parameter: "model.cubic[1]", values: [0, 0.1]}
  - {parameter: orbit.functions, values: [2, 4, 8]}
""",
    "several_curves": """kind: branch
title: grazing at several dampings, frequency followed
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: -1, restitution: 0.8, force: 0.3}
orbit: {motion: forced}
branch: {parameter: model.frequency, from: 0.6, to: 1.5,
         trace: {parameter: model.force, low: 0.1, high: 2, first_low: 0.5}}
sweep: {parameter: model.damping, values: [0.05, 0.1, 0.2]}
""",
    "branches": """kind: branch
title: several stiffnesses
model: {type: chain, particles: 4, ends: periodic, gamma: 0, floor: -1, hertz: 100}
orbit: {period: 1.5 pi, at_start: [2]}
branch: {parameter: model.gamma, from: 0, to: 0.15}
sweep: {parameter: model.hertz, from: 100, to: 1e5, points: 9, scale: log}
""",
    "rigid_states": """kind: branch
title: shapes under the impact law
model: {type: chain, particles: 6, ends: periodic, gamma: 0, floor: -1}
orbit: {period: 1.5 pi, at_start: [3]}
branch: {parameter: model.gamma, from: 0, to: 0.19, states: true}
""",
    "soft_states": """kind: branch
title: shapes under Hertz's law
model: {type: chain, particles: 6, ends: periodic, gamma: 0, floor: -1, hertz: 100}
orbit: {period: 1.5 pi, at_start: [3]}
branch: {parameter: model.gamma, from: 0, to: 0.15, states: true}
""",
    "logarithmic_branch": """kind: branch
title: along the logarithm, without multipliers
model: {type: chain, particles: 4, ends: periodic, gamma: 0.1, floor: -1}
orbit: {period: 1.5 pi, at_start: [2]}
branch: {parameter: model.hertz, from: 100, to: 1e5, scale: log, multipliers: false}
""",
    "unborn": """kind: branch
title: none begins
model: {type: chain, particles: 2, ends: periodic, gamma: 0, floor: null, cubic: 1}
orbit: {period: 7, excited: [0]}
branch: {parameter: model.gamma, from: 0, to: 0.1}
""",
    "stateless": ring("no states", GAMMA.format("from: 0, to: 0.19, points: 3"), ", states: false"),
    "floors": """kind: orbits
title: the floor of one particle
model: {type: chain, particles: 5, ends: free, gamma: 0.1, floor: [-1, -1, null, -1, -1]}
orbit:
  period: 1.5 pi
  at_start:
    - 1
  at_half: [4]
sweep:
  - {parameter: "model.floor[3]", values: [-0.9, -0.1, -0.001, -0.5]}
""",
}

# script, study, options
FIGURES = [
    ("plot_modes.py", "family", []),
    ("plot_modes.py", "poles", ["--all", "--curves", "20"]),
    ("plot_modes.py", "floors", []),
    ("plot_modes.py", "one", []),
    ("plot_modes.py", "logarithmic", []),
    ("plot_modes.py", "broken", []),
    ("plot_sweep.py", "family", []),
    ("plot_sweep.py", "poles", []),
    ("plot_sweep.py", "falling", []),
    ("plot_sweep.py", "one", []),
    ("plot_sweep.py", "logarithmic", []),
    ("plot_sweep.py", "stateless", []),
    ("plot_sweep.py", "broken", []),
    ("plot_sweep.py", "nothing", []),
    ("plot_map.py", "grid", []),
    ("plot_map.py", "grid", ["--swap", "--quantity", "clearance"]),
    ("plot_map.py", "grid", ["--quantity", "none"]),
    ("plot_map.py", "broken_grid", []),
    ("plot_approach.py", "exact", []),
    ("plot_sweep.py", "stable", []),
    ("plot_multipliers.py", "stable", []),
    ("plot_multipliers.py", "stable", ["--task", "40"]),
    ("plot_multipliers.py", "spread", []),
    ("plot_multipliers.py", "broken_stable", []),
    ("plot_stability.py", "stable_grid", []),
    ("plot_stability.py", "stable_grid", ["--all", "--swap"]),
    ("plot_lyapunov.py", "exponents", []),
    ("plot_lyapunov.py", "exponents", ["--task", "5"]),
    ("plot_lyapunov.py", "many_exponents", []),
    ("plot_lyapunov.py", "many_exponents", ["--task", "1"]),
    ("plot_lyapunov.py", "resting", []),
    ("plot_branch.py", "branch", []),
    ("plot_branch.py", "branch", ["--y", "multiplier_max"]),
    ("plot_branch.py", "branches", []),
    ("plot_branch.py", "branches", ["--y", "amplitude", "--tasks", "0", "8"]),
    ("plot_branch.py", "logarithmic_branch", ["--y", "period"]),
    ("plot_laws.py", "soft_states", ["--impacts", "rigid_states.h5", "--couplings", "3"]),
    ("plot_branch.py", "modes", ["--x", "amplitude", "--y", "frequency"]),
    ("plot_frequency_energy.py", "modes", []),
    ("plot_frequency_energy.py", "modes", ["--tasks", "2", "--energy-high", "2", "--resonances"]),
    ("plot_frequency_energy.py", "branch", []),
    ("plot_manifold.py", "modes", []),
    ("plot_manifold.py", "modes", ["--task", "2", "--axes", "q0", "q1", "v1", "--energy-high", "2"]),
    ("plot_motions.py", "modes", []),
    ("plot_ritz.py", "ritz", []),
    ("plot_ritz.py", "ritz", ["--stalled", "ritz.h5"]),
    ("plot_motions.py", "modes", ["--task", "1", "--points", "0", "7", "--plane", "q1", "v1"]),
    ("plot_curves.py", "curves", []),
    ("plot_curves.py", "several_curves", []),
    ("plot_curves.py", "several_curves", ["--tasks", "1"]),
]

# script, file, words of the message
REFUSALS = [
    ("plot_modes.py", "absent.h5", "no such file"),
    ("plot_sweep.py", "text.h5", "not a readable result"),
    ("plot_map.py", "truncated.h5", "not a readable result"),
    ("plot_approach.py", "foreign.h5", "not a result of kind orbits"),
    ("plot_map.py", "family.h5", "1 swept parameters (model.gamma), this figure needs 2"),
    ("plot_sweep.py", "grid.h5", "2 swept parameters (orbit.period, model.gamma), this figure needs 1"),
    ("plot_modes.py", "stateless.h5", "no /orbits/q"),
    ("plot_approach.py", "family.h5", "0 tasks with the outcome grazing"),
    ("plot_multipliers.py", "family.h5", "no /orbits/multipliers in it (the study did not ask for orbit.multipliers)"),
    ("plot_stability.py", "grid.h5", "no /orbits/stable in it (the study did not ask for orbit.stable)"),
    ("plot_stability.py", "stable.h5", "1 swept parameters (model.gamma), this figure needs 2"),
    ("plot_lyapunov.py", "family.h5", "not a result of kind trajectory"),
    ("plot_branch.py", "family.h5", "not a result of kind branch"),
    ("plot_laws.py", "family.h5", "not a branch with branch.states: true"),
    ("plot_laws.py", "branches.h5", "not a branch with branch.states: true"),
    ("plot_branch.py", "unborn.h5", "no branch of it begins (failed_start)"),
    ("plot_frequency_energy.py", "family.h5", "not a result of kind branch"),
    ("plot_manifold.py", "branch.h5", "no /branch/point_history_q in it (the study did not ask for branch.samples)"),
    ("plot_motions.py", "unborn.h5", "no /branch/point_history_q in it"),
    ("plot_curves.py", "family.h5", "not a result of kind branch"),
    ("plot_ritz.py", "family.h5", "not a result of kind orbits with method: ritz"),
    ("plot_curves.py", "branch.h5", "no /branch/curve_special in it (the study did not ask for branch.trace)"),
]


def run_studies(binary, folder, studies):
    for name, text in studies.items():
        study = os.path.join(folder, name + ".yaml")
        with open(study, "w", encoding="utf-8") as file:
            file.write(text)
        subprocess.run(
            [binary, "run", study, "-o", os.path.join(folder, name + ".h5"), "--progress", "never"],
            check=True,
            capture_output=True,
            timeout=60,
        )


def break_rows(source, target, rows):
    """A copy in which some tasks failed: their numbers are NaN, as the program writes them."""
    with h5py.File(source, "r") as old, h5py.File(target, "w") as new:
        for group in ("orbits", "sweep", "special"):
            if group in old:
                old.copy(group, new)
        for name in ("title", "study"):
            new.attrs[name] = old.attrs[name]
        orbits = new["orbits"]
        kinds = h5py.check_enum_dtype(orbits["outcome"].dtype)
        for i, row in enumerate(rows):
            orbits["outcome"][row] = kinds[("failed", "singular", "not_converged", "resonant")[i % 4]]
            for column in orbits.values():
                if column.dtype.kind in "fc":
                    column[row] = np.nan


def make_files(folder):
    at = lambda name: os.path.join(folder, name)  # noqa: E731
    break_rows(at("poles.h5"), at("broken.h5"), [0, 5, 6, 40, 41, 80, 120])
    break_rows(at("falling.h5"), at("nothing.h5"), range(4))
    break_rows(at("stable.h5"), at("broken_stable.h5"), [0, 7, 20, 50])
    break_rows(at("grid.h5"), at("broken_grid.h5"), [3, 20, 21, 62])
    with open(at("text.h5"), "w", encoding="utf-8") as file:
        file.write("no HDF5\n")
    with open(at("family.h5"), "rb") as whole, open(at("truncated.h5"), "wb") as part:
        part.write(whole.read(3000))
    with h5py.File(at("foreign.h5"), "w") as file:
        file["numbers"] = np.arange(3)


def call(scripts, folder, script, name, *options):
    return subprocess.run(
        [os.path.join(scripts, script), name, *options],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
    )


def check_files(stem):
    with open(stem + ".png", "rb") as file:
        assert file.read(8) == b"\x89PNG\r\n\x1a\n", "no PNG signature"
    pixels = matplotlib.image.imread(stem + ".png")
    assert pixels.shape[1] >= 1000, f"{pixels.shape[1]} pixels wide"
    colours = len(np.unique((pixels[::3, ::3, :3] * 16).astype(int).reshape(-1, 3), axis=0))
    assert colours >= 8, f"only {colours} colours: blank?"
    border = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])[:, :3]
    assert (border == 1).all(), "something is cut off at the border"
    root = xml.etree.ElementTree.parse(stem + ".svg").getroot()
    assert root.tag.endswith("svg") and len(list(root.iter())) > 50, "an empty SVG"


def figure_is_drawn(scripts, folder, script, name, options):
    stem = os.path.join(folder, "_".join([script[:-3], name] + [option.strip("-") for option in options]))
    done = call(scripts, folder, script, name + ".h5", "-o", stem, *options)
    assert done.returncode == 0 and done.stderr == "", f"exit {done.returncode}: {done.stderr}"
    assert done.stdout.split() == [stem + ".png", stem + ".svg"], done.stdout
    check_files(stem)


def default_names_stand_beside_the_result(scripts, folder):
    done = call(scripts, "/", "plot_modes.py", os.path.join(folder, "family.h5"))
    assert done.returncode == 0, done.stderr
    check_files(os.path.join(folder, "family_modes"))


def refusal_is_one_line(scripts, folder, script, name, words):
    before = set(os.listdir(folder))
    others = ["--impacts", "rigid_states.h5"] if script == "plot_laws.py" else []
    done = call(scripts, folder, script, name, "-o", "refused_" + script, *others)
    assert done.returncode == 2, f"exit {done.returncode}"
    assert done.stderr.count("\n") == 1 and done.stderr.startswith(f"{script}: {name}: "), done.stderr
    assert words in done.stderr, done.stderr
    assert not [new for new in set(os.listdir(folder)) - before if new.startswith("refused_" + script)]


def unwritable_output_is_one_line(scripts, folder):
    done = call(scripts, folder, "plot_sweep.py", "family.h5", "-o", "no/such/folder/figure")
    assert (
        done.returncode == 2 and done.stderr.count("\n") == 1 and "cannot write" in done.stderr
    ), done.stderr


def help_names_the_datasets(scripts, folder, script):
    done = call(scripts, folder, script, "--help")
    table = {
        "plot_lyapunov.py": "trajectory/outcome",
        "plot_branch.py": "branch/outcome",
        "plot_curves.py": "branch/outcome",
        "plot_frequency_energy.py": "branch/outcome",
        "plot_manifold.py": "branch/point_history_q",
        "plot_motions.py": "branch/point_history_q",
        "plot_ritz.py": "orbits/ritz_functions",
        "plot_laws.py": "branch/point_parameter",
    }.get(script, "orbits/outcome")
    assert (
        done.returncode == 0 and f"/{table}" in done.stdout and "--output" in done.stdout
    ), done.stdout


def cases(scripts, folder):
    yield from ((figure_is_drawn, scripts, folder, *figure) for figure in FIGURES)
    yield from ((refusal_is_one_line, scripts, folder, *refusal) for refusal in REFUSALS)
    yield (default_names_stand_beside_the_result, scripts, folder)
    yield (unwritable_output_is_one_line, scripts, folder)
    for script in sorted({figure[0] for figure in FIGURES}):
        yield (help_names_the_datasets, scripts, folder, script)


def passes(case):
    test, _scripts, _folder, *rest = case
    try:
        test(*case[1:])
    except Exception:  # a test that breaks is a test that fails; the others still run
        print(f"FAILED {test.__name__} {rest}\n{traceback.format_exc()}", flush=True)
        return False
    return True


def main():
    if len(sys.argv) != 3:
        print(__doc__.splitlines()[0], file=sys.stderr)
        return 2
    binary, scripts = os.path.abspath(sys.argv[1]), os.path.abspath(os.path.join(sys.argv[2], "scripts"))
    with tempfile.TemporaryDirectory() as folder:
        run_studies(binary, folder, STUDIES)
        make_files(folder)
        with ThreadPoolExecutor(2) as pool:
            outcomes = list(pool.map(passes, cases(scripts, folder)))
    print(f"{sum(outcomes)} passed, {len(outcomes) - sum(outcomes)} failed")
    return 0 if all(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
