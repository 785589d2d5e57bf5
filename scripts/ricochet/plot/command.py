"""The command `ricochet-plot`: draws the figures of a result."""

from __future__ import annotations

import argparse
import inspect
import os
import sys
import types
from collections.abc import Sequence
from typing import Any, Literal, Union, get_args, get_origin

import matplotlib as mpl
import matplotlib.pyplot as plt

from ricochet.file import ResultError
from ricochet.plot.catalogue import CATALOGUE, Spec, figures_of
from ricochet.plot.sheet import FigureError, save, style
from ricochet.result import Result

_DESCRIPTION = """Draws the figures of a result of ricochet.

  ricochet-plot RESULT.h5              all natural figures of what is in the file
  ricochet-plot RESULT.h5 --list       which figures there are, and what each shows
  ricochet-plot RESULT.h5 NAME         one of them
  ricochet-plot RESULT.h5 --y energy   the natural figures that take this option
  ricochet-plot --list                 the figures of all kinds of results"""
_COMMON = ("result", "name", "list", "output", "format", "title", "column", "width", "xlim", "ylim")


class Unusable(Exception):
    """A command line that cannot be obeyed; the text says why."""


def run() -> None:
    """The program."""
    sys.exit(main())


def main(words: Sequence[str] | None = None) -> int:
    """Exit code 0, or 2 with one line on standard error. `words`: the command line without the program's name."""
    mpl.use("Agg")  # no display where sweeps run
    options = _parser().parse_args(words)
    try:
        if options.result is None:
            _print_list(list(CATALOGUE.values()), with_kinds=True)
        else:
            _run(options)
    except (ResultError, Unusable) as trouble:
        print(f"ricochet-plot: {trouble}", file=sys.stderr)
        return 2
    return 0


# --- options ---


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ricochet-plot", allow_abbrev=False, description=_DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result", metavar="RESULT.h5", nargs="?", help="what `ricochet run` wrote")
    parser.add_argument("name", metavar="NAME", nargs="?", help="which figure; default: the natural ones of the result")
    parser.add_argument("--list", action="store_true", help="list the figures that can be drawn of the result")
    parser.add_argument(
        "-o", "--output", metavar="PATH",
        help="the file, whose suffix is the format; what the names of several files begin with; or a folder. Default: "
        "RESULT_NAME.png beside the result",
    )  # fmt: skip
    parser.add_argument("--format", choices=("png", "pdf", "svg", "gif", "mp4"), help="default: png, of animations gif")
    parser.add_argument("--title", metavar="TEXT", help="title instead of the study's; none for no title")
    parser.add_argument("--column", action="store_true", help="as wide as a column of a journal, 86 mm")
    parser.add_argument("--width", type=_positive, metavar="INCHES", help="width of the figure")
    for axis in "xy":
        parser.add_argument(f"--{axis}lim", type=float, nargs=2, metavar=("A", "B"), help=f"limits of the {axis} axis")
    group = parser.add_argument_group("options of single figures")
    for name in sorted({name for spec in CATALOGUE.values() for name in spec.options}):
        group.add_argument(flag(name), dest=name, default=argparse.SUPPRESS, **_argument(name))
    return parser


def flag(name: str) -> str:
    """The flag of an option: --xlim."""
    return "--" + name.replace("_", "-")


def _argument(name: str) -> dict[str, Any]:
    """What argparse is told of an option: its type, which is the same in all figures, and its help."""
    takers = [spec for spec in CATALOGUE.values() if name in spec.options]
    texts: dict[str, list[str]] = {}
    for spec in takers:
        texts.setdefault(spec.options[name], []).append(spec.name)
    text = "; ".join(f"{what} ({', '.join(names)})" for what, names in texts.items())
    return {"help": text.replace("%", "%%"), **_typed(takers[0].hints[name])}


def _typed(hint: Any) -> dict[str, Any]:
    """bool: a flag; Sequence or tuple: several words; Literal: one of some words; otherwise one word."""
    if get_origin(hint) in (Union, types.UnionType):  # X | None
        hint = next(kind for kind in get_args(hint) if kind is not type(None))
    if hint is bool:
        return {"action": "store_true"}
    if get_origin(hint) is Literal:
        return {"choices": get_args(hint)}
    if get_origin(hint) is tuple:
        return {**_typed(get_args(hint)[0]), "nargs": len(get_args(hint))}
    if inspect.isclass(get_origin(hint)):
        return {**_typed(get_args(hint)[0]), "nargs": "+"}
    return {"type": hint, "metavar": {int: "N", float: "X", str: "WORD"}[hint]}


def type_words(hint: Any) -> str:
    """What stands behind the flag of an option of this type: "N", "N ...", "A|B", "" of a flag alone."""
    typed = _typed(hint)
    if "choices" in typed:
        return "|".join(typed["choices"])
    one = str(typed.get("metavar", ""))
    return f"{one} ..." if typed.get("nargs") == "+" else " ".join([one] * typed.get("nargs", 1))


