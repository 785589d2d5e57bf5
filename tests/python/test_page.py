"""The scripts of docs/python.md run as they stand there; docs/figures.md is what the package prints of its figures."""

import os
import re
import subprocess

import h5py
import pytest
from program import environment

DUFFING = "duffing"  # a branch with two folds, for the second script


@pytest.fixture
def page(source):
    return (source / "docs" / "python.md").read_text()


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", page, re.M | re.S)


def python(script, source, folder):
    env = {**environment(), "PYTHONPATH": str(source / "scripts"), "MPLBACKEND": "Agg"}
    words = ["/usr/bin/python3", "-B", "-c", script]
    done = subprocess.run(words, cwd=folder, env=env, capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    return done.stdout


def test_the_ten_lines_draw_a_figure_of_the_shipped_grid(ricochet, page, source, folder):
    commands = blocks(page, "sh")[0]
    path = f"{ricochet.binary.parent}:{os.environ['PATH']}"
    subprocess.run(
        ["sh", "-ec", commands], cwd=folder, env=environment({"PATH": path}), check=True, capture_output=True
    )
    script = blocks(page, "python")[0]
    assert len(script.splitlines()) == 10
    shown = "\nfor line in plt.gca().lines: print(line.get_label(), *line.get_xdata()[-1:], *line.get_ydata()[-1:], sep=';')"
    drawn = [line.split(";") for line in python(script + shown, source, folder).splitlines()]
    with h5py.File(folder / "grid.h5") as file:
        for (label, gamma, energy), wanted in zip(drawn, (3.6, 4.2, 4.8), strict=True):
            at = (file["sweep/model.gamma"][()] == float(gamma)) & (file["orbits/energy"][()] == float(energy))
            assert at.sum() == 1 and abs(file["sweep/orbit.period"][at][0] - wanted) < 0.02, label
            assert label == f"T = {file['sweep/orbit.period'][at][0]:.3g}"
    assert (folder / "energy.pdf").read_bytes().startswith(b"%PDF")


def test_the_script_of_figures_draws_and_lists(ricochet, page, source, folder):
    ricochet.run(ricochet.studies / f"{DUFFING}.yaml", "-o", "branch.h5", cwd=folder).expect_done()
    assert "'branch'" in python(blocks(page, "python")[2], source, folder)
    assert (folder / "branch.svg").stat().st_size > 10000
    assert (folder / "branch.pdf").read_bytes().startswith(b"%PDF")


def test_the_script_over_tasks_prints_a_branch(ricochet, page, source, folder):
    ricochet.run(ricochet.studies / f"{DUFFING}.yaml", "-o", "branch.h5", cwd=folder).expect_done()
    lines = python(blocks(page, "python")[1], source, folder).splitlines()
    assert len(lines[0].split()) == 2 and float(lines[0].split()[0]) > 0
    assert "[" in lines[1]


# The figures of the sources that computed numbers can draw, and their names here.
OF_SOURCES = {
    "Example 1 of [JAP]": "modes",
    "[VID] Figure 2, left": "frequency-energy",
    "[VID] Figure 2, right": "manifold",
    "[FN97] Figure 3": "criterion",
    "[FN97] Figure 4": "diagram",
    "[FN97] Figure 5": "scaled",
    "[FN97] Figure 6": "attractor",
}


def test_the_page_of_figures_is_up_to_date(source, folder):
    printed = python("from ricochet.plot.reference import page; print(page(), end='')", source, folder)
    assert (source / "docs" / "figures.md").read_text() == printed, "python3 -m ricochet.plot.reference > docs/figures.md"


def test_every_figure_of_the_sources_has_a_name(source, folder):
    code = "import ricochet.plot; print(*(f'{s.source}={s.name}' for s in ricochet.plot.CATALOGUE.values() if s.source), sep=';')"
    assert dict(item.split("=") for item in python(code, source, folder).strip().split(";")) == OF_SOURCES
