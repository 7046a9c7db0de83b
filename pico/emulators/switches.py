"""A box of switches, as `pico.drivers.switches` describes it. What is behind each of them has `open`, `emission`, `on`
or `safe`."""

from __future__ import annotations

from collections.abc import Mapping

from pico.emulators.behind import Behind, Emulator
from pico.emulators.serving import TcpServed
from pico.model.wiring import DeviceEntry

PROPERTIES = {"shutter": "open", "laser": "emission", "lamp": "on", "input": "safe"}
"""What a switch is behind which stands what, by the last word of its driver's name."""


class Switches:
    """A conversation about switches by name."""

    def __init__(self, serial: str, switches: Mapping[str, tuple[str, Behind]]) -> None:
        self._serial, self._switches, self._rest = serial, switches, b""

    def heard(self, data: bytes) -> bytes:
        lines = (self._rest + data).split(b"\n")
        self._rest = lines.pop()
        return "".join(self._numbered(line.decode("utf-8", "replace").split()) for line in lines).encode()

    def due(self) -> bytes:
        return b""

    def _numbered(self, words: list[str]) -> str:
        return f"{' '.join(words[:1])} {self._answer(words[1:])}\n"

    def _answer(self, words: list[str]) -> str:
        match words:
            case ["identify"]:
                return f"vendor=PICO model=switches serial={self._serial} firmware=1"
            case ["read", name] if (known := self._switches.get(name.removesuffix(".sensor"))) is not None:
                return self._state(*known)
            case ["set", name, "0" | "1" as state] if name in self._switches:
                what, behind = self._switches[name]
                behind.write(what, state == "1")
                return self._state(what, behind)
        return "what?"

    def _state(self, what: str, behind: Behind) -> str:
        found = behind.read(what)
        return "?" if found is None else "1" if found else "0"


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    serial = next((str(e.identity["serial"]) for e, _ in devices.values() if "serial" in e.identity), "0")
    switches = {
        str(entry.address["name"]): (PROPERTIES[entry.driver.rpartition(".")[2]], behind)
        for entry, behind in devices.values()
    }
    return TcpServed(lambda: Switches(serial, switches))


BOX = Emulator(started=_started, bus=("host", "port"))
