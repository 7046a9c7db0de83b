"""What may befall a part that no camera over the bench sees, by the names under which people give it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.model.setup import Setup
from pico.optics.unseen import Unseen

FOCAL_LENGTH = "focal_length"
"""How the focal length of a lens is given, in mm; `Unseen` has the factor `focal`."""
_SHARES, _FACTORS = ("loss", "leak"), ("gain", "power")
_OF = {
    "gain": ("detector", "it is no detector"), "dark": ("detector", "it is no detector"),
    "leak": ("polarizer", "it is no polarizer"), "power": ("source", "it is no laser"),
    "retardance": ("waveplate", "it is no wave plate"),
}  # fmt: skip
"""The element that a change belongs to, and what is said of a part that is of another one."""


def parse(words: Sequence[str]) -> dict[str, float | str]:
    """Return changes given as `up=0.1 loss=20% power=-30% optic=plano_convex_150`; raises PicoError for other words.

    A percentage is a share; of a factor, by how much that changes.
    """
    found: dict[str, float | str] = {}
    for word in words:
        key, _, value = word.partition("=")
        try:
            share = float(value.removesuffix("%")) / (100 if value.endswith("%") else 1)
            found[key] = share + 1 if key in _FACTORS and value.endswith("%") else share
        except ValueError:
            if key != "optic" or not value:
                hint = "for example up=0.1, loss=20% or optic=plano_convex_150"
                raise PicoError(error("usage", f"`{word[:40]}` is no number by name", hint=hint)) from None
            found[key] = value
    return found


def upset(setup: Setup, name: str, was: Unseen, by: Mapping[str, float | str]) -> Unseen:
    """Return what is unseen of a part after something befell it: `by` are fields of `Unseen`, or a `focal_length` [mm].
    They add to what was there; losses, gains and powers multiply, a focal length and an optic replace it.

    Raises PicoError for a change that does not exist, and for a value that it cannot have.
    """
    if problems := [found for key, value in by.items() for found in _problems(setup, name, key, value)]:
        raise PicoError(problems)
    for key, value in by.items():
        was = _joined(setup, name, was, key, value)
    return was


def said(setup: Setup, name: str, unseen: Unseen) -> dict[str, float | str]:
    """Return what is unseen of a part, by the names that `upset` takes."""
    found = {f.name: getattr(unseen, f.name) for f in fields(Unseen) if getattr(unseen, f.name) != f.default}
    if "focal" in found and (own := setup.type_of(name).number(FOCAL_LENGTH, "mm")):
        found[FOCAL_LENGTH] = own * found.pop("focal")
    return found


def _problems(setup: Setup, name: str, key: str, value: float | str) -> Iterator[Diagnostic]:
    """Yield what is wrong with one change of a part."""
    known = [*(one.name for one in fields(Unseen) if one.name != "focal"), FOCAL_LENGTH]
    element = setup.type_of(name).optics.element
    if key not in known:
        hint = did_you_mean(key, known) or f"known: {', '.join(known)}"
        yield error("unseen", f"nothing unseen of a part is called `{key}`", hint=hint, address=name)
    elif key == "optic":
        yield from _other_optic(setup, name, str(value))
    elif key == FOCAL_LENGTH and setup.type_of(name).number(FOCAL_LENGTH, "mm") is None:
        yield error("unseen", f"{name} has no `{key}`: its type states none", address=name)
    elif key in _OF and element != _OF[key][0]:
        yield error("unseen", f"{name} has no `{key}`: {_OF[key][1]}", address=name)
    elif wanted := _wanted(key, value):
        yield error("unseen", f"`{key}` of {name} is {value}: it must be {wanted}", address=name)


def _wanted(key: str, value: float | str) -> str:
    """Return what a value must be; empty if it is."""
    if isinstance(value, str) or not math.isfinite(value):
        return "a finite number"
    if key in _SHARES and not 0 <= value < 1:
        return "a share from 0 to below 1"
    if key in _FACTORS and value <= 0:
        return "a factor above 0"
    return "a length other than 0" if key == FOCAL_LENGTH and value == 0 else ""


def _other_optic(setup: Setup, name: str, optic: str) -> Iterator[Diagnostic]:
    """Yield why the optic of another type does not fit in the mount of a part."""
    element = setup.type_of(name).optics.element
    alike = sorted(n for n, kind in setup.catalog.items() if kind.optics.element == element)
    if optic not in setup.catalog:
        hint = did_you_mean(optic, alike) or f"types of the same element: {', '.join(alike[:8])}"
        yield error("unseen", f"this lab has no type `{optic}`", hint=hint, address=name)
    elif optic not in alike or element in ("none", "block", "source", "detector"):
        text = f"{optic} does not fit in the mount of {name}: that holds a {element}"
        yield error("unseen", text, hint=f"types that do: {', '.join(alike[:8])}", address=name)


def _joined(setup: Setup, name: str, was: Unseen, key: str, by: float | str) -> Unseen:
    changed: dict[str, Any]
    if isinstance(by, str):
        changed = {"optic": "" if by == setup.lab.inventory[name].type else by}
    elif key == FOCAL_LENGTH:
        changed = {"focal": by / (setup.type_of(name).number(FOCAL_LENGTH, "mm") or by)}
    elif key in _FACTORS:
        changed = {key: getattr(was, key) * by}
    elif key == "loss":
        changed = {key: 1 - (1 - was.loss) * (1 - by)}
    else:
        changed = {key: getattr(was, key) + by}
    return replace(was, **changed)
