"""CEL behind a small interface: expressions of policies and expectations, checked before they are evaluated.

`Language(names, functions).compile(text).evaluate(values)`. Numbers are all of one kind: an integer literal is read as
a double, and so is every number of the context. The work that an expression may do is limited: 4 KiB of source, 32
levels, 10,000 steps of iteration.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

Kind = Literal["number", "bool", "text", "list", "numbers", "texts", "any"]
RESERVED = frozenset(  # words, then types
    (
        *("as", "break", "const", "continue", "else", "false", "for", "function", "if", "import", "in", "let", "loop"),
        *("namespace", "null", "package", "return", "true", "var", "void", "while"),
        *("bool", "bytes", "double", "dyn", "int", "list", "map", "null_type", "string", "type", "uint"),
    )
)
"""Words of the language, and its types: no name of a value."""
MOST_SOURCE = 4096
"""Bytes that the source of an expression may have."""

_TOKEN = re.compile(
    r"""(?P<text>[rRbB]{0,2}(?:'{3}.*?'{3}|"{3}.*?"{3}|'(?:\\.|[^'\\\n])*'|"(?:\\.|[^"\\\n])*"))"""
    r"|(?P<comment>//[^\n]*)|(?P<name>[A-Za-z_]\w*)|(?P<hex>0[xX][0-9a-fA-F]+[uU]?)"
    r"|(?P<float>\d*\.\d+(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)|(?P<int>\d+)(?![\w.])|(?P<other>\S)",
    re.DOTALL,
)
_WORD = re.compile(r"[A-Za-z_]\w*")
_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
_FOUND = re.compile(r"ERROR: <input>:(-?\d+):(-?\d+): ([^\n\[]*(?:\[(?!\w+\]\s*$)[^\n\[]*)*)")
_UNKNOWN = re.compile(r'No value with name "([^"]*)" found in Activation')
_OVERLOAD = re.compile(r"found no matching overload for '([^']*)' applied to '(.*)'")
_WORDS = {
    "double": "a number", "int": "a whole number", "string": "text", "bool": "true or false",
    "list<double>": "a list of numbers", "list<string>": "a list of texts",
}  # fmt: skip
_WANTED = {"number": "a number", "bool": "true or false"}
_TOLD: dict[str, Kind] = {
    "double": "number", "bool": "bool", "string": "text", "list<double>": "numbers", "list<string>": "texts",
    "list<dyn>": "list",
}  # fmt: skip
_KINDS = {"number": "DOUBLE", "bool": "BOOL", "text": "STRING", "any": "DYN"}
_TOO_DEEP = "too deep or too long: brackets and sums have at most about 32 terms; `&&` chains may be longer"


class ExpressionError(ValueError):
    """What is wrong with an expression, in words; `start` and `end`: the characters of its text that it is about."""

    def __init__(self, message: str, start: int = 0, end: int = 0) -> None:
        super().__init__(message)
        self.start, self.end = start, max(end, start + 1)


class UnknownValue(ExpressionError):
    """The result depends on a value that nobody knows, `name`."""

    def __init__(self, name: str) -> None:
        super().__init__(f"nobody knows {name}")
        self.name = name


@dataclass(frozen=True)
class Function:
    """A function of the language. `run` raises ValueError, in words, where it has no result. `method`: it is called as
    one of its first argument."""

    name: str
    parameters: tuple[Kind, ...]
    result: Kind
    run: Callable[..., Any]
    method: bool = False


