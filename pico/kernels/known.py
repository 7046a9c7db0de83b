"""Kernels by name: the files of FOLDER; a plug-in brings more by the entry point `pico.kernels`, a module of the same
kind."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import Any, cast

from pico import registered
from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Kernel, Result
from pico.plug_ins.calling import Interface, function, instance

FOLDER = "pico.kernels.standard"
GROUP = "pico.kernels"


def _wrong(made: Any) -> str:
    """Return what is wrong with what a kernel made: no image, and no numbers with their errors."""
    if not isinstance(made, Result):
        return instance(Result, Frame)(made)
    for name, value in (*made.value.items(), *made.sigma.items()):
        if isinstance(value, bool) or not isinstance(value, Real):
            return f"has no number as its `{name}`: {value!r}"
    if made.value.keys() != made.sigma.keys():
        return f"has values of {', '.join(made.value) or 'nothing'}, and sigmas of {', '.join(made.sigma) or 'nothing'}"
    return ""


INTERFACE = Interface(GROUP, {"KERNEL": instance(Declaration), "apply": function}, {"apply": _wrong})


def modules() -> Mapping[str, str]:
    """Return the modules of all kernels by name; imports none."""
    return registered.modules(FOLDER, GROUP)


def kernel(name: str) -> Kernel:
    """Return a kernel that there is; raises PicoError for a plug-in that is broken."""
    return cast(Kernel, registered.module(INTERFACE, name))
