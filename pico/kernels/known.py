"""Kernels by name: the files of FOLDER; a plug-in brings more by the entry point `pico.kernels`, a module of the same
kind."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import cast

from pico.kernels.kernel import Kernel

FOLDER = "pico.kernels.standard"
GROUP = "pico.kernels"


@cache
def modules() -> dict[str, str]:
    """Return the modules of all kernels by name; those of plug-ins can't replace PICO's own."""
    from importlib.metadata import entry_points
    from pkgutil import iter_modules

    own = {found.name: f"{FOLDER}.{found.name}" for found in iter_modules(import_module(FOLDER).__path__)}
    more = {entry.name: entry.value for entry in entry_points(group=GROUP)}
    return {**more, **own}


def kernel(name: str) -> Kernel:
    """Return a kernel that there is."""
    return cast(Kernel, import_module(modules()[name]))
