"""Fixtures of the tests of figures: pictures of the results that a file names in STUDIES and MADE."""

import sys
import tempfile
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent.parent / "scripts"), str(HERE)]
pytest.register_assert_rewrite("album", "both")

from album import Album  # noqa: E402  # behind the path to it
from shelf import Shelf, computed  # noqa: E402


@pytest.fixture(scope="module")
def results(ricochet, request):
    """The results of the studies of a file, STUDIES, and those that it makes by hand, MADE."""
    module = request.module
    with tempfile.TemporaryDirectory(prefix="ricochet-") as path:
        yield Shelf(Path(path), computed(ricochet, module.STUDIES) | getattr(module, "MADE", {}))


@pytest.fixture(scope="module")
def picture(results):
    """`picture("modes", "family", all=True)`: a picture of a result, drawn once."""
    album = Album(results)
    yield album
    album.close()


def pytest_generate_tests(metafunc):
    """The cases of the tests in both.py: those of the file that imports them."""
    if "figure_fits" in metafunc.fixturenames:
        metafunc.parametrize("figure_fits, name, options", metafunc.module.PICTURES)
    if "figure_refused" in metafunc.fixturenames:
        metafunc.parametrize("figure_refused, name, options, words", metafunc.module.REFUSALS)
