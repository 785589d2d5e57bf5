"""Fixtures of the tests in Python: the program under test, and an empty folder for each test."""

import os
import sys
import tempfile
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # tests run side by side already; before numpy is loaded
sys.path[:0] = [str(TESTS / "harness"), str(TESTS / "cli"), str(TESTS / "faults")]

from program import Program  # noqa: E402  # behind the path to it


def pytest_addoption(parser):
    parser.addoption("--build", type=Path, default=TESTS.parent / "build" / "release", help="folder of the build")


@pytest.fixture(scope="session")
def source():
    """The folder of the project."""
    return TESTS.parent


@pytest.fixture(scope="session")
def build(request):
    """The folder of the build under test."""
    return request.config.getoption("--build").resolve()


@pytest.fixture(scope="session")
def sanitized(build):
    """Whether the build has sanitizers in it."""
    return "RICOCHET_SANITIZE:BOOL=ON" in (build / "CMakeCache.txt").read_text()


@pytest.fixture(scope="session")
def ricochet(build, source):
    with tempfile.TemporaryDirectory(prefix="ricochet-") as shared:
        yield Program(build / "bin" / "ricochet", source, Path(shared))


@pytest.fixture
def folder():
    with tempfile.TemporaryDirectory(prefix="ricochet-", ignore_cleanup_errors=True) as path:
        yield Path(path)


@pytest.fixture(autouse=True)
def nothing_is_left_running(request):
    yield
    if "ricochet" in request.fixturenames:
        request.getfixturevalue("ricochet").end_all()
