"""The sheet that a figure is drawn on: panels that keep their size, a heading above them, notes and a legend below.

Text is measured before it is placed: headings are wrapped, and a legend has as many columns as fit.
"""

from __future__ import annotations

import contextlib
import functools
import os
import re
from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import TextPath

from ricochet.file import ResultError
from ricochet.plot import look
from ricochet.plot.words import system
from ricochet.result import Result

COLUMN = 3.4  # inches: a column of a journal
_COLUMN_TEXT = 7.5  # points, of figures so narrow
_TEXT = 10.0
_MARGIN = 0.12  # inches, around headings and legends
_LINE = 1.35  # height of a line of text over its size
_HINTING = 0.99  # of the room for text: letters on pixels are wider than their outlines
_SLENDER = 0.55  # power of its shrinking with which a figure loses height


class FigureError(ResultError):
    """What a figure needs and the result does not have; `reason` says what is missing."""


@dataclass(frozen=True)
class Style:
    """How figures are drawn: `column` as wide as a column of a journal, or `width` inches wide; `title` above them
    instead of the study's, "" for none; limits of the axes."""

    column: bool = False
    width: float | None = None
    title: str | None = None
    xlim: tuple[float, float] | None = None
    ylim: tuple[float, float] | None = None


_style: ContextVar[Style] = ContextVar("style", default=Style())


@contextlib.contextmanager
def style(**changes: Any) -> Iterator[None]:
    """Figures that are drawn inside have this style: `with ricochet.plot.style(column=True, title=""): ...`."""
    token = _style.set(replace(_style.get(), **changes))
    try:
        yield
    finally:
        _style.reset(token)


@contextlib.contextmanager
def settings() -> Iterator[None]:
    """matplotlib's settings for the style at hand."""
    with mpl.rc_context({**look.settings(_text_size()), "savefig.dpi": 300 if is_narrow() else 160}):
        yield


def _text_size() -> float:
    now = _style.get()
    width = COLUMN if now.column else now.width
    return _TEXT if width is None or width >= 6 else _COLUMN_TEXT


def is_narrow() -> bool:
    """Whether panels should stand below one another rather than side by side."""
    return _text_size() < _TEXT


class Sheet:
    """A figure in the making.

        sheet = Sheet(result, 8.6, 5.4, rows=2, heights=(2, 1))
        upper = sheet.panel(0)
        lower = sheet.panel(1, sharex=upper)
        ...
        sheet.legend(entries)
        sheet.note("3 periods above 12 are not shown")
        return sheet.finish(varied=["model.force"])

    `width`, `height`: inches that the panels take, without heading and legend. The first panel is the main one, to
    which limits of the style apply; the horizontal ones apply to all panels that share its axis.
    """

    def __init__(
        self,
        result: Result,
        width: float,
        height: float,
        rows: int = 1,
        columns: int = 1,
        heights: Sequence[float] | None = None,
        widths: Sequence[float] | None = None,
    ):
        now = _style.get()
        wanted = COLUMN if now.column else now.width or width
        self.result = result
        self.width, self.height = wanted, height * (wanted / width) ** _SLENDER
        self.figure: Figure = plt.figure(figsize=(self.width, self.height), constrained_layout=True)
        self.figure.get_layout_engine().set(w_pad=0.1 if wanted >= 6 else 0.06)
        self.cells = self.figure.add_gridspec(rows, columns, height_ratios=heights, width_ratios=widths)
        self.panels: list[Axes] = []
        self._entries: list[Artist] = []
        self._notes: list[str] = []

    def panel(self, row: Any = 0, column: Any = 0, **options: Any) -> Axes:
        """Axes in a cell, or over the cells of a slice."""
        axes = self.figure.add_subplot(self.cells[row, column], **options)
        self.panels.append(axes)
        return axes

    def legend(self, entries: Sequence[Artist]) -> None:
        """Entries of the legend below the panels, behind those that are there; one of each label."""
        for entry in entries:
            if entry.get_label() not in [other.get_label() for other in self._entries]:
                self._entries.append(entry)

    def note(self, text: str) -> None:
        """A sentence in small letters below the panels: what is not shown, and why."""
        self._notes.append(text)

    def finish(self, about: str = "", varied: Sequence[str] = (), words: Sequence[str] = ()) -> Figure:
        """Places heading, notes and legend, and applies the limits of the style.

        about   what the figure shows, where the study's title does not say it: a line of its own
        varied  parameters besides the swept ones that the figure shows, and its heading does not
        words   what the heading says behind the system: the task, the verdict
        """
        self.apply_limits()
        top = self._place_heading(about, [*system(self.result, varied), *words])
        bottom = self._place_below()
        whole = self.height + top + bottom
        self.figure.set_size_inches(self.width, whole)
        self.figure.get_layout_engine().set(rect=(0, bottom / whole, 1, self.height / whole))
        for text, down in self._heading:
            text.set_y(1 - down / whole)
        for artist, up in self._below:
            if isinstance(artist, mpl.legend.Legend):
                artist.set_bbox_to_anchor((_MARGIN / self.width, up / whole), self.figure.transFigure)
            else:
                artist.set_y(up / whole)
        return self.figure

    # --- limits ---

    def apply_limits(self) -> None:
        """Sets the limits of the style. `finish` does so; before it, a figure whose drawing depends on its limits."""
        now, main = _style.get(), self.panels[0]
        for axis, limits in (("x", now.xlim), ("y", now.ylim)):
            if limits is None:
                continue
            if getattr(main, f"get_{axis}scale")() == "log" and min(limits) <= 0:
                raise FigureError(self.result.path, f"limits {limits[0]:g} {limits[1]:g} of a logarithmic axis: both > 0")
            getattr(main, f"set_{axis}lim")(*limits)

    # --- the heading ---

    def _place_heading(self, about: str, parts: Sequence[str]) -> float:
        """Lines at the left edge; the height that they take."""
        title = self.result.title if _style.get().title is None else _style.get().title
        size, room = mpl.rcParams["font.size"], 72 * (self.width - 2 * _MARGIN)
        lines: list[tuple[str, dict[str, Any]]] = []
        if title:
            big = {"size": 1.2 * size, "weight": "bold"}
            lines += [(line, big) for line in wrapped(words_of(plain(title)), " ", room, big)]
        if about:
            lines += [(line, {"size": size}) for line in wrapped(words_of(about), " ", room, {"size": size})]
        faint = {"size": size, "color": look.FAINT}
        lines += [(line, faint) for line in wrapped(parts, ", ", room, {"size": size})]
        down = _MARGIN
        self._heading = []
        for line, options in lines:
            text = self.figure.text(_MARGIN / self.width, 1, line, va="top", ha="left", **options)
            self._heading.append((text, down))
            down += options["size"] * _LINE / 72
        return down

    # --- below the panels ---

    def _place_below(self) -> float:
        """The legend, above it the notes; the height that they take."""
        self._below: list[tuple[Any, float]] = []
        size, room = mpl.rcParams["font.size"], self.width - 2 * _MARGIN
        up = _MARGIN
        if self._entries:
            legend, height = fitted_legend(self.figure, self._entries, room)
            self._below.append((legend, up))
            up += height
        small = {"size": 0.9 * size, "color": look.FAINT, "ha": "right"}
        lines = [line for note in self._notes for line in wrapped(words_of(note), " ", 72 * room, {"size": 0.9 * size})]
        for line in reversed(lines):
            self._below.append((self.figure.text(1 - _MARGIN / self.width, 0, line, va="bottom", **small), up))
            up += 0.9 * size * _LINE / 72
        return up if self._below else 0.0


