"""What is behind an emulated device, as far as it is told: the twin, or nothing. And what an emulator declares."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from pico.model.wiring import DeviceEntry


class Behind(Protocol):
    """The world behind one device, by the names of its driver's properties (`angle`, `power`, `frame`, `joints`), in
    the driver's units. It is called from the emulator's threads, several at a time."""

    def read(self, what: str) -> Any:
        """Return what there is now; None where nothing is known of that."""
        ...

    def write(self, what: str, value: Any) -> None:
        """Let the device have done something: where its axis is now, that it emits."""
        ...

    def now(self) -> float:
        """Return the seconds of the world's clock, by which the device moves."""
        ...


class Alone:
    """Nothing is behind the device: it finds what it wrote itself, and what it was given at first."""

    def __init__(self, at_first: Mapping[str, Any] | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        self._values: dict[str, Any] = dict(at_first or {})
        self._clock = clock
        self._lock = threading.Lock()

    def read(self, what: str) -> Any:
        with self._lock:
            return self._values.get(what)

    def write(self, what: str, value: Any) -> None:
        with self._lock:
            self._values[what] = value

    def now(self) -> float:
        return self._clock()


class Running(Protocol):
    """An emulator at work: `address` is what leads to it instead of an entry's own; `close` ends it and its threads.
    One that can't be whom the lab names has an `identity` (a mapping), too: who it is."""

    @property
    def address(self) -> Mapping[str, str | int]: ...

    def close(self) -> None: ...


@dataclass(frozen=True)
class Emulator:
    """What an entry point of the group `pico.emulators` names. `started(devices)` starts one that is all of these
    devices (entries that share a link are one emulator), each with what is behind it. `bus`: which of an address tells
    one link from another."""

    started: Callable[[Mapping[str, tuple[DeviceEntry, Behind]]], Running]
    bus: tuple[str, ...]
