"""A type with a part's own parameters: one type of lens for all focal lengths that a lab owns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pico.model.catalog import ComponentType, Parameter
from pico.model.quantities import QuantityError, Value, convert

_KEPT = 1024
_made: dict[tuple[int, tuple[tuple[str, Value], ...]], tuple[ComponentType, ComponentType]] = {}


def with_parameters(kind: ComponentType, given: Mapping[str, Value]) -> ComponentType:
    """Return a type with other values of its parameters, in their units or with one (`80 mm`); the same object for the
    same type and values. Raises KeyError for a parameter that it does not have, QuantityError for what is none."""
    key = id(kind), tuple(sorted(given.items()))
    found = _made.get(key)
    if found is None or found[0] is not kind:
        if len(_made) >= _KEPT:
            _made.clear()
        found = _made[key] = kind, _made_of(kind, given)
    return found[1]


def _made_of(kind: ComponentType, given: Mapping[str, Value]) -> ComponentType:
    own = {name: replace(kind.parameters[name], value=value_of(kind.parameters[name], v)) for name, v in given.items()}
    said = ", ".join(f"{name} {_said(parameter)}" for name, parameter in own.items())
    return replace(kind, parameters={**kind.parameters, **own}, title=f"{kind.title}; {said}" if said else kind.title)


def value_of(parameter: Parameter, given: Value) -> Value:
    """Return a value in the unit of a parameter, of the kind that it has; raises QuantityError for one of another."""
    if isinstance(parameter.value, bool) or isinstance(given, bool):
        if type(parameter.value) is not type(given):
            raise QuantityError(
                f"`{given}` is not {'true or false' if isinstance(parameter.value, bool) else 'a number'}"
            )
        return given
    if isinstance(parameter.value, str):
        if not isinstance(given, str):
            raise QuantityError(f"`{given:g}` is not a word, as `{parameter.value}` is")
        return given
    return float(convert(given, parameter.unit))


def _said(parameter: Parameter) -> str:
    value = parameter.value
    number = f"{value:g}" if isinstance(value, float | int) and not isinstance(value, bool) else str(value).lower()
    return f"{number} {parameter.unit}".rstrip()
