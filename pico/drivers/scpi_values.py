"""Numbers and named positions of any instrument that answers lines of text at a VISA address: the lab's file says by
which line each is asked and set (`scpi.number`, `scpi.choice`)."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.diagnostics import PicoError, did_you_mean, error
from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.drivers.visa import ADDRESS, SETTINGS, Visa, complaints, wire_of, within_of
from pico.model.instruments.complaint import Complaint
from pico.model.instruments.declaration import Setting
from pico.model.instruments.readout import Readout, unknown
from pico.model.quantities import QuantityError, dimension
from pico.model.wiring import DeviceEntry

VALUE = "value"
"""The name of a number whose `read` is one line."""
PAUSE = 0.05
"""How long it waits until it asks again whether a position is reached [s]."""
HOLE = "{}"
"""What of a line to set something is replaced by the value."""
_NEEDS = ("pyvisa_py", "scpi")


def by_name(entry: DeviceEntry, setting: str) -> dict[str, Any]:
    """Return what a setting says for each number of an entry; one line, unit or sigma is that of `value`, or of all."""
    said = entry.settings.get(setting)
    if said is None:
        return {}
    if isinstance(said, Mapping):
        return dict(said)
    names = [VALUE] if setting in ("read", "set") else list(by_name(entry, "read"))
    return dict.fromkeys(names, said)


def units(entry: DeviceEntry) -> dict[str, str]:
    """Return the numbers of an entry, with their units."""
    said = by_name(entry, "unit")
    return {name: str(said.get(name, "")) for name in by_name(entry, "read")}


def positions(entry: DeviceEntry) -> dict[str, str]:
    """Return the names of the positions of an entry by what the device calls them."""
    said = entry.settings.get("positions")
    return {str(key): str(name) for key, name in said.items()} if isinstance(said, Mapping) else {}


class Spoken:
    """What numbers and choices have in common: the link, and who answers at its other end."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        self.name, self._entry = name, entry
        self._question = str(entry.setting("identify", "*IDN?"))
        self._queue = bool(entry.setting("error_queue", True))
        self._line = Line(name, bus, entry.identity, self._identity)

    @property
    def _within(self) -> float:
        return within_of(self._entry)

    def _identity(self, visa: Visa) -> Identity:
        if self._question:
            return judging.identity(visa.ask(self._question))
        visa.ask(next(iter(by_name(self._entry, "read").values())))  # it can't say who it is: that it is there
        return Identity(vendor="", model="", serial="")

    async def connect(self) -> Identity:
        return await self._line.connect(within=self._within)

    async def stop(self) -> None:
        """Let nothing go on; with a `stop` in its settings, send that before all else."""
        command = str(self._entry.setting("stop", ""))
        if command:
            await self._line.stop(lambda visa: visa.tell(command))
        else:
            self._line.stopped()

    async def close(self) -> None:
        await self._line.close()

    def _tell(self, visa: Visa, command: str) -> None:
        """Send a command, and ask whether it was taken, if the device has an error queue."""
        if self._queue:
            visa.told(command)
        else:
            visa.tell(command)


