"""What a driver declares of itself: the object that an entry point of the group `pico.drivers` names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pico.drivers.bus import Bus
from pico.drivers.protocols import Instrument, Maturity
from pico.model.instruments.declaration import Declaration
from pico.model.wiring import DeviceEntry


@dataclass(frozen=True, kw_only=True)
class Driver(Declaration):
    """A driver: what it declares, and how its link is opened. `made(name, entry, bus)` makes an instrument, which opens
    nothing yet. `opened(entry)` opens the link of a bus and `closed(link)` closes it, both blocking, in the bus's
    thread; `alive(link)` raises where it is lost, for links that tell by themselves.

    `needs`: the vendor's module, and the extra that installs it, or neither. `emulator`: what stands in for it.
    Importing a driver's file imports no vendor's library.
    """

    made: Callable[[str, DeviceEntry, Bus[Any]], Instrument]
    opened: Callable[[DeviceEntry], Any]
    closed: Callable[[Any], object]
    needs: tuple[str, str] | None = None
    load: Callable[[], object] | None = None
    """Imports that module, where it must be kept from something; else it is imported as it is."""
    maturity: Maturity = "documented"
    tried: str = ""
    """With `on device`: the date and the firmware."""
    emulator: str = ""
    alive: Callable[[Any], object] | None = None
