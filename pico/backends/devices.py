"""Which devices there are: the rooms beside this file, and what plug-ins add by an entry point of the group
`pico.devices`. Each gives `opened(setup, place, fidelity, clock)`, which returns a `Device` or raises PicoError."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, did_you_mean, error
from pico.plug_ins.calling import Interface, function, having, loaded
from pico.plug_ins.known import entries

if TYPE_CHECKING:
    from pico.backends.device import Device
    from pico.model.setup import Setup
    from pico.places.bench import BenchPlace

Opener = Callable[["Setup", "BenchPlace", str, Callable[[], str]], "Device"]
GROUP = "pico.devices"
SIMULATOR = "sim"
"""The device of who asks for none, and of trials."""
HARDWARE, EMULATED = "hardware", "emulated"
"""The real bench, and its drivers with emulators at the other end."""


INTERFACE = Interface(GROUP, {"": function}, {"": having("describe", "observe", "execute", "stop", "close")})


def shipped() -> list[str]:
    """Return the names of the devices that come with PICO."""
    return sorted(path.parent.name for path in Path(__file__).parent.glob("*/__init__.py"))


def known_devices() -> list[str]:
    """Return the names of all devices: those that come with PICO, and those of plug-ins."""
    return [*shipped(), *sorted(entries(GROUP))]


def opener(name: str) -> Opener:
    """Return what opens the device of this name; raises PicoError for one that there is not, and for a plug-in
    that is broken."""
    if name in shipped():
        found: Opener = import_module(f"{__package__}.{name}").opened
        return found
    added = entries(GROUP)
    if name not in added:
        known = [*shipped(), *sorted(added)]
        raise PicoError(error("backend", f"there is no backend `{name}`", hint=did_you_mean(name, known)))
    plugin: Opener = loaded(INTERFACE, added[name])
    return plugin
