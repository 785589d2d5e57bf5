"""Figures of results of kind trajectory, and their animation: what they draw, and what they cannot draw."""

import matplotlib
import numpy as np
import pytest
from album import Picture, assert_among, column
from both import test_all_of_it_fits, test_refusals_say_what_is_missing  # noqa: F401  # of PICTURES and REFUSALS
from matplotlib.colors import to_hex, to_rgba
from PIL import Image
from shelf import FAMILY, altered

import ricochet
from ricochet.plot.command import main
from ricochet.plot.trajectories.film import Film
from ricochet.plot.trajectories.motion import Motion, picked_tasks
from ricochet.plot.trajectories.phase import Portrait

MOTION = """kind: trajectory
title: {title}
model: {{type: chain, {model}}}
{start}
time: {{duration: {duration}, samples: {samples}{time}}}
"""


def motion(title, model, start, duration=30, samples=401, time="", sweep=""):
    return MOTION.format(title=title, model=model, start=start, duration=duration, samples=samples, time=time) + sweep


def driven(particles, sweep):
    model = f"particles: {particles}, ends: free, gamma: 0.1, stiffness: 0, damping: 0.1, floor: -1, wall: 1, "
    model += f"restitution: 0.8, frequency: 2.6, force: {[7] + [0] * (particles - 1)}"
    sweep = f'sweep: {{parameter: "model.force[0]", {sweep}}}\n'
    return motion("driven", model, "start: {v: 0}", 100, 2, ", lyapunov: true", sweep)


RANDOM = np.random.default_rng(7)
FLOORS = "particles: 3, ends: periodic, gamma: 0.1, floor: [-0.6, null, -0.8]"
CROWD = "particles: 20, ends: periodic, gamma: 0.3, floor: {}, wall: 1.2, restitution: 0.98"
SCATTERED = (
    f"start: {{q: {RANDOM.uniform(-0.9, 0.9, 20).round(3).tolist()}, v: {RANDOM.normal(size=20).round(3).tolist()}}}"
)
ORBIT = motion(
    "an orbit", "particles: 6, ends: periodic, gamma: 0.1, floor: -1", "orbit: {period: 1.5 pi, at_start: [3]}"
)
STUDIES = {
    "family": FAMILY,
    "orbit": ORBIT,
    "three": motion(
        "three $", FLOORS, "start: {q: [0.9, 0.2, -0.5], v: [0, 0.4, 1]}",
        sweep="sweep: {parameter: model.gamma, values: [0.1, 0.3]}\n",
    ),
    "crowd": motion("a crowd", CROWD.format(-1), SCATTERED, 10, 201),
    "ledges": motion("a crowd", CROWD.format((-1 - 0.3 * RANDOM.random(20)).round(3).tolist()), SCATTERED, 10, 201),
    "bouncing": motion(
        "until it rests", "particles: 3, ends: fixed, gamma: 0.1, damping: 0.05, floor: 0.2, restitution: 0.5",
        "start: {q: [0.5, 0.7, 1]}", 12, 301,
    ),
    "contacts": ORBIT.replace("floor: -1", "floor: -1, hertz: 1e4").replace(
        "orbit: {period: 1.5 pi, at_start: [3]}", "start: {q: [0, 0, 0, -0.9, 0, 0], v: [0, 0, 0, -1, 0, 0]}"
    ),
    "masses": motion(
        "masses", "particles: 3, mass: [1, 2, 3], cubic: 0.1, wall: 0.7, restitution: 0.8",
        "start: {q: [0.1, 0.3, 0.6], v: [0, 0, 1]}",
    ).replace("type: chain", "type: duffing_chain"),
    "quiet": motion("no hit", "particles: 3, ends: free, gamma: 0.3, floor: -3", "start: {q: [1, 0, 0]}"),
    "stopped": motion(
        "stopped", FLOORS, "start: {q: [0.9, 0.2, -0.5], v: [0, 0.4, 0]}",
        time=", events_per_time: 0.4, lyapunov: true",
        sweep='sweep: {parameter: "start.q[0]", values: [0.9, -0.7, 2]}\n',
    ),
    "refused": motion(
        "refused", FLOORS, "start: {q: [0, 0, 0]}", sweep='sweep: {parameter: "start.q[0]", values: [-0.7, -0.8]}\n'
    ),
    "exponents": driven(1, "from: 7, to: 12, points: 6"),
    "many_exponents": driven(4, "from: 7, to: 8, points: 3"),
    "resting": motion(
        "one rests", "particles: 2, ends: free, gamma: 0.1, damping: 0.05, floor: [0.2, null], restitution: 0.5",
        "start: {q: [0.5, 0.7]}", time=", lyapunov: true",
        sweep="sweep: {parameter: model.gamma, values: [0.1, 0.2]}\n",
    ),
}  # fmt: skip


