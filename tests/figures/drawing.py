"""What the tests of figures share: running a script of scripts/, in this process or as a user does, what a figure and
a refusal must be, and results that are made when they are first asked for.

What a figure shows is for eyes. Here it must exist as a large PNG with something on it and as a well-formed SVG, and
what the scripts cannot draw must end with one line and exit code 2. Numbers in figures are those that matplotlib holds.
"""

import contextlib
import importlib
import logging
import runpy
import subprocess
import sys
import warnings
import xml.etree.ElementTree
from pathlib import Path
from unittest.mock import patch

import h5py
import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")
import matplotlib.image  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

# --- what a script has done ---


class Drawn:
    """Exit code, output, and the figures of a script that ran in this process."""

    def __init__(self, words, code, out, err, figures=()):
        self.words, self.code, self.out, self.err, self.figures = words, code, out, err, figures

    def __str__(self):
        return f"{' '.join(self.words)}\n  code {self.code}\n  out {self.out!r}\n  err {self.err!r}"

    def expect_silence(self):
        assert self.code == 0 and self.err == "", str(self)
        return self

    def expect_files(self, *stems, table=False):
        """Both files of each figure, and their names on standard output, where a table may stand before them."""
        self.expect_silence()
        written, told = [f"{stem}{suffix}" for stem in stems for suffix in (".png", ".svg")], self.out.split()
        assert written == (told[-len(written) :] if table else told), str(self)
        for stem in stems:
            check_files(stem)
        return self

    def expect_refused(self, place, *phrases):
        """One line on standard error that begins with the place."""
        assert self.code == 2 and self.out == "", str(self)
        assert self.err.count("\n") == 1 and self.err.endswith("\n") and self.err.startswith(place), str(self)
        for phrase in phrases:
            assert phrase in self.err, f"expected to say {phrase!r}: {self}"
        return self


def check_files(stem):
    """STEM.png and STEM.svg are figures."""
    check_png(Path(f"{stem}.png"))
    check_svg(Path(f"{stem}.svg"))


def check_png(path):
    assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n", "no PNG signature"
    pixels = matplotlib.image.imread(path)
    assert pixels.shape[1] >= 1000, f"{pixels.shape[1]} pixels wide"
    levels = (pixels[::3, ::3, :3] * 16).astype(int)
    colours = len(np.unique(levels @ [17 * 17, 17, 1]))
    assert colours >= 8, f"only {colours} colours: blank?"
    border = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])[:, :3]
    assert (border == 1).all(), "something is cut off at the border"