class Numbers(Spoken):
    """Numbers: a `Number`, and a `SettableNumber` of those that have a line by which they are set."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        super().__init__(name, entry, bus)
        self._read, self._set, self._units = by_name(entry, "read"), by_name(entry, "set"), units(entry)
        self._sigma = {key: float(one) for key, one in by_name(entry, "sigma").items()}

    async def number(self, name: str) -> Readout:
        return await self._line.ask(f"read its {name}", lambda visa: self._number(visa, name), within=self._within)

    async def set_number(self, name: str, value: float) -> Readout:
        if (limits := self._entry.limits.get(name)) is not None:
            require_within(self.name, name, value, limits, self._units[name])
        command = str(self._set[name]).replace(HOLE, f"{value:.9g}")

        def set_(visa: Visa) -> Readout:
            self._tell(visa, command)
            return self._number(visa, name)

        return await self._line.move(f"set its {name}", set_, within=self._within)

    async def readouts(self) -> Mapping[str, Readout]:
        return {name: await self.number(name) for name in self._read}

    def _number(self, visa: Visa, name: str) -> Readout:
        unit, raw = self._units[name], visa.ask(str(self._read[name]))
        try:
            failure = visa.failure(after_reply=True) if self._queue else ""
        except ValueError as exc:
            return unknown(unit, "garbled", raw, f"its error queue can't be read: {exc}")
        found = judging.number(raw, unit, limits=self._entry.limits.get(name), failure=failure)
        return replace(found, sigma=self._sigma.get(name)) if found.value is not None else found


class Positions(Spoken):
    """Named positions: a `Choice`."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        super().__init__(name, entry, bus)
        self._names = positions(entry)
        self._goal: str | None = None

    async def choices(self) -> Sequence[str]:
        return tuple(self._names.values())

    async def position(self) -> Readout:
        found = await self._line.ask("tell its position", self._position, within=self._within)
        if self._goal is None or found.value == self._goal:
            return found
        return unknown("", "moving", found.raw, f"it moves to {self._goal}")

    async def move_to(self, name: str) -> str:
        code = next((key for key, one in self._names.items() if one == name), None)
        if code is None:
            hint = did_you_mean(name[:40], self._names.values())
            raise PicoError(
                error("device-limit", f"{self.name} has no position `{name[:40]}`", hint=hint, address=self.name)
            )
        command = str(self._entry.setting("set", "")).replace(HOLE, code)
        if not command:
            text = f"{self.name} can't be moved to {name}: its position is only read"
            raise PicoError(
                error("read-only", text, hint="`set:` in its settings says how it is moved", address=self.name)
            )
        stops, within = self._line.stops, float(self._entry.setting("seconds", _SECONDS))
        what, self._goal = f"move to {name}", name
        try:
            await self._line.move(what, lambda visa: self._tell(visa, command), within=self._within)
            return await self._arrived(what, name, stops, within)
        finally:
            self._goal = None

    async def _arrived(self, what: str, name: str, stops: int, within: float) -> str:
        ends = time.monotonic() + within
        while True:
            found = await self._line.ask(what, self._position, within=self._within)
            self._line.require_running(stops, what)
            if found.value == name:
                return name
            if time.monotonic() > ends:
                at = f"is at {found.value}" if found.value is not None else f"does not tell its position: {found.why}"
                text = f"{self.name} was to move to {name} within {within:g} s, and {at}"
                raise PicoError(error("device-missed", text, address=self.name))
            await asyncio.sleep(PAUSE)

    async def readouts(self) -> Mapping[str, Readout]:
        return {"position": await self.position()}

    def _position(self, visa: Visa) -> Readout:
        raw = visa.ask(str(self._entry.settings["read"]))
        try:
            failure = visa.failure(after_reply=True) if self._queue else ""
        except ValueError as exc:
            return unknown("", "garbled", raw, f"its error queue can't be read: {exc}")
        if failure:
            return unknown("", "instrument-error", raw, f"the error queue holds {failure[:80]}")
        return position_of(raw, self._names, self._entry.setting("moving", ""))


def position_of(raw: str, names: Mapping[str, str], moving: object = "") -> Readout:
    """Return which of the positions (`names`, by what the device calls them) a reply says; as text, or as the same
    number. `moving`: what it replies between two of them."""
    said = raw.strip()
    if said in names:
        return Readout(unit="", value=names[said], raw=raw)
    if moving != "" and said == str(moving):
        return unknown("", "moving", raw)
    number = judging.number(said, "").number
    for code, name in names.items():
        if number is not None and number == judging.number(code, "").number:
            return Readout(unit="", value=name, raw=raw)
    return unknown("", "garbled", raw, f"{said[:40]!r} is none of its positions {', '.join(names)}")


