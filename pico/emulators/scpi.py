"""Instruments that speak SCPI over a TCP socket: a power meter, a laser, and a box of contacts and relays.

A line a command, ending in a line feed; several in a line are parted by `;`. What is wrong is kept for `SYST:ERR?`.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable, Mapping
from typing import Protocol

from pico.emulators.behind import Behind, Emulator
from pico.emulators.serving import TcpServed
from pico.model.wiring import DeviceEntry

NOISE = 1e-4
"""Standard deviation of a power without a scenario, as a share of it."""
OUT_OF_RANGE = '-222,"Data out of range"'
CLOSED = 1
"""A contact with current through it: all is well. A cut wire is an open one."""


class Instrument(Protocol):
    """An instrument: commands in capitals, and what is answered; None for one that there is not, an entry of the error
    queue (`-222,"Data out of range"`) for one that is refused."""

    def answer(self, command: str, argument: str) -> str | None: ...


class Spoken:
    """SCPI around an instrument: identity, errors, several commands in a line."""

    def __init__(self, instrument: Instrument, identity: str) -> None:
        self._instrument, self._identity = instrument, identity
        self._rest, self._errors = b"", list[str]()

    def heard(self, data: bytes) -> bytes:
        *lines, self._rest = (self._rest + data).split(b"\n")
        return b"".join(self._line(line.decode("ascii", "replace")) for line in lines)

    def due(self) -> bytes:
        return b""

    def _line(self, line: str) -> bytes:
        said = [self._said(part.strip().lstrip(":")) for part in line.split(";") if part.strip()]
        replies = ";".join(reply for reply in said if reply)
        return f"{replies}\n".encode() if replies else b""

    def _said(self, text: str) -> str:
        command, _, argument = text.partition(" ")
        command = re.sub(r"[a-z]", "", command) if command != command.lower() else command.upper()
        if command == "*IDN?":
            return self._identity
        if command == "SYST:ERR?":
            return self._errors.pop(0) if self._errors else '0,"No error"'
        reply = self._instrument.answer(re.sub(r"SENS(E|OR)\b", "SENS", command), argument.strip())
        if reply is None:
            self._errors.append('-113,"Undefined header"')
        elif re.match(r'-\d+,"', reply):
            self._errors.append(reply)
            return ""
        return reply or ""


class Meter:
    """A power meter like Thorlabs' PM100: `power` [W] is behind it; it takes 400 to 1100 nm. Readings have noise."""

    LEAST, GREATEST = 400.0, 1100.0

    def __init__(self, behind: Behind) -> None:
        self._behind, self._wavelength, self._drawn = behind, 635.0, random.Random(1)
        self._unit = "W"

    def answer(self, command: str, argument: str) -> str | None:
        if command in ("MEAS:POW?", "READ?"):
            noise = self._behind.read("noise")
            noise = self._drawn.gauss(0.0, NOISE) if noise is None else noise
            watts = float(self._behind.read("power") or 0.0) * (1 + noise)
            return f"{watts if self._unit == 'W' else 10 * math.log10(max(watts, 1e-12) / 1e-3):.9E}"
        if command.startswith("SENS:POW:UNIT"):
            return self._in_unit(argument if command == "SENS:POW:UNIT" else "")
        if command == "SENS:CORR:WAV?":
            return f"{ {'MIN': self.LEAST, 'MAX': self.GREATEST}.get(argument, self._wavelength):.3f}"
        if command == "SENS:CORR:WAV":
            if not self.LEAST <= float(argument) <= self.GREATEST:
                return OUT_OF_RANGE
            self._wavelength = float(argument)
            self._behind.write("wavelength", self._wavelength)
            return ""
        return "S130C,SN 1104,,1,1,33" if command == "SYST:SENS:IDN?" else None

    def _in_unit(self, wanted: str) -> str:
        """Return the unit of a power, or read in the one that is wanted from now on."""
        if not wanted:
            return self._unit
        self._unit = "DBM" if wanted.upper() == "DBM" else "W"
        return ""


class Laser:
    """A laser: `emission` is behind it; it does not begin to emit while `interlock` is False."""

    def __init__(self, behind: Behind) -> None:
        self._behind = behind

    def answer(self, command: str, argument: str) -> str | None:
        if command == "OUTP?":
            return str(int(bool(self._behind.read("emission"))))
        if command == "OUTP":
            on = argument.upper() in ("ON", "1")
            if not on or self._behind.read("interlock") is not False:
                self._behind.write("emission", on)
            return ""
        return None


class Contacts:
    """Contacts and relays by channel. `contact` of each device is behind it: True where current flows. `relay` is what
    it was told; a shutter's sensor contact is closed where `open` is False. Each answer of contacts carries a count
    that goes on, so that one who hears the same twice knows that nobody is there any more."""

    def __init__(
        self, channels: Mapping[int, Callable[[], bool]], relays: Mapping[int, Callable[[bool], None]]
    ) -> None:
        self._channels, self._relays, self._count = channels, relays, 0

    def answer(self, command: str, argument: str) -> str | None:
        found = re.fullmatch(r"(?:(ON|OFF),)?\(@(\d+)\)", argument)
        if not found:
            return None
        channel = int(found[2])
        if command == "INP?" and channel in self._channels:
            self._count += 1
            return f"{int(self._channels[channel]())},{self._count}"
        if command == "OUTP" and channel in self._relays:
            self._relays[channel](found[1] == "ON")
            return ""
        return None


def _served(devices: Mapping[str, tuple[DeviceEntry, Behind]], instrument: Instrument) -> TcpServed:
    entry = next(iter(devices.values()))[0]
    said = {"vendor": "PICO", "model": "EMULATED", "serial": "0", "firmware": "1.0", **entry.identity}
    served = TcpServed(lambda: Spoken(instrument, ",".join(said[k] for k in ("vendor", "model", "serial", "firmware"))))
    served.address = {"visa": f"TCPIP0::127.0.0.1::{served.address['port']}::SOCKET"}
    return served


def _meter(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    return _served(devices, Meter(next(iter(devices.values()))[1]))


def _laser(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    return _served(devices, Laser(next(iter(devices.values()))[1]))


def _contacts(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    channels: dict[int, Callable[[], bool]] = {}
    relays: dict[int, Callable[[bool], None]] = {}
    for entry, behind in devices.values():
        if "relay" in entry.address:
            relays[int(entry.address["relay"])] = _switch(behind, "on" if entry.driver == "scpi.lamp" else "open")
        if "channel" in entry.address:
            shut = entry.driver == "scpi.shutter"
            channels[int(entry.address["channel"])] = _shut(behind) if shut else _contact(behind)
    return _served(devices, Contacts(channels, relays))


def _switch(behind: Behind, what: str) -> Callable[[bool], None]:
    def switch(on: bool) -> None:
        behind.write("relay", on)
        if behind.read("stuck") is None:
            behind.write(what, on)

    return switch


def _shut(behind: Behind) -> Callable[[], bool]:
    return lambda: behind.read("open") is not True


def _contact(behind: Behind) -> Callable[[], bool]:
    return lambda: behind.read("contact") is True


METER = Emulator(started=_meter, bus=("visa",))
LASER = Emulator(started=_laser, bus=("visa",))
CONTACTS = Emulator(started=_contacts, bus=("visa",))
