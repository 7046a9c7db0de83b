"""Parameters of recipes: as a recipe declares them, and as who runs it gives them (`-p tilt=30`); so are answers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, cast, get_args, get_type_hints

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.expressions import ExpressionError
from pico.manifest.text.source import Source
from pico.manifest.text.tree import List, Map, Node, Scalar, parse
from pico.model.quantities import QuantityError, require_unit
from pico.model.trace.question import Question, wanted
from pico.recipes.reader import NOTHING, Reader, scalar_texts
from pico.recipes.recipe import Parameter
from pico.recipes.scope import Scope

if TYPE_CHECKING:
    from pico.model.setup import Setup

KEYS = ("kind", "unit", "default", "range", "choices", "description")
KINDS: tuple[Any, ...] = get_args(get_type_hints(Parameter)["kind"])
_YES, _NO = ("yes", "y", "true"), ("no", "n", "false")
_NO_BENCH = cast("Setup", None)
"""What is written out speaks of no bench, so that none is needed to read it."""
_EXAMPLE = "`parameters: {tilt: {unit: deg, default: 30, range: [0, 45]}}`"


def read_parameters(reader: Reader, node: Node | None) -> dict[str, Parameter]:
    """Return the parameters that a recipe declares; what is wrong with them is said."""
    if node is None:
        return {}
    if not isinstance(node, Map):
        reader.wrong(node, "type", "`parameters` is a mapping of names", _EXAMPLE)
        return {}
    found, scope = {}, Scope({}, {})
    for word, (at, body) in node.entries.items():
        if reader.new_name(at, word, scope):
            found[word] = read_parameter(reader, word, body)
    return found


def read_parameter(reader: Reader, name: str, node: Node) -> Parameter:
    """Return a parameter as a recipe declares it; what is wrong with it is said."""
    where = reader.at(node)
    if not isinstance(node, Map):
        if isinstance(node, Scalar) and node.value is None:
            return Parameter(name, "number", source=where)
        value, looks = _value(reader, name, node, "", "")
        return Parameter(name, looks, default=value, source=where)
    reader.keys(node, KEYS, f"the parameter {name}")
    texts = {k: v.text for k, (_, v) in node.entries.items() if isinstance(v, Scalar)}
    unit, declared = texts.get("unit", ""), texts.get("kind", "")
    if declared and declared not in KINDS:
        hint = did_you_mean(declared[:40], KINDS)
        reader.wrong(node.entries["kind"][1], "choice", f"`{declared[:40]}` is no kind of value", hint)
        declared = ""
    try:
        require_unit(unit)
    except QuantityError as exc:
        reader.wrong(node.entries["unit"][1], "unit", f"unit of {name}: {exc}")
        unit = ""
    choices = (
        tuple(text for _, text in scalar_texts(node.entries["choices"][1]) or ()) if "choices" in node.entries else ()
    )
    default: Any = None
    kind: Any = declared or ("text" if choices else "number")
    if "default" in node.entries:
        default, kind = _value(reader, name, node.entries["default"][1], unit, declared or ("text" if choices else ""))
    low, high = _range(reader, name, node.get("range"), unit)
    found = Parameter(name, kind, unit, default, low, high, choices, texts.get("description", ""), where)
    if default is not None and (wrong := unfit(found, default)):
        reader.wrong(node.entries["default"][1], "range", wrong)
    return found


def _range(reader: Reader, name: str, node: Node | None, unit: str) -> tuple[float | None, float | None]:
    if node is None:
        return None, None
    ends = node.items if isinstance(node, List) else []
    if len(ends) != 2:
        reader.wrong(node, "type", f"the range of {name} is its least and its greatest value", "`range: [0, 45]`")
        return None, None
    low, high = (reader.number(Scope({}, {}), end, f"the range of {name}", unit) for end in ends)
    if NOTHING in (low, high) or low.literal > high.literal:
        return None, None
    return low.literal, high.literal


def _value(reader: Reader, name: str, node: Node, unit: str, kind: str) -> tuple[Any, Any]:
    """Return a value of a parameter, and its kind: as declared, else as it looks."""
    nothing = Scope({}, {})
    if isinstance(node, List | Map) or kind in ("numbers", "texts"):
        term, each = reader.values(nothing, node, name, unit)
        looks = "texts" if each.kind == "text" else "numbers"
        if kind and looks != kind and term is not NOTHING:
            reader.wrong(node, "type", f"{name} is declared as {kind}, and this is {looks}")
    elif kind == "text" or (not kind and not unit and isinstance(node, Scalar) and isinstance(node.value, str)):
        term, looks = reader.text(nothing, node, name), "text"
    elif kind == "bool" or (not kind and isinstance(node, Scalar) and isinstance(node.value, bool)):
        term, looks = reader.flag(nothing, node, name), "bool"
    else:
        term, looks = reader.number(nothing, node, name, unit), "number"
    try:
        return term.value({}), looks
    except ExpressionError as exc:
        reader.wrong(node, "expression", f"{name} can't be told: {exc}", exc.hint)
        return None, looks


def unfit(parameter: Parameter, value: Any) -> str:
    """Return why a value is none that a parameter may have; empty where it may."""
    unit = f" {parameter.unit}" if parameter.unit else ""
    if value == []:
        return f"{parameter.name} is an empty list"
    for one in value if isinstance(value, list) else [value]:
        if parameter.choices and one not in parameter.choices:
            return f"{parameter.name} is `{str(one)[:40]}`: one of {', '.join(parameter.choices)}"
        low, high = parameter.low, parameter.high
        if isinstance(one, float) and ((low is not None and one < low) or (high is not None and one > high)):
            return f"{parameter.name} is out of range: {one:g}{unit}, and it may be {low:g} to {high:g}{unit}"
    return ""


def given_values(parameters: Mapping[str, Parameter], words: Mapping[str, str]) -> dict[str, Any]:
    """Return the values of all parameters, of those that `words` name as a person writes them: `30`, `30 deg`,
    `[0, 15, 30]`, `{from: 0, to: 45, step: 5}`. Raises PicoError with all that is wrong."""
    found: list[Diagnostic] = []
    values: dict[str, Any] = {}
    for name in words:
        if name not in parameters:
            hint = did_you_mean(name[:40], parameters) or "it has no parameters"
            found.append(error("unknown-parameter", f"the recipe has no parameter `{name[:40]}`", hint=hint))
    for name, parameter in parameters.items():
        if name in words:
            try:
                values[name] = given_value(parameter, words[name], f"-p {name}")
            except PicoError as exc:
                found.extend(exc.diagnostics)
        elif parameter.default is None:
            unit = f", in {parameter.unit}" if parameter.unit else ""
            found.append(error("missing-parameter", f"the recipe is not told {name}{unit}", hint=f"`-p {name}=...`"))
        else:
            values[name] = parameter.default
    if found:
        raise PicoError(found)
    return values


def given_value(parameter: Parameter, word: str, source: str = "the answer") -> Any:
    """Return the value of one parameter as a person writes it, in what is called `source`; raises PicoError."""
    written = Source(source, word)
    documents, wrong = parse(written)
    if wrong or len(documents) != 1:
        text = f"`{word[:40]}` can't be read as a value of {parameter.name}"
        raise PicoError(error("parameter", text, hint="`30`, `30 deg`, `[0, 15, 30]`"))
    own = Reader(documents[0], _NO_BENCH, [])
    node = documents[0].root
    if parameter.kind in ("numbers", "texts") and isinstance(node, Scalar):
        node = List(node.start, True, node.end, [node])
    value, _ = _value(own, parameter.name, node, parameter.unit, parameter.kind)
    if own.found:
        raise PicoError(own.found)
    if unfitting := unfit(parameter, value):
        raise PicoError(error("range", unfitting))
    return value


def answered(question: Question, word: str) -> Any:
    """Return the value that an answer means as a person writes it (`yes`, `30`, `30 deg`); raises PicoError with what
    is wrong with it."""
    word = word.strip()
    if not word and question.default is not None:
        return question.default
    if question.kind in ("confirm", "bool"):
        if word.lower() not in (*_YES, *_NO):
            raise PicoError(error("answer", f"`{word[:40]}` answers neither yes nor no", hint="`yes` or `no`"))
        return word.lower() in _YES
    if not word:
        raise PicoError(error("answer", f"nothing is said of {question.name}", hint=wanted(question)))
    kind: Literal["number", "text"] = "number" if question.kind == "number" else "text"
    about = Parameter(question.name, kind, question.unit, None, question.low, question.high, question.choices)
    if kind == "number":
        return given_value(about, word)
    if wrong := unfit(about, word):
        raise PicoError(error("range", wrong, hint=wanted(question)))
    return word
