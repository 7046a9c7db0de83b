"""The routers of a coordinator: the `router` of each file of FOLDER that has one; a plug-in brings more by the entry
point `pico.server_routes`, a module of the same kind."""

from __future__ import annotations

from importlib import import_module

from fastapi import APIRouter

from pico import registered

FOLDER = "pico.server.routes"
GROUP = "pico.server_routes"


def routers() -> tuple[APIRouter, ...]:
    """Return the routers of all files, PICO's own first, by name; imports them.

    Files without a `router` hold what the others share.
    """
    found = (import_module(module) for module in registered.modules(FOLDER, GROUP).values())
    return tuple(router for module in found if isinstance(router := getattr(module, "router", None), APIRouter))
