"""CEL behind a small interface: expressions of policies and expectations, checked before they are evaluated.

`Language(names, functions).compile(text).evaluate(values)`. Numbers are all of one kind: an integer literal is read as
a double, and so is every number of the context, `size(l)` and `int(x)`; one that is whole is an index, too. The work
that an expression may do is limited: 4 KiB of source, 32 levels, 10,000 steps of iteration.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from pico.expressions import wording
from pico.expressions.rewriting import COUNT, WHOLE, as_doubles, hidden

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

_WORD = re.compile(r"[A-Za-z_]\w*")
_UNKNOWN = re.compile(r'No value with name "([^"]*)" found in Activation')
_TOLD: dict[str, Kind] = {
    "double": "number", "bool": "bool", "string": "text", "list<double>": "numbers", "list<string>": "texts",
    "list<dyn>": "list",
}  # fmt: skip
_KINDS = {"number": "DOUBLE", "bool": "BOOL", "text": "STRING", "any": "DYN"}


class ExpressionError(ValueError):
    """What is wrong with an expression, in words; `start` and `end`: the characters of its text that it is about;
    `hint`: what would be right, where that can be told."""

    def __init__(self, message: str, start: int = 0, end: int = 0, hint: str = "") -> None:
        super().__init__(message)
        self.start, self.end, self.hint = start, max(end, start + 1), hint


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
        for n, function in enumerate((*_OWN, *functions)):
            by_name.setdefault(function.name, []).append(self._declare(cel, function, str(n)))
        self._known = {**dict.fromkeys(names, ""), **CONVERSIONS, **called(functions)}
        self._env = cel.NewEnv(
            variables={name: self._kinds[kind] for name, kind in names.items()},
            functions=[cel.FunctionDecl(name, overloads) for name, overloads in by_name.items()],
        )

    def compile(self, text: str, result: Kind = "bool") -> Expression:
        """Return the expression; raises ExpressionError for a mistake in it, or where it gives no `result`."""
        if len(text.encode()) > MOST_SOURCE:
            raise ExpressionError(f"longer than {MOST_SOURCE} bytes")
        compiled = self._compiled(text)
        given, wanted = (kind.name().lower() for kind in (compiled.return_type(), self._kinds[result]))
        if given not in (wanted, "dyn") and wanted != "dyn":
            hint = "a comparison, as in `a > 0`" if wanted == "bool" else ""
            raise ExpressionError(f"it is {wording.kind(given)}, not {wording.kind(wanted)}", 0, len(text), hint)
        return Expression(text, result, compiled)

    def _compiled(self, text: str) -> Any:
        """Return what CEL makes of a text. It takes an index for an integer, and only when it evaluates for any whole
        number: where it is told to be a number CEL is not to know that."""
        source, places = as_doubles(text)
        while True:
            try:
                return self._env.compile(source)
            except RuntimeError as exc:
                indices = wording.computed_indices(source, str(exc))
                if not indices:
                    raise ExpressionError(*wording.mistake(text, source, places, str(exc), self._known)) from exc
                source, places = hidden(source, places, indices)

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
            raise ExpressionError(wording.failure(str(exc), self.text), 0, len(self.text)) from exc
        value = found.plain_value() if "error" not in found.type().name().lower() else None
        if value is None or not isinstance(value, _PYTHON[self.result]):
            said = str(found.value())
            unknown = _UNKNOWN.search(said)
            if unknown:
                raise UnknownValue(unknown[1])
            wrong = wording.failure(said, self.text) if value is None else f"it is not {wording.kind(self.result)}"
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


def _whole(given: Any) -> float:
    try:
        return float(math.trunc(float(given)))
    except (ValueError, OverflowError) as exc:
        raise ValueError(f"`{str(given)[:40]}` is no number that has a whole part") from exc


_OWN = (
    *(Function(COUNT, (kind,), "number", _count, method) for kind in ("list", "text") for method in (False, True)),
    *(Function(WHOLE, (kind,), "number", _whole) for kind in ("number", "text")),
)


def called(functions: Sequence[Function]) -> dict[str, str]:
    """Return how functions are called, by their names: `round(number)`, in words."""
    ways: dict[str, list[str]] = {}
    for one in functions:
        ways.setdefault(one.name, []).append(
            f"`{one.name}({', '.join(wording.kind(k).removeprefix('a ') for k in one.parameters)})`"
        )
    return {name: " or ".join(found) for name, found in ways.items()}


CONVERSIONS: Mapping[str, str] = {
    "size": "`size(l)`, of a list or a text", "int": "`int(x)`, of a number or a text", "bool": "`bool(t)`, of a text",
    "double": "`double(t)`, of a text", "string": "`string(x)`, of a number",
}  # fmt: skip
"""Functions that all expressions have, and how they are called."""


def doubles(value: Any) -> Any:
    """Return JSON data with every number a float, as expressions see them."""
    if isinstance(value, bool):
        return value
    if isinstance(value, int):
        return float(value)
    if isinstance(value, Mapping):
        return {str(k): doubles(v) for k, v in value.items()}
    return [doubles(v) for v in value] if isinstance(value, list | tuple) else value
