"""Figures of results of the kinds diagram and basin: what they draw, and what they cannot draw."""

import numpy as np
import pytest
from album import assert_among, column
from both import test_all_of_it_fits, test_refusals_say_what_is_missing  # noqa: F401  # of PICTURES and REFUSALS
from matplotlib.colors import to_hex, to_rgb
from shelf import altered, broken, put_text

import ricochet
import ricochet.plot

MAP = """kind: {kind}
title: {title}
model: {{type: grazing_map, {model}}}
iterate: {{{iterate}}}
{sweep}
"""
OSCILLATOR = """kind: {kind}
title: {title}
model: {{type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, {model}}}
{family}
iterate: {{{iterate}}}
sweep:
  - {sweep}
"""
PUSHED = "orbit: {motion: forced}\nbranch: {parameter: model.force, from: 1, to: 50}"
EXAMPLE = "lambda: 0.5, omega: 0.3"


def of_map(title, iterate, sweep="", model=EXAMPLE, kind="diagram"):
    return MAP.format(kind=kind, title=title, model=model, iterate=iterate, sweep=sweep and "sweep:\n  - " + sweep)


def of_oscillator(title, model, iterate, sweep, family="", kind="diagram"):
    return OSCILLATOR.format(kind=kind, title=title, model=model, iterate=iterate, sweep=sweep, family=family)


OF_D = "{parameter: model.d, from: 1e-5, to: 0.03, points: 60, scale: log"
STARTS = "{{parameter: 'iterate.start[{}]', from: -0.5, to: 0.5, points: 20}}"
OF_STARTS = "{{parameter: start.{}, from: {}, to: {}, points: 8}}"
GRID = "{parameter: model.lambda, values: [0.3, 0.5]}\n  - {parameter: model.d, from: 1e-4, to: 0.03, points: 20}"
SHORT = "transient: 500, keep: 100"
TWO = "lambda: 0.1, omega: 0.05"  # two attractors

STUDIES = {
    "plain": of_map("Figure 4", "transient: 2000, keep: 300, lyapunov: true, windows: true",
                    "{parameter: model.d, from: 5e-5, to: 0.03, points: 80}"),
    "ratios": of_map("Figure 5", "transient: 2000, keep: 300, windows: true", OF_D + "}"),
    "back": of_map("there and back", SHORT + ", follow: true", OF_D + ", back: true}", TWO),
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
                    STARTS.format(0) + "\n  - " + STARTS.format(2), TWO + ", d: 0.0156", "basin"),
    "basin_line": of_map("a line of starts", "transient: 500, start: [0, 0, 0]", STARTS.format(0),
                         TWO + ", d: 0.0156", "basin"),
    "starts": of_oscillator("starts of an oscillator", "damping: 0.1, force: 1.6, frequency: 1.8",
                            "transient: 100, period_limit: 8, measure: 20",
                            OF_STARTS.format("q", -5, 1) + "\n  - " + OF_STARTS.format("v", -4, 2), kind="basin"),
    "beyond": of_oscillator("beyond grazing", "damping: 3, force: 1, frequency: 4",
                            SHORT + ", lyapunov: true, windows: true",
                            "{parameter: grazing.beyond, from: 1e-5, to: 1e-2, points: 24, scale: log}", PUSHED),
    "over_frequency": of_oscillator("periods over two", "damping: 3, force: 1", "transient: 20, keep: 0, measure: 1",
                                    "{parameter: model.frequency, values: [1.5, 4]}\n"
                                    "  - {parameter: grazing.beyond, values: [1e-3, 1e-2]}", PUSHED),
    "impacts": of_oscillator("at impacts", "damping: 0.3, frequency: 2.5", SHORT + ", section: impact, states: true",
                             "{parameter: model.force, from: 6, to: 9, points: 8}"),
}  # fmt: skip


def some_starts_lead_nowhere(file):
    """So that the first attractor is not the largest one; one start comes to an attractor that is not listed."""
    attractor = file["basin/attractor"][()]
    attractor[np.flatnonzero(attractor == 0)[:30]] = -1
    attractor[np.flatnonzero(attractor == 0)[0]] = -2
    file["basin/attractor"][()] = attractor
    file["basin/found_tasks"][()] = [(attractor == k).sum() for k in range(len(file["basin/found_tasks"]))]