def without_exponents(file):
    """The third task grazed at once; the fourth later on."""
    group = file["trajectory"]
    group["lyapunov"][2] = np.nan
    group["outcome"][2:4] = 6


MADE = {"grazed": altered("exponents", without_exponents)}

# figure, result, options
COLUMN = {"style": {"column": True}}
PICTURES = [
    ("trajectory", "orbit", {}),
    ("trajectory", "crowd", {}),
    ("trajectory", "ledges", COLUMN),
    ("trajectory", "three", {"task": 1, "start": 2.5, "end": 20.0}),
    ("trajectory", "stopped", {"style": {"title": ""}}),
    ("trajectory", "quiet", COLUMN),
    ("spacetime", "orbit", COLUMN),
    ("spacetime", "crowd", {"root": True, "particles": [5, 9]}),
    ("spacetime", "crowd", {"limit": 0.2}),
    ("spacetime", "contacts", {"end": 20.0}),
    ("phase", "orbit", {}),
    ("phase", "crowd", {}),
    ("phase", "ledges", COLUMN),
    ("phase", "contacts", COLUMN),
    ("phase", "stopped", {"task": 2}),
    ("phase", "bouncing", {"style": {"title": ""}}),
    ("lyapunov", "exponents", {}),
    ("lyapunov", "grazed", COLUMN),
    ("lyapunov", "many_exponents", {}),
    ("lyapunov", "resting", COLUMN),
    ("lyapunov-history", "many_exponents", {"task": 1, "style": {"column": True}}),
    ("animation", "bouncing", {}),
    ("animation", "ledges", COLUMN),
]
# figure, result, options, words of the message
REFUSALS = [
    ("trajectory", "family", {}, "a figure of kind trajectory, this result is of kind orbits"),
    ("trajectory", "three", {"task": 2}, "it has no task 2, only tasks 0 to 1"),
    ("phase", "three", {"task": -1}, "no task -1"),
    ("trajectory", "stopped", {"task": 1}, "task 1 has 0 samples to draw (refused: start: the gap of obstacle 0"),
    ("phase", "three", {"particles": [3]}, "it has no particle 3, only particles 0 to 2"),
    ("phase", "crowd", {"particles": list(range(13))}, "expected at most 12"),
    ("spacetime", "three", {"particles": [1, 3]}, "particles 1 3, expected the first and the last one, of 0 to 2"),
    ("spacetime", "three", {"limit": 0.0}, "limit = 0, expected a number > 0"),
    ("spacetime", "refused", {}, "task 0 has 0 samples to draw (refused: start"),
    ("animation", "three", {"start": 31.0}, "0 samples to draw from t = 31 to 30"),
    ("animation", "three", {"frames": 0}, "frames = 0, expected 1 to 2000"),
    ("animation", "three", {"fps": 51}, "fps = 51, expected 1 to 50"),
    ("lyapunov", "three", {}, "it has no trajectory/lyapunov (the study did not ask for time.lyapunov)"),
    ("lyapunov-history", "stopped", {"task": 1}, "no exponents of task 1 are known (refused)"),
]


@pytest.mark.parametrize("name, natural", [
    ("bouncing", {"phase", "trajectory"}),
    ("crowd", {"phase", "spacetime", "trajectory"}),
    ("exponents", {"lyapunov"}),
])  # fmt: skip
def test_natural_figures_are_those_one_wants(results, name, natural):
    """Studies of exponents store two samples, and a picture of three particles is none."""
    with ricochet.open(results[name]) as result:
        assert {spec.name for spec in ricochet.plot.figures_of(result) if spec.natural(result)} == natural


def test_of_a_sweep_the_first_middle_and_last_motions_are_drawn(results):
    with ricochet.open(results["stopped"]) as result:
        assert picked_tasks(result) == [0, 2]  # task 1 was refused
    with ricochet.open(results["exponents"]) as result:
        assert picked_tasks(result) == [0, 2, 5]


# --- displacements against time ---


