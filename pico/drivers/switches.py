"""What is on or off behind a box that takes lines of text over TCP, such as a microcontroller of a lab's own: shutters
with a sensor, lasers that report themselves, lamps, safety inputs.

A question begins with a number, and so does its answer: one that comes twice, or too late, is none to the next one.
`7 read NAME` is answered by `7 1`, `7 0`, or `7 ?` where that is not known; `8 set NAME 1` or `8 set NAME 0` by what is
read then.
`9 keep NAME SECONDS` is answered by `9 kept` if the box has a dead-man: unless it hears that again within so long, it
sets NAME to 0 by itself.
A shutter `NAME` is driven as such, and read from its sensor, `NAME.sensor`; a safety input is safe where it reads `1`.
"""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Mapping
from typing import Any

from pico.base.reasons import ReasonCode
from pico.diagnostics import PicoError, error
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.line import Line
from pico.drivers.protocols import Grip, Identity, SafetyState
from pico.model.instruments.declaration import Setting
from pico.model.instruments.readout import Readout, unknown
from pico.model.wiring import DeviceEntry

_REPLY = 1.0
"""How long the box may take for an answer [s]."""
_TRAVEL = 1.0
"""How long a shutter may take until its sensor says that it is there [s]."""
_STATES = {"1": True, "0": False, "?": None}


class SwitchLink:
    """A connection to a box of switches. Raises OSError, or ValueError for what is no answer."""

    def __init__(self, host: str, port: int) -> None:
        self._socket = socket.create_connection((host, port), timeout=_REPLY)
        self._file = self._socket.makefile("rb")
        self._number = 0

    def ask(self, words: str) -> str:
        """Return the answer to a line."""
        self._number += 1
        self._socket.sendall(f"{self._number} {words}\n".encode())
        said = self._file.readline(256)
        if not said.endswith(b"\n"):
            raise ValueError("it hung up")
        number, _, answer = said.decode("utf-8", "replace").strip().partition(" ")
        if number != str(self._number):
            raise ValueError(f"it answers {said[:40]!r}, and question {self._number} was asked")
        return answer

    def readout(self, words: str) -> Readout:
        """Return the answer to a line, as it came, and the state that it says."""
        said = self.ask(words)
        state = _STATES.get(said)
        if state is not None:
            return Readout(unit="", value=state, raw=said)
        code: ReasonCode = "no-number" if said in _STATES else "garbled"
        return unknown("", code, said, "the box does not know" if said in _STATES else f"it answers {said[:40]!r}")

    def state(self, words: str) -> bool | None:
        """Return the state that a line is answered by; None where the box does not know."""
        said = self.ask(words)
        if said not in _STATES:
            raise ValueError(f"it answers {said[:40]!r} to `{words}`")
        return _STATES[said]

    def close(self) -> None:
        """Hang up, also while somebody waits for an answer."""
        self._socket.close()


class _Switch:
    prop = ""
    """The property that it has."""
    _sensor = ""
    """What follows its name where it is read."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[SwitchLink]) -> None:
        self.name, self._at = name, str(entry.address["name"])
        self._line = Line(name, bus, entry.identity, _identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def stop(self) -> None:
        """A switch does not move by itself."""

    async def close(self) -> None:
        await self._line.close()

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads, with the answer of the box."""
        name = self._at + self._sensor
        return {self.prop: await self._line.ask("tell its state", lambda link: link.readout(f"read {name}"))}

    async def _read(self, what: str, name: str) -> bool | None:
        return await self._line.ask(what, lambda link: link.state(f"read {name}"))

    async def _set(self, what: str, on: bool) -> bool | None:
        ask = self._line.move if on else self._line.end
        return await ask(what, lambda link: link.state(f"set {self._at} {int(on)}"))


