"""The command `ricochet-plot`: draws the figures of a result."""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.backend_bases import FigureCanvasBase

from ricochet.file import ResultError
from ricochet.plot.arguments import COMMON, Unusable, flag, near, options_of
from ricochet.plot.catalogue import CATALOGUE, KINDS, Spec, figures_of, in_order
from ricochet.plot.sheet import FigureError, save, style
from ricochet.result import Result

_MOST_PARTS = 12  # tasks or lines of which figures are drawn that were not asked for by name


def run() -> None:
    """The program."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # whoever reads the list may close the pipe
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


def main(words: Sequence[str] | None = None) -> int:
    """Exit code 0, or 2 with one line on standard error. `words`: the command line without the program's name."""
    try:
        with mpl.rc_context():
            mpl.rcdefaults()  # equal data give equal files, whatever the user's settings
            mpl.use("Agg")  # no display where sweeps run
            return _run(options_of(words))
    except (ResultError, Unusable) as trouble:
        _complain(str(trouble))
        return 2


def _say(text: str) -> None:
    """A line on standard output."""
    try:
        print(text, flush=True)
    except OSError as trouble:
        sys.stdout = None  # what is in its buffer cannot be written at the end, either
        raise Unusable(f"cannot write to standard output: {trouble.strerror}") from trouble


def _complain(text: str) -> None:
    print(f"ricochet-plot: {text}", file=sys.stderr)


# --- what is drawn ---


def _run(options: argparse.Namespace) -> int:
    """The exit code."""
    if options.result is None:
        _print_list(in_order(CATALOGUE.values()), with_kinds=True)
        return 0
    if options.result in CATALOGUE and not os.path.exists(options.result):
        raise Unusable(f"{options.result} is a figure; which result? ricochet-plot RESULT.h5 {options.result}")
    with Result(options.result) as result:
        if options.list:
            _print_list(figures_of(result), natural=[spec for spec in figures_of(result) if spec.natural(result)])
            return 0
        given = {name: value for name, value in vars(options).items() if name not in COMMON}
        specs = _chosen(result, options.name, given)
        jobs = [(spec, pick) for spec in specs for pick in _picks(spec, result, given, asked=options.name is not None)]
        paths = [_path(options, result, spec, pick, len(jobs)) for spec, pick in jobs]
        with style(**_style(options)):
            return _draw(result, [(spec, {**given, **pick}, path) for (spec, pick), path in zip(jobs, paths)])


def _draw(result: Result, jobs: Sequence[tuple[Spec, dict[str, Any], str]]) -> int:
    """Draws and writes the figures. Of several, one that cannot be drawn does not keep the others from it."""
    drawn = 0
    for spec, options, path in jobs:
        try:
            _write(spec.draw(result, **options), path)
        except FigureError as refused:
            if len(jobs) == 1:
                raise
            _complain(f"{refused.path}: {spec.name}: {refused.reason}")
            continue
        finally:
            plt.close("all")
        _say(path)
        drawn += 1
    return 0 if drawn else 2


def _style(options: argparse.Namespace) -> dict[str, Any]:
    title = "" if options.title == "none" else options.title
    limits = {f"{axis}lim": value and tuple(value) for axis in "xy" for value in [getattr(options, f"{axis}lim")]}
    return {"column": options.column, "width": options.width, "title": title, **limits}


def _chosen(result: Result, name: str | None, given: dict[str, Any]) -> list[Spec]:
    """The figure of this name, or the natural ones that take all options given."""
    if name is not None:
        return [_named(result, name.replace("_", "-"), given)]
    takers = [spec for spec in figures_of(result) if given.keys() <= spec.options.keys()]
    if not takers:
        flags = " and ".join(flag(option) for option in given)
        raise Unusable(f"no figure of {result.path} takes {flags}; {_there_are(result)}")
    return [spec for spec in takers if spec.natural(result)] or takers


def _there_are(result: Result) -> str:
    return f"there are {', '.join(spec.name for spec in figures_of(result))}"


