"""Parts that had other names before: what documents of then say of them, by the names of now."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TypeVar

from pico.model.lab import Lab
from pico.model.state import ComponentState, LabState, LightReference

_Each = TypeVar("_Each")
Renaming = Mapping[str, str]
"""The present name of each part by a former one."""


def renaming_of(lab: Lab) -> Renaming:
    """Return the present names of the parts of a lab by their former ones (`formerly:`); no name that a part has."""
    found = {old: name for name, part in lab.inventory.items() for old in part.formerly or ()}
    return {old: name for old, name in found.items() if old not in lab.inventory}


def renaming_between(a: Lab, b: Lab) -> Renaming:
    """Return the renaming that two labs declare together, without names that one of them has for two parts."""
    both = {**renaming_of(a), **renaming_of(b)}
    return {old: new for old, new in both.items() if not any({old, new} <= lab.inventory.keys() for lab in (a, b))}


def former_names(lab: Lab, part: str) -> tuple[str, ...]:
    """Return the names that a part had before, as the inventory lists them."""
    found = lab.inventory.get(part)
    return (found.formerly or ()) if found else ()


def called_now(names: Renaming, address: str) -> str:
    """Return an address (`p2`, `p2.angle`) by the present name of its part."""
    component, dot, rest = address.partition(".")
    return f"{names.get(component, component)}{dot}{rest}"


def renamed_keys(names: Renaming, entries: Mapping[str, _Each]) -> dict[str, _Each]:
    """Return entries by component under the present names; an entry that is there under both keeps the present one."""
    kept = {name: each for name, each in entries.items() if name not in names}
    moved = {names[name]: each for name, each in entries.items() if name in names}
    return {**moved, **kept} if moved else dict(entries)


def renamed_state(names: Renaming, state: LabState) -> LabState:
    """Return a state by the present names: its components, what they refer to, and what is expected."""
    if not names:
        return state
    parts = {name: _references(names, part) for name, part in renamed_keys(names, state.components).items()}
    expect = tuple(replace(e, that=renamed_expression(names, e.that)) for e in state.expect)
    return replace(state, components=parts, expect=expect)


def renamed_expression(names: Renaming, text: str) -> str:
    """Return an expression in which parts are called by their present names; texts in quotes stay as they are."""
    if not names or not any(old in text for old in names):
        return text
    words = "|".join(re.escape(old) for old in sorted(names, key=len, reverse=True))
    pattern = rf"\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|(?<![\w.])({words})(?=\s*\.)"
    return re.sub(pattern, lambda found: names[found[1]] if found[1] else found[0], text)


def _references(names: Renaming, part: ComponentState) -> ComponentState:
    if not part.by_light:
        return part
    return replace(part, by_light={key: _reference(names, one) for key, one in part.by_light.items()})


def _reference(names: Renaming, one: LightReference) -> LightReference:
    first, second = (names.get(name, name) for name in one.parts)
    return replace(one, **{one.kind: (first, second)})  # type: ignore[arg-type]