def impacts_of(path, task=0):
    """(time, particle, gap rate, impulse) of a task [impact, 4]."""
    first, last = column(path, "trajectory/impact_offset")[task : task + 2]
    names = ("time", "particle", "gap_rate", "impulse")
    return np.column_stack([column(path, f"trajectory/impact_{name}")[first:last] for name in names])


def hatched(drawn, panel=0):
    """Boxes of hatching in data coordinates."""
    return [patch.get_xy() for patch in drawn.axes[panel].patches if patch.get_hatch()]


def test_trajectory_has_every_sample_and_impact(picture, results):
    path, drawn = results["orbit"], picture("trajectory", "orbit")
    t, q, impacts = column(path, "trajectory/t")[0], column(path, "trajectory/q")[0], impacts_of(path)
    assert set(impacts[:, 1]) == {3} and len(impacts) == 6
    line = drawn.axes[0].lines[0].get_xydata()
    assert len(line) == len(t) + len(impacts)
    assert_among(np.column_stack([t, q[:, 3]]), line)
    assert_among(np.column_stack([impacts[:, 0], np.full(len(impacts), -1.0)]), line)
    others = np.array(drawn.axes[0].collections[0].get_segments())
    assert (others[:, :, 1] == np.delete(q, 3, axis=1).T).all() and (others[:, :, 0] == t).all()
    marks = [marks.get_offsets() for marks in drawn.axes[0].collections if len(marks.get_offsets()) == len(impacts)]
    assert len(marks) == 1 and (marks[0][:, 0] == impacts[:, 0]).all()
    assert drawn.labels() == ("time $t$", "displacement $q$")
    assert drawn.legend == ["particle 3", "5 others", "impacts"]
    assert drawn.heading == [
        "an orbit", "ring of 6 particles, $\\gamma = 0.1$, floor at $-1$, $T = 1.5\\,\\pi$, 6 impacts"
    ]  # fmt: skip


def test_heading_names_all_parameters_of_the_task(picture):
    assert picture("trajectory", "bouncing").heading[1] == (
        "3 particles, fixed ends, $\\gamma = 0.1$, damping $0.05$, floor at $0.2$, restitution $0.5$, "
        + picture("trajectory", "bouncing").heading[1].rpartition(", ")[2]
    )
    assert (
        picture("phase", "three", task=1)
        .heading[1]
        .startswith("ring of 3 particles, floor at ${-0.6},\\, \\mathrm{none},\\, {-0.8}$, $\\gamma = 0.3$, task 1, ")
    )
    assert picture("lyapunov", "exponents").heading[1] == (
        "one particle, stiffness $0$, damping $0.1$, $\\omega = 2.6$, floor at $-1$, wall at $1$, restitution $0.8$"
    )


def test_a_shared_floor_is_hatched_and_no_curve_is_in_it(picture):
    drawn = picture("trajectory", "orbit")
    (box,) = hatched(drawn)
    assert box[:, 1].max() == -1 and drawn.points()[:, 1].min() == -1
    assert len(hatched(picture("trajectory", "crowd"))) == 2


def test_floors_of_their_own_are_lines_in_the_colours_of_the_particles(picture, results):
    """Particle 2 goes below the floor of particle 0: no hatching may lie there."""
    q = column(results["three"], "trajectory/q")[0]
    assert q[:, 2].min() < -0.7
    drawn = picture("trajectory", "three")
    assert hatched(drawn) == []
    colours = {line.get_label(): line.get_color() for line in drawn.axes[0].lines}
    floors = {line.get_ydata()[0]: line.get_color() for line in drawn.axes[0].lines if len(set(line.get_ydata())) == 1}
    assert floors == {-0.6: colours["particle 0"], -0.8: colours["particle 2"]}
    assert "floors in the colour of the particle" in drawn.legend


def test_many_different_floors_are_left_out_with_a_note(picture):
    drawn = picture("trajectory", "ledges")
    assert "20 different floors are not drawn" in drawn.notes and len(hatched(drawn)) == 1  # the wall


def test_a_wall_of_the_last_mass_is_not_that_of_the_others(picture, results):
    assert column(results["masses"], "trajectory/q")[0, :, :2].max() > 0.7
    drawn = picture("trajectory", "masses")
    assert hatched(drawn) == [] and "walls in the colour of the particle" in drawn.legend


def test_without_impacts_a_few_particles_have_names(picture):
    assert picture("trajectory", "quiet").legend == ["particle 0", "particle 1", "particle 2"]


