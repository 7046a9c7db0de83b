"""How a wrong value is said: quantities of another dimension, names of units and values, expected types."""

from __future__ import annotations

import dataclasses
import math
import types
import typing
from collections.abc import Mapping
from typing import Any, Literal, Union, get_args, get_origin

from pico.model.quantities import DimensionError, QuantityError, Unit, convert, dimension

_UNITS = {
    "mm": "millimeters",
    "deg": "degrees",
    "ms": "milliseconds",
    "s": "seconds",
    "mW": "milliwatts",
    "kg": "kilograms",
    "V": "volts",
    "mm/s": "millimeters per second",
    "deg/s": "degrees per second",
    "": "a number without a unit",
}


def article(noun: str) -> str:
    """Return `noun` with its article: `a time`, `an angle`."""
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"


def expected_quantity(unit: str) -> str:
    """Return how a value in `unit` is written: "expected milliseconds, for example `2` or `2 ms`"."""
    words = _UNITS.get(unit, f"a number in {unit}")
    return f"expected {words}, for example `2` or `2 {unit}`" if unit else f"expected {words}, for example `2`"


def shown(value: Any) -> str:
    """Return a value as it is quoted in a sentence."""
    if value is None:
        return "empty"
    if isinstance(value, Mapping):
        return "a mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    text = str(value)
    return f"`{text if len(text) <= 40 else text[:37] + '...'}`"


def quantity(what: str, value: Any, unit: str) -> tuple[float | None, str, str]:
    """Return `value` as a number in `unit`, or (None, code, sentence) that says why `what` can't be that."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None, "type", f"{what} is {shown(value)}, not {_noun(unit)}"
    try:
        number = float(convert(value, unit))
    except DimensionError as exc:
        return None, "unit", f"{what} is {article(exc.want)}, not {article(_plainly(exc.have))}"
    except QuantityError as exc:
        text = str(exc).split("; expected")[0].split("; write")[0]
        return None, "unit", f"{what} is {_noun(unit)}, and {text}"
    if not math.isfinite(number):
        return None, "type", f"{what} is no finite number"
    return number, "", ""


def _plainly(name: str) -> str:
    return "quantity of another kind" if name.startswith(("[", "dimensionless", "1 /")) else name


def _noun(unit: str) -> str:
    try:
        return article(_plainly(dimension(unit)))
    except QuantityError:
        return "a number"


def options(kind: Any) -> tuple[Any, ...]:
    """Return the alternatives of a type, without None."""
    if get_origin(kind) in (Union, types.UnionType):
        return tuple(a for a in get_args(kind) if a is not type(None))
    return (kind,)


def unit_of(kind: Any) -> str | None:
    """Return the unit of a type such as `Length`, or None for another type."""
    for option in options(kind):
        for mark in getattr(option, "__metadata__", ()):
            if isinstance(mark, Unit):
                return mark.unit
    return None


def fields_of(kind: Any) -> dict[str, Any]:
    """Return the fields of a record type with their types; none for another type."""
    for option in options(kind):
        if dataclasses.is_dataclass(option):
            hints = typing.get_type_hints(option, include_extras=True)
            return {f.name: hints[f.name] for f in dataclasses.fields(option)}
    return {}


def required(kind: Any) -> list[str]:
    """Return the names of the fields that a record type can't do without."""
    missing = dataclasses.MISSING
    return [
        f.name
        for option in options(kind)
        if dataclasses.is_dataclass(option)
        for f in dataclasses.fields(option)
        if f.default is missing and f.default_factory is missing
    ]


def inside(kind: Any, step: str | int) -> Any:
    """Return the type of what stands at key or index `step` of a value of type `kind`; Any where there is none."""
    for option in options(kind):
        fields = fields_of(option)
        if step in fields:
            return fields[str(step)]
        args = get_args(option)
        if get_origin(option) is tuple and isinstance(step, int):
            if len(args) == 2 and args[1] is Ellipsis:
                return args[0]
            return args[step] if step < len(args) else Any
        if isinstance(get_origin(option), type) and issubclass(get_origin(option), Mapping) and isinstance(step, str):
            return args[1]
    return Any


def describe(kind: Any) -> str:
    """Return what a value of type `kind` is, in words: "a list of 2 numbers in mm", "one of `x`, `y`"."""
    choices = options(kind)
    if len(choices) > 1:
        return " or ".join(describe(c) for c in choices)
    option = choices[0]
    unit = unit_of(option)
    if unit is not None:
        return f"a number in {unit}"
    return _describe_one(option, get_origin(option), get_args(option))


def _describe_one(option: Any, origin: Any, args: tuple[Any, ...]) -> str:
    if origin is Literal:
        return ("one of " if len(args) > 1 else "") + ", ".join(f"`{a}`" for a in args)
    if origin is tuple:
        one = describe(args[0]).removeprefix("a ").removeprefix("an ")
        if len(args) == 2 and args[1] is Ellipsis:
            return f"a list, each {describe(args[0])}"
        return f"a list of {len(args)}, each {article(one)}"
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return "a mapping of names to values"
    if dataclasses.is_dataclass(option):
        keys = required(option) or list(fields_of(option))
        return "a mapping with " + ", ".join(f"`{k}`" for k in keys[:6])
    words = {float: "a number", int: "a whole number", bool: "`true` or `false`", str: "text"}
    return words.get(option, "a value")