class _Watched(_Switch):
    """A shutter or a laser with a dead-man: the box ends its light unless it hears `keep NAME SECONDS` again in time.
    A box without one answers that otherwise than by `kept`."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[SwitchLink]) -> None:
        super().__init__(name, entry, bus)
        self._within = float(entry.setting(WATCHDOG, 0.0)) if WATCHDOG in entry.settings else None

    @property
    def dead_man(self) -> float | None:
        """How long after the last `keep` it ends its light [s]; None if the lab does not ask for it."""
        return self._within

    async def refresh(self) -> None:
        """Keep the box from ending its light for so long again."""
        if self._within is not None:
            await self._line.ask("keep its dead-man from closing", self._keep)

    def _keep(self, link: SwitchLink) -> None:
        if (said := link.ask(f"keep {self._at} {self._within:g}")) != "kept":
            text = f"the box of {self.name} has no dead-man: it answers {said[:40]!r} to `keep`"
            hint = f"take `{WATCHDOG}` out of the settings of {self.name}, or give the box one"
            raise PicoError(error("dead-man", text, hint=hint, address=self.name))

    async def _set(self, what: str, on: bool) -> bool | None:
        if on:
            await self.refresh()  # a box without a dead-man lets no light out here
        return await super()._set(what, on)


class SwitchedShutter(_Watched):
    """A shutter with a sensor of its own."""

    prop, _sensor = "open", ".sensor"

    async def open(self, wanted: bool) -> bool:
        """Open or close it, and return what its sensor says once it is there, or has had its time."""
        await self._set("open" if wanted else "close", wanted)
        ends = time.monotonic() + _TRAVEL
        while (found := await self.is_open()) is not wanted and time.monotonic() < ends:
            await asyncio.sleep(0.02)
        return bool(found) if found is not None else not wanted

    async def is_open(self) -> bool | None:
        return await self._read("tell its position", f"{self._at}.sensor")


class SwitchedLaser(_Watched):
    """A laser that reports whether it emits."""

    prop = "emission"

    async def emit(self, on: bool) -> bool:
        found = await self._set("emit" if on else "stop emitting", on)
        return bool(found) if found is not None else not on  # what the box does not know is not as wanted

    async def stop(self) -> None:
        """Switch it off, before all else."""
        await self.emit(False)

    async def emitting(self) -> bool | None:
        return await self._read("tell whether it emits", self._at)


class SwitchedLamp(_Switch):
    """A lamp."""

    prop = "on"

    async def shine(self, on: bool) -> bool:
        return bool(await self._set("shine" if on else "go out", on))


class SwitchedGripper(_Switch):
    """A vacuum cup or a pneumatic hand, with a sensor of its own that says whether something is held."""

    prop, _sensor = "holds", ".sensor"

    async def hold(self, on: bool) -> Grip:
        """Hold or let go, and return what its sensor says once it is so, or has had its time."""
        await self._set("hold" if on else "let go", on)
        ends = time.monotonic() + _TRAVEL
        while (found := await self.grip()).holds is not on and time.monotonic() < ends:
            await asyncio.sleep(0.02)
        return found

    async def move_to(self, width: float, *, force: float | None = None) -> Grip:
        """Raise PicoError: it knows no width."""
        text = f"{self.name} holds or lets go, and can't bring its fingers {width:g} mm apart"
        raise PicoError(error("gripper", text, address=self.name))

    async def grip(self) -> Grip:
        return Grip(width=None, holds=await self._read("tell whether it holds something", self._at + self._sensor))


class SwitchedInput(_Switch):
    """A safety input."""

    prop = "safe"

    async def read(self) -> SafetyState:
        return SafetyState(safe=await self._read("tell whether it is safe", self._at), age=0.0)


def _identity(link: SwitchLink) -> Identity:
    words = dict(word.partition("=")[::2] for word in link.ask("identify").split())
    return Identity(**{key: words.get(key, "") for key in ("vendor", "model", "serial", "firmware")})


WATCHDOG = "watchdog"
"""The setting of a shutter or a laser that has the box end its light by itself."""
_SETTINGS = {
    WATCHDOG: Setting(
        optional=True, unit="s", range=(0.5, 60.0),
        about="after how long without a word from PICO the box ends its light by itself",
    )
}  # fmt: skip


def _driver(kind: str, made: Any, prop: str) -> Driver:
    return Driver(
        kind=kind, made=made,
        opened=lambda entry: SwitchLink(str(entry.address["host"]), int(entry.address["port"])),
        closed=lambda link: link.close(),
        address={"host": "the box's name or number", "port": "its TCP port", "name": "what it calls this one"},
        bus=("host", "port"), required=("host", "name"),
        properties={prop: ""}, settings=_SETTINGS if kind in ("shutter", "laser") else {},
        one_identity=True,
        maturity="emulated", emulator="switches", link="switches",
    )  # fmt: skip


SHUTTER = _driver("shutter", SwitchedShutter, "open")
LASER = _driver("laser", SwitchedLaser, "emission")
LAMP = _driver("lamp", SwitchedLamp, "on")
GRIPPER = _driver("gripper", SwitchedGripper, "holds")
INPUT = _driver("safety input", SwitchedInput, "safe")
