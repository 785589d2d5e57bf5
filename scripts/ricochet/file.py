"""The HDF5 file of a result: what may be opened, and what its values are in Python.

Enums are words, texts are str, complex numbers complex128. Everything that goes wrong is a ResultError with the file
and the reason.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from typing import Any

import h5py
import numpy as np

from ricochet.sweep import Array

SCHEMA_VERSION = 1  # the latest schema of results that this package reads
_LINKS = {"DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"}  # attributes by which HDF5 attaches scales


class ResultError(Exception):
    """What a file cannot give, and why.

    `path` is the file, `reason` the rest of the message.
    """

    def __init__(self, path: str, reason: str):
        super().__init__(f"{path}: {reason}")
        self.path, self.reason = path, reason


class MissingError(ResultError, KeyError):
    """A table, column or parameter that the result does not have; also a KeyError."""

    __str__ = Exception.__str__  # that of KeyError adds quotes


class ResultFile:
    """A result that is open for reading. Values are read when they are asked for."""

    def __init__(self, path: str | os.PathLike[str]):
        self.path = os.fspath(path)
        self._file = self._opened()
        try:
            self._check_schema()
        except ResultError:
            self.close()
            raise

    def _opened(self) -> h5py.File:
        if not os.path.isfile(self.path):
            raise self.error("there is no such file")
        try:
            if not h5py.is_hdf5(self.path):
                raise self.error("it is not an HDF5 file")
            return h5py.File(self.path, "r")
        except OSError as error:
            raise self.error(f"it is damaged, or cannot be read: {error}") from error

    def _check_schema(self) -> None:
        root = self.attributes("/")
        version = root.get("schema_version")
        if root.get("creator") != "ricochet" or not isinstance(version, int):
            raise self.error("it is not a result of ricochet")
        if not 1 <= version <= SCHEMA_VERSION:
            raise self.error(f"schema_version = {version}, this package reads 1 to {SCHEMA_VERSION}")
        if "study" not in self:
            raise self.error("it has no group /study: an earlier build of ricochet wrote it; run its study again")

    def close(self) -> None:
        self._file.close()

    def error(self, reason: str) -> ResultError:
        return ResultError(self.path, reason)

    @contextlib.contextmanager
    def _reading(self, name: str) -> Iterator[h5py.File]:
        if not self._file:
            raise self.error("it is closed")
        try:
            yield self._file
        except MemoryError:
            raise
        except Exception as error:  # what h5py raises depends on where the damage is
            raise self.error(f"{name} cannot be read, the file is damaged: {error}") from error

    def __contains__(self, name: str) -> bool:
        with self._reading(name) as file:
            return name in file

    def groups(self) -> list[str]:
        """Names of the groups in the root."""
        with self._reading("/") as file:
            return [name for name in file if isinstance(file[name], h5py.Group)]

    def attributes(self, name: str) -> dict[str, Any]:
        """The attributes of a group or a data set as Python values: str, int, float, bool, lists of str, arrays."""
        with self._reading(name) as file:
            attributes = file[name].attrs
            return {key: python_value(attributes[key]) for key in attributes if key not in _LINKS}

    def axes(self, group: str) -> dict[str, tuple[str, ...]]:
        """{name: axes} of the data sets in a group."""
        with self._reading(group) as file:
            return {name: tuple(python_value(data.attrs["axes"]).split()) for name, data in file[group].items()}

    def length(self, name: str) -> int:
        """The extent of the first axis of a data set."""
        with self._reading(name) as file:
            return int(file[name].shape[0])

    def words(self, name: str) -> tuple[str, ...]:
        """The words of an enum in the order of their codes, which count from 0; () of other data sets."""
        with self._reading(name) as file:
            codes = h5py.check_enum_dtype(file[name].dtype) or {}
        return tuple(sorted(codes, key=codes.__getitem__))

    def stored(self, name: str, first: int = 0, last: int | None = None) -> Array:
        """Rows first to last - 1 of a data set as they are stored: codes of enums, bytes of texts."""
        with self._reading(name) as file:
            return np.asarray(file[name][first:last])

    def values(self, name: str, first: int = 0, last: int | None = None) -> Array:
        """The same as words of enums and str of texts."""
        stored = self.stored(name, first, last)
        if stored.dtype.kind == "S":
            with self._reading(name):
                return texts(stored)
        words = self.words(name)
        if not words:
            return stored
        if stored.size and not (stored.min() >= 0 and stored.max() < len(words)):
            raise self.error(f"{name} cannot be read, the file is damaged: a code that has no word")
        return np.array(words)[stored]


def texts(stored: Array) -> Array:
    """Bytes in UTF-8 as str."""
    if stored.size == 0:
        return np.zeros(stored.shape, dtype="U1")
    return np.char.decode(stored, "utf-8")


def python_value(value: Any) -> Any:
    """An attribute as h5py reads it, as a Python value; arrays of numbers stay arrays."""
    if isinstance(value, bytes):
        return value.decode()
    if isinstance(value, np.ndarray) and value.dtype.kind in "SO":
        return [python_value(element) for element in value.tolist()]
    if isinstance(value, np.generic):
        return python_value(value.item())
    return value
