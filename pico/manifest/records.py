"""A document as a record of the model: pydantic checks it, and what it finds is said in PICO's own words."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from pico.diagnostics import Diagnostic, did_you_mean, error
from pico.manifest.text.kinds import METADATA
from pico.manifest.text.scalars import resolve
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, plain, scalars
from pico.manifest.wording import describe, expected_quantity, fields_of, inside, options, quantity, shown, unit_of

if TYPE_CHECKING:
    from pydantic import TypeAdapter

T = TypeVar("T")
_ABOUT_A_KEY = ("missing", "unexpected_keyword_argument")
_HEADER = ("apiVersion", "kind", "metadata")


@cache
def _adapter(record: Any) -> TypeAdapter[Any]:
    from pydantic import TypeAdapter

    return TypeAdapter(record)


def read_record(document: Document, kind: str, record: type[T]) -> tuple[T | None, list[Diagnostic]]:
    """Return the record that a document of `kind` holds, or every diagnostic of why it holds none."""
    from pydantic import ValidationError

    assert isinstance(document.root, Map)
    unbounded = _unbounded(document)
    if unbounded:
        return None, unbounded
    data = plain(document.root)
    metadata = data.get("metadata")
    misplaced = _misplaced(document, kind)
    merged = {k: v for k, v in data.items() if k not in _HEADER and k not in METADATA[kind]}
    merged |= {k: v for k, v in metadata.items() if k in METADATA[kind]} if isinstance(metadata, dict) else {}
    try:
        adapter: Any = record  # mypy does not take type[T] for hashable
        value: T = _adapter(adapter).validate_json(json.dumps(merged), strict=True)
    except ValidationError as exc:
        return None, misplaced + _Translation(document, kind, record).all(exc.errors(include_url=False))
    return (None if misplaced else value), misplaced


def _unbounded(document: Document) -> list[Diagnostic]:
    return [
        error(
            "type",
            f"{shown(node.text)} is no finite number",
            hint="give a number that can be measured",
            source=document.source.range(node.start, node.end),
        )
        for node in scalars(document.root)
        if isinstance(node.value, float) and not math.isfinite(node.value)
    ]


def _misplaced(document: Document, kind: str) -> list[Diagnostic]:
    assert isinstance(document.root, Map)
    return [
        error(
            "unknown-key",
            f"`{key}` stands outside of metadata",
            hint=f"write `metadata: {{{key}: ...}}`",
            source=document.source.range(at.start, at.end),
        )
        for key, (at, _) in document.root.entries.items()
        if key in METADATA[kind]
    ]


@dataclass(frozen=True, slots=True)
class _Place:
    """Where an error's path leads: the words of the path, the node there and its key, and its type in the model."""

    words: str
    node: Node
    key: Node
    kind: Any


