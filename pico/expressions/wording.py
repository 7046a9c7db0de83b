"""What CEL says of an expression, in words of who wrote it, and what would be right."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence

from pico.diagnostics import did_you_mean
from pico.expressions.rewriting import WRITTEN

_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
_FOUND = re.compile(r"ERROR: <input>:(-?\d+):(-?\d+): ([^\n\[]*(?:\[(?!\w+\]\s*$)[^\n\[]*)*)")
_OVERLOAD = re.compile(r"found no matching overload for '([^']*)' applied to '\((.*)\)'")
_INDEX = re.compile(r"found no matching overload for '_\[_\]' applied to '\(list\(.*\), double\)'")
_WORDS = {
    "double": "a number", "int": "a whole number", "string": "text", "bool": "true or false", "dyn": "a value",
    "list(double)": "a list of numbers", "list(string)": "a list of texts", "list(dyn)": "a list",
    "number": "a number", "numbers": "a list of numbers", "texts": "a list of texts", "list": "a list",
}  # fmt: skip
_HINTS = {
    "_[_]": "a list takes a whole number from 0 on: `l[0]`, `l[size(l) - 1]`",
    "_%_": "`mod(a, b)` is the remainder",
    "_+_": "`string(x)` makes a text of a number, `double(t)` a number of a text; `l + [x]` lengthens a list",
}
_OTHERWISE = {
    "max": "most(l)", "maximum": "most(l)", "min": "least(l)", "minimum": "least(l)", "len": "size", "length": "size",
    "avg": "mean", "average": "mean", "std": "sd", "stdev": "sd", "fmod": "mod", "float": "double", "str": "string",
    "and": "&&", "or": "||", "not": "!", "if": "a ? b : c", "else": "a ? b : c", "last": "l[size(l) - 1]",
}  # fmt: skip
"""What others call it, and what it is called here."""
_TOO_DEEP = "too deep or too long: brackets and sums have at most about 32 terms; `&&` chains may be longer"


def kind(name: str) -> str:
    """Return in words what a value is of which CEL, or a signature, says the kind."""
    name = name.strip().replace("<", "(").replace(">", ")")
    return _WORDS.get(name, name)


def computed_indices(source: str, said: str) -> list[int]:
    """Return where the brackets are whose index CEL does not take, for it is a number."""
    found = (_place(source, one) for one in _FOUND.finditer(said) if _INDEX.search(one[3]))
    return [at for at in found if source[at : at + 1] == "["]


def mistake(
    text: str, source: str, places: Sequence[int], said: str, known: Mapping[str, str]
) -> tuple[str, int, int, str]:
    """Return what is wrong, from where to where in `text`, and what would be right (empty: nobody can tell). `known`:
    names and functions that there are, with how these are called."""
    found = _FOUND.search(said)
    if found is None or int(found[1]) < 1:
        return _TOO_DEEP if "recursion" in said else said.partition("[")[0].strip(), 0, len(text), ""
    start = places[min(_place(source, found), len(places) - 1)]
    return _about(text, start, found[3].strip(), known)


def failure(said: str, text: str = "") -> str:
    """Return in words why an evaluation of the expression `text` gave nothing."""
    if "Iteration budget" in said:
        return "it looks at too many things: more than 10,000 steps"
    missing = re.search(r'Key not found in map : "([^"]*)"', said)
    if missing:
        return f"there is no `{missing[1]}` in it"
    if beyond := re.search(r"index=(-?\d+) size=(\d+)", said):
        return _beyond(int(beyond[1]), int(beyond[2]), text)
    if "Index error: expected integer" in said:
        return "an item of a list has a whole number: `l[int(x)]`, `l[size(l) - 1]`"
    if "No matching overloads" in said or "matching overload" in said:
        return f"it compares what does not go together: {said.split(':', 1)[-1].strip()[:120]}"
    return re.sub(r"^[A-Z_]+: ", "", said.partition(" [")[0])[:200]


def _beyond(index: int, size: int, text: str) -> str:
    """Return in words that a list of `size` items has none at `index`, with its name if only one list is in `text`."""
    values = f"{size} value{'' if size == 1 else 's'}"
    lists = {*re.findall(r"([A-Za-z_][\w.]*)\[", text)}
    name = lists.pop() if len(lists) == 1 else ""
    if not name:
        return f"a list has {values}, so its item [{index}] does not exist"
    return f"`{name}` has {values}, so `{name}[{index}]` does not exist"


def _place(source: str, found: re.Match[str]) -> int:
    lines = source.split("\n")
    return sum(len(line) + 1 for line in lines[: int(found[1]) - 1]) + int(found[2]) - 1


def _about(text: str, start: int, said: str, known: Mapping[str, str]) -> tuple[str, int, int, str]:
    """Return a mistake that was found at `start`, in our words."""
    path = next((m for m in _PATH.finditer(text) if m.start() <= start < m.end()), None)
    if said.startswith("undeclared reference") and text[start : start + 1] == "(":
        name = WRITTEN.get(name := said.split("'")[1], name)
        end = len(text[:start].rstrip())
        begin, end = (end - len(name), end) if text[:end].endswith(name) else (start, start + 1)
        if called := known.get(name):
            return f"there is no function `{name}` that takes this many arguments", begin, end, called
        return f"there is no function `{name}`", begin, end, _meant(name, known)
    if path and ("undeclared reference" in said or "operand of a select" in said):
        said, hint = _unknown(path[0], known)
        return said, path.start(), path.end(), hint
    if overload := _OVERLOAD.search(said):
        operator = WRITTEN.get(overload[1], overload[1])
        return _misfit(operator, overload[2]), start, start + 1, _HINTS.get(operator) or known.get(operator, "")
    if text[start : start + 1] == "=":
        return "`=` alone says nothing here", start, start + 1, "`==` compares"
    words = said.partition(" (in container")[0].removeprefix("Syntax error: ")
    words = re.sub(r"mismatched input '<EOF>'.*", "it ends too early", words)
    words = re.sub(r"token recognition error at: '(.*)'.*", r"an open quote or an unknown sign, `\1`", words)
    hint = _meant(path[0], ()) if path else "`x * x`" if text[start - 1 : start + 1] == "**" else ""
    return f"it can't be read here: {re.sub(r' expecting .*', '', words)}", start, start + 1, hint


def _unknown(name: str, known: Collection[str]) -> tuple[str, str]:
    """Return that nothing has this name, with a hint; of a field of what is a value that it has none."""
    whole, _, field = name.rpartition(".")
    if whole in known and not any(other.startswith(f"{whole}.") for other in known):
        return f"`{whole}` is the value itself and has no `.{field}`", f"write `{whole}`"
    return f"nothing is called `{name}`{_near(name, known)}", ""


def _near(name: str, known: Collection[str]) -> str:
    near = did_you_mean(name, known)
    return f"; {near}" if near.startswith("did") else ""


def _meant(name: str, known: Collection[str]) -> str:
    """Return what a word that there is not may have meant; empty where nobody can tell."""
    other = _OTHERWISE.get(name.lower())
    return f"here it is `{other}`" if other else _near(name, known).removeprefix("; ")


def _misfit(operator: str, kinds: str) -> str:
    """Return in words that an operator does not take what it is given: `_>_` and `double, string`."""
    sign = operator.replace("_", " ").strip() if operator.startswith(("_", "!", "-")) else f"{operator}()"
    given = " and ".join(kind(one) for one in kinds.split(", "))
    return f"`{sign}` does not go with {given}"
