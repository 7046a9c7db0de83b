"""Optical elements by name: a file each of `pico.optics.elements`; a plug-in brings more by the entry point
`pico.elements`, a module of the same kind."""

from __future__ import annotations

from pico import registered

FOLDER = "pico.optics.elements"
GROUP = "pico.elements"


def own() -> tuple[str, ...]:
    """Return the names of PICO's own elements, read from the folder; imports none."""
    return registered.own(FOLDER, GROUP)


def known() -> tuple[str, ...]:
    """Return the names of all elements, PICO's own first; imports none."""
    return tuple(registered.modules(FOLDER, GROUP))
