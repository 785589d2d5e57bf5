"""Results of ricochet as numpy arrays: parameters, tables of columns, swept values as coordinates.

    result = ricochet.open("grid.h5")
    result.parameters["model.particles"]                        # 30
    orbits = result["orbits"].select({"orbit.period": 4.5})     # a line of the grid
    orbits["model.gamma"], orbits["energy"]                     # arrays [rows]

    ricochet.plot.sweep(result)                                 # a figure; needs matplotlib

`Result` is a file, `Table` a table in it; what a file cannot give is a `ResultError`. docs/python.md has a page on it,
docs/results.md lists tables and columns.
"""

from __future__ import annotations

import importlib
from typing import Any

from ricochet.file import MissingError, ResultError
from ricochet.result import Result, open  # noqa: A004  # ricochet.open(path), as h5py.File(path) would not say
from ricochet.sweep import Sweep
from ricochet.table import Table

__all__ = ["MissingError", "Result", "ResultError", "Sweep", "Table", "open"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """`ricochet.plot` is imported when it is first used: matplotlib is large, and reading does without it."""
    if name == "plot":
        return importlib.import_module("ricochet.plot")
    raise AttributeError(f"module 'ricochet' has no attribute {name!r}")
