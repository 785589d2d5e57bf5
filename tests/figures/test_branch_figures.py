"""Figures of results of kind `branch`: branches, curves of special points, nonlinear modes and their motions."""

import numpy as np
import pytest
from drawing import FAMILY, Shelf, assert_among, cases, column, computed, counts, draws, points, refuses

STUDIES = {
    "family": FAMILY,
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
}

# script, result, options
FIGURES = [
    ("plot_branch.py", "branch", []),
    ("plot_branch.py", "branch", ["--y", "multiplier_max"]),
    ("plot_branch.py", "branches", []),
    ("plot_branch.py", "branches", ["--y", "amplitude", "--tasks", "0", "8"]),
    ("plot_branch.py", "logarithmic_branch", ["--y", "period"]),
    ("plot_branch.py", "modes", ["--x", "amplitude", "--y", "frequency"]),
    ("plot_laws.py", "soft_states", ["--impacts", "rigid_states.h5", "--couplings", "3"]),
    ("plot_frequency_energy.py", "modes", []),
    ("plot_frequency_energy.py", "modes", ["--tasks", "2", "--energy-high", "2", "--resonances"]),
    ("plot_frequency_energy.py", "branch", []),
    ("plot_manifold.py", "modes", []),
    ("plot_manifold.py", "modes", ["--task", "2", "--axes", "q0", "q1", "v1", "--energy-high", "2"]),
    ("plot_motions.py", "modes", []),
    ("plot_motions.py", "modes", ["--task", "1", "--points", "0", "7", "--plane", "q1", "v1"]),
    ("plot_curves.py", "curves", []),
    ("plot_curves.py", "several_curves", []),
    ("plot_curves.py", "several_curves", ["--tasks", "1"]),
]

# script, file, options, words of the message
NOT_ASKED = "in it (the study did not ask for branch."
RIGID = ["--impacts", "rigid_states.h5"]
REFUSALS = [
    ("plot_branch.py", "family.h5", [], "not a result of kind branch"),
    ("plot_laws.py", "family.h5", RIGID, "not a branch with branch.states: true"),
    ("plot_laws.py", "branches.h5", RIGID, "not a branch with branch.states: true"),
    ("plot_branch.py", "unborn.h5", [], "no branch of it begins (failed_start)"),
    ("plot_frequency_energy.py", "family.h5", [], "not a result of kind branch"),
    ("plot_manifold.py", "branch.h5", [], f"no /branch/point_history_q {NOT_ASKED}samples)"),
    ("plot_motions.py", "unborn.h5", [], "no /branch/point_history_q in it"),
    ("plot_curves.py", "family.h5", [], "not a result of kind branch"),
    ("plot_curves.py", "branch.h5", [], f"no /branch/curve_special {NOT_ASKED}trace)"),
]


@pytest.fixture(scope="module")
def results(ricochet, shared):
    return Shelf(shared, computed(ricochet, STUDIES))


@pytest.mark.parametrize("script, name, options", cases(FIGURES))
def test_figure_is_drawn(scripts, results, folder, script, name, options):
    draws(scripts, results, folder, script, name, options)


@pytest.mark.parametrize("script, name, options, words", cases(REFUSALS))
def test_refusal_is_one_line(scripts, results, folder, script, name, options, words):
    refuses(scripts, results, folder, script, name, options, words)


def test_default_name_stands_beside_the_result(scripts, results):
    """As a process of its own."""
    path = results["branch"]
    scripts.start("plot_branch.py", path, cwd="/").expect_files(path.with_name("branch_branch"))


# --- numbers in figures ---


def admissible(path):
    return np.isin(column(path, "branch/point_outcome"), ("admissible", "grazing"))


def rows_of(path, what, task):
    first, last = column(path, f"branch/{what}_offset")[task : task + 2]
    return slice(first, last)


@pytest.mark.parametrize("name", ["branch", "branches"])
def test_branch_goes_through_all_points_and_special_points(scripts, results, name):
    path = results[name]
    (figure,) = scripts.look("plot_branch.py", path)
    drawn = points(figure.axes[0])
    for what in ("point", "special"):
        at, energy = column(path, f"branch/{what}_parameter"), column(path, f"branch/{what}_energy")
        assert_among(np.column_stack([at, energy]), *drawn.T)


