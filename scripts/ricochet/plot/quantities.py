"""What may be on an axis: a numeric column of a table, an element of it, a swept parameter, or the number of the row."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ricochet.plot.sheet import FigureError
from ricochet.plot.words import parameter_label, state_symbol, with_units
from ricochet.result import Result
from ricochet.sweep import Array
from ricochet.table import Table

ROW = "row"
_LONGEST = 80  # letters of a label
# What only says something beside other columns: "the same of a velocity", "particle of it".
_RELATIVE = re.compile(
    r"(its|this|the same|of|between|when|parameter at)\b.*|.*\b(there|it|them|then|others)\b.*|.*ends"
)


@dataclass(frozen=True)
class Quantity:
    """Numbers of a table.

    name    as it was asked for: "energy", "q[3]", "model.gamma"
    values  [rows, ...], real; infinite ones are NaN
    axes    names of the axes behind the first
    label   of an axis, with units
    """

    name: str
    values: Array
    axes: tuple[str, ...]
    label: str


def numeric_columns(table: Table) -> list[str]:
    """Columns that hold numbers, not words or texts."""
    return [name for name in table.columns if table[name].dtype.kind in "iufcb"]


def quantity(result: Result, table: Table, name: str) -> Quantity:
    """The quantity of this name. `q[3]` is element 3 of the column's last axis, `L[0,1]` one of its last two."""
    if name == ROW:
        return Quantity(name, np.arange(len(table), dtype=float), (), f"row of {table.name}")
    if name in table and name not in table.columns:
        return Quantity(name, table[name].astype(float), (), parameter_label(result, name))
    column, places = _parsed(name)
    if column not in numeric_columns(table):
        words = "holds words" if column in table.columns else "is no column"
        names = ", ".join([*numeric_columns(table), *table.coordinates])
        raise FigureError(result.path, f"{column} {words} of {table.name}; its columns of numbers are {names}")
    values, axes = table[column], table.axes_of(column)[1:]
    if len(places) > len(axes):
        raise FigureError(result.path, f"{name}: {column} has the axes [{', '.join(axes) or 'row'}] only")
    label = [_meaning(result, table, column)]
    for place in reversed(places):
        extent = values.shape[-1]
        if place >= extent:
            raise FigureError(result.path, f"{name}: the axis {axes[-1]} of {column} has {extent} elements, from 0")
        values, label, axes = values[..., place], [*label, f"{axes[-1]} {place}"], axes[:-1]
    text = ", ".join([label[0], *reversed(label[1:])])
    return Quantity(name, _real(values), axes, with_units(text, table.attributes(column).get("units")))


def _parsed(name: str) -> tuple[str, list[int]]:
    found = re.fullmatch(r"(.*)\[(\d+(?:,\s*\d+)*)\]", name)
    return (found[1], [int(place) for place in found[2].split(",")]) if found else (name, [])


def _real(values: Array) -> Array:
    """Numbers to draw, of complex ones the modulus."""
    real = np.abs(values) if np.iscomplexobj(values) else values.astype(float)
    return np.where(np.isfinite(real), real, np.nan)


def _meaning(result: Result, table: Table, column: str) -> str:
    """What the file says about a column, up to the first restriction; its name where that depends on other columns."""
    said = table.attributes(column)
    if said.get("parameter"):
        return parameter_label(result, str(said["parameter"]))
    if said.get("observed"):
        return state_symbol(str(said["observed"]))
    text = re.split(r"[,;:]| \(", str(said.get("long_name", "")))[0].strip()
    if len(text) < 3 or len(text) > _LONGEST or _RELATIVE.fullmatch(text):
        text = column.replace("_", " ")
    return f"{text}, modulus" if table[column].dtype.kind == "c" else text
