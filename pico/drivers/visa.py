"""A link to what speaks SCPI, by PyVISA with its own backend in Python: USB, serial lines and sockets alike."""

from __future__ import annotations

from typing import Any

from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Identity
from pico.model.wiring import DeviceEntry

REPLY = 1.0
"""How long a reply may take [s]."""
ADDRESS = {"visa": "the VISA address (`USB0::0x1313::0x8078::P0001::INSTR`, `TCPIP0::10.0.0.7::5025::SOCKET`)"}


class Visa:
    """An open VISA resource: one line out, one line back. What came before a question is no answer to it."""

    def __init__(self, entry: DeviceEntry) -> None:
        import pyvisa

        self._manager = pyvisa.ResourceManager("@py")
        self.resource: Any = self._manager.open_resource(
            str(entry.address["visa"]), open_timeout=round(REPLY * 1000), timeout=round(REPLY * 1000),
            read_termination="\n", write_termination="\n",
        )  # fmt: skip

    def ask(self, question: str) -> str:
        """Return the reply to a question; raises what PyVISA raises."""
        from pyvisa.constants import BufferOperation

        self.resource.flush(BufferOperation.discard_read_buffer)
        return str(self.resource.query(question)).strip()

    def tell(self, command: str) -> None:
        """Send a command that has no reply."""
        self.resource.write(command)

    def told(self, command: str) -> None:
        """Send a command that has no reply, and ask whether it was taken; raises ValueError where it was not."""
        self.tell(command)
        if not (said := self.ask("SYST:ERR?")).startswith(("0", "+0")):
            raise ValueError(f"it answers `{command}` by {said[:60]}")

    def number(self, question: str) -> float:
        """Return the reply as a number; raises ValueError where it is none."""
        return float(self.ask(question))

    def identity(self) -> Identity:
        """Return who answers to `*IDN?`."""
        return identity_of(self.ask("*IDN?"))

    def close(self) -> None:
        """Close it; also while a question hangs in it."""
        self.resource.close()
        self._manager.close()


def identity_of(said: str) -> Identity:
    """Return who says this of itself: vendor, model, serial, firmware; raises ValueError where it is no identity."""
    words = [word.strip() for word in said.split(",")]
    if len(words) != 4 or not all(word.isprintable() for word in words):
        raise ValueError(f"{said[:60]!r} is no identity")
    vendor, model, serial, firmware = words
    return Identity(vendor=vendor, model=model, serial=serial, firmware=firmware)


def require_read_back(name: str, what: str, wanted: object, found: object) -> None:
    """Raise PicoError where a device reads back something else than it was set to."""
    if wanted != found:
        text = f"{name} was to have {what} {wanted}, and reads back {found}"
        hint = "it may be out of its range, or held back by an interlock of its own"
        raise PicoError(error("device-read-back", text, hint=hint, address=name))
