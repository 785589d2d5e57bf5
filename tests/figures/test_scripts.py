"""What all scripts that draw have in common: how they start, and their help."""

import os

import pytest

# What the help says, besides --output.
HELP = {
    "plot_approach.py": ["/orbits/outcome"],
    "plot_attractor.py": ["/diagram/outcome"],
    "plot_basin.py": ["/basin/outcome"],
    "plot_branch.py": ["/branch/outcome"],
    "plot_curves.py": ["/branch/outcome"],
    "plot_diagram.py": ["/diagram/outcome"],
    "plot_frequency_energy.py": ["/branch/outcome"],
    "plot_grazing.py": ["/grazing/outcome"],
    "plot_grazing_curve.py": ["/grazing/outcome"],
    "plot_grazing_windows.py": ["/grazing/verdict"],
    "plot_laws.py": ["/branch/point_parameter"],
    "plot_manifold.py": ["/branch/point_history_q"],
    "plot_map.py": ["/orbits/outcome"],
    "plot_modes.py": ["/orbits/outcome"],
    "plot_motions.py": ["/branch/point_history_q"],
    "plot_multipliers.py": ["/orbits/outcome"],
    "plot_periods.py": ["/diagram/outcome"],
    "plot_ritz.py": ["/orbits/ritz_functions"],
    "plot_stability.py": ["/orbits/outcome"],
    "plot_sweep.py": ["/orbits/outcome"],
    "plot_windows.py": ["/window/task"],
}


def expect_help(drawn, words):
    told = drawn.expect_silence().out
    for word in ["--output", *words]:
        assert word in told, told


@pytest.mark.parametrize("script", HELP)
def test_help_names_the_datasets(scripts, folder, script):
    expect_help(scripts.draw(script, "--help", cwd=folder), HELP[script])


def test_help_of_a_process(scripts, folder):
    expect_help(scripts.start("plot_modes.py", "--help", cwd=folder), HELP["plot_modes.py"])


def test_scripts_start_by_their_first_line(scripts):
    """And none is missing in these tests."""
    paths = {path.name: path for pattern in ("plot_*.py", "animate_*.py") for path in scripts.folder.glob(pattern)}
    assert paths.keys() == HELP.keys()
    for path in paths.values():
        assert path.read_text().startswith("#!/usr/bin/python3\n") and os.access(path, os.X_OK), path.name
