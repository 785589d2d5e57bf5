"""Figures of results of kind grazing: what they draw, and what they cannot draw."""

import numpy as np
import pytest
from album import assert_among, column
from both import test_all_of_it_fits, test_refusals_say_what_is_missing  # noqa: F401  # of PICTURES and REFUSALS
from matplotlib.colors import to_rgba
from shelf import altered, put_text

import ricochet
from ricochet.plot import look

OSCILLATOR = """kind: grazing
title: {title}
model: {{type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: {damping},
        force: 0.05, frequency: {frequency}}}
orbit: {{motion: forced}}
branch: {{parameter: model.force, from: 0.05, to: {to}{branch}}}
grazing: {{coefficients: 16, windows: {windows}}}
"""
FREQUENCIES = "sweep: {{parameter: model.frequency, values: [{}]}}\n"


def oscillator(title, damping, frequency=4, to=500, branch="", windows=0, sweep=""):
    text = OSCILLATOR.format(
        title=title, damping=damping, frequency=frequency, to=to, branch=branch, windows=windows
    )  # fmt: skip
    return text + (FREQUENCIES.format(sweep) if sweep else "")


def traced(low, high):
    return (
        f", scale: log, trace: {{parameter: model.frequency, low: {low}, high: {high}, step_most: 0.05, points: 900}}"
    )


SERIES = """kind: grazing
title: masses in series
model: {type: duffing_chain, particles: 2, restitution: 0.8, stiffness: [2, 1], damping: [3, 1], wall: 1, force: 0.1,
        frequency: 3}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.1, to: 1000, scale: log}
grazing: {windows: 12}
sweep:
  - {parameter: "model.damping[1]", values: [1, 3]}
  - {parameter: model.frequency, from: 0.5, to: 5, points: 7}
"""
FIVE = """kind: grazing
title: five masses
model: {type: chain, particles: 5, ends: fixed, gamma: 0.1, damping: 3, restitution: 0.8, floor: null,
        wall: [null, null, null, null, 1], force: 0.1, frequency: 2}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.1, to: 1000, scale: log}
grazing: {coefficients: 12, windows: 0}
"""
STUDIES = {
    "regimes": oscillator("three regimes", 3, windows=16, sweep="6, 4, 1.5"),
    "light": oscillator("light damping", 0.1, frequency=1.1, branch=traced(0.75, 2.5), windows=4),
    "heavy": oscillator("heavy damping", 3, branch=traced(2, 6), windows=4),
    "series": SERIES,
    "five": FIVE,
    "far": oscillator("far from the wall", 3, to=1),
    "sparse": oscillator("one of two grazes", 3, to=30, windows=6, sweep="4, 40"),
}


def no_direction(file):
    file["grazing/xi"][...] = 0


def undecided(file):
    """A c_0 that is zero within the tolerance."""
    file["grazing/verdict"][0] = 2
    put_text(file, "grazing/verdict_reason", 0, b"c_0 is zero within $tolerance")


MADE = {"still": altered("heavy", no_direction), "undecided": altered("heavy", undecided)}

# figure, result, options
PICTURES = [
    ("criterion", "regimes", {"task": 1}),
    ("criterion", "light", {}),
    ("criterion", "five", {}),
    ("criterion", "undecided", {}),
    ("criterion", "series", {"task": 1, "style": {"column": True}}),
    ("grazing-curve", "light", {}),
    ("grazing-curve", "heavy", {"style": {"column": True}}),
    ("grazing-windows", "regimes", {}),
    ("grazing-windows", "series", {}),
    ("grazing-windows", "series", {"tasks": [9], "style": {"column": True}}),
    ("grazing-windows", "sparse", {}),
]
# figure, result, options, words of the message
REFUSALS = [
    ("criterion", "far", {}, "no grazing point in it (none)"),
    ("criterion", "regimes", {"task": 3}, "it has no task 3, only tasks 0 to 2"),
    ("criterion", "sparse", {"task": 1}, "task 1 has no continuous or discontinuous or undecided grazing bifurcation"),
    ("criterion", "still", {}, "xi of task 0 has no direction"),
    ("grazing-windows", "light", {}, "no continuous grazing bifurcation in it, only discontinuous"),
    ("grazing-windows", "series", {"tasks": [0]}, "task 0 has no continuous grazing bifurcation"),
    ("grazing-windows", "five", {}, "it has no grazing/window_period (the study did not ask for grazing.windows)"),
    ("grazing-curve", "regimes", {}, "it has no grazing/curve (the study did not ask for branch.trace)"),
]


