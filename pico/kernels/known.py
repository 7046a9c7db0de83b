"""Kernels by name: the files of FOLDER; a plug-in brings more by the entry point `pico.kernels`, a module of the same
kind."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import cast

from pico import registered
from pico.kernels.kernel import Kernel

FOLDER = "pico.kernels.standard"
GROUP = "pico.kernels"


def modules() -> Mapping[str, str]:
    """Return the modules of all kernels by name; imports none."""
    return registered.modules(FOLDER, GROUP)


def kernel(name: str) -> Kernel:
    """Return a kernel that there is."""
    return cast(Kernel, import_module(modules()[name]))
