"""Figures of results of kind branch: branches, curves of special points, nonlinear modes and their motions."""

import re

import numpy as np
import pytest
from album import assert_among, column, counts
from both import test_all_of_it_fits, test_refusals_say_what_is_missing  # noqa: F401  # of PICTURES and REFUSALS
from matplotlib.colors import to_rgb
from shelf import FAMILY, altered

import ricochet

FORCED = """kind: branch
title: through grazing
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 0.2, cross: true}
"""
RING = """kind: branch
title: {title}
model: {{type: chain, particles: 6, ends: periodic, gamma: 0, floor: -1{hertz}}}
orbit: {{period: 1.5 pi, at_start: [3]}}
branch: {{parameter: model.gamma, from: 0, to: {to}, states: true}}
"""
STUDIES = {
    "family": FAMILY,
    "forced": FORCED,
    "returning": """kind: branch
title: a Duffing oscillator beside a wall, through resonance
model: {type: duffing_chain, particles: 1, mass: 1, stiffness: 1, cubic: 0.5, damping: 0.1, wall: 1, restitution: 0.8,
        force: 0.3, frequency: 0.6}
orbit: {motion: forced}
branch: {parameter: model.frequency, from: 0.6, to: 2.5, cross: true, segments: 8}
""",
    "driven": FORCED.replace("cross: true", "cross: true, samples: 33"),
    "rigid": RING.format(title="under the impact law", hertz="", to=0.19),
    "soft": RING.format(title="under Hertz's law", hertz=", hertz: 100", to=0.15),
    "curves": """kind: branch
title: grazing, a fold and a period doubling
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 1.1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 20, scale: log, cross: true,
         trace: {parameter: model.frequency, low: 0.3, high: 3}}
""",
    "several_curves": """kind: branch
title: grazing at several dampings, frequency followed
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: -1, restitution: 0.8, force: 0.3}
orbit: {motion: forced}
branch: {parameter: model.frequency, from: 0.6, to: 1.5,
         trace: {parameter: model.force, low: 0.1, high: 2, first_low: 0.5}}
sweep: {parameter: model.damping, values: [0.05, 0.1, 0.2]}
""",
    "modes": """kind: branch
title: two masses before a wall
model: {type: duffing_chain, particles: 2, mass: 1, stiffness: [3, 1], cubic: [0, 0], wall: 2}
orbit: {mode: 0}
branch: {parameter: orbit.energy, from: 0.1, to: 3, step_most: 0.2, cross: true, samples: 31}
sweep: {parameter: "model.cubic[1]", values: [0, 0.1, 0.2]}
""",
    "branches": """kind: branch
title: several stiffnesses
model: {type: chain, particles: 4, ends: periodic, gamma: 0, floor: -1, hertz: 100}
orbit: {period: 1.5 pi, at_start: [2]}
branch: {parameter: model.gamma, from: 0, to: 0.15}
sweep: {parameter: model.hertz, from: 100, to: 1e5, points: 9, scale: log}
""",
    "logarithmic": """kind: branch
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


def _no_motion(file):
    """No point of the branch is a motion."""
    kinds = file["branch/point_outcome"].dtype
    file["branch/point_outcome"][:] = np.full(len(file["branch/point_outcome"]), 1, dtype=kinds)


MADE = {"no_motion": altered("forced", _no_motion)}
COLUMN = {"column": True}

# figure, result, options
PICTURES = [
    ("branch", "forced", {}),
    ("branch", "forced", {"all": True}),
    ("branch", "forced", {"style": COLUMN}),
    ("branch", "no_motion", {"all": True}),
    ("branch", "rigid", {"y": "multiplier_max"}),
    ("branch", "branches", {}),
    ("branch", "branches", {"y": "amplitude", "tasks": [0, 8]}),
    ("branch", "logarithmic", {"y": "period"}),
    ("branch", "modes", {"x": "amplitude", "y": "frequency"}),
    ("frequency-energy", "modes", {}),
    ("frequency-energy", "modes", {"style": COLUMN}),
    ("frequency-energy", "modes", {"tasks": [2], "resonances": True, "all": True}),
    ("manifold", "modes", {}),
    ("manifold", "modes", {"style": COLUMN}),
    ("manifold", "modes", {"task": 2, "x": "q0", "y": "q1", "z": "v1", "energy_high": 2.0}),
    ("motions", "modes", {}),
    ("motions", "modes", {"style": COLUMN, "points": [3]}),
    ("motions", "modes", {"task": 1, "points": [0, 7], "x": "q1", "y": "v1"}),
    ("curves", "curves", {}),
    ("curves", "curves", {"style": COLUMN}),
    ("curves", "several_curves", {"all": True}),
    ("curves", "several_curves", {"tasks": [1], "all": True}),
]
# figure, result, options, words of the message
REFUSALS = [
    ("branch", "family", {}, "a figure of kind branch, this result is of kind orbits"),
    ("branch", "unborn", {}, "no branch of it begins (failed_start)"),
    ("branch", "no_motion", {}, "no motion of it is admissible; --all draws the others, too"),
    ("branch", "forced", {"y": "speed"}, "there is no quantity speed; there are parameter, energy, amplitude"),
    ("branch", "logarithmic", {"y": "multiplier_max"}, "the multiplier_max is not known of any point"),
    ("branch", "branches", {"tasks": [9]}, "there is no task 9; it has tasks 0 to 8"),
    ("frequency-energy", "unborn", {}, "no branch of it begins (failed_start)"),
    ("manifold", "forced", {}, "it has no branch/point/history_q (the study did not ask for branch.samples)"),
    ("manifold", "modes", {"z": "q2"}, "there is no component q2; there are q0 to q1 and v0 to v1"),
    ("manifold", "modes", {"energy_high": 0.01}, "no motion of task 0 up to the energy 0.01 is admissible"),
    ("motions", "modes", {"task": 3}, "there is no task 3; it has tasks 0 to 2"),
    ("motions", "modes", {"points": [99]}, "there is no point 99 of the task"),
    ("curves", "forced", {}, "it has no branch/curve (the study did not ask for branch.trace)"),
    ("laws", "branches", {}, "it has no branch/point/q (the study did not ask for branch.states)"),
    ("laws", "soft", {}, "figure laws needs a second result, of the chain with rigid floors: --impacts"),
]


def test_the_heading_says_which_particle_hits(picture):
    assert "particle 3 hits" in picture("branch", "rigid").heading[-1]
    assert "hit" not in " ".join(picture("branch", "forced").heading)


def test_natural_figures_are_those_that_one_wants(results):
    wanted = {"forced": ["branch"], "curves": ["branch", "curves"], "soft": ["branch"]}
    wanted["modes"] = ["frequency-energy", "manifold", "motions"]
    for name, names in wanted.items():
        with ricochet.open(results[name]) as result:
            found = [spec.name for spec in ricochet.plot.figures_of(result) if spec.natural(result)]
        assert sorted(found) == names


# --- what is read and drawn ---


def admissible(path):
    return np.isin(column(path, "branch/point_outcome"), ("admissible", "grazing"))


def rows_of(path, what, task):
    first, last = column(path, f"branch/{what}_offset")[task : task + 2]
    return slice(first, last)


def places(path, what, x="parameter", y="energy", rows=slice(None)):
    """Points or special points in the plane of two quantities [row, 2]."""
    return np.column_stack([column(path, f"branch/{what}_{name}")[rows] for name in (x, y)])


def marks(axes):
    """Places of the markers [marker, 2]."""
    found = [line.get_xydata() for line in axes.lines if line.get_linestyle() == "None"]
    return np.concatenate([np.empty((0, 2)), *found])


def pixels(axes, points):
    return axes.transData.transform(points)


# --- branches ---


@pytest.mark.parametrize("name, y", [("forced", "amplitude"), ("branches", "energy")])
def test_branch_goes_through_all_points_and_special_points(picture, results, name, y):
    drawn = picture("branch", name, all=True).points()
    for what in ("point", "special"):
        assert_among(places(results[name], what, y=y), drawn)


def test_branch_of_forced_motions_shows_the_amplitude(picture):
    drawn = picture("branch", "forced")
    assert drawn.labels() == ("amplitude of the force", "amplitude, the largest $|q_i|$ over the period")
    system = r"one particle, damping $0.1$, $\omega = 1$, wall at $1$, restitution $0.8$"
    assert drawn.heading == ["through grazing", system]
    assert picture("branch", "soft").labels() == (r"coupling $\gamma$", "energy $E$")


def test_branch_leaves_out_stretches_that_are_not_admissible(picture, results):
    drawn, path = picture("branch", "forced"), results["forced"]
    sound, points = admissible(path), places(path, "point", y="amplitude")
    assert sound.sum() == 75
    assert_among(points[sound], drawn.points())
    assert not set(map(tuple, points[~sound].tolist())) & set(map(tuple, drawn.points().tolist()))
    assert drawn.notes == "49 points on stretches that are not admissible: not drawn; --all draws them"
    low, high = drawn.axes[0].get_ylim()
    assert low < points[sound, 1].min() and points[sound, 1].max() < high < 1.1 * points[sound, 1].max()
    assert "not admissible" in picture("branch", "forced", all=True).legend


def test_special_points_of_what_is_not_admissible_are_left_out(picture, results):
    """Of a mode through the wall the file has period doublings."""
    path = results["modes"]
    kinds = counts(column(path, "branch/special_kind"))
    tasks, bad = np.diff(column(path, "branch/special_offset")), ~admissible(path)
    at = column(path, "branch/special_point") + np.repeat(column(path, "branch/point_offset")[:-1], tasks)
    hidden = counts(column(path, "branch/special_kind")[bad[at] & bad[at + 1]])
    assert hidden == {"period_doubling": 2}
    few, many = (picture("branch", "modes", all=all) for all in (False, True))
    assert f"period doubling ({kinds['period_doubling']})" in many.legend
    assert f"period doubling ({kinds['period_doubling'] - 2})" in few.legend
    assert f"grazing ({kinds['grazing']})" in few.legend and "2 special points there: not drawn" in few.notes
    assert len(marks(few.axes[0])) == sum(kinds.values()) - 2


def test_special_points_along_which_segments_return_count_once(picture, results):
    """From the point where it loses its impact again, the Duffing oscillator's branch returns along its beginning."""
    drawn, path = picture("branch", "returning"), results["returning"]
    folds = places(path, "special", y="amplitude")[column(path, "branch/special_kind") == "fold"]
    shown = [fold for fold in folds.tolist() if fold in marks(drawn.axes[0]).tolist()]
    assert len(shown) == 4 and "fold (2)" in drawn.legend


def test_branch_changes_its_look_at_special_points(picture, results):
    """The admissible stretch ends where it grazes, the unstable one at the fold."""
    path = results["forced"]
    special = dict(zip(column(path, "branch/special_kind"), places(path, "special", y="amplitude").tolist()))
    lines = [line for line in picture("branch", "forced").axes[0].lines if len(line.get_xydata()) > 1]
    before, unstable, stable = (line.get_xydata()[[0, -1]].tolist() for line in lines)
    assert before[1] == special["grazing"] and unstable[1] == stable[0] == special["fold"]
    assert [line.is_dashed() for line in lines] == [False, True, False]


def test_crowded_special_points_are_enlarged_in_an_inset(picture, results):
    """Fold and grazing point of the driven oscillator differ by 3e-5 of the force; the unstable motions lie between."""
    drawn, path = picture("branch", "forced"), results["forced"]
    drawn.figure.draw_without_rendering()
    panel, (inset,) = drawn.axes[0], drawn.axes[0].child_axes
    special = places(path, "special", y="amplitude")
    assert np.hypot(*np.diff(pixels(panel, special), axis=0)[0]) < 2
    assert np.hypot(*np.diff(pixels(inset, special), axis=0)[0]) > 50
    assert_among(special, marks(inset))
    assert any(line.is_dashed() for line in inset.lines)


@pytest.mark.parametrize("figure, name, options", [
    ("branch", "forced", {}), ("frequency-energy", "modes", {}), ("frequency-energy", "modes", {"style": COLUMN})
])  # fmt: skip
def test_insets_lie_inside_the_panel_and_on_no_curve(picture, figure, name, options):
    drawn = picture(figure, name, **options)
    drawn.figure.draw_without_rendering()
    panel, (inset,) = drawn.axes[0], drawn.axes[0].child_axes
    box, whole = inset.get_tightbbox(drawn.figure.canvas.get_renderer()), panel.get_window_extent()
    assert whole.x0 < box.x0 and whole.x1 > box.x1 and whole.y0 < box.y0 and whole.y1 > box.y1
    for line in panel.lines:
        at = pixels(panel, line.get_xydata())
        steps = np.arange(0, len(at) - 1, 0.02) if len(at) > 1 else np.zeros(1)
        dense = np.column_stack([np.interp(steps, np.arange(len(at)), x) for x in at.T])
        assert not inset.get_window_extent().count_contains(dense)


def test_markers_on_one_another_are_rings(picture, results):
    """In the inset of the modes a period doubling lies on a grazing point and a fold."""
    (inset,) = picture("frequency-energy", "modes").axes[0].child_axes
    hollow = [line for line in inset.lines if str(line.get_markerfacecolor()) == "none"]
    solid = [line for line in inset.lines if line.get_marker() == "D"]
    assert hollow and all(line.get_markersize() > 1.3 * solid[0].get_markersize() for line in hollow)


def test_no_inset_where_special_points_lie_apart(picture):
    assert not picture("branch", "rigid").axes[0].child_axes
    assert not picture("branch", "branches").axes[0].child_axes


def test_extremes_of_the_energy_are_those_over_the_period(picture):
    """Along the coupling the energy is not extreme there."""
    drawn = picture("branch", "rigid")
    assert "$dE/dT = 0$ (1)" in drawn.legend and not any("extreme" in label for label in drawn.legend)


def test_limits_of_the_style_decide_what_is_crowded(picture):
    style = {"xlim": (0.09995, 0.10005), "ylim": (0.99999, 1.00002)}
    drawn = picture("branch", "forced", style=style)
    assert drawn.axes[0].get_xlim() == style["xlim"] and not drawn.axes[0].child_axes


def test_unknown_stability_is_in_the_legend_where_it_is_seen(picture):
    assert "stability unknown" in picture("branch", "logarithmic", y="period").legend
    for figure, name in (("branch", "forced"), ("frequency-energy", "modes")):  # unknown at the grazing points only
        assert "stability unknown" not in picture(figure, name).legend


def test_segments_are_named_by_their_impacts(picture):
    assert {"no impact per period", "1 impact per period"} < set(picture("branch", "forced").legend)


# --- nonlinear modes ---


def test_frequency_energy_plot_goes_through_all_motions(picture, results):
    path = results["modes"]
    wanted = np.column_stack([column(path, "branch/point_energy"), 2 * np.pi / column(path, "branch/point_period")])
    assert_among(wanted, picture("frequency-energy", "modes", all=True).points())
    drawn = picture("frequency-energy", "modes")
    assert_among(wanted[admissible(path)], drawn.points())
    assert drawn.labels() == ("energy $E$", r"frequency $2\pi/T$")
    assert drawn.axes[0].get_ylim()[1] < 1.1 * wanted[admissible(path), 1].max()
    assert "7 resonances not marked" in drawn.notes


def test_values_of_a_sweep_differ_in_colour_and_have_the_words_of_all_figures(picture):
    words = [f"cubic term of spring 1 = ${value}$" for value in ("0", "0.1", "0.2")]
    for figure in ("frequency-energy", "branch"):
        drawn = picture(figure, "modes")
        assert [label for label in drawn.legend if "cubic" in label] == words
    shades = {line.get_color() for line in drawn.axes[0].lines if line.get_linestyle() == "-"}
    apart = [np.ptp([to_rgb(one), to_rgb(other)], axis=0).max() for one in shades for other in shades if one != other]
    assert len(shades) == 3 and min(apart) > 0.3
    assert words[0] in picture("motions", "modes").heading[1]
    assert words[2] in picture("manifold", "modes", task=2).heading[1]


def test_motions_are_those_of_the_points(picture, results):
    path = results["modes"]
    drawn = picture("motions", "modes", task=1, points=[0, 7], x="q1", y="v1")
    first = rows_of(path, "point", 1).start
    q, v = (column(path, f"branch/point_history_{name}") for name in "qv")
    for k, row in enumerate((first, first + 7)):
        history, orbit = drawn.axes[2 * k : 2 * k + 2]
        assert (np.array([line.get_ydata() for line in history.lines[:2]]) == q[row].T).all()
        assert (orbit.lines[0].get_xydata() == np.column_stack([q[row, :, 1], v[row, :, 1]])).all()
    assert drawn.labels(3) == ("$q_{1}$", "$v_{1}$")


def test_motions_are_drawn_with_their_obstacles(picture):
    drawn = picture("motions", "modes")
    assert drawn.legend == ["$q_{0}$", "$q_{1}$", "first state", "wall of $q_{1}$", "wall"]
    assert "wall at $2$" in drawn.heading[2]
    assert not drawn.axes[0].patches  # q0 passes the wall of q1
    for axes in drawn.axes:  # q1 stands on every vertical axis
        assert 2.0 in [line.get_ydata()[0] for line in axes.lines if np.ptp(line.get_ydata()) == 0]
        assert axes.get_ylim()[1] > 2
    sideways = picture("motions", "modes", task=1, points=[0, 7], x="q1", y="v1").axes[1]
    assert 2.0 in [line.get_xdata()[0] for line in sideways.lines if np.ptp(line.get_xdata()) == 0]


def test_motions_name_the_parameter_and_differ_in_amplitude(picture, results):
    """The branch of a driven oscillator runs along its force; segments beyond grazing may return to its beginning."""
    drawn, path = picture("motions", "driven"), results["driven"]
    titles = [axes.get_title(loc="left") for axes in drawn.axes[::2]]
    assert all(re.match(r"force = \$[0-9.]+\$, period", title) for title in titles)
    largest = [np.abs(axes.lines[0].get_ydata()).max() for axes in drawn.axes[::2]]
    drawn_from = column(path, "branch/point_amplitude")[admissible(path)]
    assert largest[0] == pytest.approx(drawn_from.min(), rel=0.01) and largest == sorted(largest)


@pytest.mark.parametrize("style", [None, COLUMN, {"xlim": (0, 1), "ylim": (0, 1), **COLUMN}])
def test_manifold_shows_the_labels_of_its_three_axes(picture, style):
    drawn = picture("manifold", "modes", style=style)
    drawn.figure.draw_without_rendering()
    space, renderer, whole = drawn.axes[0], drawn.figure.canvas.get_renderer(), drawn.figure.bbox
    bar = drawn.axes[1].get_tightbbox(renderer)
    for axis, text in zip((space.xaxis, space.yaxis, space.zaxis), ("$q_{0}$", "$v_{0}$", "$q_{1}$")):
        box = axis.label.get_window_extent(renderer)
        assert axis.label.get_text() == text and box.width > 2
        assert 0 <= box.x0 and box.x1 <= whole.width and 0 <= box.y0 and box.y1 <= whole.height
        assert not box.overlaps(bar)


def test_manifold_has_the_admissible_motions_up_to_an_energy(picture, results):
    path = results["modes"]
    space = picture("manifold", "modes", task=2, x="q0", y="q1", z="v1", energy_high=2.0).axes[0]
    mine = np.zeros(len(column(path, "branch/point_energy")), bool)
    mine[rows_of(path, "point", 2)] = True
    rows = np.flatnonzero(mine & admissible(path) & (column(path, "branch/point_energy") <= 2))
    q, v = (column(path, f"branch/point_history_{name}") for name in "qv")
    motions = [np.stack([q[row, :, 0], q[row, :, 1], v[row, :, 1]]) for row in rows]
    drawn = [np.array(line.get_data_3d()) for line in space.lines]
    assert len(drawn) > 5
    for line in drawn:
        assert any((line == motion).all() for motion in motions)
    segments = counts(column(path, "branch/point_segment")[rows])
    faces = sum(len(surface.get_facecolor()) for surface in space.collections)
    assert faces == sum((count - 1) * (q.shape[1] - 1) for count in segments.values())


# --- curves in two parameters, and two laws of contact ---


@pytest.mark.parametrize("name, options, task", [
    ("curves", {}, None), ("several_curves", {}, None), ("several_curves", {"tasks": [1]}, 1)
])  # fmt: skip
def test_curves_go_through_all_points(picture, results, name, options, task):
    path = results[name]
    rows = slice(None) if task is None else rows_of(path, "curve", task)
    wanted = places(path, "curve", "second", "parameter", rows)
    drawn = picture("curves", name, all=True, **options)
    assert len(wanted) > 50
    assert_among(wanted, drawn.points())
    ways = [line.get_xydata() for line in drawn.axes[0].lines if line.get_linewidth() in (1.8, 1.4)]
    assert_among(np.concatenate(ways), wanted)


def test_curves_leave_out_what_is_not_admissible(picture, results):
    path = results["curves"]
    sound = np.isin(column(path, "branch/curve_outcome"), ("admissible", "grazing"))
    points, drawn = places(path, "curve", "second", "parameter"), picture("curves", "curves")
    assert_among(points[sound], drawn.points())
    assert not set(map(tuple, points[~sound].tolist())) & set(map(tuple, drawn.points().tolist()))
    assert f"{(~sound).sum()} points of the curves, not admissible: not drawn" in drawn.notes


def test_grazing_in_closed_form_is_that_of_each_task(picture, results):
    """A^2 = b^2 ((k - m w^2)^2 + c^2 w^2), of three dampings."""
    drawn = picture("curves", "several_curves", all=True)
    forms = [line.get_xydata() for line in drawn.axes[0].lines if line.get_linewidth() == 0.9]
    for damping, ways in zip((0.05, 0.1, 0.2), np.array_split(np.array(forms), 3)):
        for force, frequency in ways.transpose(0, 2, 1):
            assert np.allclose(force, np.hypot(1 - frequency**2, damping * frequency), rtol=1e-12)
    (label,) = [label for label in drawn.legend if "closed form" in label]
    assert r"\cdot 10^{-1" in label
    assert drawn.notes.startswith("from pale to dark: damping from $0.05$ to $0.2$")


def test_laws_are_compared_at_common_couplings(picture, results):
    soft, hard = results["soft"], results["rigid"]
    drawn = picture("laws", "soft", impacts=str(hard), curves=3).expect_whole()

    def shape(path, gamma):
        rows = admissible(path)
        at, q = column(path, "branch/point_parameter")[rows], column(path, "branch/point_q")[rows]
        return np.array([np.interp(gamma, at, x) for x in q.T])

    for k, gamma in enumerate(np.linspace(0, column(soft, "branch/point_parameter").max(), 3)):
        rigid, compliant = (line.get_ydata() for line in drawn.axes[0].lines[2 * k : 2 * k + 2])
        assert np.allclose(rigid, shape(hard, gamma)) and np.allclose(compliant, shape(soft, gamma))
        assert np.allclose(drawn.axes[1].lines[k].get_ydata(), compliant - rigid)
    assert "floor" in drawn.legend and "Hertz contacts $k = 100$" in drawn.heading[2]


def test_laws_refuse_branches_that_do_not_fit(picture, results):
    for other, words in (("branches", "branch/point/q"), ("modes", "along orbit.energy, this figure needs one along")):
        with pytest.raises(ricochet.ResultError, match=words):
            picture("laws", "soft", impacts=str(results[other]))
