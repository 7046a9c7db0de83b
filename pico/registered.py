"""Modules by name: a file each of a folder of PICO's, and those of the same kind that plug-ins bring by an entry point;
PICO's own can't be replaced."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module


@cache
def modules(folder: str, group: str) -> Mapping[str, str]:
    """Return the modules by name, PICO's own first; imports none of them. A file `if_` of the folder is named `if`."""
    from importlib.metadata import entry_points
    from pkgutil import iter_modules

    names = sorted(found.name for found in iter_modules(import_module(folder).__path__))
    own = {name.rstrip("_"): f"{folder}.{name}" for name in names}
    more = {entry.name: entry.value for entry in entry_points(group=group) if entry.name not in own}
    return {**own, **dict(sorted(more.items()))}


def own(folder: str, group: str) -> tuple[str, ...]:
    """Return the names of those that PICO brings."""
    return tuple(name for name, module in modules(folder, group).items() if module.startswith(f"{folder}."))
