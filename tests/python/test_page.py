"""The scripts of docs/python.md run as they stand there."""

import os
import re
import subprocess

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
    assert len(script.splitlines()) <= 14
    shown = "\nfor line in plt.gca().lines: print(line.get_label(), len(line.get_xdata()), *line.get_ydata()[:1])"
    drawn = [line.rsplit(" ", 2) for line in python(script + shown, source, folder).splitlines()]
    assert [(label, int(points)) for label, points, _ in drawn][0] == ("solutions of the equations", 100)
    assert drawn[1][0] == "admissible orbits" and 10 < int(drawn[1][1]) < 100
    assert (folder / "energy.pdf").read_bytes().startswith(b"%PDF")


def test_the_script_over_tasks_prints_a_branch(ricochet, page, source, folder):
    ricochet.run(ricochet.studies / f"{DUFFING}.yaml", "-o", "branch.h5", cwd=folder).expect_done()
    lines = python(blocks(page, "python")[1], source, folder).splitlines()
    assert len(lines[0].split()) == 2 and float(lines[0].split()[0]) > 0
    assert "[" in lines[1]
