"""What the devices of a guard last said, and since when each is silent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pico.backends.hardware.guard.verdict import InputState, LaserState
from pico.diagnostics import PicoError
from pico.drivers.protocols import SafetyState
from pico.model.wiring import SafetyEntry

HELD = 0.2
"""How much of a pause of its own the guard counts [s]: more than it takes between two looks."""
SILENT = 0.6
"""How long a laser or a shutter may leave the guard without an answer while light may be out [s]."""


def unsafe(entry: SafetyEntry, state: SafetyState) -> str:
    """Return why a safety input does not count as safe, '' if it does. What is unknown, or was heard too long ago, is
    unsafe."""
    if state.safe is None:
        return "is not known to be safe"
    if not state.safe:
        return "is not safe"
    return f"was last heard {state.age:.1f} s ago" if state.age > entry.heartbeat else ""


@dataclass
class Heard:
    """The last answer of one device, when it came, and what went wrong since, '' for nothing."""

    value: Any = None
    at: float | None = None
    wrong: str = ""


@dataclass
class Hearing:
    """The answers of all devices of a guard, by name or address; times by the guard's `Awake` clock [s]. `since`: from
    when on answers are due, because light may be out, or the guard has only begun."""

    since: float
    heard: dict[str, Heard] = field(default_factory=dict)

    def answered(self, name: str, value: Any, now: float) -> None:
        """Take an answer."""
        self.heard[name] = Heard(value, now)

    def failed(self, name: str, exc: Exception) -> None:
        """Take that no answer came: the last one counts until it is too old."""
        known = self.heard.setdefault(name, Heard())
        summary = exc.diagnostics[0].summary if isinstance(exc, PicoError) else str(exc)
        known.wrong = summary or "it does not answer"

    def silence(self, name: str, now: float, limit: float) -> str:
        """Return why a device counts as silent, '' if it answered within `limit` [s]."""
        known = self.heard.get(name) or Heard()
        last = self.since if known.at is None else max(known.at, self.since)
        if now - last <= limit:
            return ""
        age = f"has not answered for {now - last:.1f} s"
        return f"{age}: {known.wrong}" if known.wrong else age

    def input(self, name: str, entry: SafetyEntry, now: float) -> InputState:
        """Return the state of a safety input."""
        known = self.heard.get(name)
        if silent := self.silence(name, now, entry.heartbeat):
            return InputState(kind=entry.kind, why=silent)
        fresh = known is not None and known.at is not None and known.at >= self.since
        return InputState(kind=entry.kind, why=unsafe(entry, known.value) if known is not None and fresh else "")

    def laser(self, emission: str | None, shutters: Mapping[str, Any], of: Any, now: float) -> LaserState:
        """Return the state of a laser whose emission and shutters are read at these addresses."""
        addresses = ([emission] if emission else []) + list(shutters)
        silent = {a: why for a in addresses if (why := self.silence(a, now, SILENT))}
        return LaserState(
            emission=self._known(emission, silent) if emission else None,
            shutters=tuple(self._known(address, silent) for address in shutters), of=of, silent=silent,
        )  # fmt: skip

    def _known(self, address: str, silent: Mapping[str, str]) -> bool | None:
        known = self.heard.get(address)
        return None if address in silent or known is None else known.value