def test_a_run_that_stopped_says_when_and_why(picture, results):
    drawn, time = picture("trajectory", "stopped"), column(results["stopped"], "trajectory/time")[0]
    assert f"stopped at $t = {time:.4g}$" in drawn.heading[1] and drawn.axes[0].get_xlim() == (0, time)
    assert drawn.notes.startswith("event limit: events at more than 0.4 times")


# --- particles against time ---


def test_spacetime_is_the_displacements_and_impacts(picture, results):
    drawn, impacts = picture("spacetime", "crowd"), impacts_of(results["crowd"])
    assert (drawn.axes[0].images[0].get_array() == column(results["crowd"], "trajectory/q")[0].T).all()
    assert len(drawn.offsets()) == len(impacts) > 20
    assert_among(impacts[:, :2], drawn.offsets())
    assert drawn.legend == ["impacts at floors", "impacts at walls"]
    assert "colours end at $0.2$" in picture("spacetime", "crowd", limit=0.2).notes
    assert picture("spacetime", "crowd", root=True, particles=[5, 9]).axes[0].get_ylim() == (4.5, 9.5)


# --- phase portraits ---


def titles(drawn):
    return [axes.get_title("left") for axes in drawn.axes if axes.get_title("left")]


def test_panels_are_in_the_order_of_the_particles(picture, results):
    hits = np.bincount(impacts_of(results["crowd"])[:, 1].astype(int), minlength=20)
    drawn = picture("phase", "crowd")
    chosen = [int(title.split()[1].rstrip(":")) for title in titles(drawn)]
    assert chosen == sorted(chosen) and len(chosen) == 6
    most = [particle for particle in chosen if hits[particle]]
    assert len(most) == 5 and min(hits[most]) >= np.sort(hits)[-5] and (np.diff(hits[most]) > 0).any()
    assert drawn.notes == "the 5 particles that hit most often, and a neighbour that does not; --particles draws others"
    given = picture("phase", "crowd", particles=[7, 2, 7])
    assert [title.split(":")[0] for title in titles(given)] == ["particle 7", "particle 2"] and given.notes == ""


def test_each_panel_has_the_obstacles_of_its_own_particle(picture):
    drawn = picture("phase", "three", particles=[0, 1, 2])
    faces = [[box[:, 0].max() for box in hatched(drawn, panel)] for panel in range(3)]
    assert faces == [[-0.6], [], [-0.8]]


def test_phase_portrait_has_every_impact_and_sample(picture, results):
    drawn = picture("phase", "orbit", particles=[3, 2])
    times, t = impacts_of(results["orbit"])[:, 0], column(results["orbit"], "trajectory/t")[0]
    at_sample = (np.abs(t - times[:, None]) < 1e-9 * (1 + times[:, None])).any(axis=1).sum()  # they are left out
    for axes, impacts, left_out in zip(drawn.axes, (len(times), 0), (at_sample, 0)):
        # Pieces of a curve have a stroke less than points; impacts are the last and the first points of pieces.
        assert len(axes.collections[0].get_segments()) == len(t) - left_out - 1 + impacts
        assert [len(marks.get_offsets()) for marks in axes.collections[1:]] == [impacts] * (2 if impacts else 0)
    assert drawn.labels() == ("displacement $q$", "velocity $v$")
    assert drawn.legend == ["start", "jump at the obstacle", "before the impact", "after the impact"]


@pytest.mark.parametrize("name, particle, restitution", [("orbit", 3, 1.0), ("crowd", 6, 0.98), ("masses", 2, 0.8)])
def test_portrait_breaks_at_impacts(results, name, particle, restitution):
    """No piece crosses an impact, and the pieces obey the law of reflection, also for other masses than one."""
    with ricochet.open(results[name]) as result:
        portrait = Portrait(Motion(result), particle)
        pieces = list(portrait.pieces())
    assert len(portrait.times) > 3 and len(pieces) == len(portrait.times) + 1
    assert np.abs(portrait.after + restitution * portrait.before).max() < 1e-9
    for t, _q, v in pieces:  # speeds change by no more than the largest acceleration lets them
        assert (np.abs(np.diff(v)) <= 5 * np.diff(t) + 1e-6).all()


# --- exponents ---


def test_exponents_are_those_of_the_result(picture, results):
    values, at = (
        column(results["exponents"], "trajectory/lyapunov"),
        column(results["exponents"], "sweep/model.force[0]"),
    )
    drawn = picture("lyapunov", "exponents")
    lines = [line.get_xydata() for line in drawn.axes[0].lines if line.get_linestyle() == "-"][1:]  # zero first
    assert values.shape == (6, 2)
    for k in range(2):
        assert (lines[k] == np.column_stack([at, values[:, k]])).all()
    assert drawn.legend == ["$\\lambda_{1}$", "$\\lambda_{2}$", "above zero: chaos"] and drawn.notes == ""