def _complaints(entry: DeviceEntry) -> Iterator[Complaint]:
    yield from complaints(entry)
    read, sets = by_name(entry, "read"), by_name(entry, "set")
    for setting in ("set", "unit", "sigma"):
        for name in by_name(entry, setting).keys() - read.keys():
            text = f"`{name[:40]}` is not read, and has a `{setting}`"
            yield Complaint(f"settings.{setting}", text, did_you_mean(name[:40], read) or "add it to `read`")
    for setting, said in (("read", read), ("set", sets)):
        for name, one in said.items():
            if not isinstance(one, str) or not one.strip():
                yield Complaint(f"settings.{setting}", f"`{setting}` of {name} is a line of text, not `{one}`")
    for name, one in sets.items():
        yield from _hole("settings.set", one)
        if name in read and name not in entry.limits:
            hint = f"add `limits: {{{name}: [least, greatest]}}`, in its unit"
            yield Complaint("settings.set", f"`{name}` is set, and has no limits", hint)
    for name, one in units(entry).items():
        try:
            dimension(one)
        except QuantityError as exc:
            yield Complaint("settings.unit", f"the unit of `{name}`: {exc}", exc.hint)


def _hole(key: str, line: object) -> Iterator[Complaint]:
    if isinstance(line, str) and line.count(HOLE) != 1:
        yield Complaint(key, f"`{line[:40]}` has not one `{HOLE}`", f"`{HOLE}` stands for what is set: `VOLT {HOLE}`")


def _wrong_positions(entry: DeviceEntry) -> Iterator[Complaint]:
    yield from complaints(entry)
    names = list(positions(entry).values())
    if "positions" in entry.settings and (len(names) < 2 or len(set(names)) < len(names)):
        hint = "by what the device calls them: `positions: {1: open, 2: nd1}`"
        yield Complaint("settings.positions", "`positions` are two different names at least", hint)
    if "set" in entry.settings:
        yield from _hole("settings.set", entry.settings["set"])


_SECONDS = 5.0
_LINK = {
    **SETTINGS,
    "identify": Setting(kind=str, default="*IDN?", about="the question who it is; empty if it can't say that"),
    "error_queue": Setting(kind=bool, default=True, about="whether it knows `SYST:ERR?`, asked after each line"),
    "stop": Setting(kind=str, optional=True, about="the line that ends a motion at once"),
}
_PART = {**ADDRESS, "part": "a name of your own, if several devices of the lab are one instrument"}


def _declared(made: Callable[..., Any], kind: str, **more: Any) -> Driver:
    return Driver(
        kind=kind, made=made, opened=Visa, closed=Visa.close, address=_PART, bus=("visa",), wire=wire_of,
        places=("part",), one_identity=True, needs=_NEEDS, maturity="emulated", emulator="scpi.values",
        link="scpi.values", **more,
    )  # fmt: skip


NUMBER = _declared(
    Numbers, "number", named=units, check=_complaints, writes=lambda entry, name: name in by_name(entry, "set"),
    settings={
        **_LINK,
        "read": Setting(kind=(str, dict), about="the line that asks for it, or such a line for each number by name"),
        "set": Setting(kind=(str, dict), optional=True, about="the line that sets it, with `{}` for the number"),
        "unit": Setting(kind=(str, dict), default="", about="the unit of the number"),
        "sigma": Setting(kind=(float, dict), optional=True, about="one standard deviation of the number, in its unit"),
    },
)  # fmt: skip
CHOICE = _declared(
    Positions, "choice", properties={"position": ""}, check=_wrong_positions,
    writes=lambda entry, name: "set" in entry.settings,
    settings={
        **_LINK,
        "read": Setting(kind=str, about="the line that asks for the position"),
        "set": Setting(kind=str, optional=True, about="the line that moves it, with `{}` for the position"),
        "positions": Setting(kind=dict, about="the names of the positions, by what the device calls them"),
        "moving": Setting(kind=(str, int, float), optional=True, about="what it replies between two positions"),
        "seconds": Setting(default=_SECONDS, unit="s", range=(0.1, 120.0), about="how long a move may take"),
    },
)  # fmt: skip
