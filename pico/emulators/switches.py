"""A box of switches, as `pico.drivers.switches` describes it. What is behind each of them has `open`, `emission`, `on`
or `safe`."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from pico.emulators.behind import Behind, Emulator
from pico.emulators.serving import TcpServed
from pico.model.wiring import DeviceEntry

PROPERTIES = {"shutter": "open", "laser": "emission", "lamp": "on", "input": "safe", "gripper": "holds"}
"""What a switch is behind which stands what, by the last word of its driver's name."""


class DeadMen:
    """The dead-man of each switch of a box that was told to have one: it goes off where nobody keeps it on. Time is the
    wall's: whoever keeps it on lives by that."""

    def __init__(self, switches: Mapping[str, tuple[str, Behind]], clock: Callable[[], float] = time.monotonic) -> None:
        self._switches, self._clock, self._until = switches, clock, dict[str, float]()

    def keep(self, name: str, seconds: float) -> None:
        """Keep a switch on for so long."""
        self._until[name] = self._clock() + seconds

    def fall(self) -> None:
        """Switch off what nobody kept on."""
        now = self._clock()
        for name in [name for name, until in self._until.items() if until < now]:
            del self._until[name]
            what, behind = self._switches[name]
            if behind.read(what):
                behind.write(what, False)


class Switches:
    """A conversation about switches by name; those of one box share its dead-men."""

    def __init__(
        self, serial: str, switches: Mapping[str, tuple[str, Behind]], dead_men: DeadMen | None = None
    ) -> None:  # fmt: skip
        self._serial, self._switches, self._rest = serial, switches, b""
        self._dead_men = dead_men or DeadMen(switches)

    def heard(self, data: bytes) -> bytes:
        self._dead_men.fall()
        lines = (self._rest + data).split(b"\n")
        self._rest = lines.pop()
        return "".join(self._numbered(line.decode("utf-8", "replace").split()) for line in lines).encode()

    def due(self) -> bytes:
        self._dead_men.fall()
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
            case ["keep", name, seconds] if name in self._switches and seconds.replace(".", "", 1).isdigit():
                self._dead_men.keep(name, float(seconds))
                return "kept"
        return "what?"

    def _state(self, what: str, behind: Behind) -> str:
        found = behind.read(what)
        return "?" if found is None else "1" if found else "0"


class WatchedBox(TcpServed):
    """A box whose dead-men go on where nobody is connected."""

    def __init__(self, conversation: Callable[[], Switches], dead_men: DeadMen) -> None:
        self._dead_men = dead_men
        super().__init__(conversation)

    def idle(self) -> None:
        self._dead_men.fall()


def _property(entry: DeviceEntry) -> str:
    """Return which property a switch is; of a driver that is not PICO's, the first that the lab maps."""
    usual = next((wired.property for wired in entry.map.values()), "open")
    return PROPERTIES.get(entry.driver.rpartition(".")[2], usual)


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    serial = next((str(e.identity["serial"]) for e, _ in devices.values() if "serial" in e.identity), "0")
    switches = {str(entry.address["name"]): (_property(entry), behind) for entry, behind in devices.values()}
    dead_men = DeadMen(switches)
    return WatchedBox(lambda: Switches(serial, switches, dead_men), dead_men)


BOX = Emulator(started=_started, bus=("host", "port"))
