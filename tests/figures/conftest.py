"""Fixtures of the tests of figures: the scripts, and folders for the results that they draw."""

import sys
import tempfile
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
pytest.register_assert_rewrite("drawing")

from drawing import Scripts  # noqa: E402  # behind the path to it


@pytest.fixture
def scripts(source, capfd):
    return Scripts(source / "scripts", capfd)


@pytest.fixture(scope="module")
def shared():
    """A folder that lasts as long as the tests of a file."""
    with tempfile.TemporaryDirectory(prefix="ricochet-") as path:
        yield Path(path)
