"""Modules by name: a file each of a folder of PICO's, and those of the same kind that plug-ins bring by an entry point;
PICO's own can't be replaced."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import Any

from pico.diagnostics import Diagnostic, PicoError
from pico.plug_ins.calling import Interface, module_of
from pico.plug_ins.faults import CODE
from pico.plug_ins.known import FOLDERS, entries


@cache
def modules(folder: str, group: str) -> Mapping[str, str]:
    """Return the modules by name, PICO's own first; imports none of them. A file `if_` of the folder is named `if`."""
    from pkgutil import iter_modules

    names = sorted(found.name for found in iter_modules(import_module(folder).__path__))
    own = {name.rstrip("_"): f"{folder}.{name}" for name in names}
    more = {name: entry.value for name, entry in entries(group).items() if name not in own}
    return {**own, **dict(sorted(more.items()))}


def own(folder: str, group: str) -> tuple[str, ...]:
    """Return the names of those that PICO brings."""
    return tuple(name for name, module in modules(folder, group).items() if module.startswith(f"{folder}."))


_LOADED: dict[tuple[str, str], Any] = {}
"""What was loaded, by group and module: a plug-in's functions are guarded once."""


def module(interface: Interface, name: str) -> Any:
    """Return the module of this name as `interface` says; raises KeyError for a name that there is not, and PicoError
    (code `plugin`) for a plug-in that is broken."""
    path = modules(FOLDERS[interface.group], interface.group)[name]
    key = (interface.group, path)
    if key not in _LOADED or sys.modules.get(path) is None:
        _LOADED[key] = module_of(interface, name, path)
    return _LOADED[key]


def intact(interface: Interface) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return all modules by name but those of plug-ins that are broken, and a warning for each of these."""
    found: dict[str, Any] = {}
    wrong: list[Diagnostic] = []
    for name in modules(FOLDERS[interface.group], interface.group):
        try:
            found[name] = module(interface, name)
        except PicoError as exc:
            if any(one.code != CODE for one in exc.diagnostics):
                raise
            wrong += [replace(one, severity="warning") for one in exc.diagnostics]
    return found, tuple(wrong)
