"""The one way model data is declared, turned into canonical JSON and digested."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True, kw_only_default=True)
def record(cls: type[T]) -> type[T]:
    """Make `cls` a frozen, slotted, keyword-only dataclass; pydantic, where it reads one, refuses unknown keys."""
    cls.__pydantic_config__ = {"extra": "forbid"}  # type: ignore[attr-defined]
    return dataclasses.dataclass(frozen=True, slots=True, kw_only=True)(cls)


@cache
def _fields(cls: type) -> tuple[tuple[str, str], ...]:
    """Attribute and JSON name of each field: a trailing underscore (`from_`) is dropped."""
    return tuple((f.name, f.name.rstrip("_")) for f in dataclasses.fields(cls))


def as_json(value: Any) -> Any:
    """Return `value` (records, mappings, sequences, scalars) as plain JSON data; fields that are None are left out."""
    if isinstance(value, str | bool | int) or value is None:
        return value
    if isinstance(value, float):
        return value
    if isinstance(value, Mapping):
        return {str(k): as_json(v) for k, v in value.items()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        pairs = ((key, getattr(value, name)) for name, key in _fields(type(value)))
        return {key: as_json(v) for key, v in pairs if v is not None}
    if isinstance(value, Sequence | set | frozenset):
        return [as_json(v) for v in (sorted(value) if isinstance(value, set | frozenset) else value)]
    raise TypeError(f"{type(value).__name__} has no JSON form")


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        rounded = round(value, 6) + 0.0  # -0.0 becomes 0.0
        return int(rounded) if rounded.is_integer() else rounded
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items()}
    if isinstance(value, list):
        return [_rounded(v) for v in value]
    return value


def canonical(value: Any) -> str:
    """Return canonical JSON: keys sorted, no white space, floats rounded to 1e-6, whole numbers without a point."""
    return json.dumps(_rounded(as_json(value)), sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def digest(value: Any) -> str:
    """Return `sha256:...` of the canonical JSON of `value`."""
    return "sha256:" + hashlib.sha256(canonical(value).encode()).hexdigest()