# --- measured text ---


@functools.lru_cache(maxsize=4096)
def text_width(text: str, size: float, weight: str = "normal") -> float:
    """The width of one line in points, without a renderer: that of the control points, not of the curves between them."""
    if not text:
        return 0.0
    path = TextPath((0, 0), text, size=size, prop=FontProperties(weight=weight))
    across = path.vertices[path.codes != Path.CLOSEPOLY, 0] if len(path.vertices) else []
    return float(np.ptp(across)) if len(across) else 0.0


def plain(text: str) -> str:
    """Free text without mathematics: dollars as they are."""
    return text.replace("$", r"\$")


def words_of(text: str) -> list[str]:
    """The words of a text; mathematics between dollars is part of a word, with the spaces in it."""
    return re.findall(r"(?:\\\$|\$[^$]*\$|[^\s$])+", text)


def wrapped(parts: Sequence[str], separator: str, room: float, font: dict[str, Any]) -> list[str]:
    """Parts joined into lines that are at most `room` points wide. Widths of parts are added up, and lines measured only
    when they are nearly full."""
    look_of = font["size"], font.get("weight", "normal")
    gap = text_width(f"x{separator}x", *look_of) - 2 * text_width("x", *look_of)
    lines: list[str] = []
    taken = 0.0
    for part in parts:
        longer = f"{lines[-1]}{separator}{part}" if lines else part
        taken += gap + text_width(part, *look_of)
        if taken > 0.9 * room:
            taken = text_width(longer, *look_of)
        if lines and taken <= _HINTING * room:
            lines[-1] = longer
        else:
            lines[-1:] = [lines[-1] + separator.rstrip(), part] if lines else [part]
            taken = text_width(part, *look_of)
    return [line for line in lines if line]


def fitted_legend(figure: Figure, entries: Sequence[Artist], room: float) -> tuple[Any, float]:
    """A legend with as many columns as `room` inches allow, and its height in inches."""
    options = {"loc": "lower left", "borderaxespad": 0, "borderpad": 0, "labelspacing": 0.45}
    rows = {-(-len(entries) // columns) for columns in range(1, min(len(entries), 6) + 1)}
    for columns in sorted({-(-len(entries) // length) for length in rows}, reverse=True):  # of about equal length
        legend = figure.legend(handles=list(entries), ncol=columns, **options)
        box = legend.get_window_extent()
        if columns == 1 or box.width <= room * figure.dpi:
            break
        legend.remove()
    return legend, box.height / figure.dpi + 0.08


# --- files ---


def save(figure: Any, path: str | os.PathLike[str]) -> None:
    """Writes a figure, or an animation, in the format that the suffix says: .png, .pdf, .svg; .gif, .mp4. A figure is
    there whole or not at all."""
    path = os.fspath(path)
    if not isinstance(figure, Figure):
        with settings():
            figure.save(path)
        return
    suffix = os.path.splitext(path)[1].lower()
    undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}  # equal data give equal files
    part = f"{path}.{os.getpid()}.part"
    try:
        with settings():
            figure.savefig(part, format=suffix[1:], metadata=undated.get(suffix))
        os.replace(part, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(part)