def test_every_grazing_point_is_a_figure_of_its_own(results):
    spec = ricochet.plot.CATALOGUE["criterion"]
    with ricochet.open(results["sparse"]) as one, ricochet.open(results["series"]) as all_graze:
        assert list(spec.parts(one)) == [0] and list(spec.parts(all_graze)) == list(range(14))


# --- the criterion ---


@pytest.mark.parametrize("name, task", [("regimes", 0), ("regimes", 2), ("series", 3), ("light", 0)])
def test_criterion_has_the_coefficients_over_the_powers_of_the_multiplier(picture, results, name, task):
    right = picture("criterion", name, task=task).axes[1]
    heads = next(marks.get_offsets() for marks in right.collections if len(marks.get_offsets()) > 1)
    c, size = (
        column(results[name], "grazing/coefficient")[task],
        np.abs(column(results[name], "grazing/multiplier")[task]),
    )
    i = np.arange(len(heads))
    assert len(heads) == min(13, len(c)) and (heads[:, 0] == i).all()
    assert np.allclose(heads[:, 1], c[i] / size**i, rtol=1e-12)
    alpha = column(results[name], "grazing/alpha")[task]
    levels = [line.get_ydata()[0] for line in right.lines if len(set(line.get_ydata())) == 1]
    assert (alpha in levels) == np.isfinite(alpha)


@pytest.mark.parametrize("name, task", [("regimes", 1), ("series", 3), ("series", 5), ("light", 0), ("five", 0)])
def test_arrows_point_behind_the_plane_where_coefficients_are_negative(picture, results, name, task):
    left = picture("criterion", name, task=task).axes[0]
    tips = np.array([text.xy for text in left.texts if getattr(text, "arrow_patch", None)])
    first = column(results[name], "grazing/first_negative")[task]
    signs = np.sign(column(results[name], "grazing/coefficient")[task, : len(tips)])
    assert len(tips) >= 5 and first < 8
    assert (np.sign(tips[:, 0]) == signs).all()
    assert np.hypot(*tips.T).max() == pytest.approx(1) and np.hypot(*tips.T).min() >= 0.299


def test_arrows_follow_the_iterates_where_nothing_is_stretched(picture, results):
    """One particle: the section has two coordinates, and the picture is the plane itself but for the lengths."""
    left = picture("criterion", "light").axes[0]
    tips = np.array([text.xy for text in left.texts if getattr(text, "arrow_patch", None)])
    eta, L, x = (column(results["light"], f"grazing/{name}")[0] for name in ("eta", "L", "xi"))
    across = eta / np.linalg.norm(eta)
    for tip in tips:
        assert tip[0] / np.hypot(*tip) == pytest.approx(across @ x / np.linalg.norm(x), abs=1e-12)
        x = L @ x


def test_criterion_says_where_it_grazes_and_what_follows(picture, results):
    force = column(results["regimes"], "grazing/parameter")[1]
    about, system = picture("criterion", "regimes", task=1).heading[1:3]
    assert about == "continuous grazing bifurcation: windows of rising periods with chaos between them"
    assert system.startswith("one particle, damping $3$, wall at $1$, restitution $0.8$,")
    assert (
        rf"$\omega = 4$, force = ${force:.6g}$" in system and r"$\lambda = 0.5488$" in system and "$A_g = 16$" in system
    )
    assert "$c_{0} < 0$, another impact after one return" in picture("criterion", "light").heading[1]
    assert (
        "undecided grazing bifurcation: c_0 is zero within \\$tolerance" in picture("criterion", "undecided").heading[1]
    )
    heading = " ".join(picture("criterion", "five").heading)
    assert "wall of particle 4 at $1$" in heading and "dimensionless" not in heading and "none" not in heading


