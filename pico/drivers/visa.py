"""A link to what speaks SCPI, by PyVISA: USB, serial lines and sockets, with its backend in Python or another one."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

from pico.diagnostics import PicoError, error
from pico.drivers import judging
from pico.drivers.bus import LONGEST
from pico.drivers.protocols import Identity
from pico.model.instruments.addresses import number_in, wrong_host
from pico.model.instruments.complaint import Complaint
from pico.model.instruments.declaration import Setting
from pico.model.wiring import DeviceEntry

REPLY = 1.0
"""How long a reply may take, if the lab says nothing [s]."""
ADDRESS = {"visa": "the VISA address (`USB0::0x1313::0x8078::P0001::INSTR`, `TCPIP0::10.0.0.7::5025::SOCKET`)"}
_SERIAL: dict[str, Setting] = {
    "baud_rate": Setting(kind=int, default=9600, range=(50, 4_000_000), unit="baud", about="speed of the serial line"),
    "data_bits": Setting(kind=int, default=8, choices=(7, 8), about="bits of a character on the serial line"),
    "parity": Setting(kind=str, default="none", choices=("none", "odd", "even"), about="parity on the serial line"),
    "stop_bits": Setting(kind=int, default=1, choices=(1, 2), about="stop bits on the serial line"),
}
SETTINGS: dict[str, Setting] = {
    "timeout": Setting(default=REPLY, unit="s", range=(0.05, LONGEST - 0.5), about="how long one reply may take"),
    "read_termination": Setting(kind=str, default="\n", about="what ends a reply"),
    "write_termination": Setting(kind=str, default="\n", about="what ends a command"),
    "backend": Setting(
        kind=str, default="@py", about="the VISA library: `@py`, `@ivi` (the vendor's), or `FILE.yaml@sim`"
    ),
    **_SERIAL,
}
"""What `settings` of a device at a VISA address may say."""
_HEX = re.compile(r"0[xX][0-9a-fA-F]+")
_MOST_ERRORS = 30
"""How many entries of an error queue are read at most: queues hold 2 to 30."""


def wire_of(entry: DeviceEntry) -> tuple[str, ...]:
    """Return what tells one physical link from another: host and port of a socket, the port of a serial line, or the
    address, in one way of writing."""
    words = str(entry.address.get("visa", "")).split("::")
    kind = words[0].upper()
    if kind.startswith("TCPIP") and words[-1].upper() == "SOCKET" and len(words) == 4:
        return words[1].lower(), number_in(words[2])
    if kind.startswith("ASRL"):
        return (words[0][4:],)
    board = kind if kind[-1:].isdigit() else f"{kind}0"
    rest = [str(int(w, 16)) if _HEX.fullmatch(w) else w.lower() for w in words[1:]]
    return (board, *(rest[:-1] if rest[-1:] == ["instr"] else rest))


def complaints(entry: DeviceEntry) -> Iterator[Complaint]:
    """Yield a host that is none, and the settings of a serial line that a device elsewhere has: they would do
    nothing."""
    visa = str(entry.address.get("visa", ""))
    if visa.upper().startswith("TCPIP") and len(words := visa.split("::")) > 1:
        yield from wrong_host(words[1], "address.visa")
    if visa and not visa.upper().startswith("ASRL"):
        for key in _SERIAL.keys() & entry.settings.keys():
            text = f"`{key}` does nothing: `{visa[:60]}` is no serial line"
            yield Complaint(
                f"settings.{key}", text, "delete it, or write the address of a serial line, `ASRL...::INSTR`"
            )


def within_of(entry: DeviceEntry) -> float:
    """Return how long a few questions to a device may take in all [s]: two late replies, and never too long."""
    return min(LONGEST - 0.2, 2.0 + 2 * float(entry.setting("timeout", REPLY)))


def resource_options(entry: DeviceEntry) -> dict[str, Any]:
    """Return what PyVISA is told when it opens the resource of an entry."""
    from pyvisa.constants import Parity, StopBits

    said: dict[str, Any] = {key: entry.settings.get(key, known.default) for key, known in SETTINGS.items()}
    milliseconds = round(float(said["timeout"] or REPLY) * 1000)
    options = {
        "timeout": milliseconds, "open_timeout": milliseconds,
        "read_termination": said["read_termination"], "write_termination": said["write_termination"],
    }  # fmt: skip
    if str(entry.address["visa"]).upper().startswith("ASRL"):
        options |= {
            "baud_rate": said["baud_rate"], "data_bits": said["data_bits"],
            "parity": Parity[str(said["parity"])],
            "stop_bits": {1: StopBits.one, 2: StopBits.two}[int(said["stop_bits"] or 1)],
        }  # fmt: skip
    return options


def backend_of(entry: DeviceEntry) -> str:
    """Return the VISA library of an entry, as PyVISA names it."""
    said = str(entry.setting("backend", "@py"))
    return "" if said == "@ivi" else said  # PyVISA's own name for the vendor's library


def queue_of(ask: Callable[[str], str], first_ask: Callable[[str], str] | None = None) -> str:
    """Return the oldest entry of the error queue that `ask` reaches, and empty the queue; '' if it was empty. Raises
    ValueError for what is no entry. `first_ask`: how the first entry is asked for, if otherwise."""
    first = last = judging.failure((first_ask or ask)("SYST:ERR?"))
    for _ in range(_MOST_ERRORS):
        if not last:
            break
        last = judging.failure(ask("SYST:ERR?"))
    return first


def ask_if_known(resource: Any, ask: Callable[[str], str], question: str) -> str | None:
    """Return the reply of a PyVISA resource to a question that it may not know, None if it does not answer in time;
    a late reply cannot be taken for that to another question, which has another form. Raises what PyVISA raises."""
    from pyvisa.constants import StatusCode
    from pyvisa.errors import VisaIOError

    before, resource.timeout = resource.timeout, PATIENCE
    try:
        return ask(question)
    except VisaIOError as exc:
        if exc.error_code != StatusCode.error_timeout:
            raise
        return None
    finally:
        resource.timeout = before


PATIENCE = 500.0
"""How long an answer is waited for to a question that an instrument may not know [ms]."""


class Visa:
    """An open VISA resource: one line out, one line back. What came before a question is no answer to it."""

    def __init__(self, entry: DeviceEntry) -> None:
        import pyvisa

        manager = pyvisa.ResourceManager(backend_of(entry))
        self.resource: Any = manager.open_resource(str(entry.address["visa"]), **resource_options(entry))

    def ask(self, question: str) -> str:
        """Return the reply to a question; raises what PyVISA raises."""
        from pyvisa.constants import BufferOperation

        self.resource.flush(BufferOperation.discard_read_buffer)
        return str(self.resource.query(question)).strip()

    def ask_if_known(self, question: str) -> str | None:
        """Return the reply to a question, None if the instrument does not know it; raises what PyVISA raises."""
        return ask_if_known(self.resource, self.ask, question)

    def tell(self, command: str) -> None:
        """Send a command that has no reply."""
        self.resource.write(command)

    def told(self, command: str) -> None:
        """Send a command that has no reply, and ask whether it was taken; raises ValueError where it was not."""
        self.tell(command)
        if said := self.failure():
            raise ValueError(f"it answers `{command}` by {said[:60]}")

    def failure(self, *, after_reply: bool = False) -> str:
        """Return the oldest entry of the error queue, and empty the queue; '' if it was empty already. Raises
        ValueError for what is no entry. `after_reply`: what is left of the reply before it, whose line was broken, is
        taken for an entry, and is none."""
        return queue_of(self.ask, self._ask_at_once if after_reply else None)

    def _ask_at_once(self, question: str) -> str:
        said = str(self.resource.query(question)).strip()
        return said or str(self.resource.read()).strip()  # some end a line with a blank after the line feed

    def identity(self) -> Identity:
        """Return who answers to `*IDN?`."""
        return judging.identity(self.ask("*IDN?"))

    def close(self) -> None:
        """Close it; also while a question hangs in it. PyVISA has one manager for all: closing that one would close
        the links of other devices, too."""
        self.resource.close()


def require_read_back(name: str, what: str, wanted: object, found: object) -> None:
    """Raise PicoError where a device reads back something else than it was set to."""
    if wanted != found:
        text = f"{name} was to have {what} {wanted}, and reads back {found}"
        hint = "it may be out of its range, or held back by an interlock of its own"
        raise PicoError(error("device-read-back", text, hint=hint, address=name))