def doubles(file):
    """Periods 16 and 28 beside those of the windows; exponents that are not known."""
    period = file["diagram/attractor_period"][()]
    chaos = np.flatnonzero(period == 0)
    period[chaos[:2]] = [16, 28]
    file["diagram/attractor_period"][()] = period
    file["diagram/lyapunov"][list(chaos[-3:])] = np.nan


def many_periods(file):
    """Twenty of them, those from 12 on at one task each."""
    file["diagram/attractor_period"][()] = np.concatenate([np.repeat(np.arange(2, 12), 5), np.arange(12, 22)])


def windows_that_repeat(file):
    """Of those of the periods 5, 6, 7: one that is 4 twice over, one that is not located, one with two impacts."""
    table = {name: data[()] for name, data in file["window"].items()}
    four, five, six, seven = (np.flatnonzero(table["period"] == n)[0] for n in (4, 5, 6, 7))
    table["period"][five], table["impacts"][five] = 8, 2
    for name in ("low", "high", "parameter"):
        table[name][five] = table[name][four]
    table["low"][six] = np.nan
    table["impacts"][seven] = 2
    for name in ("period", "impacts", "low", "high", "parameter"):
        file["window"][name][()] = table[name]
    put_text(file, "window/reason", six, b"lost")


FAILURES = ("failed", "diverged")
MADE = {
    "uneven": altered("basin", some_starts_lead_nowhere),
    "doubles": altered("plain", doubles),
    "many": altered("ratios", many_periods),
    "repeats": altered("ratios", windows_that_repeat),
    "broken": broken("plain", "diagram", [0, 5, 6, 40, 79], FAILURES),
    "nothing": broken("plain", "diagram", range(80), FAILURES),
    "broken_beyond": broken("beyond", "diagram", [0, 7, 23], FAILURES),
    "broken_periods": broken("periods", "diagram", range(100, 400), FAILURES),
}

NARROW = {"style": {"column": True}}
# figure, result, options
PICTURES = [
    ("diagram", "plain", {}),
    ("diagram", "back", {}),
    ("diagram", "one", {}),
    ("diagram", "grid", {"line": 1}),
    ("diagram", "beyond", {}),
    ("diagram", "beyond", NARROW),
    ("diagram", "many", {}),
    ("scaled", "ratios", {}),
    ("scaled", "listed", {"multiplier": 0.5}),
    ("attractor", "attractor", {}),
    ("attractor", "attractor", NARROW),
    ("attractor", "dense", {}),
    ("attractor", "impacts", {"task": 3, "x": "q0", "y": "time"}),
    ("periods", "periods", NARROW),
    ("periods", "broken_periods", {}),
    ("basin", "uneven", {"x": "iterate.start[2]"}),
    ("basin", "starts", NARROW),
    ("windows", "ratios", NARROW),
    ("windows", "repeats", {}),
]
# figure, result, options, words of the message
REFUSALS = [
    ("diagram", "basin", {}, "a figure of kind diagram, this result is of kind basin"),
    ("diagram", "attractor", {}, "no parameter is swept"),
    ("diagram", "periods", {}, "it has no diagram/values (the study did not ask for iterate.keep)"),
    ("diagram", "grid", {}, "2 lines along model.d in it: say which, --line 0 to 1"),
    ("diagram", "grid", {"line": 2}, "it has no line 2, only lines 0 to 1"),
    ("diagram", "nothing", {}, "no iterate of line 0 is finite"),
    ("scaled", "beyond", {}, "a map along positive model.d, the last sweep is over grazing.beyond"),
    ("scaled", "listed", {}, "gives no lambda: say --multiplier"),
    ("scaled", "listed", {"multiplier": 2.0}, "lambda = 2"),
    ("attractor", "plain", {}, "it has no diagram/state (the study did not ask for iterate.states)"),
    ("attractor", "impacts", {}, "8 tasks in it: say which, --task 0 to 7"),
    ("attractor", "attractor", {"task": 1}, "it has no task 1, only tasks 0 to 0"),
    ("attractor", "attractor", {"x": "z1", "y": "z4"}, "no number z4, it has z1, z2, z3"),
    ("periods", "plain", {}, "1 swept parameter (model.d), this figure needs 2"),
    ("basin", "plain", {}, "of kind basin"),
    ("basin", "basin_line", {}, "this figure needs 2"),
    ("windows", "grid", {}, "it has no window (the study did not ask for iterate.windows)"),
]