def test_legend_of_the_criterion_names_what_is_drawn(picture, results):
    first = column(results["series"], "grazing/first_negative")[3]
    value = column(results["series"], "grazing/coefficient")[3, first]
    assert picture("criterion", "series", task=3).legend == [
        "$c_i > 0$", f"first negative one, $c_{{{first}}} = {value:.3g}$", "later $c_i < 0$", "impact"]  # fmt: skip
    alpha = column(results["regimes"], "grazing/alpha")[1]
    assert picture("criterion", "regimes", task=1).legend == [
        "$c_i > 0$", rf"$\alpha = {alpha:.3g}$, the limit", r"proved positive for $i \geq 0$",
        r"eigenvector $\zeta$ of $\lambda$", "impact"]  # fmt: skip


def test_what_is_proved_beyond_the_stored_coefficients_is_a_note(picture, results):
    settled = column(results["five"], "grazing/settled")[0]
    drawn = picture("criterion", "five")
    assert settled >= 12 and rf"proved positive for $i \geq {settled}$" in drawn.notes
    assert not any("proved" in label for label in drawn.legend)


# --- curves ---


@pytest.mark.parametrize("name", ["light", "heavy"])
def test_curve_goes_through_all_points(picture, results, name):
    drawn = picture("grazing-curve", name)
    wanted = np.column_stack([column(results[name], f"grazing/curve_{of}") for of in ("second", "parameter")])
    lines = np.concatenate([line.get_xydata() for line in drawn.axes[0].lines if line.get_linestyle() == "-"])
    assert_among(wanted, lines)
    assert_among(lines, wanted)
    assert drawn.axes[0].get_ylabel() == "amplitude of the force"
    assert drawn.axes[-1].get_xlabel() == r"frequency $\omega$ of the force"


def test_curve_marks_where_a_coefficient_changes_its_sign(picture, results):
    path, axes = results["light"], picture("grazing-curve", "light").axes[0]
    changed = column(path, "grazing/curve_change") >= 0
    wanted = np.column_stack([column(path, f"grazing/curve_{of}")[changed] for of in ("second", "parameter")])
    marks = np.concatenate([line.get_xydata() for line in axes.lines if line.get_marker() in ("D", "o")])
    assert changed.sum() > 20 and len(marks) == changed.sum() + 1  # and where the curve begins
    assert_among(wanted, marks)
    counted = [line for line in axes.lines if line.get_marker() == "D"]
    assert f"the first negative $c_i$ changes ({len(counted)})" in picture("grazing-curve", "light").legend


def test_lower_panel_counts_the_returns_until_another_impact(picture, results):
    path = results["light"]
    regular = column(path, "grazing/curve_change") < 0
    first = column(path, "grazing/curve_first_negative")
    shown = picture("grazing-curve", "light").offsets(1)
    some = regular & (first >= 0)
    assert_among(np.column_stack([column(path, "grazing/curve_second")[some], first[some] + 1.0]), shown)
    assert len(picture("grazing-curve", "heavy").axes) == 1  # continuous everywhere


def test_curve_is_compared_with_the_closed_form(picture, results):
    force, w = (column(results["heavy"], f"grazing/curve_{of}") for of in ("parameter", "second"))
    far = np.max(np.abs(force / np.hypot(1 - w**2, 3 * w) - 1))
    assert far < 1e-9
    digit, power = f"{far:.0e}".split("e")
    words = rf"relative distance from the closed form of grazing: at most ${digit}\cdot 10^{{{int(power)}}}$"
    assert words.replace("1\\cdot ", "") in picture("grazing-curve", "heavy").notes.replace("1\\cdot ", "")


# --- windows ---