def _named(result: Result, name: str, given: dict[str, Any]) -> Spec:
    if name not in CATALOGUE:
        raise Unusable(f"there is no figure {name}" + (near(name, CATALOGUE) or f"; {_there_are(result)}"))
    spec = CATALOGUE[name]
    for option in given:
        if option not in spec.options:
            takes = ", ".join(flag(other) for other in spec.options) or "none"
            raise Unusable(f"figure {name} has no option {flag(option)}; its options are: {takes}")
    return spec


def _picks(spec: Spec, result: Result, given: dict[str, Any], asked: bool) -> list[dict[str, int]]:
    """The figures of a result that has several: the value of the option that picks each. Of many some, spread over
    them, unless the figure is asked for by its name."""
    if not spec.part or spec.missing(result):
        return [{}]
    if spec.part in given:
        return [{spec.part: given[spec.part]}]
    values = list(spec.parts(result))
    if not asked and len(values) > _MOST_PARTS:
        kept = np.linspace(0, len(values) - 1, _MOST_PARTS).round().astype(int)
        every = f"ricochet-plot {result.path} {spec.name}"
        _complain(f"{spec.name}: {_MOST_PARTS} of {len(values)} {spec.part}s are drawn; all of them: {every}")
        values = [values[k] for k in kept]
    return [{spec.part: value} for value in values] or [{}]


# --- where to ---


def _path(options: argparse.Namespace, result: Result, spec: Spec, pick: dict[str, int], count: int) -> str:
    """The file of a figure; one of several tasks or lines has the number of its own."""
    stem, suffix = _stem_and_suffix(options)
    suffix = suffix or spec.writes[0]
    if suffix.lower() not in spec.writes:
        raise Unusable(f"figure {spec.name} is written as {', '.join(e[1:] for e in spec.writes)}, not as {suffix[1:]}")
    beside = f"{os.path.splitext(result.path)[0]}_{spec.name}"
    number = "".join(f"_{value}" for value in pick.values() if len(spec.parts(result)) > 1)
    if not stem:
        stem = beside + number
    elif os.path.isdir(stem):
        stem = os.path.join(stem, os.path.basename(beside)) + number
    elif count > 1:
        stem += f"_{spec.name}{number}"
    folder = os.path.dirname(stem) or "."
    if not os.path.isdir(folder):
        raise Unusable(f"cannot write {stem}{suffix}: there is no folder {folder}")
    return stem + suffix


def _stem_and_suffix(options: argparse.Namespace) -> tuple[str, str]:
    """What --output and --format say; "" where they say nothing."""
    stem, suffix = options.output or "", ""
    ending = os.path.splitext(stem)[1]
    if ending.lower() in {known for spec in CATALOGUE.values() for known in spec.writes}:
        stem, suffix = os.path.splitext(stem)
    elif ending[1:].lower() in FigureCanvasBase.get_supported_filetypes():
        raise Unusable(f"{options.output}: figures are not written as {ending[1:]}")
    if options.format and suffix and suffix[1:].lower() != options.format:
        raise Unusable(f"{options.output} and --format {options.format} are different formats")
    return stem, suffix or (f".{options.format}" if options.format else "")


def _write(figure: Any, path: str) -> None:
    try:
        save(figure, path)
    except OSError as trouble:
        raise Unusable(f"cannot write {path}: {trouble.strerror or trouble}") from trouble


# --- the list ---


def _print_list(specs: Sequence[Spec], natural: Sequence[Spec] | None = None, with_kinds: bool = False) -> None:
    width = max((len(spec.name) for spec in specs), default=0)
    for spec in specs:
        kinds = f"{', '.join(spec.kinds) if len(spec.kinds) < len(KINDS) else 'all kinds'}: " if with_kinds else ""
        request = "" if natural is None or spec in natural else " (by its name only)"
        source = f" ({spec.source})" if spec.source else ""
        _say(f"{spec.name:{width}}  {kinds}{spec.shows}{source}{request}")


if __name__ == "__main__":
    run()
