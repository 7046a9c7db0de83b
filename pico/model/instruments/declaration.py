"""What a driver declares of itself as data: addresses, properties with units, settings. Files are checked against it
without opening a link."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from pico.diagnostics import did_you_mean
from pico.model.instruments.addresses import number_in, wrong_values
from pico.model.instruments.complaint import Complaint
from pico.model.wiring import DeviceEntry, Scalar

Said = Scalar | Mapping[str, Scalar]
POSITIONS = "positions"
"""A setting of this name has the names of positions, by what the device calls them."""
UNIT = "unit"
"""A setting of this name is the unit of the properties that are declared in its default."""


@dataclass(frozen=True, kw_only=True)
class Setting:
    """One setting that a driver takes from `settings:` of a device."""

    about: str
    """What it does, for a person."""
    default: Said | None = None
    """What holds without it; None if the lab has to state it."""
    kind: type | tuple[type, ...] = float
    """`float` takes whole numbers, too; `int`, `str`, `bool` and `dict` (a mapping) take only such. A tuple: any of
    them."""
    unit: str = ""
    range: tuple[float, float] | None = None
    """The least and the greatest value, in `unit`."""
    choices: tuple[Said, ...] = ()
    """The only values that it takes; any if empty."""
    optional: bool = False
    """Whether a lab may leave it out though it has no default."""

    def complaint(self, value: Said) -> str:
        """Return what is wrong with a value, '' if nothing is."""
        whole = isinstance(value, int) and not isinstance(value, bool)
        kinds = self.kind if isinstance(self.kind, tuple) else (self.kind,)
        if not (type(value) in kinds or (float in kinds and whole)):
            return f"is {' or '.join(_WORDS[one] for one in kinds)}, not `{str(value)[:40]}`"
        if self.choices and value not in self.choices:
            return f"is one of {', '.join(map(str, self.choices))}, not `{str(value)[:40]}`"
        if (
            self.range is not None
            and isinstance(value, int | float)
            and not self.range[0] <= float(value) <= self.range[1]
        ):
            low, high = self.range
            return f"is {low:g} to {high:g} {self.unit}".rstrip() + f", not {value}"
        return ""


_WORDS = {float: "a number", int: "a whole number", str: "text", bool: "true or false", dict: "a mapping"}


@dataclass(frozen=True, kw_only=True)
class Declaration:
    """What a driver declares of itself.

    `kind`: which protocol its instruments have. `address`: what an address says, with what that is; `bus`: which of it
    tells one link from another. `properties`: what a lab may map and limit, with units, '' for what has none.
    """

    kind: str
    address: Mapping[str, str]
    bus: tuple[str, ...]
    properties: Mapping[str, str] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Limits of properties that hold if the lab states none, in the units of the properties."""
    settings: Mapping[str, Setting] | None = None
    """The settings that it takes; None if it does not declare them, which lets any pass."""
    more_settings: str = ""
    """What else `settings` may name, in words, such as nodes of a camera; '' for nothing."""
    link: str = ""
    """Drivers that can share a link say the same here; else none do."""
    places: tuple[str, ...] | None = None
    """Which keys of the address tell the devices at one link apart; by default all that are not in `bus`."""
    required: tuple[str, ...] = ()
    """The keys of the address that a lab has to state, beside those of `bus`."""
    numbers: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    """The keys of the address that are whole numbers, with the least and the greatest."""
    takes: Callable[[DeviceEntry], Sequence[Mapping[str, str]]] | None = None
    """Returns all places that an entry's device takes at its link, each as `place` says one, if they are several."""
    robot: str = ""
    """The model of the robots that an arm or a gripper is for; '' for any."""
    usual: Mapping[str, str] = field(default_factory=dict)
    """The parts of an address that hold if the lab leaves them out."""
    one_identity: bool = False
    """Whether all devices at one link have the identity of the link, as those of a switch box have."""
    wire: Callable[[DeviceEntry], tuple[str, ...]] | None = None
    """Returns what tells one physical link from another, if that is not the `bus` part of the address as written."""
    named: Callable[[DeviceEntry], Mapping[str, str]] | None = None
    """Returns the properties of an entry with their units, for drivers of which the lab names them."""
    writes: Callable[[DeviceEntry, str], bool] | None = None
    """Returns whether a property of an entry can be set, for drivers that read some only."""
    check: Callable[[DeviceEntry], Iterator[Complaint]] | None = None
    """Yields what is wrong with an entry beyond what is declared here."""

    def properties_of(self, entry: DeviceEntry) -> Mapping[str, str]:
        """Return the properties of an entry's device, with their units."""
        return self.properties if self.named is None else self.named(entry)

    def writable(self, entry: DeviceEntry, name: str) -> bool:
        """Return whether a property of an entry's device can be set."""
        return self.writes is None or self.writes(entry, name)

    def position_names(self, entry: DeviceEntry) -> Mapping[str, str]:
        """Return the names of the positions of an entry, by what the device calls them; none for what has none."""
        said = entry.settings.get(POSITIONS)
        return {str(code): str(name) for code, name in said.items()} if isinstance(said, Mapping) else {}

    def unit(self, entry: DeviceEntry, name: str) -> str:
        """Return the unit of a property of an entry's device; '' if it has none."""
        said = self.properties_of(entry).get(name, "")
        if self.named is not None:
            return said
        stated = entry.settings.get(UNIT)
        chosen = (self.settings or {}).get(UNIT)
        return str(stated) if chosen is not None and said == chosen.default and isinstance(stated, str) else said

    def limits(self, entry: DeviceEntry, name: str) -> tuple[float, float] | None:
        """Return the limits of a property: those of the lab, or else the usual ones of the driver."""
        return entry.limits.get(name, self.bounds.get(name))

    def setting(self, entry: DeviceEntry, name: str) -> Said:
        """Return a setting of an entry, or its default; raises KeyError for one that has neither."""
        default = (self.settings or {})[name].default
        value = entry.settings.get(name, default)
        if value is None:
            raise KeyError(name)
        return value

    def physical_link(self, entry: DeviceEntry) -> tuple[str, ...]:
        """Return what tells one physical link from another: host and port, or the name of a port."""
        if self.wire is not None:
            return self.wire(entry)
        said = {key: number_in(entry.address[key]) for key in self.bus if key in entry.address}
        return tuple(value.lower() if key == "host" else value for key, value in said.items())

    def place(self, entry: DeviceEntry) -> dict[str, str]:
        """Return where at its link an entry's device is, by keys of the address, in one way of writing."""
        keys = self.places if self.places is not None else tuple(key for key in self.address if key not in self.bus)
        said = {**self.usual, **{key: number_in(value) for key, value in entry.address.items()}}
        return {key: said[key].upper() if key in self.usual else said[key] for key in keys if key in said}

    def places_of(self, entry: DeviceEntry) -> Sequence[Mapping[str, str]]:
        """Return all places at its link that an entry's device takes."""
        return (self.place(entry),) if self.takes is None else self.takes(entry)

    def complaints(self, entry: DeviceEntry) -> Iterator[Complaint]:
        """Yield all that is wrong with an entry, by the key at which it stands."""
        for where, said, known in (
            ("address", entry.address, self.address),
            ("limits", entry.limits, self.properties_of(entry)),
        ):
            for key in said:
                if key not in known:
                    hint = _known(key, known)
                    yield Complaint(f"{where}.{key}", f"`{entry.driver}` has no `{key[:40]}` in its {where}", hint)
        for key in dict.fromkeys((*self.bus, *self.required)):
            serial = key == "host" and "port" in self.bus and key not in self.required  # it may have a port alone
            if key not in entry.address and not serial:
                yield Complaint("address", f"the address has no `{key}`", f"`{key}` is {self.address[key]}")
        yield from wrong_values(entry.address, self.numbers)
        for key, wired in entry.map.items():
            if wired.property not in self.properties_of(entry):
                hint = _known(wired.property, self.properties_of(entry))
                text = f"`{entry.driver}` has no property `{wired.property[:40]}`"
                yield Complaint(f"map.{key}.property", text, hint)
        yield from self._settings(entry)
        if self.check is not None:
            yield from self.check(entry)

    def _settings(self, entry: DeviceEntry) -> Iterator[Complaint]:
        if self.settings is None:
            return
        for key, value in entry.settings.items():
            known = self.settings.get(key)
            if known is None:
                if not self.more_settings:
                    yield Complaint(
                        f"settings.{key}", f"`{entry.driver}` has no setting `{key[:40]}`", _known(key, self.settings)
                    )
            elif wrong := known.complaint(value):
                yield Complaint(f"settings.{key}", f"`{key}` {wrong}", known.about)
        for key, known in self.settings.items():
            if known.default is None and not known.optional and key not in entry.settings:
                text, hint = f"`{entry.driver}` needs the setting `{key}`", f"`settings: {{{key}: ...}}`: {known.about}"
                yield Complaint("driver", text, hint)


def _known(word: str, known: Mapping[str, object]) -> str:
    if not known:
        return "it has none"
    near = did_you_mean(word[:40], known)
    has = "it has " + ", ".join(f"`{name}`" for name in sorted(known))
    return f"{near} {has}" if near.startswith("did") else has
