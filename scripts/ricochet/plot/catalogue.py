"""The catalogue of figures: what each shows, of which results it can be drawn, and its options.

A figure is a function from a result to matplotlib's figure, declared by `@figure(...)`; what the declaration says is all
that `ricochet-plot` knows of it.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, get_type_hints

from ricochet.plot.sheet import FigureError, settings
from ricochet.plot.words import count
from ricochet.result import Result

# Which key of the study stores a column; by its whole name where another table has one of that name, too.
_ASKED_BY = {
    "branch/point/q": "branch.states",
    "q": "orbit.states",
    "v": "orbit.states",
    "multipliers": "orbit.multipliers",
    "multiplier_max": "orbit.stable",
    "stable": "orbit.stable",
    "ritz_functions": "orbit.method: ritz",
    "lyapunov": "time.lyapunov",
    "history_q": "branch.samples",
    "curve": "branch.trace",
    "values": "iterate.keep",
    "state": "iterate.states",
    "window": "iterate.windows",
    "window_period": "grazing.windows",
}


@dataclass(frozen=True)
class Spec:
    """A figure: its name, what it shows, what it needs, its options and its function.

    kinds    kinds of results that it can be drawn of
    columns  columns "table/column", or tables, that the result must have
    swept    how many parameters must be swept, None if it does not matter
    reason   of a result that has all this: why the figure cannot be drawn, "" if it can
    natural  whether `ricochet-plot RESULT.h5` draws it, of this result
    part     option that picks one of several figures of a result, "task" or "line"; "" if there is one
    parts    of a result: the values of that option for which figures are drawn
    writes   suffixes of its files
    options  {keyword argument: what it says}
    source   the figure of a source that it is: "[FN97] Figure 4"
    """

    name: str
    shows: str
    kinds: tuple[str, ...]
    draw: Callable[..., Any]
    columns: tuple[str, ...] = ()
    swept: int | None = None
    reason: Callable[[Result], str] = field(default=lambda result: "")
    natural: Callable[[Result], bool] = field(default=lambda result: True)
    part: str = ""
    parts: Callable[[Result], Sequence[int]] = field(default=lambda result: ())
    writes: tuple[str, ...] = (".png", ".pdf", ".svg")
    options: Mapping[str, str] = field(default_factory=dict)
    source: str = ""

    def missing(self, result: Result) -> str:
        """Why the figure cannot be drawn of a result; "" if it can."""
        if result.kind not in self.kinds:
            return f"{self.name} is a figure of kind {' or '.join(self.kinds)}, this result is of kind {result.kind}"
        for name in self.columns:
            if not _has(result, name):
                asked = _ASKED_BY.get(name) or _ASKED_BY.get(name.rpartition("/")[2])
                return f"it has no {name}" + (f" (the study did not ask for {asked})" if asked else "")
        if self.swept is not None and len(result.swept) != self.swept:
            held = f" ({', '.join(result.swept)})" if result.swept else ""
            return f"{count(len(result.swept), 'swept parameter')}{held}, this figure needs {self.swept}"
        return self.reason(result)

    @property
    def hints(self) -> dict[str, Any]:
        """{option: its type}."""
        found = get_type_hints(inspect.unwrap(self.draw))
        return {name: found[name] for name in self.options}


def _has(result: Result, name: str) -> bool:
    table, _, column = name.rpartition("/")
    return name in result or (table in result and column in result[table])


KINDS = ("orbits", "trajectory", "branch", "grazing", "diagram", "basin")
CATALOGUE: dict[str, Spec] = {}  # by name


def figure(
    *kinds: str, shows: str, options: Mapping[str, str] | None = None, **more: Any
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Declares a function as the figure of its name: `@figure("orbits", shows="...", columns=("orbits/q",))`."""

    def declare(draw: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(draw)
        def checked(result: Result, **given: Any) -> Any:
            missing = spec.missing(result)
            if missing:
                raise FigureError(result.path, missing)
            with settings():
                return draw(result, **given)

        name = draw.__name__.replace("_", "-")
        spec = Spec(name, shows, kinds, checked, options=dict(options or {}), **more)
        CATALOGUE[name] = spec
        return checked

    return declare


def figures_of(result: Result) -> list[Spec]:
    """The figures that can be drawn of a result."""
    return [spec for spec in in_order(CATALOGUE.values()) if not spec.missing(result)]


def in_order(specs: Iterable[Spec]) -> list[Spec]:
    """Figures in the order of the kinds, and of their names; those of many kinds behind."""
    return sorted(specs, key=lambda spec: (len(spec.kinds) > 2, KINDS.index(spec.kinds[0]), spec.name))
