"""An instrument that answers the lines that a lab's file names for `scpi.number` and `scpi.choice`.

A number is what is behind it, and NaN (9.91E37) if nothing is. A position takes a time to be reached; meanwhile the
instrument replies `moving`, if the lab's file has that, or else the position that it left.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from pico.drivers.scpi_values import HOLE, by_name, positions
from pico.emulators.behind import Behind, Emulator
from pico.emulators.serving import TcpServed
from pico.model.instruments.kind import name_at
from pico.model.wiring import DeviceEntry

TRAVEL = 0.4
"""How long it takes from one position to another [s]."""
NAN = "9.91E37"
NO_ERROR, UNDEFINED = '0,"No error"', '-113,"Undefined header"'


class _Number:
    """The numbers of one device."""

    def __init__(self, entry: DeviceEntry, behind: Behind) -> None:
        self._behind = behind
        self._reads = {str(line): name for name, line in by_name(entry, "read").items()}
        self._sets = {name: _template(str(line)) for name, line in by_name(entry, "set").items()}

    def answer(self, line: str) -> str | None:
        """Return the reply to a line, '' for none, None for a line that it does not know."""
        if (name := self._reads.get(line)) is not None:
            found = self._behind.read(name)
            return NAN if found is None else f"{float(found) + (self._behind.read('noise') or 0.0):.9E}"
        for name, template in self._sets.items():
            if (said := template.fullmatch(line)) is not None:
                try:
                    self._behind.write(name, float(said[1]))
                except ValueError:
                    return None
                return ""
        return None

    def due(self) -> None:
        """Nothing becomes of a number by itself."""


class _Choice:
    """The positions of one device; `stuck` behind it keeps it where it is."""

    def __init__(self, entry: DeviceEntry, behind: Behind) -> None:
        self._behind, self._names = behind, positions(entry)
        self._read, self._set = str(entry.settings["read"]), _template(str(entry.setting("set", HOLE)))
        self._moving = str(entry.setting("moving", ""))
        self._goal, self._there = "", 0.0

    def answer(self, line: str) -> str | None:
        """Return the reply to a line, '' for none, None for a line that it does not know."""
        self.due()
        if line == self._read:
            return self._moving if self._goal and self._moving else self._at()
        said = self._set.fullmatch(line)
        if said is None or said[1] not in self._names:
            return None
        if said[1] != self._at() and self._behind.read("stuck") is None:
            self._goal, self._there = said[1], self._behind.now() + TRAVEL
        return ""

    def due(self) -> None:
        """Let it have arrived."""
        if self._goal and self._behind.now() >= self._there:
            self._behind.write("position", self._names[self._goal])
            self._goal = ""

    def _at(self) -> str:
        name = name_at(self._names.values(), self._behind.read("position"))
        return next((code for code, one in self._names.items() if one == name), next(iter(self._names)))


def _template(line: str) -> re.Pattern[str]:
    before, _, after = line.partition(HOLE)
    return re.compile(f"{re.escape(before)}(.+){re.escape(after)}")


class Values:
    """A conversation in lines with the devices that are one instrument."""

    def __init__(self, entries: Mapping[str, DeviceEntry], devices: list[_Number | _Choice]) -> None:
        entry = next(iter(entries.values()))
        said = {"vendor": "PICO", "model": "EMULATED", "serial": "0", "firmware": "1.0", **entry.identity}
        self._who = ",".join(said[key] for key in ("vendor", "model", "serial", "firmware"))
        self._question = str(entry.setting("identify", "*IDN?"))
        self._ends = str(entry.setting("write_termination", "\n")), str(entry.setting("read_termination", "\n"))
        self._stops = {str(one.setting("stop", "")) for one in entries.values()} - {""}
        self._devices, self._rest, self._errors = devices, "", list[str]()

    def heard(self, data: bytes) -> bytes:
        *lines, self._rest = (self._rest + data.decode("ascii", "replace")).split(self._ends[0])
        replies = (self._said(line.strip()) for line in lines if line.strip())
        return "".join(f"{reply}{self._ends[1]}" for reply in replies if reply).encode()

    def due(self) -> bytes:
        for one in self._devices:
            one.due()
        return b""

    def _said(self, line: str) -> str:
        if line == self._question:
            return self._who
        if line == "SYST:ERR?":
            return self._errors.pop(0) if self._errors else NO_ERROR
        if line in self._stops:
            return ""
        for one in self._devices:
            if (reply := one.answer(line)) is not None:
                return reply
        self._errors.append(UNDEFINED)
        return ""


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    entries = {name: entry for name, (entry, _) in devices.items()}
    kinds: Mapping[str, type[_Number] | type[_Choice]] = {"scpi.number": _Number, "scpi.choice": _Choice}
    made: list[_Number | _Choice] = [
        kinds[entry.driver](entry, behind) for entry, behind in devices.values() if entry.driver in kinds
    ]
    served = TcpServed(lambda: Values(entries, made))
    served.address = {"visa": f"TCPIP0::127.0.0.1::{served.address['port']}::SOCKET"}
    return served


INSTRUMENT = Emulator(started=_started, bus=("visa",))
