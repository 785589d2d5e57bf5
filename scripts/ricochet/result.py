"""A result: the parameters of its study, and the tables in it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ricochet.file import MissingError, ResultFile, python_value
from ricochet.sweep import Array, Sweep
from ricochet.table import Layout, Table

if TYPE_CHECKING:
    import xarray

_NO_TABLES = {"run", "study", "sweep"}  # groups of attributes, and that of the swept values
_FOUND = {"attractor_row": "found"}  # what columns begin with whose axis has another name
_UNITS = ":units"  # what follows a parameter's name in that of the attribute with its units


def open(path: str | os.PathLike[str]) -> Result:  # noqa: A001  # used as ricochet.open
    """Opens a result for reading. A file that is no result, damaged, or of a later schema is a ResultError."""
    return Result(path)


class Result:
    """One result, open for reading; `with ricochet.open(path) as result:` closes it.

    path        the file
    parameters  {key of the study: value}, the defaults filled in: float, int, bool, str, list of str, array of numbers
                [elements]; None for null (nan as an element of an array). Swept ones have their value at the first task
    units       {key: units} of parameters that are not dimensionless
    swept       the keys that are swept, in the order of the sweeps: ("model.gamma", "model.floor[3]")
    given       the keys that the study gives; all others have their defaults
    kind        "orbits", "trajectory", "branch", "grazing", "diagram" or "basin"
    title       the title of the study, "" if it has none
    sweep       the grid of the tasks
    """

    def __init__(self, path: str | os.PathLike[str]):
        self._file = ResultFile(path)
        self.path: str = self._file.path
        try:
            self._read_study()
            self.sweep: Sweep = self._read_sweep()
            self._layouts = self._read_layouts()
            self._tables: dict[str, Table] = {}  # those that were asked for, which keep the columns that were read
        except BaseException:
            self.close()
            raise

    def __repr__(self) -> str:
        return f"<Result {self.path}: kind {self.kind}, {self.sweep.tasks} tasks, tables {', '.join(self.tables)}>"

    def __enter__(self) -> Result:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file; arrays that were read stay."""
        self._file.close()

    # --- parameters ---

    def _read_study(self) -> None:
        study = self._file.attributes("study")
        missing = {"swept", "given", "kind"} - study.keys()
        if missing:
            raise self._file.error(f"/study has no {min(missing)}, the file is damaged")
        self.swept: tuple[str, ...] = _names(study.pop("swept"))
        self.given: tuple[str, ...] = _names(study.pop("given"))
        self.units: dict[str, str] = {
            name.removesuffix(_UNITS): text for name, text in study.items() if name.endswith(_UNITS)
        }
        self.parameters: dict[str, Any] = {
            name: _parameter(value) for name, value in study.items() if not name.endswith(_UNITS)
        }
        self.kind: str = self.parameters["kind"]
        self.title: str = self.parameters.get("title") or ""

    def parameters_of(self, task: int) -> dict[str, Any]:
        """The parameters of one task: `parameters` with the swept values of that task."""
        self._check_task(task)
        found = dict(self.parameters)
        for name in self.swept:
            _assign(found, name, self.sweep.values[name][task].item())
        return found

    def _check_task(self, task: int) -> None:
        if not 0 <= task < self.sweep.tasks:
            raise self._file.error(f"it has no task {task}, only tasks 0 to {self.sweep.tasks - 1}")

    def _read_sweep(self) -> Sweep:
        tasks = self._file.length("task")
        shape = self._file.attributes("sweep").get("grid", ()) if self.swept else ()
        shape = tuple(int(points) for points in np.atleast_1d(shape))
        values = {name: self._file.values(f"sweep/{name}") for name in self.swept}
        if len(shape) != len(self.swept) or np.prod(shape, dtype=int) != tasks:
            raise self._file.error(f"its {tasks} tasks do not fill the grid of /sweep, the file is damaged")
        if any(column.shape != (tasks,) for column in values.values()):
            raise self._file.error("a column of /sweep does not have one value per task, the file is damaged")
        return Sweep(self.swept, shape, values)

    # --- tables ---

    def _read_layouts(self) -> dict[str, Layout]:
        """{table: layout}. A group holds the table of its own name, and one for each further axis of rows, whose
        columns begin with its name: point_energy [point_row] is the column energy of branch/point."""
        tables: dict[str, Layout] = {}
        for group in self._file.groups():
            axes = {} if group in _NO_TABLES else self._file.axes(group)
            has_tasks = any(along[0] == "task" for along in axes.values())
            for name, along in axes.items():
                table, column = group, name
                if along[0] == "task_edge":
                    continue
                if has_tasks and along[0] != "task":
                    word = _FOUND.get(along[0]) or along[0].removesuffix("_row")
                    table, column = f"{group}/{word}", name.removeprefix(f"{word}_")
                tables.setdefault(table, {})[column] = (f"{group}/{name}", along)
        return tables

    @property
    def tables(self) -> tuple[str, ...]:
        """Names of the tables: that of the kind with one row per task ("branch"), ragged ones ("branch/point"), and
        "special", "window", "basin/found"."""
        return tuple(self._layouts)

    def __contains__(self, name: object) -> bool:
        return name in self._layouts

    def __getitem__(self, name: str) -> Table:
        """A table with all its rows; of ragged tables those of all tasks, one after another."""
        if name not in self._layouts:
            raise MissingError(self.path, f"it has no table {name}; it has {', '.join(self.tables)}")
        if name not in self._tables:
            self._tables[name] = self._table(name)
        return self._tables[name]

    def _table(self, name: str) -> Table:
        layout = self._layouts[name]
        data_set, (row_axis, *_) = next(iter(layout.values()))
        rows = np.arange(self._file.length(data_set))
        owners = self._owners(name, row_axis, len(rows))
        if row_axis == "task":
            return Table(self._file, name, layout, self.sweep, owners, rows.reshape(self.sweep.shape), self.swept)
        return Table(self._file, name, layout, self.sweep, owners, rows, (row_axis,))

    def _owners(self, name: str, row_axis: str, length: int) -> Array | None:
        """The task of every stored row of a table; None if its rows belong to no task."""
        tasks = np.arange(self.sweep.tasks)
        if row_axis == "task":
            if length != len(tasks):
                raise self._file.error(f"/{name} does not have one row per task, the file is damaged")
            return tasks
        if name == "window":
            return self._window_tasks()
        if "/" in name and f"{name}_offset" in self._file:
            return np.repeat(tasks, self._counts(f"{name}_offset", length))
        return None

    def _window_tasks(self) -> Array:
        owners = self._file.values("window/task")
        if owners.size and not (owners.min() >= 0 and owners.max() < self.sweep.tasks):
            raise self._file.error("/window/task names a task that there is not, the file is damaged")
        return owners

    def _counts(self, data_set: str, length: int) -> Array:
        """The number of rows of every task of a ragged table."""
        edges = self._file.values(data_set)
        counts = np.diff(edges)
        if len(counts) != self.sweep.tasks or edges[0] != 0 or edges[-1] != length or (counts < 0).any():
            raise self._file.error(f"/{data_set} does not bound the rows of its table, the file is damaged")
        return counts

    @property
    def special_points(self) -> Table:
        """The table of special points: "special" of orbits, "branch/special" of branches."""
        for name in ("special", "branch/special"):
            if name in self:
                return self[name]
        raise MissingError(self.path, "it has no table of special points")

    def to_xarray(self, name: str) -> xarray.Dataset:
        """The same as `result[name].to_xarray()`, with title and kind as attributes."""
        return self[name].to_xarray().assign_attrs(title=self.title, kind=self.kind)


def _names(value: Any) -> tuple[str, ...]:
    """A list of names as h5py reads it; one without elements may be an empty array of any type."""
    return tuple(value) if len(value) else ()


def _parameter(value: Any) -> Any:
    """An attribute of /study: nan is null."""
    value = python_value(value)
    return None if isinstance(value, float) and np.isnan(value) else value


def _assign(parameters: dict[str, Any], name: str, value: float) -> None:
    """Sets a swept parameter, or an element of a list by its index, as in model.floor[3]."""
    list_name, _, index = name.partition("[")
    if not index:
        parameters[name] = int(value) if isinstance(parameters.get(name), int) else value
    else:
        elements = np.array(parameters[list_name])
        elements[int(index.removesuffix("]"))] = value
        parameters[list_name] = elements