def panel_of(drawn, label):
    """The panel whose vertical axis has a label that begins so."""
    return next(axes for axes in drawn.axes if axes.get_ylabel().startswith(label))


# --- diagrams ---


@pytest.mark.parametrize("name", ["falling", "listed"])
def test_diagram_is_dark_where_iterates_are(picture, results, name):
    """In the cell of an iterate, and of periodic ones in its neighbours above and below; nowhere else."""
    path = results[name]
    mesh = picture("diagram", name).axes[0].collections[0]
    corners = mesh.get_coordinates()
    x, y = corners[0, :, 0], corners[:, 0, 1]
    dark = ~np.ma.getmaskarray(mesh.get_array().reshape(len(y) - 1, len(x) - 1))
    at, values = column(path, "sweep/model.d"), column(path, "diagram/values")
    periodic = column(path, "diagram/attractor_period") > 0
    assert len(x) == len(at) + 1 and periodic.any()
    assert (np.searchsorted(x, np.sort(at)) == np.arange(1, len(x))).all()
    for cells, task in zip(dark.T, np.argsort(at)):
        filled = np.zeros(len(cells), bool)
        row = np.searchsorted(y, values[task], side="right") - 1
        if periodic[task]:
            near = row[:, None] + [-1, 0, 1]
        else:
            near = 3 * (row[:, None] // 3) + [0, 1, 2]
        filled[np.unique(near)] = True
        assert (cells == filled).all(), task


def test_a_bar_says_what_colours_mean_and_a_note_of_lines(picture):
    drawn = picture("diagram", "plain")
    assert drawn.axes[-1].get_ylabel() == "share of the iterates in a cell"
    assert "a line of an attractor of period n has 1/n of the iterates" in drawn.notes
    assert drawn.heading == ["Figure 4", "map (6.1)\u2013(6.5) of [FN97], $\\lambda = 0.5$, $\\omega = 0.3$"]


def test_diagram_has_the_exponents_of_its_line(picture, results):
    path = results["grid"]
    drawn = picture("diagram", "grid", line=1)
    rows = slice(20, 40)
    wanted = np.column_stack([column(path, "sweep/model.d"), column(path, "diagram/lyapunov")])[rows]
    assert (panel_of(drawn, "exponent").lines[0].get_xydata() == wanted).all()
    assert r"$\lambda = 0.5$" in drawn.heading[1]


def test_unknown_exponents_are_told(picture):
    assert "3 of 80 exponents are unknown" in picture("diagram", "doubles").notes
    assert "unknown" not in picture("diagram", "plain").notes


def test_failures_are_told(picture):
    assert "5 of 80 points have diverged or failed" in picture("diagram", "broken").notes
    assert "3 of 24 points have diverged or failed" in picture("diagram", "broken_beyond").notes


def test_motions_are_told_with_the_force_at_grazing(picture, results):
    drawn = picture("diagram", "beyond")
    path = results["beyond"]
    force = column(path, "diagram/parameter") / (1 + column(path, "sweep/grazing.beyond"))
    assert f"force ${force[0]:.6g}$ at grazing" in drawn.heading[-1] and "force $1$" not in drawn.heading[-1]
    at_grazing = np.sort(column(path, "diagram/map_values")[0])[[0, -1]]
    told = float(drawn.heading[-1].split("$q_{0} = ")[1].split("$")[0])
    assert np.abs(told - at_grazing).min() < 1e-3
    assert drawn.axes[0].get_ylabel().endswith(r"\,/\,\sqrt{\mu}$")
    assert drawn.axes[3].get_xlabel() == "$\\mu$ = force / its value at grazing \u2212 1"


def test_values_over_the_root_are_the_stored_ones(picture, results):
    """The extent of the axis, which is that of the values and 3 % on each side."""
    path = results["ratios"]
    values, at = column(path, "diagram/values"), column(path, "sweep/model.d")
    for whole, options in ((values / np.sqrt(at)[:, None], {}), (values, {"values": True})):
        low, high = whole.min(), whole.max()
        wanted = (low - 0.03 * (high - low), high + 0.03 * (high - low))
        assert np.allclose(picture("diagram", "ratios", **options).axes[0].get_ylim(), wanted, rtol=1e-12)


def test_there_and_back_have_colours_of_their_own(picture, results):
    drawn = picture("diagram", "back")
    assert drawn.legend == ["with rising values", "with falling values", "both"]
    assert column(results["back"], "diagram/attractor_period").ptp() > 0
    colours = {to_hex(dashes.get_color()[0]) for dashes in panel_of(drawn, "period").collections}
    assert colours == {to_hex(ricochet.plot.look.BLUE), to_hex(ricochet.plot.look.RED)}


# --- periods below diagrams ---


def dashes_of(panel):
    """{row: [first place, last place]} of the dashes of the panel of periods."""
    (dashes,) = [lines for lines in panel.collections if hasattr(lines, "get_segments")]
    return dashes, [(segment[0, 1], segment[:, 0]) for segment in dashes.get_segments()]


def test_every_period_has_its_row(picture, results):
    """Those of the tasks and of the windows, 16 and 28 beyond all others, too; dashes lie over the tasks."""
    panel = panel_of(picture("diagram", "doubles"), "period")
    named = [int(text.get_text()) for text in panel.get_yticklabels()]
    period, at = column(results["doubles"], "diagram/attractor_period"), column(results["doubles"], "sweep/model.d")
    assert set(named) == set(period[period > 0]) | set(column(results["doubles"], "window/period"))
    _, dashes = dashes_of(panel)
    for value, place in zip(period, at):
        over = {named[int(row)] for row, (first, last) in dashes if first < place < last}
        assert over == ({value} if value else set()), place


def test_periods_that_are_not_shown_are_named(picture):
    drawn = picture("diagram", "many")
    shown = len(panel_of(drawn, "period").get_yticklabels())
    assert shown == 14 and "periods 16, 17, 18, 19, 20, 21 of 6 points are not shown" in drawn.notes


def test_no_period_is_told_with_its_limit(picture):
    assert "no period up to 64 where the panel of periods is empty" in picture("diagram", "plain").notes


def test_windows_hide_no_attractor_and_no_number(picture, results):
    """Bars have a colour of their own and lie below the dashes; every bar has its number, the narrow ones, too."""
    drawn = picture("diagram", "beyond")
    panel = panel_of(drawn, "period")
    bars = [area for area in panel.collections if not hasattr(area, "get_segments")]
    dashes, _ = dashes_of(panel)
    periods = column(results["beyond"], "window/period")
    assert len(bars) == len(periods) and all(bar.get_zorder() < dashes.get_zorder() for bar in bars)
    assert sorted(int(text.get_text()) for text in panel.texts) == sorted(periods)
    faces = [to_hex(patch.get_facecolor()) for patch in drawn.figure.legends[0].get_patches()]
    assert len(faces) == len(set(faces)) == 4
    assert {"motion", "its return map", "both", "period of the attractor"} < set(drawn.legend)


def test_bars_reach_from_edge_to_edge(picture, results):
    path = results["plain"]
    panel = panel_of(picture("diagram", "plain"), "period")
    bars = [area for area in panel.collections if not hasattr(area, "get_segments")]
    ends = np.array([bar.get_paths()[0].get_extents().intervalx for bar in bars])
    edges = np.column_stack([column(path, "window/low"), column(path, "window/high")])
    edges = edges[np.argsort(column(path, "window/period"), kind="stable")]
    assert np.allclose(ends, np.clip(edges, *panel.get_xlim()), rtol=1e-12)


def test_repeated_and_lost_windows_have_no_bar(picture):
    drawn = picture("diagram", "repeats")
    panel = panel_of(drawn, "period")
    assert "windows of period 6 are not located" in drawn.notes
    assert {"window, one impact in a period", "window, other numbers of impacts"} < set(drawn.legend)
    assert sorted(int(text.get_text()) for text in panel.texts)[:2] == [4, 7]


def test_distances_are_the_stored_ones(picture, results):
    path = results["beyond"]
    distance, period = column(path, "diagram/distance"), column(path, "diagram/attractor_period")
    same = (period > 0) & (period == column(path, "diagram/map_period"))
    points = np.column_stack([column(path, "sweep/grazing.beyond"), distance])
    panel = panel_of(picture("diagram", "beyond"), "distance")
    other, filled = (line.get_xydata() for line in panel.lines[:2])
    assert same.any() and not same.all()
    assert (filled == points[same]).all() and (other == points[~same]).all()


# --- the scaled view ---


def test_scaled_view_is_that_of_the_source(picture, results):
    path = results["ratios"]
    drawn = picture("scaled", "ratios")
    at = np.log(np.sqrt(column(path, "sweep/model.d"))) / np.log(0.5)
    x = drawn.axes[0].collections[0].get_coordinates()[0, :, 0]
    assert (np.searchsorted(x, np.sort(at)) == np.arange(1, len(x))).all()
    assert drawn.labels() == ("", r"$z_{1}\,/\,\sqrt{d}$")
    assert panel_of(drawn, "period").get_xlabel() == r"$\ln\sqrt{d}\,/\,\ln\lambda$, with $\lambda = 0.5$"


# --- attractors ---


@pytest.mark.parametrize("options, pairs", [({}, [(0, 1), (0, 2), (1, 2)]), ({"x": "z3", "y": "z1"}, [(2, 0)]),
                                            ({"x": "z3"}, [(2, 0), (2, 1)])])  # fmt: skip
def test_attractor_has_all_states(picture, results, options, pairs):
    drawn = picture("attractor", "attractor", **options)
    states = column(results["attractor"], "diagram/state")[0]
    assert states.shape == (2000, 3) and len(drawn.axes) == len(pairs)
    for panel, (i, j) in enumerate(pairs):
        assert (drawn.points(panel) == states[:, [i, j]]).all()
        assert drawn.labels(panel) == (f"$z_{{{i + 1}}}$", f"$z_{{{j + 1}}}$")


def test_attractor_is_told(picture, results):
    drawn = picture("attractor", "attractor")
    exponents = column(results["attractor"], "diagram/exponents")[0]
    text = ", ".join(f"${value:.4f}$" for value in exponents)
    assert drawn.heading[-1].endswith(f"2000 iterates, no period up to 64, exponents {text} per iterate")


def test_states_at_impacts_have_a_time(picture, results):
    drawn = picture("attractor", "impacts", task=3)
    states = column(results["impacts"], "diagram/state")[3]
    assert drawn.labels() == ("time in the period of the force", "velocity $v_{0}$")
    assert (drawn.points() == states[:, [2, 1]]).all()


# --- maps of periods ---


@pytest.mark.parametrize("options", [{}, {"x": "d"}], ids=["straight", "turned"])
def test_periods_are_those_of_the_grid(picture, results, options):
    """Those up to 16 as they are, 18 is none."""
    path = results["periods"]
    drawn = picture("periods", "periods", **options)
    period = column(path, "diagram/attractor_period")
    assert set(column(path, "diagram/outcome")) == {"periodic", "aperiodic"} and period.max() <= 16
    wanted = np.where(period == 0, 18, period).reshape(40, 40) - 1
    shown = drawn.axes[0].collections[0].get_array().reshape(40, 40)
    assert (shown == (wanted if options else wanted.T)).all()
    present = sorted(set(period.tolist()) - {0})
    assert drawn.legend[: len(present) + 1] == [f"period {n}" for n in present] + ["no period up to 64"]


def test_what_diverged_has_an_entry(picture):
    assert "diverged or failed" in picture("periods", "broken_periods").legend


def test_colours_of_periods_differ(picture):
    """Of 1 and 2, and of those that follow one another in the same hue, clearly."""
    faces = [to_rgb(face) for face in picture("periods", "periods").axes[0].collections[0].get_cmap().colors[:16]]
    lightness = [np.dot(face, (0.3, 0.59, 0.11)) for face in faces]
    for one, other in zip(range(14), range(2, 16)):
        apart = np.linalg.norm(np.subtract(faces[one], faces[other]))
        assert apart > 0.14 and lightness[other] > lightness[one] + 0.02, (one + 1, other + 1)


def test_a_force_that_varies_is_told_from_where_to_where(picture, results):
    path = results["over_frequency"]
    force = column(path, "diagram/parameter") / (1 + column(path, "sweep/grazing.beyond"))
    drawn = picture("periods", "over_frequency")
    assert f"force ${force.min():.6g}$ to ${force.max():.6g}$ at grazing" in drawn.heading[-1]


# --- basins ---


@pytest.mark.parametrize("options", [{}, {"x": "iterate.start[2]"}], ids=["straight", "turned"])
def test_basins_are_those_of_the_grid(picture, results, options):
    """Attractors by falling size; 6 are those that are not listed, 7 is none."""
    path = results["uneven"]
    drawn = picture("basin", "uneven", **options)
    attractor, sizes = column(path, "basin/attractor"), column(path, "basin/found_tasks")
    rank = np.argsort(np.argsort(-sizes, kind="stable"))
    assert sizes.tolist() == [169, 200] and (attractor == -1).sum() == 30
    wanted = np.where(attractor < 0, np.where(attractor == -2, 6, 7), rank[attractor]).reshape(20, 20)
    shown = drawn.axes[0].collections[0].get_array().reshape(20, 20)
    assert (shown == (wanted if options else wanted.T)).all()
    for size, text in zip(-np.sort(-sizes), drawn.legend):
        assert f"({100 * size / 400:.3g} %)" in text
    assert drawn.legend[2:4] == ["other attractors (0.25 %)", "diverged or failed (7.5 %)"]


def test_starts_of_motions_are_told_with_their_force(picture, results):
    drawn = picture("basin", "starts")
    assert drawn.labels() == ("start $q_{0}$", "start $v_{0}$")
    assert "force $1.6$" in drawn.heading[-1]
    ends = column(results["starts"], "basin/end")
    marks = drawn.points()
    assert len(marks) >= 2 and np.abs(marks[:, None] - ends).max(axis=2).min(axis=1).max() == 0


# --- windows ---


def test_table_has_the_exact_edges(results):
    """The flip and the border of the orbits with one impact of the example map, whose z1 does not depend on z2, z3."""
    with ricochet.open(results["plain"]) as result:
        lines = [line.split() for line in ricochet.plot.window_table(result).splitlines()]
    rows = {int(words[0]): words for words in lines if words and words[0].isdigit()}
    for n in (5, 6, 7):
        c, size = 0.5 ** (n - 1), 0.5
        s = c / 2 / (1 - 3 * c)
        low = (s**2 * (1 + 3 * c) + c * s) / (1 - c * size)
        high = (1 - size) * size ** (2 * (n - 2)) / (1 - size ** (n - 2) * (3 - 2 * size)) ** 2
        assert abs(float(rows[n][2]) / low - 1) < 1e-8 and rows[n][3] == "flip", rows[n]
        assert abs(float(rows[n][5]) / high - 1) < 1e-8 and rows[n][6] == "border", rows[n]


def test_table_tells_what_is_left_out(results):
    with ricochet.open(results["repeats"]) as result:
        table = ricochet.plot.window_table(result)
    assert "not located: lost" in table
    assert "those that repeat one of these by a multiple of its period: 1" in table


def test_windows_have_the_edges_of_the_table(picture, results):
    path = results["ratios"]
    drawn = picture("windows", "ratios")
    upper = drawn.axes[0]
    period, impacts = column(path, "window/period"), column(path, "window/impacts")
    for side, marker in (("low", "v"), ("high", "^")):
        edge, kind = column(path, f"window/{side}"), column(path, f"window/{side}_kind")
        (shown,) = [line.get_xydata() for line in upper.lines if line.get_marker() == marker and line.get_zorder() == 3]
        shown = shown[np.isfinite(shown[:, 1])]
        assert len(shown) > 3 and len(set(shown[:, 0])) == len(shown)
        located = (impacts == 1) & np.isfinite(edge) & ~np.isin(kind, ("open", "regular", "none"))
        assert_among(shown, np.column_stack([period, edge])[located])
        assert set(shown[:, 0]) == set(period[located])


def test_windows_are_told(picture):
    drawn = picture("windows", "ratios")
    assert drawn.heading[1] == "edges of the windows with one impact in a period"
    assert drawn.labels() == ("", "$d$ at the edges") and drawn.labels(1)[0] == "period $n$"
    assert drawn.legend[0] == "lower edge" and drawn.legend[-1] == r"$\lambda^2 = 0.25$"
    left_out = picture("windows", "repeats").notes
    assert "1 window that repeat" in left_out and "1 window without located edges" in left_out


# --- parts ---


def test_parts_are_the_lines_and_tasks_that_can_be_drawn(results):
    figures = ricochet.plot.CATALOGUE
    with ricochet.open(results["grid"]) as grid, ricochet.open(results["impacts"]) as impacts:
        assert figures["diagram"].parts(grid) == [0, 1] and figures["windows"].parts(grid) == []
        assert figures["attractor"].parts(impacts) == list(range(8)) and figures["diagram"].parts(impacts) == [0]
    with ricochet.open(results["periods"]) as periods:
        assert figures["diagram"].parts(periods) == [0, 5, 11, 16, 22, 27, 33, 39]
        assert not figures["attractor"].natural(periods)