def bars(axes, colour):
    """[bar, 2, 2]: lower left and upper right corners of filled areas of a colour."""
    areas = [area for area in axes.collections if to_rgba(colour) in map(tuple, area.get_facecolor())]
    return np.array([[v.min(axis=0), v.max(axis=0)] for area in areas for v in [area.get_paths()[0].vertices]])


def test_windows_are_bars_between_their_edges(picture, results):
    panels = picture("grazing-windows", "regimes").axes[::2]
    names = ("period", "exists", "low_d", "high_d")
    tasks = zip(*(column(results["regimes"], f"grazing/window_{name}") for name in names))
    shown = 0
    for axes, (period, exists, low, high) in zip(panels, tasks):
        exists = exists.astype(bool)
        closed = exists & np.isfinite(high)
        drawn = bars(axes, look.BLUE)
        assert len(drawn) == exists.sum()
        assert_among(np.column_stack([low[closed], high[closed]]), drawn[:, :, 0])
        assert (np.abs(drawn[:, :, 1].mean(axis=1) - period[exists]) < 0.2).all()
        shown += len(drawn)
    assert len(panels) == 3 and shown > 10


def test_predictions_of_the_limit_map_lie_under_the_bars(picture, results):
    low, high = (column(results["regimes"], f"grazing/predicted_{of}_d") for of in ("flip", "border"))
    panels = picture("grazing-windows", "regimes").axes[::2]
    for task, axes in enumerate(panels):
        born = low[task] < high[task]
        drawn = bars(axes, look.ORANGE)
        assert len(drawn) == born.sum() and (task == 0) == (born.sum() == 0)
        if born.any():
            assert_among(np.column_stack([low[task], high[task]])[born], drawn[:, :, 0])
        crosses = [line for line in axes.lines if line.get_marker() == "x"]
        assert len(crosses) == (~born & np.isfinite(low[task])).sum()


def test_strip_counts_stable_orbits(picture, results):
    """At points between its edges, where windows of all periods are known."""
    colours = {to_rgba(colour): k for k, colour in enumerate(("#ffffff", "#cfe3f1", "#2f78b0"))}
    exists, low, high = (column(results["series"], f"grazing/window_{of}") for of in ("exists", "low_d", "high_d"))
    strip = picture("grazing-windows", "series", tasks=[9]).axes[1]
    areas = [patch for patch in strip.patches if patch.get_facecolor() in colours]
    for area in areas:
        ends = area.get_xy()[:, 0]
        d = np.sqrt(ends.min() * ends.max())
        stable = (exists[9].astype(bool) & (low[9] < d) & (d < high[9])).sum()
        assert colours[area.get_facecolor()] == stable
    assert len(areas) > 5


def test_legend_of_windows_has_whole_phrases(picture):
    assert picture("grazing-windows", "regimes").legend == [
        "window: orbit admissible and stable",
        "end of a window: border collision",
        "end of a window: period doubling",
        "window predicted by the limit map",
        "limit map: orbit never stable",
        "strip: no such orbit is stable",
        "strip: one such orbit is stable",
        "strip: two such orbits are stable: windows overlap",
        "strip: longer periods, not computed",
    ]


def test_windows_say_which_tasks_are_left_out(picture):
    assert picture("grazing-windows", "regimes").notes == ""
    drawn = picture("grazing-windows", "series")
    assert len(drawn.axes) == 10
    assert "5 of 7 tasks with windows are drawn; --tasks picks others" in drawn.notes
    assert "7 tasks without a continuous grazing bifurcation" in drawn.notes
    assert "1 task without a continuous grazing bifurcation" in picture("grazing-windows", "sparse").notes


def test_panels_of_windows_name_their_task_and_regime(picture):
    titles = [axes.get_title(loc="left") for axes in picture("grazing-windows", "regimes").axes[::2]]
    assert titles[0] == r"$\omega = 6$, $\lambda = 0.6703$: chaos as $d \to 0$"
    assert "overlapping windows of rising periods" in titles[2]
    assert picture("grazing-windows", "regimes").labels(-1)[0] == "$d$, by which the motion would pass the obstacle"