class _Translation:
    """Turns pydantic's errors about one document into diagnostics."""

    def __init__(self, document: Document, kind: str, record: type) -> None:
        self.document, self.kind, self.record = document, kind, record

    def all(self, errors: Sequence[Any]) -> list[Diagnostic]:
        """Return one diagnostic a place, in the words of the deepest error where alternatives failed."""
        by_place: dict[tuple[int, bool, tuple[Any, ...]], Diagnostic] = {}
        for found in errors:
            place = self._place(found["loc"], found["type"])
            # Of `fingers: {...}`, meant as a mapping, only what is wrong inside matters, not that it isn't `none`.
            if isinstance(place.node, Map) and found["type"] == "literal_error" and len(options(place.kind)) > 1:
                continue
            inside_key = found["loc"][-1:] if found["type"] in _ABOUT_A_KEY else ()
            by_place.setdefault((id(place.key), found["type"] == "missing", inside_key), self._say(place, found))
        return list(by_place.values())

    def _place(self, loc: tuple[str | int, ...], problem: str) -> _Place:
        node: Node = self.document.root
        key: Node = node
        kind: Any = self.record
        words = ""
        for step in loc[:-1] if problem in _ABOUT_A_KEY else loc:
            entry = self._step(node, step)
            if entry is None:
                continue  # the name of an alternative, not a step in the document
            key, node = entry
            kind = inside(kind, step)
            words += f"[{step}]" if isinstance(step, int) else f".{step}" if words else str(step)
        return _Place(words, node, key, kind)

    def _step(self, node: Node, step: str | int) -> tuple[Node, Node] | None:
        if isinstance(node, List) and isinstance(step, int) and step < len(node.items):
            return node.items[step], node.items[step]
        if not isinstance(node, Map) or not isinstance(step, str):
            return None
        if node is self.document.root and step in METADATA[self.kind]:
            metadata = node.get("metadata")
            return metadata.entries.get(step) if isinstance(metadata, Map) else None
        return node.entries.get(step)

    def _say(self, place: _Place, found: Any) -> Diagnostic:
        name = place.words or f"the {self.kind}"
        if found["type"] == "missing" and isinstance(place.node, List):
            found = {"type": "too_short"}  # pydantic calls each item that a list lacks a missing one
        if found["type"] == "missing":
            return self._missing(name, place, str(found["loc"][-1]))
        if found["type"] == "unexpected_keyword_argument":
            return self._unknown(name, place, str(found["loc"][-1]))
        unit = unit_of(place.kind)
        if unit is not None:
            value = plain(place.node)
            _, code, summary = quantity(name, value, unit)
            return self._at(place.node, code or "type", summary or f"{name} is wrong", label=expected_quantity(unit))
        reason = found.get("ctx", {}).get("error")
        if isinstance(reason, ValueError) and found["type"] == "value_error":
            node, kind = _named(place, str(reason))
            hint = getattr(reason, "hint", "") or f"expected {describe(kind)}"
            return self._at(node, "value", f"{name}: {reason}", hint=hint)
        summary = f"{name} is {shown(plain(place.node))}"
        if isinstance(place.node, Scalar) and place.node.value is None:
            return self._at(place.key, "type", summary, hint=f"expected {describe(place.kind)}")
        hint = f"expected {describe(place.kind)}" + _quotes(place)
        if found["type"] == "literal_error" and isinstance(place.node, Scalar):
            near = did_you_mean(place.node.text[:40], _literals(place.kind))
            hint = near if near.startswith("did") else hint
        return self._at(place.node, "type", summary, hint=hint)

    def _missing(self, name: str, place: _Place, field: str) -> Diagnostic:
        hint = f"expected `{field}:` {describe(fields_of(place.kind).get(field, Any))}"
        metadata = self.document.root.entries.get("metadata") if isinstance(self.document.root, Map) else None
        if place.node is self.document.root and field in METADATA[self.kind] and metadata:
            return self._at(metadata[0], "missing-key", f"metadata has no `{field}`", hint=hint)
        return self._at(place.key, "missing-key", f"{name} has no `{field}`", hint=hint)

    def _unknown(self, name: str, place: _Place, key: str) -> Diagnostic:
        at = place.node.entries[key][0] if isinstance(place.node, Map) and key in place.node.entries else place.key
        known = [
            f for f in fields_of(place.kind) if place.node is not self.document.root or f not in METADATA[self.kind]
        ]
        hint = did_you_mean(key[:40], known) or "known: " + ", ".join(f"`{k}`" for k in sorted(known))
        return self._at(at, "unknown-key", f"unknown key `{key[:40]}` in {name}", hint=hint)

    def _at(self, node: Node, code: str, summary: str, *, hint: str = "", label: str = "") -> Diagnostic:
        if node is self.document.root and isinstance(node, Map) and node.entries:
            node = next(iter(node.entries.values()))[0]
        where = self.document.source.range(node.start, node.end)
        return error(code, summary, hint=hint, label=label, source=where)


def _named(place: _Place, reason: str) -> tuple[Node, Any]:
    """Return the value of the key that a reason names in backticks, at a place or one level below it, and its type in
    the model; the key of the place if it names none that is there."""
    levels = [(place.node, place.kind)]
    if isinstance(place.node, Map):
        levels += [(value, inside(place.kind, key)) for key, (_, value) in place.node.entries.items()]
    for word in reason.split("`")[1::2]:
        for node, kind in levels:
            if isinstance(node, Map) and word in node.entries:
                return node.entries[word][1], inside(kind, word)
    return place.key, place.kind


def _quotes(place: _Place) -> str:
    """What to say of a value whose quotes are wrong: numbers have none, text that looks like a number needs them."""
    node, wanted = place.node, options(place.kind)
    if not isinstance(node, Scalar):
        return ""
    if str in wanted and not isinstance(node.value, str) and node.value is not None:
        least = ">=" if isinstance(place.key, Scalar) and place.key.text == "requires_pico" else ""
        return f': put it in quotes, "{least}{node.text[:40]}"'
    if node.style and not isinstance(resolve(node.text), str) and str not in wanted:
        return ", without quotes"
    return ""


def _literals(kind: Any) -> list[str]:
    from typing import get_args

    return [str(a) for option in options(kind) for a in get_args(option) if isinstance(a, str)]
