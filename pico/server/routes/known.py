"""The routers of a coordinator: the `router` of each file of FOLDER that has one; a plug-in brings more by the entry
point `pico.server_routes`, a module of the same kind."""

from __future__ import annotations

from dataclasses import replace

from fastapi import APIRouter

from pico import registered
from pico.diagnostics import Diagnostic, PicoError
from pico.plug_ins.calling import Interface, instance, module_of

FOLDER = "pico.server.routes"
GROUP = "pico.server_routes"
SHARED = Interface(GROUP)
"""Files without a `router` hold what the others share."""
INTERFACE = Interface(GROUP, {"router": instance(APIRouter)})


def routers() -> tuple[tuple[APIRouter, ...], tuple[Diagnostic, ...]]:
    """Return the routers of all files, PICO's own first, by name, and a warning for each plug-in that is broken;
    imports them."""
    found: list[APIRouter] = []
    wrong: list[Diagnostic] = []
    for name, path in registered.modules(FOLDER, GROUP).items():
        try:
            module = module_of(SHARED if path.startswith(f"{FOLDER}.") else INTERFACE, name, path)
        except PicoError as exc:
            wrong += [replace(one, severity="warning") for one in exc.diagnostics]
        else:
            if isinstance(router := getattr(module, "router", None), APIRouter):
                found.append(router)
    return tuple(found), tuple(wrong)
