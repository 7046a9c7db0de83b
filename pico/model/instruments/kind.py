"""What a kind of instrument is: which protocol its drivers have, what it reads and sets, and how a lab names that."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from pico.model.catalog import Tunable
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.readout import Readout
from pico.model.observation import ObservedValue
from pico.model.quantities import Value

Role = Literal["arm", "gripper", "camera", "safety input", "part"]
"""What an instrument is on a bench; `part`: it reads and sets values of a component."""
Datatype = Literal["float", "bool", "choice"]


_TRUTH = {"on": True, "true": True, "off": False, "false": False}
"""What positions of a tunable of datatype bool are called."""


def value_at(tunable: Tunable | None, name: str) -> Value | None:
    """Return the value of a tunable at a named position; None if the position is none of its values. Of datatype bool
    the positions are `on` and `off`, of datatype float their names are numbers."""
    if tunable is None or tunable.datatype == "choice":
        return name
    if tunable.datatype == "bool":
        return _TRUTH.get(name.lower())
    try:
        return float(name)
    except ValueError:
        return None


def name_at(names: Iterable[str], value: object) -> str | None:
    """Return the named position at which a tunable of whatever datatype has this value; None for none."""
    if isinstance(value, str):
        return next((name for name in names if name == value), None)
    tunable = Tunable(datatype="bool" if isinstance(value, bool) else "float")
    return next((name for name in names if value is not None and value_at(tunable, name) == value), None)


class Memory(Protocol):
    """Where a bench keeps what a device was told and does not tell again."""

    def get(self, address: str, default: Value) -> Value:
        """Return what was kept last, `default` if nothing was."""
        ...

    def put(self, address: str, value: Value | None) -> None:
        """Keep a value; None to forget it."""
        ...


class Driven(Protocol):
    """A tunable with a device."""

    moves: bool
    """Whether something turns or slides for it, which a stop ends."""

    @property
    def instrument(self) -> Any: ...

    async def read(self) -> ObservedValue:
        """Return what it is; unknown if the device does not know. Raises PicoError if that can't be asked."""
        ...

    async def set(self, value: Value) -> Value:
        """Bring it to a value, and return what is read back; raises PicoError."""
        ...

    async def home(self) -> Value:
        """Find its zero, and return what is read there; raises PicoError."""
        ...


class Measured(Protocol):
    """A measurable with a device."""

    colored: bool
    """Whether what it reads depends on the wavelength of the light, which it is told."""

    async def read(self, wavelength: float | None = None) -> Readout:
        """Return what it reads, in the unit of its property; `wavelength`: of the light [nm]. Raises PicoError."""
        ...


@dataclass(frozen=True, kw_only=True)
class Point:
    """A property of an instrument that a lab has under a name of its own."""

    instrument: Any
    """What the driver made; it has the protocol of its kind."""
    address: str
    """`component.tunable` or `component.measurable`."""
    property: str
    conversion: Conversion
    """Between the numbers of the property and those of the lab."""
    tunable: Tunable | None = None
    """What the type of the component declares; None for a measurable."""
    memory: Memory
    writable: bool = True
    """Whether the driver can set the property."""


@dataclass(frozen=True, kw_only=True)
class InstrumentKind:
    """A kind of instrument. A new one is a file beside those of `pico/drivers/kinds`, or of a plug-in (entry point
    `pico.kinds`), with this as its `KIND`."""

    name: str
    about: str
    """What it is, in a line for people."""
    protocol: type
    """What a driver of it must have, a `typing.Protocol`."""
    reads: Callable[[Any], Awaitable[str]]
    """Returns in words what an instrument reads, for `pico devices check`; moves nothing."""
    role: Role = "part"
    usual: Mapping[str, str] = field(default_factory=dict)
    """By the tunable or measurable: the property that it is, if the lab has no `map`."""
    by_name: bool = False
    """Whether, without `map`, a property is the tunable or measurable of the same name."""
    datatypes: tuple[Datatype, ...] = ("float", "bool", "choice")
    """Of which tunables it can set."""
    drives: Callable[[Point], Driven | None] = lambda point: None
    """Returns what sets a tunable; None for a property that it only reads."""
    measures: Callable[[Point], Measured | None] = lambda point: None
    """Returns what reads a measurable; None for a property that it only sets."""

    @property
    def methods(self) -> tuple[str, ...]:
        """The methods of the protocol."""
        known = {name: one for base in reversed(self.protocol.__mro__) for name, one in vars(base).items()}
        return tuple(sorted(name for name, one in known.items() if callable(one) and not name.startswith("_")))