def test_convergence_of_exponents_is_that_of_the_task(picture, results):
    path = results["exponents"]
    first, last = column(path, "trajectory/lyapunov_offset")[5:7]
    time, history = (column(path, f"trajectory/lyapunov_{name}")[first:last] for name in ("time", "history"))
    drawn = picture("lyapunov-history", "exponents", task=5)
    lines = [line.get_xydata() for line in drawn.axes[0].lines if len(line.get_xdata()) == len(time)]
    for k in range(2):
        assert (lines[k] == np.column_stack([time, history[:, k]])).all()
    assert (history[-1] == column(path, "trajectory/lyapunov")[5]).all() and len(history) > 5
    assert drawn.heading[1].endswith("= $12$, task 5")


def test_gaps_of_exponents_are_explained(picture):
    drawn = picture("lyapunov", "grazed")
    assert drawn.notes == "1 run ended early: grazing 1 run without exponents: grazing"
    assert "run that ended early" in drawn.legend
    circles = [
        line for line in drawn.axes[0].lines if line.get_marker() == "o" and line.get_markerfacecolor() == "white"
    ]
    assert [np.isfinite(line.get_ydata()).tolist() for line in circles] == [[False, True]] * 2


def test_lost_directions_are_triangles_at_the_lower_edge(picture, results):
    values = column(results["resting"], "trajectory/lyapunov")
    drawn = picture("lyapunov", "resting")
    triangles = [len(line.get_xdata()) for line in drawn.axes[0].lines if line.get_marker() == "v"]
    assert sum(triangles) == np.isneginf(values).sum() > 0
    assert any(label.startswith("$-\\infty$") for label in drawn.legend)


# --- animation ---


@pytest.fixture(scope="module")
def film(results):
    """`film("bouncing", frames=20)`: the film of a result."""

    def draw(name, **options):
        with ricochet.open(results[name]) as result:
            return ricochet.plot.animation(result, **options)

    yield draw
    matplotlib.pyplot.close("all")


def clock(film, k):
    film.show(k)
    return film.figure.axes[0].get_title("right")


def test_a_film_shows_the_whole_motion(film):
    shown = film("bouncing")
    assert 120 <= shown.pictures <= 600
    assert (clock(shown, 0), clock(shown, shown.pictures - 1)) == ("t =  0.00", "t = 12.00")
    assert Picture(shown.figure).heading[-1].endswith(f"$t = 0$ to $12$ in {shown.pictures / 20:.3g} s")
    assert "too few to follow" in Picture(film("crowd", frames=8).figure).notes


def test_particles_of_a_film_are_at_their_displacements(film, results):
    t, q = column(results["bouncing"], "trajectory/t")[0], column(results["bouncing"], "trajectory/q")[0]
    shown = film("bouncing", frames=31)  # every tenth sample
    for k in (0, 7, 30):
        shown.show(k)
        (discs,) = [c for c in shown.figure.axes[0].collections if len(c.get_offsets()) == 3 and c.get_zorder() == 3]
        assert np.allclose(discs.get_offsets(), np.column_stack([range(3), q[10 * k]]), atol=1e-12)
        assert clock(shown, k) == f"t = {t[10 * k]:5.2f}"


@pytest.mark.parametrize("name, ends", [
    ("bouncing", [(-0.75, 0), (2.75, 0)]),
    ("masses", [(-0.75, 0), None]),
    ("quiet", [None, None]),
    ("three", [(-0.5, 0.2), (2.5, 0.2)]),
])  # fmt: skip
def test_springs_end_where_the_chain_does(film, name, ends):
    """At the ground, at the last particle, or halfway to the other end of a ring; always behind the obstacles."""
    springs, *blocks, _discs, _flashes, _clock = film(name, frames=2).show(0)
    (line,) = springs.get_segments()
    found = [tuple(point) if point[0] != round(point[0]) else None for point in (line[0], line[-1])]
    assert found == ends
    assert all(block.get_zorder() > springs.get_zorder() for block in blocks)
    assert all(to_rgba(block.get_facecolor())[3] == 1 for block in blocks[::2])  # springs are hidden behind them


