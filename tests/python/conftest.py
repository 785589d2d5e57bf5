"""Puts the package and what these tests share into Python's path."""

import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent.parent / "scripts"), str(HERE)]
pytest.register_assert_rewrite("small_results")
