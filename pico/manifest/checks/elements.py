"""Optical elements by name: a file each of `pico.optics.elements`; a plug-in brings more by the entry point
`pico.elements`, a module of the same kind."""

from __future__ import annotations

from functools import cache

FOLDER = "pico.optics.elements"
GROUP = "pico.elements"


@cache
def own() -> tuple[str, ...]:
    """Return the names of PICO's own elements, read from the folder; imports none."""
    from importlib import import_module
    from pkgutil import iter_modules

    return tuple(sorted(found.name for found in iter_modules(import_module(FOLDER).__path__)))


@cache
def plugged_in() -> dict[str, str]:
    """Return the modules of the elements that plug-ins bring, by the element's name; PICO's own can't be replaced."""
    from importlib.metadata import entry_points

    return {entry.name: entry.value for entry in entry_points(group=GROUP) if entry.name not in own()}


def module_of(element: str) -> str:
    """Return the module that says what an element does to light."""
    return f"{FOLDER}.{element}" if element in own() else plugged_in().get(element, f"{FOLDER}.{element}")
