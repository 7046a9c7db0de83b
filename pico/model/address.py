"""Parts of a state as a person names them: `p2`, or one tunable of it, `p2.pose`, `p1.angle`; and by which names
documents know parts that had other ones before."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TypeVar

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.model.lab import Lab
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, LightReference

_Each = TypeVar("_Each")
Renaming = Mapping[str, str]
"""The present name of each part by a former one."""
Named = Mapping[str, frozenset[str] | None]
"""For each component that was named, the tunables of it; None for all of them."""


def read_addresses(setup: Setup, words: Iterable[str]) -> Named:
    """Return what `words` name, by component, which may be named as it was before; raises PicoError for each that the
    lab does not have."""
    names = renaming_of(setup.lab)
    found: dict[str, frozenset[str] | None] = {}
    wrong: list[Diagnostic] = []
    for word in sorted({called_now(names, word) for word in words}):
        component, _, tunable = word.partition(".")
        problem = _problem(setup, word, component, tunable)
        if problem:
            wrong.append(problem)
        elif not tunable:
            found[component] = None
        else:
            before = found.get(component, frozenset())
            found[component] = None if before is None else before | {tunable}
    if wrong:
        raise PicoError(wrong)
    return found


def holds(named: Named, component: str, tunable: str) -> bool:
    """Return whether a tunable of a component is among what was named."""
    some = named.get(component, frozenset())
    return some is None or tunable in some


def addresses(named: Named) -> Iterator[str]:
    """Yield what was named as it would be written: `p1.angle`, `p2`."""
    for component, tunables in sorted(named.items()):
        if tunables is None:
            yield component
        else:
            yield from (f"{component}.{tunable}" for tunable in sorted(tunables))


def _problem(setup: Setup, word: str, component: str, tunable: str) -> Diagnostic | None:
    known = setup.lab.inventory
    if component not in known:
        return error("unknown-component", f"the lab has no component `{component}`", hint=_near(component, known))
    kinds = ["pose", *setup.type_of(component).tunables]
    if "." not in word or tunable in kinds:
        return None
    whole = "a pose is one thing: name it as `pose`" if tunable == "slot" or tunable.startswith("pose.") else ""
    return error(
        "unknown-tunable", f"{component} has no tunable `{tunable}`", hint=whole or _near(tunable, kinds),
        address=component,
    )  # fmt: skip


def _near(word: str, known: Iterable[str]) -> str:
    if word.startswith("-"):
        return "options go before `--`, components after it"
    return did_you_mean(word, known)


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