def test_each_particle_of_a_film_has_its_own_floor(film):
    _springs, *blocks, _discs, _flashes, _clock = film("three", frames=2).show(0)
    boxes = [block.get_bbox() for block in blocks[::2]]
    assert [(box.x0, box.x1, box.y1) for box in boxes] == [(-0.3, 0.3, -0.6), (1.7, 2.3, -0.8)]


def test_gif_moves_and_is_small(film, folder):
    shown, path = film("crowd", frames=30, fps=10), folder / "film.gif"
    ricochet.plot.save(shown, path)
    with Image.open(path) as image:
        assert image.n_frames == 30 and image.size == tuple(np.array(shown.figure.get_size_inches() * 100).astype(int))
        assert image.info["duration"] == 100 and image.info["loop"] == 0
        pictures = []
        for k in range(30):
            image.seek(k)
            pictures.append(np.array(image.convert("RGB")))
    assert (pictures[15] != pictures[0]).sum() > 1000, "it does not move"
    assert to_hex(pictures[0].min(axis=(0, 1)) / 255) == "#002222"  # ink, and none of the unused magenta
    assert path.stat().st_size < 12000 * 30


def test_pictures_of_a_gif_are_those_of_the_figure(film, folder):
    """Though what stands still is drawn once."""
    shown, path = film("bouncing", frames=12), folder / "film.gif"
    shown.save(path)
    shown.show(11)
    with matplotlib.rc_context({"savefig.dpi": shown.dpi}):
        shown.figure.savefig(folder / "last.png")
    with Image.open(path) as image, Image.open(folder / "last.png") as last:
        image.seek(11)
        film_picture, figure = (np.array(one.convert("RGB")).astype(int) for one in (image, last))
    assert film_picture.shape == figure.shape
    assert (np.abs(film_picture - figure).max(axis=2) > 60).mean() < 2e-3  # but for the colours of the palette


def test_settings_hold_while_a_film_is_written(film, folder):
    shown = film("quiet", frames=2)
    widths = []

    def show(k):
        widths.append(matplotlib.rcParams["hatch.linewidth"])
        return shown.show(k)

    Film(shown.figure, show, 2, 20, 50, "x").save(folder / "film.gif")
    assert set(widths) == {0.6} != {matplotlib.rcParams["hatch.linewidth"]}


def test_few_samples_are_said(picture):
    """Studies of exponents store two."""
    for figure in ("trajectory", "phase", "spacetime"):
        assert "2 samples only (time.samples)" in picture(figure, "exponents").notes


def test_a_film_is_there_whole_or_not_at_all(film, folder):
    def torn(k):
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError):
        Film(film("quiet", frames=2).figure, torn, 2, 20, 50, "x").save(folder / "film.gif")
    assert not list(folder.glob("film*"))


def test_the_command_writes_a_film(results, folder, capsys):
    assert main([str(results["quiet"]), "animation", "--frames", "3", "-o", str(folder / "film")]) == 0
    assert capsys.readouterr().out == f"{folder / 'film.gif'}\n" and (folder / "film.gif").stat().st_size > 1000
    assert main([str(results["quiet"]), "animation", "--frames", "2", "-o", str(folder / "film.GIF")]) == 0
    assert capsys.readouterr().out == f"{folder / 'film.GIF'}\n"
    assert main([str(results["quiet"]), "animation", "-o", str(folder / "film.png")]) == 2
    assert "animation is written as gif, mp4, not as png" in capsys.readouterr().err


def test_mp4_needs_ffmpeg(results, folder, capsys, monkeypatch):
    path = folder / "film.mp4"
    words = [str(results["quiet"]), "animation", "--frames", "3", "-o", str(path)]
    monkeypatch.setenv("PATH", str(folder))
    assert main(words) == 2 and not path.exists()
    assert capsys.readouterr().err.endswith(
        "film.mp4 needs the program ffmpeg, which is not there; a .gif does without it\n"
    )
    (folder / "ffmpeg").write_text('#!/bin/sh\nfor last; do :; done\n/bin/cat >"$last"\n')  # keeps what it is given
    (folder / "ffmpeg").chmod(0o755)
    assert main(words) == 0 and path.stat().st_size % 3 == 0 and path.stat().st_size > 3 * 800 * 400 * 4
    (folder / "ffmpeg").write_text("#!/bin/sh\n/bin/cat >/dev/null\nexit 3\n")
    assert main(words) == 2 and "ffmpeg did not write" in capsys.readouterr().err