def check_svg(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.tag.endswith("svg") and len(list(root.iter())) > 50, "an empty SVG"
    assert path.stat().st_size < 2e6, "more points than a file should hold"


# --- running scripts ---


class Scripts:
    """The scripts of a folder; `capture` is pytest's capfd, which has what HDF5 says, too."""

    def __init__(self, folder, capture):
        self.folder, self._capture = folder, capture

    def start(self, script, *words, cwd):
        """As a user does: a process of its own, by the script's first line."""
        words = [str(self.folder / script), *map(str, words)]
        done = subprocess.run(words, cwd=cwd, capture_output=True, text=True, timeout=120)
        return Drawn(words, done.returncode, done.stdout, done.stderr)

    def draw(self, script, *words, cwd, save=Figure.savefig):
        """In this process, from which the script finds nothing and in which it leaves nothing."""
        words, figures = [str(self.folder / script), *map(str, words)], []

        def remember(figure, *args, **options):
            if figure not in figures:
                figures.append(figure)
            return save(figure, *args, **options)

        self._capture.readouterr()
        with self._own_modules(), contextlib.chdir(cwd), matplotlib.rc_context(), closed(), told() as warned, \
             patch.object(sys, "argv", words), patch.object(Figure, "savefig", remember):  # fmt: skip
            code = exit_code(words[0])
        out, err = self._capture.readouterr()
        return Drawn(words, code, out, err + "".join(warned), figures)

    def look(self, script, path, *words):
        """The figures of a result, drawn but not written."""
        drawn = self.draw(script, path.name, *words, "-o", "unwritten", cwd=path.parent, save=lambda *_, **__: None)
        return drawn.expect_silence().figures

    def load(self, name):
        """A module of the scripts."""
        with self._own_modules():
            return importlib.import_module(name)

    @contextlib.contextmanager
    def _own_modules(self):
        """The folder of the script comes first in the path of modules and nothing of the project else is in it; its own
        modules are read anew. `figures`, for one, is a folder of tests and a module of the scripts."""
        own = [path.stem for path in self.folder.glob("*.py")]
        hidden = {name: sys.modules.pop(name) for name in own if name in sys.modules}
        elsewhere = [entry for entry in sys.path if entry and not Path(entry).is_relative_to(self.folder.parent)]
        try:
            with patch.object(sys, "path", [str(self.folder), *elsewhere]):
                yield
        finally:
            for name in own:
                sys.modules.pop(name, None)
            sys.modules.update(hidden)


def exit_code(path):
    """Runs a script as Python does that is given its path; what it does not catch fails the test."""
    try:
        runpy.run_path(path, run_name="__main__")
    except SystemExit as end:
        return int(end.code or 0)
    return 0


@contextlib.contextmanager
def closed():
    try:
        yield
    finally:
        plt.close("all")


@contextlib.contextmanager
def told():
    """Lines of the warnings that a process of its own would write; log messages go to standard error as there."""
    lines = []
    with warnings.catch_warnings(record=True) as caught, patch.object(logging.getLogger(), "handlers", []):
        warnings.simplefilter("default")
        for kind in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
            warnings.simplefilter("ignore", kind)
        warnings.filterwarnings("default", category=DeprecationWarning, module="__main__")
        yield lines
        lines += [warnings.formatwarning(w.message, w.category, w.filename, w.lineno) for w in caught]


# --- cases ---


def label(script, name, options):
    """The name of a case, and of its files."""
    return "-".join([Path(script).stem, name.removesuffix(".h5"), *(option.strip("-") for option in options)])


def cases(rows):
    """Rows (script, result, options, ...) as parameters of a test."""
    return [pytest.param(*row, id=label(*row[:3])) for row in rows]


def draws(scripts, results, folder, script, name, options, endings=("",), suffix="", table=False):
    """The script writes the figures STEM + ending where it is asked to, and nothing else; -o may have a suffix."""
    stem, cwd = folder / label(script, name, options), results.folder_of(f"{name}.h5", *options)
    drawn = scripts.draw(script, f"{name}.h5", "-o", f"{stem}{suffix}", *options, cwd=cwd)
    stems = [f"{stem}{ending}" for ending in endings]
    drawn.expect_files(*stems, table=table)
    assert len(list(folder.iterdir())) == 2 * len(stems)
    return drawn


def refuses(scripts, results, folder, script, name, options, words):
    """One line, and no file is left."""
    cwd = results.folder_of(name, *options)
    before = sorted(cwd.iterdir())
    drawn = scripts.draw(script, name, "-o", folder / "refused", *options, cwd=cwd)
    drawn.expect_refused(f"{script}: {name}: ", words)
    assert not list(folder.iterdir()) and sorted(cwd.iterdir()) == before, "something is left"


def refuses_places(scripts, results, script, name, *options):
    """A folder that is not there, to write to."""
    drawn = scripts.draw(script, name, "-o", "no/such/folder/figure", *options, cwd=results.folder_of(name))
    drawn.expect_refused(f"{script}: {name}: ", "cannot write")


# --- results ---


class Shelf:
    """Results in a folder, each made when it is first asked for: by `makers[name](shelf, path)`."""

    def __init__(self, folder, makers):
        self.folder, self._makers, self._made = folder, makers, set()

    def __getitem__(self, name):
        path = self.folder / f"{name}.h5"
        if name not in self._made:
            self._makers[name](self, path)
            self._made.add(name)
        return path

    def folder_of(self, *words):
        """The folder, with the results in it that the words of a command line name."""
        for word in words:
            if word.endswith(".h5"):
                self[word.removesuffix(".h5")]
        return self.folder


def computed(ricochet, studies):
    """Makers of the results of studies."""

    def maker(text):
        def make(shelf, path):
            path.with_suffix(".yaml").write_text(text)
            ricochet.run(f"{path.stem}.yaml", cwd=shelf.folder).expect_done()

        return make

    return {name: maker(text) for name, text in studies.items()}


def absent(shelf, path):
    """No file."""


def no_hdf5(shelf, path):
    path.write_text("no HDF5\n")


def foreign(name, shape=3):
    """A file with nothing but one data set."""

    def make(shelf, path):
        with h5py.File(path, "w") as file:
            file[name] = np.arange(shape)

    return make


def beginning_of(name):
    return lambda shelf, path: path.write_bytes(shelf[name].read_bytes()[:3000])


def altered(name, change, groups):
    """A copy of some groups of a result, changed by `change(file)`."""

    def make(shelf, path):
        with h5py.File(shelf[name], "r") as old, h5py.File(path, "w") as new:
            for group in groups:
                if group in old:
                    old.copy(group, new)
            new.attrs.update(old.attrs)
            change(new)

    return make


def broken(name, group, rows, outcomes):
    """A copy in which some tasks ended with these outcomes in turn: their numbers are NaN, as the program has them."""

    def change(file):
        columns = file[group]
        kinds = h5py.check_enum_dtype(columns["outcome"].dtype)
        for i, row in enumerate(rows):
            columns["outcome"][row] = kinds[outcomes[i % len(outcomes)]]
            for column in columns.values():
                if column.dtype.kind in "fc":
                    column[row] = np.nan
            if "attractor_period" in columns:
                columns["attractor_period"][row] = 0

    return altered(name, change, (group, "sweep", "special"))


# --- studies of orbits, which all files of tests need at least for refusals ---

RING = """kind: orbits
title: {title}
model: {{type: chain, particles: 6, ends: periodic, gamma: 0.1, floor: -1}}
orbit: {{period: 1.5 pi, at_start: [3]{orbit}}}
sweep:
{sweep}
"""


def ring(title, sweep, orbit=""):
    return RING.format(title=title, sweep=sweep, orbit=orbit)


def over_gamma(values):
    return f"  - {{parameter: model.gamma, {values}}}"


FAMILY = ring("a family", over_gamma("from: 0, to: 0.19, points: 12"))


# --- numbers in figures ---


def column(path, name):
    """A data set, of an enum its names."""
    with h5py.File(path, "r") as file:
        data = file[name]
        kinds = h5py.check_enum_dtype(data.dtype)
        if kinds is None:
            return data[()]
        names = {value: word for word, value in kinds.items()}
        return np.vectorize(names.get, otypes=[object])(data[()])


def points(axes):
    """Points of all lines and markers in data coordinates: [point, 2]."""
    lines = [line.get_xydata() for line in axes.lines if line.get_transform().contains_branch(axes.transData)]
    return np.concatenate([np.empty((0, 2)), *lines])


def assert_among(wanted, *columns):
    """Every wanted point is one of those of the columns x, y."""
    have = set(map(tuple, np.column_stack(columns).tolist()))
    missing = [row for row in map(tuple, np.asarray(wanted).tolist()) if row not in have]
    assert not missing, f"{len(missing)} of {len(wanted)} points are not there, {missing[0]} for one"


def counts(words):
    return dict(zip(*np.unique(np.asarray(words, str), return_counts=True)))