class Language:
    """The names that expressions may use, with the kind of each (`p2.angle`: a number), and the functions."""

    def __init__(self, names: Mapping[str, Kind], functions: Sequence[Function] = ()) -> None:
        from cel_expr_python import cel

        self.names = names
        self._kinds = {kind: getattr(cel.Type, word) for kind, word in _KINDS.items()}
        lists = {"list": cel.Type.DYN, "numbers": cel.Type.DOUBLE, "texts": cel.Type.STRING}
        self._kinds |= {kind: cel.Type.List(of) for kind, of in lists.items()}
        by_name: dict[str, list[Any]] = {}
        for n, function in enumerate((*_COUNTS, *functions)):
            by_name.setdefault(function.name, []).append(self._declare(cel, function, str(n)))
        self._known = {*names, *(f.name for f in functions), "size", "has"}
        self._env = cel.NewEnv(
            variables={name: self._kinds[kind] for name, kind in names.items()},
            functions=[cel.FunctionDecl(name, overloads) for name, overloads in by_name.items()],
        )

    def compile(self, text: str, result: Kind = "bool") -> Expression:
        """Return the expression; raises ExpressionError for a mistake in it, or where it gives no `result`."""
        if len(text.encode()) > MOST_SOURCE:
            raise ExpressionError(f"longer than {MOST_SOURCE} bytes")
        source, places = _as_doubles(text)
        try:
            compiled = self._env.compile(source)
        except RuntimeError as exc:
            raise self._explained(text, source, places, str(exc)) from exc
        given, wanted = (kind.name().lower() for kind in (compiled.return_type(), self._kinds[result]))
        if given not in (wanted, "dyn") and wanted != "dyn":
            raise ExpressionError(f"it is {_WORDS.get(given, given)}, not {_WORDS.get(wanted, wanted)}", 0, len(text))
        return Expression(text, result, compiled)

    def kind_of(self, text: str) -> tuple[Kind, Expression]:
        """Return of which kind the value of an expression will be, with it: `any` where only its values tell, `list`
        for an empty one. Raises ExpressionError for a mistake in it."""
        found = self.compile(text, "any")
        kind = _TOLD.get(found._compiled.return_type().name().lower(), "any")
        return kind, Expression(text, kind, found._compiled)

    def _declare(self, cel: Any, function: Function, tag: str) -> Any:
        parameters = [self._kinds[kind] for kind in function.parameters]
        return cel.Overload(
            f"{function.name}_{tag}", return_type=self._kinds[function.result], parameters=parameters,
            is_member=function.method, impl=function.run,
        )  # fmt: skip

    def _explained(self, text: str, source: str, places: Sequence[int], said: str) -> ExpressionError:
        found = _FOUND.search(said)
        if found is None or int(found[1]) < 1:
            return ExpressionError(_TOO_DEEP if "recursion" in said else said.partition("[")[0].strip(), 0, len(text))
        lines = source.split("\n")
        at = sum(len(line) + 1 for line in lines[: int(found[1]) - 1]) + int(found[2]) - 1
        start = places[min(at, len(places) - 1)]
        return self._about(text, start, found[3].strip())

    def _about(self, text: str, start: int, said: str) -> ExpressionError:
        """Return a mistake that was found at `start`, in our words."""
        path = next((m for m in _PATH.finditer(text) if m.start() <= start < m.end()), None)
        if said.startswith("undeclared reference") and text[start : start + 1] == "(":
            return ExpressionError(f"there is no function {_quoted(said)} that takes this many arguments", start)
        if path and ("undeclared reference" in said or "operand of a select" in said):
            return ExpressionError(f"nothing is called `{path[0]}`{self._near(path[0])}", path.start(), path.end())
        overload = _OVERLOAD.search(said)
        if overload:
            return ExpressionError(_misfit(overload[1], overload[2]), start)
        words = said.partition(" (in container")[0].removeprefix("Syntax error: ")
        words = re.sub(r"mismatched input '<EOF>'.*", "it ends too early", words)
        words = re.sub(r"token recognition error at: '(.*)'.*", r"an open quote or an unknown sign, `\1`", words)
        return ExpressionError(f"it can't be read here: {re.sub(r' expecting .*', '', words)}", start)

    def _near(self, name: str) -> str:
        import difflib

        near = difflib.get_close_matches(name, self._known, n=1, cutoff=0.6)
        return f"; did you mean `{near[0]}`?" if near else ""


