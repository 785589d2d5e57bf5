"""The page of figures: docs/figures.md is what `python3 -m ricochet.plot.reference` prints."""

from __future__ import annotations

import inspect
from typing import Any

from ricochet.plot.arguments import flag, type_words
from ricochet.plot.catalogue import CATALOGUE, KINDS, Spec, in_order

_BEGINNING = """# Figures

`ricochet-plot RESULT.h5` draws the figures that one wants of a result; `ricochet-plot RESULT.h5 NAME` draws one, and
`ricochet-plot RESULT.h5 --list` says which there are. In Python each is a function of `ricochet.plot` that returns
matplotlib's figure; options are keyword arguments ([python.md](python.md#figures)). In a checkout the command is
`scripts/ricochet-plot`; it needs matplotlib (Debian: `python3-matplotlib`).

| option of all figures | meaning |
|---|---|
| `-o PATH` | the file, whose suffix is the format; what the names of several files begin with; or a folder |
| `--format png\\|pdf\\|svg` | the format; of an animation gif or mp4 |
| `--title TEXT` | title instead of the study's; `none` for no title |
| `--column`, `--width INCHES` | as wide as a column of a journal, 86 mm; so wide |
| `--xlim A B`, `--ylim A B` | limits of the axes of the main panel |

What a result cannot give is one line on standard error, and exit code 2.
"""


def page() -> str:
    """The page in Markdown: a chapter per figure, by kinds."""
    specs = in_order(CATALOGUE.values())
    kinds = list(dict.fromkeys(spec.kinds for spec in specs))
    parts = [_BEGINNING]
    for group in kinds:
        parts.append(f"## Results of {'all kinds' if len(group) == len(KINDS) else f'kind {_listed(group)}'}\n")
        parts += [_chapter(spec) for spec in specs if spec.kinds == group]
    return "\n".join(parts)


def _listed(kinds: tuple[str, ...]) -> str:
    words = [f"`{kind}`" for kind in kinds]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _chapter(spec: Spec) -> str:
    source = f" This is {spec.source}." if spec.source else ""
    lines = [f"### {spec.name}\n", (inspect.getdoc(spec.draw) or "") + source + "\n"]
    if spec.columns:
        lines.append(f"It needs {', '.join(f'`{name}`' for name in spec.columns)}.\n")
    if spec.options:
        lines += ["| option | meaning |", "|---|---|"]
        lines += [f"| `{flag(name)}{_values(spec, name)}` | {_sentence(text)} |" for name, text in spec.options.items()]
        lines.append("")
    return "\n".join(lines)


def _values(spec: Spec, name: str) -> str:
    words = type_words(spec.hints[name]).replace("|", "\\|")
    return f" {words}" if words else ""


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def _main() -> Any:
    print(page(), end="")


if __name__ == "__main__":
    _main()
