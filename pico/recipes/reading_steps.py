"""The steps of a recipe as they are read: each against the names that are known where it stands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pico.diagnostics import did_you_mean
from pico.expressions import ExpressionError
from pico.kernels.pipeline import spelt
from pico.manifest.text.tree import List, Map, Node, Scalar
from pico.recipes.reader import NOTHING, Reader, scalar_texts
from pico.recipes.recipe import Act, Assert, Call, Choice, Each, Let, Name, Parameter, Recipe, Scan, Step, While
from pico.recipes.registry import CONTROL, known, step_file
from pico.recipes.scanning import column, result_names
from pico.recipes.scope import Scope
from pico.recipes.terms import Term, literal, text_term

BESIDE = ("as", "name", "retries")
"""Keys that may stand beside any step."""
OF: Mapping[str, tuple[str, ...]] = {
    "foreach": ("steps",), "if": ("then", "else"), "while": ("most", "steps"), "call": ("with",), "let": (),
    "assert": ("message",), "scan": ("read", "required"),
}  # fmt: skip
"""Keys that stand beside the steps of the language itself."""


@dataclass(frozen=True)
class Reading:
    """One recipe while it is read: `called` returns one that it calls, None where that is wrong, which is said; `full`:
    lists that are never empty."""

    root: Map
    reader: Reader
    full: frozenset[str]
    called: Callable[[Node], Recipe | None]


def read_steps(reading: Reading, scope: Scope, node: Node | None, at: str, what: str) -> tuple[Step, ...]:
    """Return the steps of a list; names that they give are known to those that follow."""
    if not isinstance(node, List):
        if node is not None:
            reading.reader.wrong(node, "type", f"`{what}` is no list of steps", "each begins with `- `")
        return ()
    found = []
    for n, item in enumerate(node.items):
        if (step := _step(reading, scope, item, f"{at}{n + 1}")) is not None:
            found.append(step)
    return tuple(found)


def _step(reading: Reading, scope: Scope, node: Node, at: str) -> Step | None:
    reader = reading.reader
    names, reader.mark = (*CONTROL, *known()), len(reader.found)
    if not isinstance(node, Map):
        hint = f"`- {node.text}:`" if isinstance(node, Scalar) and node.text in names else "`- measure: cam.centroid`"
        reader.wrong(node, "type", "a step is a mapping that begins with what is done", hint)
        return None
    kinds = [key for key in node.entries if key in names]
    if len(kinds) != 1:
        first = next(iter(node.entries.values()))[0] if node.entries else node
        if kinds:
            text = f"one step does one thing: `{kinds[0]}` or `{kinds[1]}`"
            reader.wrong(node.entries[kinds[1]][0], "step", text, "begin another step with `- `")
        else:
            word = first.text if isinstance(first, Scalar) else ""
            hint = did_you_mean(word[:40], names) or f"steps: {', '.join(names)}"
            reader.wrong(first, "step", f"there is no step `{word[:40]}`", hint)
        return None
    kind = kinds[0]
    allowed = (kind, *BESIDE, *(OF[kind] if kind in CONTROL else step_file(kind).KIND.keys))
    reader.keys(node, allowed, f"the step `{kind}`")
    beside = {k: v for k, (_, v) in node.entries.items() if k != kind}
    title = _title(beside.get("name"), kind, node)
    common = {"at": at, "title": title, "source": reader.at(node.entries[kind][0]), "says": _said(scope, title)}
    common["retries"] = _retries(reader, scope, beside.get("retries"))
    body = node.entries[kind][1]
    if kind in CONTROL:
        return _CONTROL[kind](reading, scope, body, beside, common)
    return _act(reading, scope, kind, body, beside, common)


def _act(reading: Reading, scope: Scope, kind: str, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    given = step_file(kind).read(reading.reader, scope, body, beside)
    binds = _bind(reading, scope, beside.get("as"), kind, given.names)
    scope.measured.update(given.measured)
    if common["says"] is None and "name" not in beside and isinstance(body, Map):
        common = {**common, "says": _filled(kind, body, given.values)}
    return Act(**common, kind=kind, given=given.values, binds=binds, names=dict(given.names))


def _bind(reading: Reading, scope: Scope, node: Node | None, kind: str, names: Any) -> str:
    """Return the name that `as` gives to a result, which is known from then on; empty for none."""
    reader = reading.reader
    if node is None:
        return ""
    word = node.text if isinstance(node, Scalar) else ""
    if not names and len(reader.found) > reader.mark:
        reader.lost.add(word)
    elif not names:
        reader.wrong(node, "name", f"`{kind}` here has no result that could be called `{word[:40]}`")
    elif reader.new_name(node, word, scope):
        _define(reading, scope, word, names)
        return word
    return ""


def _define(reading: Reading, scope: Scope, word: str, names: Mapping[str, Name]) -> None:
    reading.reader.lost.discard(word)
    gone = [n for n in scope.own if n == word or n.startswith(f"{word}.")]
    for old in gone:
        del scope.own[old]
    scope.own.update({f"{word}.{part}" if part else word: kind for part, kind in names.items()})


def _title(node: Node | None, kind: str, step: Map) -> str:
    if isinstance(node, Scalar) and node.text:
        return node.text
    body = step.entries[kind][1]
    if isinstance(body, Scalar):
        return f"{kind} {body.text}".strip()
    if isinstance(body, Map):
        entries = ((k, v) for k, (_, v) in body.entries.items())
        return f"{kind} {', '.join(f'{k}: {v.text}' if isinstance(v, Scalar) else k for k, v in entries)}"
    return f"{kind} {', '.join(i.text for i in body.items if isinstance(i, Scalar))}"


def _said(scope: Scope, title: str) -> Term | None:
    """Return a title with expressions in it; None where it has none, or they are wrong, which its step says."""
    try:
        term = text_term(title, scope.language)
    except ExpressionError:
        return None
    return None if term.known else term


def _filled(kind: str, body: Map, values: Mapping[str, Any]) -> Term | None:
    """Return what a step does with the values of its expressions (`set p1.angle: 10`); None where it has none."""
    parts: list[Any] = []
    for key, (_, node) in body.entries.items():
        term = values.get(key)
        told = (
            term.parts if isinstance(term, Term) and term.parts else (node.text if isinstance(node, Scalar) else key,)
        )
        parts += [", " if parts else f"{kind} ", f"{key}: ", *told]
    return None if all(isinstance(part, str) for part in parts) else Term(parts=tuple(parts))


def _retries(reader: Reader, scope: Scope, node: Node | None) -> int:
    if node is None:
        return 0
    term = reader.number(scope, node, "retries", low=0, high=100)
    if not term.known or term is NOTHING or term.literal != int(term.literal):
        if term is not NOTHING:
            reader.wrong(node, "type", "`retries` is a whole number, written out")
        return 0
    return int(term.literal)


# the language itself


def _foreach(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    reader = reading.reader
    inner, over = scope.inner(), dict[str, Term]()
    if not isinstance(body, Map) or not body.entries:
        reader.wrong(body, "type", "`foreach` takes names with their values", "`foreach: {tilt: [0, 15, 30]}`")
        return Each(**common)
    for word, (at, node) in body.entries.items():
        term, each = reader.values(scope, node, word)
        if reader.new_name(at, word, scope):
            over[word] = term
            _define(reading, inner, word, {"": each})
    steps = _inside(reading, inner, beside, "steps", common["at"])
    if all(_full(reading, term, body.entries[word][1]) for word, term in over.items()):
        scope.measured |= inner.measured  # it goes round at least once
    return Each(**common, over=over, steps=steps)


def _full(reading: Reading, term: Term, node: Node) -> bool:
    """Return whether a list has a value at least, wherever it comes from: a range has."""
    return bool(term.literal) or isinstance(node, Map) or any(term.text == f"${{{name}}}" for name in reading.full)


def _scan(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    reader, example = reading.reader, "`scan: {p1.angle: {from: 1, to: 5, count: 9}}`, and `read: cam.power`"
    over, names = dict[str, Term](), dict[str, Name]()
    if not isinstance(body, Map) or not body.entries:
        reader.wrong(body, "type", "`scan` takes tunables with their values", example)
        return Scan(**common)
    for address, (at, node) in body.entries.items():
        if (known := reader.tunable_at(at, address)) is not None:
            over[address], each = reader.all_of_tunable(scope, *known, node)
            names[column(address)] = Name("numbers", each.unit)
    listed = scalar_texts(beside["read"]) if "read" in beside else None
    if not listed:
        reader.wrong(beside.get("read", body), "missing-key", "`scan` does not say what to read", example)
    of = tuple(a for node, text in listed or () if reader.measurable(node, a := spelt(text)))
    measured = {f"{a.partition('.')[0]}.{n}": unit for a in of for n, unit in reader.numbers(a).items()}
    where = {  # a pose and a set-point are no numbers of an instrument, and have columns all the same
        f"{a}.{part}" if part else a: name.unit for a in of if not reader.numbers(a)
        for part, name in result_names(reader.setup, a, {}).items() if name.kind == "number"
    }  # fmt: skip
    for address, unit in (measured | where).items():
        names |= {column(address): Name("numbers", unit), f"{column(address)}_sigma": Name("numbers", unit)}
    names["part"] = Name("numbers")
    scope.measured |= measured.keys()
    required = _required(reader, scope, beside.get("required"))
    binds = _bind(reading, scope, beside.get("as"), "scan", names)
    return Scan(**common, over=over, of=of, binds=binds, names=names, required=required)


def _required(reader: Reader, scope: Scope, node: Node | None) -> bool:
    """Whether a scan fails at a point without a value: that is written out."""
    term = literal(True) if node is None else reader.flag(scope, node, "required")
    if node is not None and not (term.known and isinstance(term.literal, bool)):
        reader.wrong(node, "type", "`required` of a scan is true or false, written out")
    return term.literal is not False


def _inside(reading: Reading, scope: Scope, beside: Mapping[str, Node], key: str, at: str) -> tuple[Step, ...]:
    if key not in beside:
        hint = f"`{key}:` and a list of steps below it"
        reading.reader.wrong(reading.root, "missing-key", f"step {at} has no `{key}`", hint)
        return ()
    return read_steps(reading, scope, beside[key], f"{at}.", key)


def _if(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    that = reading.reader.flag(scope, body, "the condition")
    then = _inside(reading, scope.inner(), beside, "then", common["at"])
    other = (
        read_steps(reading, scope.inner(), beside["else"], f"{common['at']}.else.", "else") if "else" in beside else ()
    )
    return Choice(**common, that=that, then=then, otherwise=other)


def _while(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    reader = reading.reader
    that = reader.flag(scope, body, "the condition")
    most = reader.number(scope, beside["most"], "most", low=1, high=10_000) if "most" in beside else NOTHING
    if most is NOTHING or not most.known:
        reader.wrong(beside.get("most", body), "bound", "`while` needs a bound, written out", "`most: 10`")
        most = literal(1)
    steps = _inside(reading, scope.inner(), beside, "steps", common["at"])
    return While(**common, that=that, most=int(most.literal), steps=steps)


def _let(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    reader = reading.reader
    if not isinstance(body, Map) or not body.entries:
        reader.wrong(body, "type", "`let` takes names with their values", "`let: {half: (a - b) / 2}`")
        return Let(**common)
    values = {}
    for word, (at, node) in body.entries.items():
        term, kind = reader.any(scope, node, word)
        old = scope.own.get(word)
        if old is not None and old.kind != kind.kind and term is not NOTHING:
            reader.wrong(at, "type", f"`{word}` was {old.kind} before, and now is {kind.kind}", "another name for it")
        elif reader.new_name(at, word, scope):
            values[word] = term
            _define(reading, scope, word, {"": old or kind})
    return Let(**common, values=values)


def _assert(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    that = reading.reader.flag(scope, body, "what must hold")
    said = reading.reader.text(scope, beside["message"], "the message") if "message" in beside else None
    return Assert(**common, that=that, message=said)


def _call(reading: Reading, scope: Scope, body: Node, beside: Mapping[str, Node], common: Any) -> Step:
    reader = reading.reader
    recipe = reading.called(body)
    if recipe is None:
        _bind(reading, scope, beside.get("as"), "call", {})
        return Call(**common)
    given, arguments = dict[str, Term](), beside.get("with")
    entries = arguments.entries if isinstance(arguments, Map) else {}
    if arguments is not None and not isinstance(arguments, Map):
        reader.wrong(arguments, "type", "`with` is a mapping of parameters to values")
    for word, (at, node) in entries.items():
        parameter = recipe.parameters.get(word)
        if parameter is None:
            hint = did_you_mean(word[:40], recipe.parameters) or "it has no parameters"
            reader.wrong(at, "unknown-key", f"{recipe.name} has no parameter `{word[:40]}`", hint)
        else:
            given[word] = _argument(reader, scope, node, parameter)
    missing = [p.name for p in recipe.parameters.values() if p.default is None and p.name not in entries]
    if missing:
        reader.wrong(
            body, "missing-key", f"{recipe.name} is not told {', '.join(missing)}", f"`with: {{{missing[0]}: ...}}`"
        )
    binds = _bind(reading, scope, beside.get("as"), "call", recipe.returned)
    return Call(**common, recipe=recipe, given=given, binds=binds)


def _argument(reader: Reader, scope: Scope, node: Node, parameter: Parameter) -> Term:
    if parameter.kind == "number":
        return reader.number(scope, node, parameter.name, parameter.unit, parameter.low, parameter.high)
    if parameter.kind == "bool":
        return reader.flag(scope, node, parameter.name)
    if parameter.kind == "text":
        return reader.text(scope, node, parameter.name)
    return reader.values(scope, node, parameter.name, parameter.unit)[0]


_CONTROL: Mapping[str, Callable[..., Step]] = {
    "foreach": _foreach, "if": _if, "while": _while, "let": _let, "assert": _assert, "call": _call,
    "scan": _scan,
}  # fmt: skip
