"""The one way model data is declared, turned into canonical JSON and digested."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from functools import cache, wraps
from typing import Any, TypeVar, cast, dataclass_transform

T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])
REMEMBERED = 4
"""Of so many objects is kept what was computed of them, see `remembered`: a bench, and those that it is tried as."""


@dataclass_transform(frozen_default=True, kw_only_default=True)
def record(cls: type[T]) -> type[T]:
    """Make `cls` a frozen, slotted, keyword-only dataclass; pydantic, where it reads one, refuses unknown keys, and
    numbers that are not finite."""
    cls.__pydantic_config__ = {"extra": "forbid", "allow_inf_nan": False}  # type: ignore[attr-defined]
    return dataclasses.dataclass(frozen=True, slots=True, kw_only=True)(cls)


@cache
def _fields(cls: type) -> tuple[tuple[str, str], ...]:
    """Attribute and JSON name of each field: a trailing underscore (`from_`) is dropped."""
    return tuple((f.name, f.name.rstrip("_")) for f in dataclasses.fields(cls))


def as_json(value: Any, number: Callable[[float], float] = float) -> Any:
    """Return `value` (records, mappings, sequences, scalars) as plain JSON data, numbers with a point as `number` gives
    them; fields that are None are left out."""
    kind: Any = type(value)
    if kind is str or value is None or kind is int or kind is bool:
        return value
    if kind is float:
        return number(value)
    if kind is dict:
        return {str(k): as_json(v, number) for k, v in value.items()}
    if kind is tuple or kind is list:
        return [as_json(v, number) for v in value]
    if hasattr(kind, "__dataclass_fields__"):
        return {key: as_json(v, number) for name, key in _fields(kind) if (v := getattr(value, name)) is not None}
    return as_json(_builtin(value), number)


def _builtin(value: Any) -> Any:
    """Return a value of another type as one of those that JSON data are made of."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, set | frozenset):
        return sorted(value)
    for builtin in (str, int, float):
        if isinstance(value, builtin):
            return builtin(value)
    if isinstance(value, Sequence):
        return list(value)
    raise TypeError(f"{type(value).__name__} has no JSON form")


def remembered(work: F) -> F:
    """Let what is computed of a frozen object (the first argument) and of hashable ones be computed once, for the
    objects of which this was asked last; what is returned must not be changed."""
    known: dict[int, tuple[object, dict[tuple[Any, ...], Any]]] = {}

    @wraps(work)
    def recall(of: Any, *more: Any) -> Any:
        kept = known.get(id(of))
        if kept is None or kept[0] is not of:
            while len(known) >= REMEMBERED:
                known.pop(next(iter(known)), None)
            kept = known[id(of)] = of, {}
        found = kept[1]
        if more not in found:
            found[more] = work(of, *more)
        return found[more]

    return cast(F, recall)


def _rounded(value: float) -> float:
    rounded = round(value, 6) + 0.0  # -0.0 becomes 0.0
    return int(rounded) if rounded.is_integer() else rounded


def canonical(value: Any) -> str:
    """Return canonical JSON: keys sorted, no white space, floats rounded to 1e-6, whole numbers without a point."""
    return json.dumps(as_json(value, _rounded), sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def digest(value: Any) -> str:
    """Return `sha256:...` of the canonical JSON of `value`."""
    return "sha256:" + hashlib.sha256(canonical(value).encode()).hexdigest()