def _positive(word: str) -> float:
    value = float(word)
    if not 1 <= value <= 100:
        raise argparse.ArgumentTypeError(f"{word} is not a width, 1 to 100 inches")
    return value


# --- what is drawn ---


def _run(options: argparse.Namespace) -> None:
    with Result(options.result) as result:
        if options.list:
            _print_list(figures_of(result), natural=[spec for spec in figures_of(result) if spec.natural(result)])
            return
        given = {name: value for name, value in vars(options).items() if name not in _COMMON}
        jobs = [(spec, pick) for spec in _chosen(result, options.name, given) for pick in _picks(spec, result, given)]
        paths = [_path(options, result, spec, pick, len(jobs)) for spec, pick in jobs]
        with style(**_style(options)):
            for (spec, pick), path in zip(jobs, paths):
                _write(spec.draw(result, **{**given, **pick}), path)


def _style(options: argparse.Namespace) -> dict[str, Any]:
    title = "" if options.title == "none" else options.title
    limits = {f"{axis}lim": value and tuple(value) for axis in "xy" for value in [getattr(options, f"{axis}lim")]}
    return {"column": options.column, "width": options.width, "title": title, **limits}


def _chosen(result: Result, name: str | None, given: dict[str, Any]) -> list[Spec]:
    """The figure of this name, or the natural ones that take all options given."""
    if name is not None:
        return [_named(result, name.replace("_", "-"), given)]
    fitting = figures_of(result)
    natural = [spec for spec in fitting if spec.natural(result)]
    takers = [spec for spec in natural if given.keys() <= spec.options.keys()]
    takers = takers or [spec for spec in fitting if given and given.keys() <= spec.options.keys()]
    if not fitting:
        raise FigureError(result.path, f"no figure can be drawn of it; {_why_none(result)}")
    if not takers:
        flags = " and ".join(flag(option) for option in given)
        raise Unusable(f"no figure of {result.path} takes {flags}; it has {', '.join(spec.name for spec in fitting)}")
    return takers


def _why_none(result: Result) -> str:
    reasons = [f"{s.name}: {s.missing(result)}" for s in CATALOGUE.values() if result.kind in s.kinds]
    return "; ".join(reasons) or f"there is none of kind {result.kind}"


def _named(result: Result, name: str, given: dict[str, Any]) -> Spec:
    if name not in CATALOGUE:
        names = ", ".join(spec.name for spec in figures_of(result))
        raise Unusable(f"there is no figure {name}; of {result.path} there are {names}")
    spec = CATALOGUE[name]
    for option in given:
        if option not in spec.options:
            takes = ", ".join(flag(other) for other in spec.options) or "none"
            raise Unusable(f"figure {name} has no option {flag(option)}; its options are: {takes}")
    return spec


def _picks(spec: Spec, result: Result, given: dict[str, Any]) -> list[dict[str, int]]:
    """The figures of a result that has several: the value of the option that picks each."""
    if not spec.part or spec.part in given or spec.missing(result):
        return [{}]
    return [{spec.part: value} for value in spec.parts(result)] or [{}]


# --- where to ---


def _path(options: argparse.Namespace, result: Result, spec: Spec, pick: dict[str, int], count: int) -> str:
    """The file of a figure; a figure of several has the number of its task or line."""
    stem, suffix = options.output or "", ""
    known = {ending for other in CATALOGUE.values() for ending in other.writes}
    if os.path.splitext(stem)[1] in known:
        stem, suffix = os.path.splitext(stem)
    if options.format:
        suffix = "." + options.format
    suffix = suffix or spec.writes[0]
    if suffix not in spec.writes:
        raise Unusable(f"figure {spec.name} is written as {', '.join(e[1:] for e in spec.writes)}, not as {suffix[1:]}")
    number = "".join(f"_{value}" for value in pick.values() if len(spec.parts(result)) > 1)
    beside = os.path.splitext(result.path)[0] + "_" + spec.name
    if not stem:
        stem = beside
    elif os.path.isdir(stem):
        stem = os.path.join(stem, os.path.basename(beside))
    elif count > 1:
        stem += "_" + spec.name
    return stem + number + suffix


def _write(figure: Any, path: str) -> None:
    try:
        save(figure, path)
    except OSError as trouble:
        raise Unusable(f"cannot write {path}: {trouble.strerror or trouble}") from trouble
    finally:
        plt.close("all")
    print(path)


# --- the list ---


def _print_list(specs: Sequence[Spec], natural: Sequence[Spec] | None = None, with_kinds: bool = False) -> None:
    width = max((len(spec.name) for spec in specs), default=0)
    for spec in specs:
        kinds = f"{', '.join(spec.kinds)}: " if with_kinds else ""
        request = "" if natural is None or spec in natural else " (by its name only)"
        source = f" ({spec.source})" if spec.source else ""
        print(f"{spec.name:{width}}  {kinds}{spec.shows}{source}{request}")


if __name__ == "__main__":
    run()
