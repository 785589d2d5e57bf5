"""A table of a result: named columns, the task of every row, swept values as coordinates, grids."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ricochet.file import MissingError, ResultFile
from ricochet.sweep import Array, Sweep

if TYPE_CHECKING:
    import xarray

Layout = dict[str, tuple[str, tuple[str, ...]]]  # {column: (its data set, the axes of that)}


class Table:
    """Rows of one table: all of them, or those that were selected.

    Columns are numpy arrays whose first axis is the row: `table["energy"]` [rows], `table["q"]` [rows, particles].
    Enums are words, texts str, complex numbers complex128. Swept values are columns, too: `table["model.gamma"]`.
    Arrays are read when they are asked for, and cannot be written to: use `.copy()`.

    name    as in `result[name]`: "orbits", "branch/point"
    tasks   the task of every row [rows]; None of tables that belong to no task (special points, attractors)
    """

    def __init__(
        self,
        file: ResultFile,
        name: str,
        layout: Layout,
        sweep: Sweep,
        owners: Array | None,
        rows: Array,
        dims: tuple[str, ...],
    ):
        """Made by `Result`. `owners`: the task of every stored row. `rows`: the stored rows of this table, an array
        over the swept parameters `dims` if they are a grid, otherwise a list over the one axis in it."""
        self.name = name
        self._file, self._layout, self._sweep, self._owners = file, layout, sweep, owners
        self._shaped, self._dims = rows, dims
        self._rows = rows.ravel()
        self._read: dict[str, Array] = {}

    def __repr__(self) -> str:
        return f"<Table {self.name}: {len(self)} rows, columns {', '.join(self.columns)}>"

    def __len__(self) -> int:
        """The number of rows."""
        return len(self._rows)

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __contains__(self, name: object) -> bool:
        return name in self._layout or (self._owners is not None and name in self._sweep.names)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns, without those of swept parameters."""
        return tuple(self._layout)

    # --- columns ---

    def __getitem__(self, name: str) -> Array:
        """A column [rows, ...], or the value of a swept parameter at every row [rows]."""
        if name not in self._layout and name in self:
            return self._sweep.values[name][self._known_tasks()]
        if name not in self._read:
            self._read[name] = self._taken(self._file.values, name)
        return self._read[name]

    def codes(self, name: str) -> Array:
        """An enum as integers [rows]: places in `words(name)`."""
        return self._taken(self._file.stored, name)

    def words(self, name: str) -> tuple[str, ...]:
        """The words that an enum may have; () of other columns."""
        return self._file.words(self._data_set(name))

    def attributes(self, name: str) -> dict[str, Any]:
        """What the file says about a column: units, long_name, source, tolerances; `parameter`, the key of the study
        whose values it holds; `observed`, the number of the state that it holds."""
        return self._file.attributes(self._data_set(name))

    def axes_of(self, name: str) -> tuple[str, ...]:
        """The names of the axes of a column as stored: ("task", "particle")."""
        self._data_set(name)
        return self._layout[name][1]

    def _data_set(self, name: str) -> str:
        if name not in self._layout:
            has = ", ".join((*self.columns, *self.coordinates))
            raise MissingError(self._file.path, f"{self.name} has no column {name}; it has {has}")
        return self._layout[name][0]

    def _taken(self, read: Callable[[str, int, int], Array], name: str) -> Array:
        """The rows of this table from a data set, of which no more is read than from the first to the last."""
        data_set = self._data_set(name)
        first, last = (int(self._rows.min()), int(self._rows.max()) + 1) if len(self) else (0, 0)
        block = read(data_set, first, last)
        if len(block) != last - first:
            raise self._file.error(f"{data_set} has fewer rows than its table, the file is damaged")
        if len(self) != last - first or (np.diff(self._rows) != 1).any():
            block = block[self._rows - first]
        block.flags.writeable = False
        return block

    # --- swept values ---

    @property
    def tasks(self) -> Array | None:
        return None if self._owners is None else self._known_tasks()

    def _known_tasks(self) -> Array:
        if self._owners is None:
            raise self._file.error(f"the rows of {self.name} belong to no task and have no swept values")
        tasks: Array = self._owners[self._rows]
        return tasks

    @property
    def coordinates(self) -> dict[str, Array]:
        """{swept parameter: its value at every row [rows]}."""
        if self._owners is None:
            return {}
        return {name: self[name] for name in self._sweep.names}

    @property
    def is_grid(self) -> bool:
        """Whether the rows are the points of a grid: one row per task, and all tasks, or lines and planes of them."""
        return all(name in self._sweep.names for name in self._dims)

    @property
    def axes(self) -> dict[str, Array]:
        """{swept parameter: its values [points]} of a grid, in the order of the sweeps; parameters for which one value
        was selected are left out."""
        self._expect_grid()
        found = {}
        for place, name in enumerate(self._dims):
            line = tuple(slice(None) if other == place else 0 for other in range(self._shaped.ndim))
            found[name] = self[name].reshape(self._shaped.shape)[line]
        return found

    def grid(self, name: str) -> Array:
        """A column as an array with one axis per sweep, in the order of `axes`, followed by the column's own axes."""
        self._expect_grid()
        column = self[name]
        return column.reshape(self._shaped.shape + column.shape[1:])

    def _expect_grid(self) -> None:
        if not self.is_grid:
            raise self._file.error(f"these rows of {self.name} are no grid: it has one row per task, before `where`")

    # --- selection ---

    def _with(self, rows: Array, dims: tuple[str, ...]) -> Table:
        return Table(self._file, self.name, self._layout, self._sweep, self._owners, rows, dims)

    def _row_dim(self) -> str:
        """The axis of the stored rows, "task" or "point_row"."""
        return next(iter(self._layout.values()))[1][0]

    def _without_grid(self, rows: Array) -> Table:
        return self._with(rows, (self._row_dim(),))

    def select(self, at: Mapping[str, float] | None = None, /, *, exact: bool = False, **more: float) -> Table:
        """The rows whose swept values are nearest to those given; with `exact` they are equal but for rounding.

        `table.select({"model.gamma": 0.1})`, or `table.select(gamma=0.1)` if no other swept parameter ends so. A value
        outside the sweep is a ResultError. A grid stays a grid, without the axes of the parameters given. A value that
        stands twice in a sweep (there and back) gives the rows of both.
        """
        self._known_tasks()
        table = self
        for name, value in {**(at or {}), **more}.items():
            try:
                full = self._sweep.full_name(name)
                chosen = self._sweep.nearest(full, value, exact)
            except ValueError as error:
                raise self._file.error(str(error)) from None
            table = table._line(full, chosen)
        return table

    def _line(self, name: str, value: float) -> Table:
        """The rows at which a swept parameter has this value."""
        if not self.is_grid or name not in self._dims:
            return self._without_grid(self._rows[self[name] == value])
        place = self._dims.index(name)
        found = np.flatnonzero(self.axes[name] == value)
        if len(found) > 1:
            return self._with(np.take(self._shaped, found, axis=place), self._dims)
        left = self._dims[:place] + self._dims[place + 1 :]
        return self._with(np.take(self._shaped, found[0], axis=place), left)

    def where(self, condition: Array | None = None, /, **equal: Any) -> Table:
        """The rows that satisfy a condition [rows] of bools, or whose columns have the given values.

        `table.where(table["energy"] < 1)`, `table.where(outcome="admissible", side=["floor", "wall"])`: a list allows
        each of its values. Swept values are compared as they are stored; `select` allows for rounding. A word that the
        enum does not have is a ResultError.
        """
        kept = np.ones(len(self), dtype=bool)
        if condition is not None:
            condition = np.asarray(condition)
            if condition.shape != kept.shape or condition.dtype != bool:
                raise self._file.error(f"a condition on {self.name} is an array of {len(self)} bools")
            kept &= condition
        for name, allowed in equal.items():
            kept &= np.isin(self[name], self._checked(name, np.atleast_1d(allowed)))
        return self._without_grid(self._rows[kept])

    def _checked(self, name: str, allowed: Array) -> Array:
        words = self.words(name) if name in self._layout else ()
        for value in allowed.tolist():
            if words and value not in words:
                raise self._file.error(f"{self.name}: {name} is never {value!r}; its words are {', '.join(words)}")
        return allowed

    def task(self, task: int) -> Table:
        """The rows of one task."""
        tasks, count = self._known_tasks(), self._sweep.tasks
        if not 0 <= task < count:
            raise self._file.error(f"it has no task {task}, only tasks 0 to {count - 1}")
        return self._without_grid(self._rows[tasks == task])

    def by_task(self) -> Iterator[Table]:
        """The rows of every task of the result, one after another; some may have none."""
        tasks = self._known_tasks()
        order = np.argsort(tasks, kind="stable")
        edges = np.searchsorted(tasks[order], np.arange(self._sweep.tasks + 1))
        return (self._without_grid(self._rows[order[low:high]]) for low, high in zip(edges, edges[1:]))

    # --- xarray ---

    def to_xarray(self) -> xarray.Dataset:
        """An xarray.Dataset: a grid has the swept parameters as dimensions and coordinates, another table the axis of
        its rows, with swept values and tasks along it. A column that is called like an axis has the name of the table
        before its own (special_particle). A ResultError if xarray is not installed."""
        try:
            import xarray
        except ImportError as error:
            raise self._file.error("to_xarray needs xarray (Debian: python3-xarray)") from error
        rows = self._dims if self._owners is not None and self.is_grid else (self._row_dim(),)
        across = {axis for _, axes in self._layout.values() for axis in axes[1:]}
        variables = {}
        for name, (_, axes) in self._layout.items():
            column = self[name].reshape(self._shaped.shape + self[name].shape[1:])
            variable = f"{self.name.rpartition('/')[2]}_{name}" if name in across else name
            variables[variable] = (rows + axes[1:], column, self.attributes(name))
        data = xarray.Dataset(variables, attrs={"table": self.name})
        return data.assign_coords(self._xarray_coordinates(rows))

    def _xarray_coordinates(self, rows: tuple[str, ...]) -> dict[str, Any]:
        if self._owners is None:
            return {}
        found: dict[str, Any] = {"task": (rows, self._owners[self._shaped])}
        for name, values in self.coordinates.items():
            if name in rows:
                found[name] = (name, self.axes[name])
            elif self.is_grid and len(values):  # the one that was selected
                found[name] = values[0]
            else:
                found[name] = (rows, values)
        return found
