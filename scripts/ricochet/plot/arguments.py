"""The command line of `ricochet-plot`: options of all figures, and one flag for each option of a figure."""

from __future__ import annotations

import argparse
import difflib
import inspect
import math
import re
import types
from collections.abc import Iterable, Sequence
from typing import Any, Literal, NoReturn, Union, get_args, get_origin

from ricochet.plot.catalogue import CATALOGUE

_DESCRIPTION = """Draws the figures of a result of ricochet.

  ricochet-plot RESULT.h5              all natural figures of what is in the file
  ricochet-plot RESULT.h5 --list       which figures there are, and what each shows
  ricochet-plot RESULT.h5 NAME         one of them
  ricochet-plot RESULT.h5 --y energy   the natural figures that take this option
  ricochet-plot --list                 the figures of all kinds of results"""
COMMON = ("result", "name", "list", "output", "format", "title", "column", "width", "xlim", "ylim")


class Unusable(Exception):
    """A command line that cannot be obeyed; the text says why."""


class _Parser(argparse.ArgumentParser):
    """Whose complaint is one line without the usage."""

    def error(self, message: str) -> NoReturn:
        raise Unusable(message.removeprefix("argument "))


def options_of(words: Sequence[str] | None) -> argparse.Namespace:
    """The command line, its options and words in any order."""
    parser = _parser()
    options, unknown = parser.parse_known_intermixed_args(words)
    if unknown:
        raise Unusable(_unknown(unknown[0], [flag for action in parser._actions for flag in action.option_strings]))
    for axis in "xy":
        limits = getattr(options, f"{axis}lim")
        if limits and limits[0] == limits[1]:
            raise Unusable(f"--{axis}lim {limits[0]:g} {limits[1]:g}: the limits are equal")
    return options


def _unknown(word: str, flags: Sequence[str]) -> str:
    if not word.startswith("-"):
        return f"{word} is one word too many: RESULT.h5 NAME"
    flag = word.partition("=")[0]
    return f"there is no option {flag}{near(flag, flags)}"


def near(word: str, words: Iterable[str]) -> str:
    """ "; did you mean ...?" with the word that is most like this one, "" if none is."""
    found = difflib.get_close_matches(word, list(words), 1)
    return f"; did you mean {found[0]}?" if found else ""


def _parser() -> argparse.ArgumentParser:
    layout = argparse.RawDescriptionHelpFormatter
    parser = _Parser("ricochet-plot", allow_abbrev=False, description=_DESCRIPTION, formatter_class=layout)
    parser._negative_number_matcher = re.compile(r"-(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")  # argparse's has no exponent
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
    widths = parser.add_mutually_exclusive_group()
    widths.add_argument("--column", action="store_true", help="as wide as a column of a journal, 86 mm")
    widths.add_argument("--width", type=_inches, metavar="INCHES", help="width of the figure")
    for axis in "xy":
        parser.add_argument(
            f"--{axis}lim", type=_number, nargs=2, metavar=("A", "B"), help=f"limits of the {axis} axis"
        )
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
    one_word = {int: (_whole, "N"), float: (_number, "X"), str: (str, "WORD")}
    return dict(zip(("type", "metavar"), one_word[hint]))


def type_words(hint: Any) -> str:
    """What stands behind the flag of an option of this type: "N", "N ...", "A|B", "" of a flag alone."""
    typed = _typed(hint)
    if "choices" in typed:
        return "|".join(typed["choices"])
    one = str(typed.get("metavar", ""))
    return f"{one} ..." if typed.get("nargs") == "+" else " ".join([one] * typed.get("nargs", 1))


def _number(word: str) -> float:
    """A number that is finite."""
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{word} is not a number")
    return value


def _whole(word: str) -> int:
    try:
        return int(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word} is not a whole number") from None


def _inches(word: str) -> float:
    value = _number(word)
    if not 1 <= value <= 100:
        raise argparse.ArgumentTypeError(f"{word} is not a width, 1 to 100 inches")
    return value
