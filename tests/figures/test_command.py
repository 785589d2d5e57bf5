"""The command ricochet-plot: which figures it draws, where it writes them, and what it says."""

import dataclasses
import functools
import inspect
import os
import signal
import subprocess
import xml.etree.ElementTree
from collections import defaultdict
from pathlib import Path
from typing import get_type_hints

import h5py
import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest
from matplotlib.figure import Figure
from PIL import Image
from shelf import FAMILY, altered

import ricochet
from ricochet.plot import CATALOGUE, arguments, command
from ricochet.plot.catalogue import KINDS

GRAZING = """kind: grazing
title: three regimes
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 3, force: 1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 1, to: 50}
grazing: {windows: 5}
sweep: {parameter: model.frequency, values: [6, 4, 1.5]}
"""


def foreign(shelf, path):
    with h5py.File(path, "w") as file:
        file["values"] = [1.0, 2.0]


def truncated(shelf, path):
    whole = shelf["family"].read_bytes()
    path.write_bytes(whole[: len(whole) // 2])


def not_hdf5(shelf, path):
    path.write_text("a,b\n1,2\n")


def of_an_earlier_build(file):
    del file["study"]


STUDIES = {"family": FAMILY, "grazing": GRAZING}
MADE = {
    "foreign": foreign,
    "truncated": truncated,
    "text": not_hdf5,
    "earlier": altered("family", of_an_earlier_build),
}


class Outcome:
    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err

    def expect(self, *files):
        """Done without a word but the names of these files, which are there and hold pictures."""
        assert (self.code, self.err) == (0, ""), self.err
        assert self.out.splitlines() == [str(file) for file in files]
        for file in files:
            expect_picture(file)

    def expect_refused(self, *words):
        assert self.code == 2 and self.out == "", self.out
        assert self.err.startswith("ricochet-plot: ") and len(self.err.splitlines()) == 1, self.err
        for word in words:
            assert word in self.err, self.err


def expect_picture(path):
    """A file of the format that its suffix says, with something in it."""
    content = Path(path).read_bytes()
    suffix = os.path.splitext(path)[1].lower()
    if suffix == ".pdf":
        assert content.startswith(b"%PDF-") and content.rstrip().endswith(b"%%EOF") and len(content) > 5000
    elif suffix == ".svg":
        assert len(list(xml.etree.ElementTree.fromstring(content).iter())) > 100
    else:
        with Image.open(path) as image:
            assert image.format.lower() == suffix[1:] and len(image.convert("L").getcolors()) > 10


@pytest.fixture
def plot(capsys):
    """`plot("r.h5", "modes")`: the command in this process."""

    def start(*words):
        code = command.main([str(word) for word in words])
        assert plt.get_fignums() == []
        return Outcome(code, *capsys.readouterr())

    return start


@pytest.fixture
def process(source):
    """`process("r.h5", "modes")`: the command as a user starts it."""

    def start(*words, stdout=subprocess.PIPE, **options):
        words = [source / "scripts" / "ricochet-plot", *words]
        return subprocess.Popen(words, stdout=stdout, stderr=subprocess.PIPE, text=True, **options)

    return start


@pytest.fixture
def drawn(monkeypatch, plot):
    """`drawn("r.h5", "modes")`: the figures that the command would write, which it does not."""

    def start(*words):
        figures = []
        monkeypatch.setattr(command, "save", lambda figure, path: figures.append(figure))
        assert plot(*words).code == 0
        return figures

    return start


@pytest.fixture
def family(results, folder):
    """A result alone in a folder."""
    path = folder / "family.h5"
    path.write_bytes(results["family"].read_bytes())
    return path


@pytest.fixture
def grazing(results, folder):
    path = folder / "grazing.h5"
    path.write_bytes(results["grazing"].read_bytes())
    return path


@pytest.fixture
def quick(monkeypatch):
    """Figures with nothing but axes: for tests of files."""

    def axes_only(result, **options):
        with ricochet.plot.sheet.settings():
            return plt.subplots(figsize=(3, 2))[0]

    for name, spec in CATALOGUE.items():
        draw = functools.wraps(spec.draw)(lambda *words, **options: axes_only(*words, **options))
        monkeypatch.setitem(CATALOGUE, name, dataclasses.replace(spec, draw=draw))


def names(folder):
    return sorted(path.name for path in folder.iterdir())


# --- as a user starts it ---


def test_the_program_draws_what_is_natural_beside_the_result(process, family):
    """Whatever the user's settings of matplotlib, and the display."""
    settings = family.parent / "settings"
    settings.mkdir()
    (settings / "matplotlibrc").write_text("axes.grid: True\nfont.size: 30\nbackend: QtAgg\n")
    surroundings = os.environ | {"MPLCONFIGDIR": str(settings), "DISPLAY": ":77"}
    with process("family.h5", "modes", "--format", "svg", cwd=family.parent, env=surroundings) as started:
        out, err = started.communicate()
    assert (started.returncode, out, err) == (0, "family_modes.svg\n", "")
    expect_picture(family.with_name("family_modes.svg"))
    own = family.with_name("own.svg")
    assert command.main([str(family), "modes", "-o", str(own)]) == 0
    assert own.read_bytes() == family.with_name("family_modes.svg").read_bytes()


def test_a_closed_pipe_is_no_trouble(process):
    started = process("--list")
    started.stdout.close()
    started.stdout = None
    _, err = started.communicate()
    assert err == "" and started.returncode in (0, -signal.SIGPIPE)


def test_a_full_disk_is_said(process):
    with open("/dev/full", "w") as full:
        started = process("--list", stdout=full)
        _, err = started.communicate()
    assert started.returncode == 2
    assert err == "ricochet-plot: cannot write to standard output: No space left on device\n"


def test_a_missing_library_is_named(process, folder):
    (folder / "matplotlib.py").write_text("raise ModuleNotFoundError('no', name='matplotlib')")
    started = process("--list", env=os.environ | {"PYTHONPATH": str(folder)})
    out, err = started.communicate()
    assert (started.returncode, out) == (2, "")
    assert err == "ricochet-plot: it needs matplotlib (Debian: python3-matplotlib)\n"


# --- the list ---


def test_the_list_has_all_figures_and_their_kinds(plot):
    listed = plot("--list")
    assert listed.out == plot().out and (listed.code, listed.err) == (0, "")
    lines = dict(line.split(maxsplit=1) for line in listed.out.splitlines())
    assert lines.keys() == CATALOGUE.keys()
    for name, spec in CATALOGUE.items():
        kinds = "all kinds" if set(spec.kinds) == set(KINDS) else ", ".join(spec.kinds)
        source = f" ({spec.source})" if spec.source else ""
        assert lines[name] == f"{kinds}: {spec.shows}{source}"


@pytest.mark.parametrize("name", ["family", "grazing"])
def test_the_list_of_a_result_has_what_can_be_drawn_of_it(plot, results, name):
    listed = plot(results[name], "--list")
    with ricochet.open(results[name]) as result:
        specs = {spec.name: spec for spec in ricochet.plot.figures_of(result)}
        by_name = {spec.name for spec in specs.values() if not spec.natural(result)}
    assert [line.split()[0] for line in listed.out.splitlines()] == list(specs)
    marked = {line.split()[0] for line in listed.out.splitlines() if line.endswith(" (by its name only)")}
    assert marked == by_name and "columns" in by_name


# --- where to ---


def test_figures_stand_beside_the_result(quick, plot, grazing):
    stem = grazing.with_suffix("")
    plot(grazing).expect(*(f"{stem}_criterion_{k}.png" for k in range(3)), f"{stem}_grazing-windows.png")
    before = names(grazing.parent)
    plot(grazing, "criterion", "--task", 1).expect(f"{stem}_criterion_1.png")
    plot(grazing, "grazing_windows").expect(f"{stem}_grazing-windows.png")
    assert names(grazing.parent) == before


def test_a_result_in_the_current_folder_has_its_figures_there(quick, plot, family, monkeypatch):
    monkeypatch.chdir(family.parent)
    plot("family.h5", "modes").expect("family_modes.png")


def test_output_is_a_file(quick, plot, family):
    folder = family.parent
    for name in ("a.png", "b.pdf", "c.svg", "D.PNG", "E.Pdf"):
        plot(family, "modes", "-o", folder / name).expect(folder / name)
    plot(family, "modes", "-o", folder / "v0.5").expect(folder / "v0.5.png")
    plot(family, "modes", "-o", folder / "v0.5", "--format", "pdf").expect(folder / "v0.5.pdf")
    plot(family, "modes", "-o", folder / "same.svg", "--format", "svg").expect(folder / "same.svg")
    assert "a.png.png" not in names(folder)


def test_output_is_what_several_names_begin_with(quick, plot, grazing):
    stem = grazing.parent / "figures of paper"
    wanted = [f"{stem}_criterion_{k}.svg" for k in range(3)] + [f"{stem}_grazing-windows.svg"]
    plot(grazing, "--output", f"{stem}.svg").expect(*wanted)
    plot(grazing, "criterion", "--output", stem, "--format", "svg").expect(*wanted[:3])
    plot(grazing, "criterion", "--task", 2, "--output", stem, "--format", "svg").expect(f"{stem}.svg")


def test_output_is_a_folder(quick, plot, family):
    (family.parent / "v1.png").mkdir()
    (family.parent / "figures").mkdir()
    for folder in ("figures", "figures/"):
        plot(family, "modes", "-o", f"{family.parent}/{folder}").expect(f"{family.parent}/figures/family_modes.png")


def test_equal_results_give_equal_files(plot, family):
    for suffix in (".png", ".pdf", ".svg"):
        files = [family.with_name(f"{k}{suffix}") for k in range(2)]
        for file in files:
            plot(family, "columns", "-o", file).expect(file)
        assert files[0].read_bytes() == files[1].read_bytes()


def test_a_file_is_there_whole_or_not_at_all(quick, plot, family, monkeypatch):
    own = family.with_name("own.png")
    plot(family, "modes", "-o", own).expect(own)
    before = own.read_bytes()

    def half(figure, path, **options):
        Path(path).write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", half)
    plot(family, "modes", "-o", own).expect_refused(f"cannot write {own}: No space left on device")
    assert own.read_bytes() == before and names(family.parent) == ["family.h5", "own.png"]


# --- how ---


def test_titles(drawn, family):
    def title(*words):
        (figure,) = drawn(family, "modes", *words)
        return [text.get_text() for text in figure.texts if text.get_weight() == "bold"]

    assert title() == ["a family"]
    assert title("--title", "for 5 $ and 6 $") == [r"for 5 \$ and 6 \$"]
    assert title("--title", "none") == title("--title", "") == []


def test_widths(plot, family):
    def pixels(*words):
        path = family.with_name("w.png")
        plot(family, "columns", "-o", path, *words).expect(path)
        with Image.open(path) as image:
            return image.width

    assert pixels("--column") == round(3.4 * 300)
    assert pixels("--width", 5) == 5 * 300
    assert pixels("--width", 10) == 10 * 160


def test_limits(drawn, family):
    (figure,) = drawn(family, "modes", "--xlim", "-1e-1", "4.5", "--ylim", "-.5", "2e0")
    assert figure.axes[0].get_xlim() == figure.axes[1].get_xlim() == (-0.1, 4.5)
    assert figure.axes[0].get_ylim() == (-0.5, 2) and figure.axes[1].get_ylim() != (-0.5, 2)


def test_words_may_stand_in_any_order(drawn, family):
    for words in (
        (family, "--column", "modes", "--all"),
        ("--column", family, "--all", "modes"),
        (family, "modes", "--all", "--column"),
    ):
        (figure,) = drawn(*words)
        assert figure.get_figwidth() == 3.4


def test_options_choose_the_figures_that_take_them(drawn, grazing):
    assert [len(figure.axes) for figure in drawn(grazing, "--tasks", 0, 2)] == [4]  # windows: two panels, two strips
    (figure,) = drawn(grazing, "--task", 2)
    assert r"\omega = 1.5" in " ".join(text.get_text() for text in figure.texts)
    (figure,) = drawn(grazing, "--y", "alpha")  # a figure that is not natural
    assert figure.axes[0].get_ylabel() == "eta P xi"


def test_nothing_of_the_process_is_changed(plot, family):
    mpl.rcParams["font.size"] = 13.5
    try:
        before = dict(mpl.rcParams)
        assert plot(family, "modes").code == 0
        assert dict(mpl.rcParams) == before
    finally:
        mpl.rcdefaults()


# --- what is too much, or cannot be drawn ---


def test_of_many_tasks_some_are_drawn_unasked(quick, plot, grazing, monkeypatch):
    monkeypatch.setattr(command, "_MOST_PARTS", 2)
    stem = grazing.with_suffix("")
    some = plot(grazing)
    assert some.code == 0 and [line.rpartition("_")[2] for line in some.out.splitlines()] == [
        "0.png",
        "2.png",
        "grazing-windows.png",
    ]
    assert (
        some.err
        == f"ricochet-plot: criterion: 2 of 3 tasks are drawn; all of them: ricochet-plot {grazing} criterion\n"
    )
    plot(grazing, "criterion").expect(*(f"{stem}_criterion_{k}.png" for k in range(3)))


def test_a_figure_that_cannot_be_drawn_does_not_keep_others_from_it(plot, grazing):
    several = plot(grazing, "--xlim", -1, 1)
    assert several.code == 0 and len(several.out.splitlines()) == 3
    assert several.err == f"ricochet-plot: {grazing}: grazing-windows: limits -1 1 of a logarithmic axis: both > 0\n"
    plot(grazing, "grazing-windows", "--xlim", -1, 1).expect_refused("limits -1 1 of a logarithmic axis")


REFUSALS = [
    (["{absent}"], ["absent.h5: there is no such file"]),
    (["{folder}"], ["there is no such file"]),
    (["{foreign}"], ["it is not a result of ricochet"]),
    (["{truncated}", "--list"], ["it is damaged, or cannot be read"]),
    (["{text}", "modes"], ["it is not an HDF5 file"]),
    (["{earlier}"], ["an earlier build of ricochet wrote it"]),
    (["modes"], ["modes is a figure; which result? ricochet-plot RESULT.h5 modes"]),
    (["{family}", "modez"], ["there is no figure modez; did you mean modes?"]),
    (["{family}", "xyz"], ["there is no figure xyz; there are ", "modes"]),
    (["{family}", "criterion"], ["family.h5: criterion is a figure of kind grazing, this result is of kind orbits"]),
    (["{family}", "modes", "more"], ["more is one word too many"]),
    (["{family}", "modes", "--alll"], ["there is no option --alll; did you mean --all?"]),
    (["{family}", "modes", "--curve=3"], ["there is no option --curve; did you mean --curves?"]),
    (
        ["{family}", "modes", "--table", "orbits"],
        ["figure modes has no option --table; its options are: --all, --curves"],
    ),
    (["{family}", "modes", "--curves", "few"], ["--curves: few is not a whole number"]),
    (["{family}", "modes", "--width", "0.5"], ["--width: 0.5 is not a width, 1 to 100 inches"]),
    (["{family}", "modes", "--width", "wide"], ["--width: wide is not a number"]),
    (["{family}", "modes", "--width", "5", "--column"], ["--column: not allowed with argument --width"]),
    (["{family}", "modes", "--xlim", "1"], ["--xlim: expected 2 arguments"]),
    (["{family}", "modes", "--xlim", "1", "nan"], ["--xlim: nan is not a number"]),
    (["{family}", "modes", "--ylim", "1", "1.0"], ["--ylim 1 1: the limits are equal"]),
    (["{family}", "modes", "--format", "jpg"], ["--format: invalid choice: 'jpg'"]),
    (["{family}", "modes", "--format", "gif"], ["figure modes is written as png, pdf, svg, not as gif"]),
    (["{family}", "modes", "-o", "x.jpg"], ["x.jpg: figures are not written as jpg"]),
    (["{family}", "modes", "-o", "x.png", "--format", "pdf"], ["x.png and --format pdf are different formats"]),
    (["{family}", "modes", "-o", "{folder}/new/"], ["there is no folder", "new"]),
    (["{family}", "modes", "-o", "{folder}/new/x.pdf"], ["x.pdf: there is no folder"]),
    (["{grazing}", "criterion", "--task", "9"], ["it has no task 9, only tasks 0 to 2"]),
]


@pytest.mark.parametrize("words, said", REFUSALS)
def test_refusals_are_one_line_and_nothing_is_written(plot, results, folder, words, said, monkeypatch):
    made = ("family", "grazing", *MADE)
    places = {name: results[name] for name in made} | {"absent": folder / "absent.h5", "folder": folder}
    monkeypatch.chdir(folder)
    plot(*(word.format(**places) for word in words)).expect_refused(*said)
    assert names(folder) == []
    assert not [path for path in results.folder.iterdir() if path.suffix not in (".h5", ".yaml")]


# --- the catalogue ---


def test_options_of_one_name_have_one_type():
    types = defaultdict(set)
    for spec in CATALOGUE.values():
        for option, hint in spec.hints.items():
            types[option].add(str(hint))
    assert {option: hints for option, hints in types.items() if len(hints) > 1} == {}
    assert not types.keys() & {*arguments.COMMON, "help"}


@pytest.mark.parametrize("spec", CATALOGUE.values(), ids=CATALOGUE)
def test_every_figure_is_declared_as_its_function_is(spec):
    function = inspect.unwrap(spec.draw)
    keywords = [name for name, each in inspect.signature(function).parameters.items() if each.kind is each.KEYWORD_ONLY]
    assert sorted(keywords) == sorted(spec.options), "options that have no help, or do not exist"
    assert all(spec.options.values()) and spec.shows and function.__doc__
    assert get_type_hints(function)["return"] is not None
    assert not spec.part or spec.part in spec.options
    assert set(spec.kinds) <= set(KINDS) and spec.kinds
    exported = spec.name.replace("-", "_")
    assert exported in ricochet.plot.__all__ and getattr(ricochet.plot, exported) is spec.draw


def test_the_help_has_every_option(capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(["--help"])
    said = " ".join(capsys.readouterr().out.split())
    assert ended.value.code == 0
    for spec in CATALOGUE.values():
        for option, text in spec.options.items():
            assert arguments.flag(option) in said and text in said


def test_the_command_starts_by_its_first_line(source):
    path = source / "scripts" / "ricochet-plot"
    assert path.read_text().startswith("#!/usr/bin/python3\n") and os.access(path, os.X_OK)
