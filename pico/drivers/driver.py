"""What a driver declares of itself: the object that an entry point of the group `pico.drivers` names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from pico.drivers.bus import Bus
from pico.drivers.protocols import Instrument, Maturity
from pico.model.wiring import DeviceEntry

Kind = Literal[
    "arm", "gripper", "axis", "camera", "depth camera", "power meter", "laser", "shutter", "lamp", "safety input"
]


@dataclass(frozen=True)
class Driver:
    """A driver. `kind`: which protocol its instruments have; `made(name, entry, bus)` makes one, which opens nothing
    yet. `opened(entry)` opens the link of a bus and `closed(link)` closes it, both blocking, in the bus's thread;
    `alive(link)` raises where it is lost, for links that tell by themselves.

    `address`: what an address says, with what that is; `bus`: which of it tells one link from another. `properties`:
    what a lab may map and limit, with units. `needs`: the vendor's module, and the extra that installs it, or neither.
    `emulator`: what stands in for it. Importing a driver's file imports no vendor's library.
    """

    kind: Kind
    made: Callable[[str, DeviceEntry, Bus[Any]], Instrument]
    opened: Callable[[DeviceEntry], Any]
    closed: Callable[[Any], object]
    address: Mapping[str, str]
    bus: tuple[str, ...]
    properties: Mapping[str, str] = field(default_factory=dict)
    needs: tuple[str, str] | None = None
    load: Callable[[], object] | None = None
    """Imports that module, where it must be kept from something; else it is imported as it is."""
    maturity: Maturity = "documented"
    tried: str = ""
    """With `on device`: the date and the firmware."""
    emulator: str = ""
    alive: Callable[[Any], object] | None = None
    link: str = ""
    """Drivers that can share a link say the same here; else none do."""
