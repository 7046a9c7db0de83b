"""Which plug-ins there are, by the entry points of PICO's groups; imports none of them."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

KINDS: Mapping[str, str] = {
    "pico.algorithms": "algorithm", "pico.commands": "command", "pico.devices": "backend", "pico.drivers": "driver",
    "pico.elements": "optical element", "pico.emulators": "emulator", "pico.goals": "goal", "pico.kernels": "kernel",
    "pico.kinds": "kind of instrument", "pico.primitives": "primitive", "pico.recipe_steps": "recipe step",
    "pico.routines": "routine", "pico.server_routes": "server route", "pico.sim.primitives": "simulated primitive",
}  # fmt: skip
"""What a plug-in of each group of entry points is called."""
FOLDERS: Mapping[str, str] = {
    "pico.algorithms": "pico.optimize.algorithms", "pico.elements": "pico.optics.elements",
    "pico.goals": "pico.bench.ready.goals",
    "pico.kernels": "pico.kernels.standard", "pico.kinds": "pico.drivers.kinds",
    "pico.recipe_steps": "pico.recipes.steps",
    "pico.server_routes": "pico.server.routes",
}  # fmt: skip
"""The folders of PICO beside whose files one more can be put."""


@dataclass(frozen=True)
class PlugIn:
    """One plug-in."""

    group: str
    """The group of its entry point, one of KINDS."""
    name: str
    module: str
    """The module that it is in."""
    attribute: str = ""
    """What of the module it is; empty for the module itself."""
    package: str = ""
    """The distribution that brings it; empty for a file put beside those of PICO."""

    @property
    def title(self) -> str:
        """What it is called in messages: kind, name, package."""
        package = f" of package {self.package}" if self.package else ""
        return f"the {KINDS[self.group]} plug-in `{self.name}`{package}"


def entries(group: str) -> dict[str, EntryPoint]:
    """Return the entry points of a group by name; imports none of them."""
    from importlib.metadata import entry_points

    return {entry.name: entry for entry in entry_points(group=group)}


def plug_in(group: str, entry: EntryPoint) -> PlugIn:
    """Return the plug-in of an entry point."""
    module, _, attribute = entry.value.partition(":")
    dist = getattr(entry, "dist", None)
    return PlugIn(group, entry.name, module.strip(), attribute.partition("[")[0].strip(), dist.name if dist else "")


def named(group: str, name: str, module: str) -> PlugIn:
    """Return the plug-in of this name that is in a module."""
    found = entries(group).get(name)
    return plug_in(group, found) if found is not None and found.value == module else PlugIn(group, name, module)


def plug_in_of(module: str, path: str, more: Mapping[str, str] = {}) -> PlugIn | None:
    """Return the plug-in that a module at `path` belongs to; None if it belongs to none. `more`: as FOLDERS."""
    if own_file(path):
        return None
    folder, _, name = module.rpartition(".")
    beside = {**FOLDERS, **more}
    group = next((g for g, f in beside.items() if f == folder), None)
    if group is not None:
        own = getattr(sys.modules.get(folder), "__file__", None) or ""
        return PlugIn(group, name.rstrip("_"), module) if Path(own).parent != Path(path).parent else None
    top = module.partition(".")[0]
    return None if top in sys.stdlib_module_names or top == "pico" else _by_top(tuple(sys.path)).get(top)


@lru_cache(maxsize=4)
def _by_top(_: tuple[str, ...]) -> Mapping[str, PlugIn]:
    """Return the first plug-in of each package at the top. Finding all entry points reads the files of every
    distribution on the path: much too long for a device that fails ten times a second while others are asked."""
    found: dict[str, PlugIn] = {}
    for group in KINDS:
        for entry in entries(group).values():
            one = plug_in(group, entry)
            found.setdefault(one.module.partition(".")[0], one)
    return found


def own_module(module: str) -> bool:
    """Whether a module is PICO's own: of its name, and in its folder."""
    from importlib.util import find_spec

    if module.partition(".")[0] != "pico":
        return False
    try:
        found = sys.modules[module].__spec__ if module in sys.modules else find_spec(module)
    except (ImportError, ValueError):
        return True
    return found is None or found.origin is None or own_file(found.origin)


_ROOT = f"{Path(__file__).resolve().parent.parent}{os.sep}"


def own_file(path: str) -> bool:
    """Whether a file lies in PICO's own folders."""
    return path.startswith(_ROOT)
