"""What goes wrong between a control box and who talks to it."""

from __future__ import annotations

from dataclasses import dataclass, field

_GARBAGE = b"\x13\x37" * 11


@dataclass
class WireFault:
    """What happens to the next `times` answers, of one register or of any.

    `kind`: `drop`, `delay` (by `seconds`), `duplicate`, `truncate` (half of it is sent) or `garbage` (sent instead).
    """

    kind: str
    register: int | None = None
    times: int = 1
    seconds: float = 0.0


@dataclass
class Wire:
    """One connection: what was received and is no whole request yet, and what is to be sent, with when [s]."""

    buffer: bytes = b""
    due: list[tuple[float, bytes]] = field(default_factory=list)
    protocol: int = 2

    def say(self, data: bytes, register: int, faults: list[WireFault], now: float) -> None:
        """Have an answer sent, or what a fault makes of it; a fault that is used up is taken off the list."""
        found = next((fault for fault in faults if fault.register in (None, register)), None)
        if found is None:
            self.due.append((now, data))
            return
        found.times -= 1
        if found.times <= 0:
            faults.remove(found)
        if found.kind == "delay":
            self.due.append((now + found.seconds, data))
        else:
            said = {"drop": b"", "duplicate": data * 2, "truncate": data[: len(data) // 2], "garbage": _GARBAGE}
            self.due.append((now, said[found.kind]))

    def ready(self, now: float) -> bytes:
        """Return what is to be sent by now, and forget it."""
        sent = b"".join(data for when, data in self.due if when <= now)
        self.due = [(when, data) for when, data in self.due if when > now]
        return sent
