"""What goes wrong with an emulated device by itself, as a scenario says: behind it, and on its wire."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from typing import Any, Protocol, runtime_checkable

from pico.emulators.behind import Behind
from pico.model.instruments.emulation import Disturbance

SILENT = 1.0
"""How long a device that restarts answers nothing [s]."""


class Disturbed:
    """What is behind a device, with what goes wrong there: `travel` that it has, `lost_steps`, and draws of its
    `settle_error` and `noise`, each None where the scenario does not name it."""

    def __init__(self, behind: Behind, about: Disturbance, drawn: random.Random) -> None:
        self._behind, self._about, self._drawn = behind, about, drawn

    def now(self) -> float:
        return self._behind.now()

    def read(self, what: str) -> Any:
        if what in ("travel", "lost_steps"):
            return getattr(self._about, what) or None
        if what in ("settle_error", "noise"):
            sigma = getattr(self._about, what)
            return self._drawn.gauss(0.0, sigma) if sigma else None
        return self._behind.read(what)

    def write(self, what: str, value: Any) -> None:
        self._behind.write(what, value)


class Line:
    """The wire of a device: replies are late or lost, and the device restarts, once."""

    def __init__(
        self, about: Disturbance, drawn: random.Random, reboot: Callable[[], None] = lambda: None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        """`reboot`: what the device forgets when it restarts."""
        self._about, self._drawn, self._reboot, self._clock = about, drawn, reboot, clock
        self._began, self._commands, self._silent_until = clock(), 0, 0.0
        self._rebooted = about.reboot_after is None and about.reboot_after_commands is None
        self._due: list[tuple[float, bytes]] = []

    def hears(self) -> bool:
        """Return whether the device hears a command that comes now: not while it restarts."""
        self._commands += 1
        self._restart_when_due()
        return self._clock() >= self._silent_until

    def sent(self, reply: bytes) -> bytes:
        """Return what of a reply, and of those before it, is on the wire now."""
        now = self._clock()
        self._restart_when_due()
        if reply and now >= self._silent_until and self._drawn.random() >= self._about.dropped_replies:
            self._due.append((now + self._about.latency, reply))
        out = b"".join(said for when, said in self._due if when <= now)
        self._due = [(when, said) for when, said in self._due if when > now]
        return out

    def _restart_when_due(self) -> None:
        after, commands = self._about.reboot_after, self._about.reboot_after_commands
        late = after is not None and self._clock() - self._began >= after
        if not self._rebooted and (late or (commands is not None and self._commands > commands)):
            self._rebooted, self._silent_until, self._due = True, self._clock() + SILENT, []
            self._reboot()


@runtime_checkable
class OnWire(Protocol):
    """An emulator whose wire can be disturbed: its `line`, and `reboot`, what it forgets when it restarts."""

    line: Line | None
    reboot: Callable[[], None]