@dataclass(frozen=True)
class Expression:
    """A checked expression."""

    text: str
    result: Kind
    _compiled: Any

    def evaluate(self, values: Mapping[str, Any]) -> Any:
        """Return the value for `values` by name; raises UnknownValue for one that is needed and missing, and
        ExpressionError where there is no result."""
        try:
            words = words_of([self.text])
            spoken = {name: value for name, value in values.items() if name.partition(".")[0] in words}
            found = self._compiled.eval(data={name: doubles(value) for name, value in spoken.items()})
        except RuntimeError as exc:
            raise ExpressionError(_failure(str(exc)), 0, len(self.text)) from exc
        value = found.plain_value() if "error" not in found.type().name().lower() else None
        if value is None or not isinstance(value, _PYTHON[self.result]):
            said = str(found.value())
            unknown = _UNKNOWN.search(said)
            if unknown:
                raise UnknownValue(unknown[1])
            wrong = _failure(said) if value is None else f"it is not {_WANTED.get(self.result, self.result)}"
            raise ExpressionError(wrong, 0, len(self.text))
        return value


_PYTHON: dict[Kind, Any] = {
    "number": float, "bool": bool, "text": str, "list": list, "numbers": list, "texts": list, "any": object,
}  # fmt: skip


def words_of(texts: Iterable[str]) -> set[str]:
    """Return the words of which expressions consist, names among them."""
    return {word for text in texts for word in _WORD.findall(text)}


def _count(items: Any) -> float:
    return float(len(items))


_COUNTS = tuple(
    Function("count", (kind,), "number", _count, method) for kind in ("list", "text") for method in (False, True)
)


def doubles(value: Any) -> Any:
    """Return JSON data with every number a float, as expressions see them."""
    if isinstance(value, bool):
        return value
    if isinstance(value, int):
        return float(value)
    if isinstance(value, Mapping):
        return {str(k): doubles(v) for k, v in value.items()}
    return [doubles(v) for v in value] if isinstance(value, list | tuple) else value


@cache
def _as_doubles(text: str) -> tuple[str, list[int]]:
    """Return the source with integers as doubles, except where they are an index, and `size` as `count`, a double; and
    for each of its characters, and its end, the place in `text` that it comes from."""
    out: list[str] = []
    places: list[int] = []
    last, tokens = 0, list(_TOKEN.finditer(text))
    for n, token in enumerate(tokens):
        after = tokens[n + 1][0] if n + 1 < len(tokens) else ""
        word = token[0]
        if token["int"] and not (n > 1 and tokens[n - 1][0] == "[" and after == "]" and _ends_value(tokens[n - 2])):
            word += ".0"
        elif word == "size" and after == "(":
            word = "count"
        gap = text[last : token.start()]
        out += [gap, word]
        places += [*range(last, token.start()), *(min(token.start() + i, token.end() - 1) for i in range(len(word)))]
        last = token.end()
    return "".join([*out, text[last:]]), [*places, *range(last, len(text) + 1)]


def _ends_value(token: re.Match[str]) -> bool:
    return bool(token["name"]) or token[0] in ("]", ")")


def _quoted(said: str) -> str:
    return f"`{said.split(chr(39))[1]}`"


def _misfit(operator: str, kinds: str) -> str:
    """Return in words that an operator does not take what it is given: `'_>_' applied to '(double, string)'`."""
    sign = operator.replace("_", " ").strip() if operator.startswith(("_", "!", "-")) else f"{operator}()"
    given = " and ".join(_WORDS.get(k.strip(), k.strip()) for k in kinds.strip("()").split(", "))
    return f"`{sign}` does not go with {given}"


def _failure(said: str) -> str:
    """Return in words why an evaluation gave nothing."""
    if "Iteration budget" in said:
        return "it looks at too many things: more than 10,000 steps"
    missing = re.search(r'Key not found in map : "([^"]*)"', said)
    if missing:
        return f"there is no `{missing[1]}` in it"
    if "No matching overloads" in said or "matching overload" in said:
        return f"it compares what does not go together: {said.split(':', 1)[-1].strip()[:120]}"
    return re.sub(r"^[A-Z_]+: ", "", said.partition(" [")[0])[:200]