def test_branch_marks_each_special_point_once(scripts, results):
    path = results["branch"]
    (figure,) = scripts.look("plot_branch.py", path)
    marks = [line.get_xydata() for line in figure.axes[0].lines if line.get_linestyle() == "None"]
    kinds = counts(column(path, "branch/special_kind"))
    assert kinds["grazing"] == 1 and sorted(map(len, marks)) == sorted(kinds.values())
    names = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert {f"{kind.replace('_', ' ')} ({count})" for kind, count in kinds.items()} <= set(names), names


def test_frequency_energy_plot_goes_through_all_points(scripts, results):
    path = results["modes"]
    (figure,) = scripts.look("plot_frequency_energy.py", path)
    wanted = np.column_stack([column(path, "branch/point_energy"), 2 * np.pi / column(path, "branch/point_period")])
    assert_among(wanted, *points(figure.axes[0]).T)


@pytest.mark.parametrize("name, options, task", [
    ("curves", [], None), ("several_curves", [], None), ("several_curves", ["--tasks", "1"], 1)
])  # fmt: skip
def test_curves_go_through_all_points(scripts, results, name, options, task):
    path = results[name]
    (figure,) = scripts.look("plot_curves.py", path, *options)
    rows = slice(None) if task is None else rows_of(path, "curve", task)
    wanted = np.column_stack([column(path, f"branch/curve_{of}")[rows] for of in ("second", "parameter")])
    assert len(wanted) > 50
    assert_among(wanted, *points(figure.axes[0]).T)
    ways = [line.get_xydata() for line in figure.axes[0].lines if line.get_linewidth() in (1.8, 1.4)]
    assert_among(np.concatenate(ways), *wanted.T)


def test_motions_are_those_of_the_points(scripts, results):
    path = results["modes"]
    (figure,) = scripts.look("plot_motions.py", path, "--task", "1", "--points", "0", "7", "--plane", "q1", "v1")
    first = rows_of(path, "point", 1).start
    q, v = (column(path, f"branch/point_history_{name}") for name in "qv")
    for k, row in enumerate((first, first + 7)):
        history, orbit = figure.axes[2 * k : 2 * k + 2]
        assert (np.array([line.get_ydata() for line in history.lines[:2]]) == q[row].T).all()
        assert (orbit.lines[0].get_xydata() == np.column_stack([q[row, :, 1], v[row, :, 1]])).all()


def test_manifold_has_the_admissible_motions_up_to_an_energy(scripts, results):
    path = results["modes"]
    (figure,) = scripts.look("plot_manifold.py", path, "--task", "2", "--axes", "q0", "q1", "v1", "--energy-high", "2")
    mine = np.zeros(len(column(path, "branch/point_energy")), bool)
    mine[rows_of(path, "point", 2)] = True
    rows = np.flatnonzero(mine & admissible(path) & (column(path, "branch/point_energy") <= 2))
    q, v = (column(path, f"branch/point_history_{name}") for name in "qv")
    motions = [np.stack([q[row, :, 0], q[row, :, 1], v[row, :, 1]]) for row in rows]
    drawn = [np.array(line.get_data_3d()) for line in figure.axes[0].lines]
    assert len(drawn) > 5
    for line in drawn:
        assert any((line == motion).all() for motion in motions)
    segments = counts(column(path, "branch/point_segment")[rows])
    faces = sum(len(surface.get_facecolor()) for surface in figure.axes[0].collections)
    assert faces == sum((count - 1) * (q.shape[1] - 1) for count in segments.values())


def test_laws_are_compared_at_common_couplings(scripts, results):
    soft, hard = results["soft_states"], results["rigid_states"]
    (figure,) = scripts.look("plot_laws.py", soft, "--impacts", hard, "--couplings", "3")

    def shape(path, gamma):
        rows = admissible(path)
        at, q = column(path, "branch/point_parameter")[rows], column(path, "branch/point_q")[rows]
        return np.array([np.interp(gamma, at, x) for x in q.T])

    low, high = (pick(column(soft, "branch/point_parameter")) for pick in (np.min, np.max))
    assert low == 0 and high == pytest.approx(0.15)
    for k, gamma in enumerate(np.linspace(low, high, 3)):
        rigid, compliant = (line.get_ydata() for line in figure.axes[0].lines[2 * k : 2 * k + 2])
        assert np.allclose(rigid, shape(hard, gamma)) and np.allclose(compliant, shape(soft, gamma))
        assert np.allclose(figure.axes[1].lines[k].get_ydata(), compliant - rigid)
