"""Numbers, parameters and systems in words: labels of axes, and the line below the title."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import numpy as np

from ricochet.result import Result
from ricochet.sweep import Array

_LABELS = {
    "model.gamma": r"coupling $\gamma$",
    "orbit.period": r"period $T$",
    "orbit.energy": "energy $E$",
    "model.hertz": r"stiffness $k$ of the Hertz contacts",
    "model.frequency": r"frequency $\omega$ of the force",
    "model.force": "amplitude of the force",
    "model.lambda": r"multiplier $\lambda$ of the map",
    "model.omega": r"multiplier $\omega$ of the map",
    "model.d": "$d$, by which the motion would pass the obstacle",
    "grazing.beyond": "$\\mu$ = parameter / its value at grazing \u2212 1",
}
_SYMBOLS = {
    "model.gamma": r"\gamma",
    "orbit.period": "T",
    "orbit.energy": "E",
    "model.hertz": "k",
    "model.frequency": r"\omega",
    "model.lambda": r"\lambda",
    "model.omega": r"\omega",
    "model.d": "d",
    "grazing.beyond": r"\mu",
}
_SPRINGS = ("model.stiffness", "model.quadratic", "model.cubic", "model.damping")
# What is said about a system: the words, and the value that goes without saying.
_PROPERTIES: dict[str, tuple[str, Any]] = {
    "model.gamma": (r"$\gamma = {}$", None),
    "model.mass": ("mass ${}$", 1),
    "model.stiffness": ("stiffness ${}$", 1),
    "model.quadratic": ("quadratic term ${}$", 0),
    "model.cubic": ("cubic term ${}$", 0),
    "model.damping": ("damping ${}$", 0),
    "model.link_quadratic": ("quadratic term of the coupling ${}$", 0),
    "model.link_cubic": ("cubic term of the coupling ${}$", 0),
    "model.link_damping": ("damping of the coupling ${}$", 0),
    "model.force": ("force ${}$", 0),
    "model.frequency": (r"$\omega = {}$", None),
    "model.phase": ("phase ${}$", 0),
    "model.floor": ("floor at ${}$", None),
    "model.wall": ("wall at ${}$", None),
    "model.restitution": ("restitution ${}$", 1),
    "model.hertz": ("Hertz contacts $k = {}$", None),
    "model.lambda": (r"$\lambda = {}$", None),
    "model.omega": (r"$\omega = {}$", None),
    "model.d": ("$d = {}$", None),
    "model.stretch": ("$s = {}$", 1),
    "orbit.period": ("$T = {}$", None),
}
_MOST_ITEMS = 4  # of a list that is written out


# --- numbers ---


def number(value: float, digits: int = 12) -> str:
    """A number as mathematical text without dollars: 1.5\\,\\pi, 3\\cdot10^{-5}, 0.25."""
    turns = value / np.pi
    if value and f"{turns:.12g}" == f"{turns:.4g}":
        factor = f"{turns:.4g}"
        return {"1": r"\pi", "-1": r"-\pi"}.get(factor, factor + r"\,\pi")
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    if not power:
        return mantissa
    factor = {"1": "", "-1": "-"}.get(mantissa, mantissa + r"\cdot ")
    return factor + rf"10^{{{int(power)}}}"


def complex_number(value: complex, digits: int = 4) -> str:
    """A complex number in the same way, real where its imaginary part is zero."""
    if value.imag == 0:
        return number(value.real, digits)
    sign = "+" if value.imag > 0 else "-"
    real = number(value.real, digits) if value.real else ""
    return rf"{real} {sign} {number(abs(value.imag), digits)}\,i".strip()


def count(number: int, noun: str, ending: str = "s") -> str:
    """ "1 impact", "3 impacts", "no impact"; `ending` makes the plural."""
    return f"{number or 'no'} {noun}{ending if number > 1 else ''}"


# --- parameters ---


def parameter_label(result: Result, name: str) -> str:
    """A parameter as the label of an axis, with its units if it has some."""
    return with_units(_LABELS.get(name) or _element_label(result, name), result.units.get(name))


def with_units(label: str, units: str | None) -> str:
    return label if units in (None, "", "1") else f"{label} [{units}]"


def _element_label(result: Result, name: str) -> str:
    path, _, item = name.partition("[")
    index = item.rstrip("]")
    if path == "iterate.start" and item:
        return f"start $z_{{{int(index) + 1}}}$"
    if path in ("start.q", "start.v"):
        whole = not item and result.parameters["model.particles"] > 1
        return f"start ${path[-1]}$ of all particles" if whole else f"start ${path[-1]}_{{{index or 0}}}$"
    if path in ("orbit.at_start", "orbit.at_half"):
        return f"particle that hits at $t = {'0' if path.endswith('start') else 'T/2'}$"
    word = {"hertz": "Hertz stiffness"}.get(path.split(".")[-1], path.split(".")[-1].replace("_", " "))
    if path in ("model.cubic", "model.quadratic"):
        word += " term"
    if not item:
        return word
    springs = result.parameters.get("model.type") == "duffing_chain" and path in _SPRINGS
    return f"{word} of {'spring' if springs else 'particle'} {index}"


def parameter_symbol(result: Result, name: str) -> str:
    """A parameter in few letters, before "= 0.1": its symbol or its words."""
    return f"${_SYMBOLS[name]}$" if name in _SYMBOLS else _element_label(result, name)


def assignment(result: Result, name: str, value: float, digits: int = 6) -> str:
    """ "gamma = 0.1" in mathematical letters."""
    return equation(parameter_symbol(result, name), number(value, digits))


def equation(symbol: str, value: str) -> str:
    """A symbol or words, and a value in mathematical text without dollars. Behind words the equals sign is a letter:
    a formula that began with it would have no room behind it."""
    return f"{symbol[:-1]} = {value}$" if symbol.endswith("$") else f"{symbol} = ${value}$"


def followed(result: Result) -> str:
    """The key of the parameter that a family is followed in."""
    return str(result.parameters["branch.parameter"])


def second(result: Result) -> str:
    """The key of the second parameter of curves."""
    return str(result.parameters["branch.trace.parameter"])


def task_words(result: Result, task: int) -> list[str]:
    """The swept parameters of a task with their values; of one without a sweep nothing."""
    return [assignment(result, name, float(result.sweep.values[name][task])) for name in result.swept]


def state_symbol(name: str) -> str:
    """A number of a state by its name, as people write it: q0, v1, z3, "time"."""
    found = re.fullmatch(r"([a-z]+?)(\d+)", name)
    return f"${found[1]}_{{{found[2]}}}$" if found else name


# --- systems ---


def system(result: Result, varied: Iterable[str] = ()) -> list[str]:
    """The system with its fixed parameters in words. `varied`: parameters that the figure shows besides the swept ones."""
    left_out = {*result.swept, *varied}
    return [_kind_of_system(result)] + [
        phrase for name in _PROPERTIES if name not in left_out and (phrase := _property(result, name, left_out))
    ]


def _kind_of_system(result: Result) -> str:
    values = result.parameters
    if values["model.type"] == "grazing_map":
        return "map (5.11) of [FN97]" if len(values["model.eta"]) else "map (6.1)\u2013(6.5) of [FN97]"
    particles = values["model.particles"]
    if values["model.type"] == "duffing_chain":
        return count(particles, "mass", "es") + (" in series" if particles > 1 else "")
    if is_alone(result):
        return "one particle"
    word = "particle" if particles == 1 else "particles"
    return {"periodic": f"ring of {particles} {word}"}.get(
        values["model.ends"], f"{particles} {word}, {values['model.ends']} ends"
    )


def is_alone(result: Result) -> bool:
    """Whether the system is a particle without neighbours."""
    values = result.parameters
    return bool(
        values.get("model.particles") == 1
        and (values["model.type"] == "duffing_chain" or values["model.ends"] != "fixed" or values["model.gamma"] == 0)
    )


def _property(result: Result, name: str, varied: set[str]) -> str:
    """The words for one parameter, "" where it goes without saying."""
    words, usual = _PROPERTIES[name]
    value = result.parameters.get(name)
    if value is None or (name == "model.gamma" and is_alone(result)):
        return ""
    if name == "model.frequency" and not _is_forced(result, varied):
        return ""
    items = np.atleast_1d(value)
    fixed = np.array([f"{name}[{i}]" not in varied for i in range(len(items))])
    if all(item == usual or item != item for item in items[fixed].tolist()):
        return ""
    having = np.flatnonzero(~np.isnan(items))
    if fixed.all() and len(having) == 1 < len(items) and name in ("model.floor", "model.wall"):
        words = words.replace(" at", f" of particle {having[0]} at")
        items, fixed = items[having], fixed[having]
    return words.format(_list_text(items, fixed))


def _is_forced(result: Result, varied: set[str]) -> bool:
    amplitude = np.atleast_1d(result.parameters.get("model.force", 0))
    return bool((amplitude != 0).any()) or any(name.startswith("model.force") for name in varied)


def _list_text(items: Array, fixed: Array) -> str:
    """The items of a list; dots for those that are swept."""
    texts = [r"\mathrm{none}" if np.isnan(item) else number(float(item), 6) for item in items]
    texts = [text if is_fixed else r"\cdot" for text, is_fixed in zip(texts, fixed)]
    if len(set(texts)) == 1:
        return texts[0]
    if len(texts) > _MOST_ITEMS:
        texts = [*texts[: _MOST_ITEMS - 2], r"\ldots", texts[-1]]
    return ",\\, ".join("{" + text + "}" if text.startswith("-") else text for text in texts)  # {}: no room after -


# --- obstacles ---


def obstacles(result: Result, task: int | None = None) -> dict[str, Array]:
    """Places of the obstacles of every particle: {"floor": [particles], "wall": [particles]}, NaN where there is none.
    Without a task, NaN also where they are swept."""
    values = result.parameters if task is None else result.parameters_of(task)
    found = {side: _places(values, side) for side in ("floor", "wall")}
    if task is None:
        for name in result.swept:
            path, _, item = name.partition("[")
            side = path.removeprefix("model.")
            if side in found:
                found[side][int(item.rstrip("]")) if item else slice(None)] = np.nan
    return found


def _places(values: dict[str, Any], side: str) -> Array:
    particles = values["model.particles"]
    place = values.get(f"model.{side}")
    places = np.full(particles, np.nan)
    if place is None:
        return places
    in_series = values["model.type"] == "duffing_chain" and side == "wall" and np.ndim(place) == 0
    places[particles - 1 if in_series else slice(None)] = place  # one wall of masses in series is that of the last
    return places
