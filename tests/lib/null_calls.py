"""Writes calls of all public functions with NULL, from the prototypes in the headers: the tables of test_null.c.

usage: null_calls.py FOLDER-OF-HEADERS OUTPUT

Which pointers may be NULL is read from the docstrings. What a call passes besides NULL is zeros, 1 for numbers, and an
address that must not be called for callbacks: a function is to refuse NULL before it looks at anything else.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

FUNCTION = re.compile(
    r"(?:/\*\*(?P<doc>(?:(?!\*/).)*)\*/\s*)?^RIC_API\s+(?P<result>[^;({]*?)(?P<name>\bric_\w+)"
    r"\((?P<parameters>(?:[^()]|\((?:[^()])*\))*)\)", re.DOTALL | re.MULTILINE)
REMARK = re.compile(r"/\*(?!\*).*?\*/", re.DOTALL)
OPAQUE = re.compile(r"^typedef struct (ric_\w+) \1;", re.MULTILINE)


@dataclass
class Parameter:
    name: str
    type: str  # without the name; of a callback its whole declaration
    may_be_null: bool

    @property
    def is_callback(self):
        return "(*" in self.type

    @property
    def is_pointer(self):
        return "*" in self.type


@dataclass
class Function:
    name: str
    result: str
    parameters: list

    @property
    def can_fail(self):
        """By the convention of status.h: it returns a status, and its last parameter is the error."""
        return self.result == "ric_status" and bool(self.parameters) and self.parameters[-1].type == "ric_error *"

    @property
    def ends_an_object(self):
        return self.result == "void" and self.name.endswith(("_destroy", "_clear"))


# --- reading the headers


def entries(doc):
    """The names and the text of each @param."""
    text = " ".join(line.strip(" *") for line in doc.splitlines())
    for entry in re.split(r"(?=@\w+)", text):
        found = re.match(r"@param (\w+(?:, \w+)*) +(.*)", entry)
        if found:
            yield found[1].split(", "), found[2]


def allowed_null(doc):
    """A clause of an entry that says NULL means the parameters that it names, or else all of the entry."""
    for names, text in entries(doc):
        for clause in re.split(r"[;.(]", text):
            if re.search(r"\bNULL\b", clause):
                yield from [n for n in names if re.search(rf"\b{n}\b", clause)] or names


def at_commas(text):
    """Parts between the commas that stand outside brackets."""
    depth, word = 0, ""
    for c in text + ",":
        depth += (c == "(") - (c == ")")
        if c == "," and depth == 0:
            yield " ".join(word.split())
            word = ""
        else:
            word += c


def parameter(declaration, allowed):
    callback = re.match(r".*?\(\*(\w+)\)", declaration)
    name = callback[1] if callback else re.search(r"(\w+)$", declaration)[1]
    kind = declaration if callback else declaration[: -len(name)].strip()
    return Parameter(name, kind, name in allowed or name in ("error", "user"))


def functions_of(text):
    for match in FUNCTION.finditer(REMARK.sub(" ", text)):
        words = [w for w in at_commas(match["parameters"]) if w not in ("void", "...")]
        allowed = set(allowed_null(match["doc"] or ""))
        yield Function(match["name"], match["result"].strip(), [parameter(w, allowed) for w in words])


# --- writing the calls


def argument(index, p, null):
    """@param null  the parameter that is NULL, or None"""
    if p.name == "error":
        return p.name
    if p is null or p.name == "user" or (p.is_callback and p.may_be_null):
        return "NULL"
    if p.is_callback:
        return p.name
    if p.is_pointer:
        return f"(void *)zeros[{index}]"
    return "1" if p.type in ("size_t", "double") else f"({p.type}){{0}}"


def call(number, function, null):
    """A function in C that makes the call."""
    callbacks = [p for p in function.parameters if p.is_callback and argument(0, p, null) == p.name]
    lines = [f"static ric_status call_{number}(ric_error *error) {{"]
    lines += [f"  {p.type};\n  memset(&{p.name}, 1, sizeof {p.name});" for p in callbacks]
    words = ", ".join(argument(i, p, null) for i, p in enumerate(function.parameters))
    if function.can_fail:
        lines.append(f"  return {function.name}({words});")
    else:
        lines.append(f"  (void)error;\n  {function.name}({words});\n  return RIC_OK;")
    return "\n".join([*lines, "}"])


def table(name, calls, numbers):
    """@param calls  of a function and the parameter that is NULL"""
    parts, rows = [], []
    for function, null in calls:
        number = next(numbers)
        parts.append(call(number, function, null))
        rows.append(f'    {{"{function.name}", "{null.name if null else ""}", call_{number}}},')
    return "\n\n".join([*parts, "\n".join([f"static const null_call {name}[] = {{", *rows, "};"])])


def written(functions, opaque):
    numbers = iter(range(10**6))
    refused = [(f, p) for f in functions if f.can_fail for p in f.parameters if p.is_pointer and not p.may_be_null]
    ended = [(f, f.parameters[0]) for f in functions if f.ends_an_object]
    ended += [(f, None) for f, _ in ended]

    def reads_data_only(f):
        return not any(re.fullmatch(rf"(const )?{o} \*", p.type) for p in f.parameters for o in opaque)

    zeros = [(f, None) for f in functions if f.can_fail and reads_data_only(f)]
    return "\n\n".join([table("refused", refused, numbers), table("ended", ended, numbers),
                        table("of_zeros", zeros, numbers)])


def main(headers, output):
    texts = [path.read_text() for path in sorted(Path(headers).glob("*.h"))]
    functions = [f for text in texts for f in functions_of(text)]
    exported = sum(len(re.findall(r"^RIC_API", text, re.MULTILINE)) for text in texts)
    if len(functions) != exported:
        sys.exit(f"null_calls: {len(functions)} functions understood, expected {exported}")
    opaque = {name for text in texts for name in OPAQUE.findall(text)}
    Path(output).write_text(f"/* Written by null_calls.py from the headers. */\n\n{written(functions, opaque)}\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
