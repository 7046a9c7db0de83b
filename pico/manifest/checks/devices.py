"""Whether the entry of a device is what its driver takes: address, limits, settings, properties, units of its map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document
from pico.model.catalog import Tunable
from pico.model.instruments.conversion import same_dimension
from pico.model.instruments.declaration import Declaration
from pico.model.instruments.kind import value_at
from pico.model.instruments.kinds import kind_of
from pico.model.instruments.mapping import mapped
from pico.model.quantities import QuantityError, dimension
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired
from pico.plug_ins.calling import Interface, instance, loaded
from pico.plug_ins.known import entries

_AT_VALUE = ("address", "settings", "driver", "map")
"""What is wrong with one of these stands at its value, and not at its key."""


_INTERFACE = Interface("pico.drivers", {"": instance(Declaration)})


@cache
def declaration(name: str) -> tuple[Declaration | None, tuple[Diagnostic, ...]]:
    """Return what a driver declares of itself, None for one that is not installed, or is broken; and what is wrong
    with a plug-in."""
    known = entries("pico.drivers")
    if name not in known:
        return None, ()
    try:
        found: Declaration = loaded(_INTERFACE, known[name])
        kind_of(found.kind)
    except PicoError as exc:
        return None, tuple(exc.diagnostics)
    return found, ()


def check_entry(
    document: Document, name: str, entry: DeviceEntry, about: Declaration, setup: Setup
) -> Iterator[Diagnostic]:  # fmt: skip
    """Yield what is wrong with a device's entry by what its driver declares, each at its place."""
    for one in about.complaints(entry):
        path = ("devices", name, *one.key.split("."))
        missing = one.text.startswith(f"`{entry.driver}` has no") and path[2] != "map"
        at = where_key(document, *path) if missing or path[2] not in _AT_VALUE else where(document, *path)
        yield error("device", f"{name}: {one.text}", hint=one.hint, source=at)
    owner = entry.of or name
    robot = setup.lab.robots.get(owner)
    if robot is not None and about.robot not in ("", robot.model):
        own = [n for n in sorted(entries("pico.drivers")) if (d := declaration(n)[0]) and _is_for(d, about.kind, robot)]
        text = f"{owner} is of the model `{robot.model}`, and `{entry.driver}` is for the model `{about.robot}`"
        hint = f"drivers of its {about.kind}: {', '.join(f'`{n}`' for n in own)}" if own else "no driver is for that"
        yield error("device", text, hint=hint, source=where(document, "devices", name, "driver"))
    if owner in setup.lab.inventory:
        for key, wired in mapped(setup, about, entry, owner).items():
            if wired.property in about.properties_of(entry):
                yield from _mapped(document, name, entry, about, setup, owner, key, wired)


def _mapped(
    document: Document, name: str, entry: DeviceEntry, about: Declaration, setup: Setup, owner: str, key: str,
    wired: Wired,
) -> Iterator[Diagnostic]:  # fmt: skip
    kind, path = setup.type_of(owner), ("map", key) if key in entry.map else ("driver",)
    at = where(document, "devices", name, *path)
    tunable = kind.tunables.get(key)
    units = {n: t.unit for n, t in kind.tunables.items()} | {n: m.unit for n, m in kind.measurables.items()}
    own = about.unit(entry, wired.property)
    if key not in units:
        if key not in entry.map:  # else told already
            text = f"{owner} has no `{key}`, which {_with_article(about.kind)} is if the lab has no `map`"
            hint = f"`map: {{NAME: {{property: {wired.property}}}}}`, or name another component by `of:`"
            yield error("unknown-tunable", text, hint=hint, source=at)
        return
    takes = kind_of(about.kind).datatypes
    if tunable is not None and tunable.datatype not in takes:
        what = f"{owner}.{key} is a {tunable.datatype}, and {name} is {_with_article(about.kind)}"
        text = f"{what}: it drives to numbers" if takes == ("float",) else f"{what}: it does not set that"
        yield error(
            "value",
            text,
            hint=f"map a tunable of datatype {' or '.join(takes)}" if takes else "leave `map` out",
            source=at,
        )
    elif tunable is not None and (ends := _ends_light(setup, owner, key)) and about.kind not in ends:
        text = f"{owner}.{key} lets light out, and the guard of light can't end it through {_with_article(about.kind)}"
        fit = [f"`{n}`" for n in sorted(entries("pico.drivers")) if (d := declaration(n)[0]) and d.kind == ends[0]]
        hint = f"choose a driver of the kind `{ends[0]}`: {', '.join(fit)}"
        yield error("value", text, hint=hint, source=at)
    elif tunable is not None and not about.writable(entry, wired.property) and tunable.restore.kind != "none":
        text = f"{owner}.{key} is set, and `{wired.property}` of {name} is only read"
        hint = "`set:` in its settings says how it is set; a value that is only read is a measurable of its type"
        yield error("value", text, hint=hint, source=at)
    elif tunable is not None and (names := about.position_names(entry)):
        yield from _positions(document, name, tunable, f"{owner}.{key}", names)
    elif own and units[key] and (wrong := _unit(wired, own, units[key], f"{owner}.{key}", entry.driver)):
        yield error("unit", wrong[0], hint=wrong[1], source=at)


def _is_for(about: Declaration, kind: str, robot: Robot) -> bool:
    return about.kind == kind and about.robot in ("", robot.model)


def _ends_light(setup: Setup, owner: str, key: str) -> tuple[str, ...]:
    """Return the kinds of device through which the guard of light ends what a tunable lets out, the usual one first;
    none if it lets none out. A lamp, which tells nothing of itself, may be a source of class 1 alone."""
    if key == "shutter":
        return ("shutter",)
    kind = setup.type_of(owner)
    if key != "emission" or kind.optics.element != "source":
        return ()
    stated = kind.parameters.get("laser_class")
    return ("laser", "lamp") if stated is not None and str(stated.value) == "1" else ("laser",)


def _with_article(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _positions(
    document: Document, name: str, tunable: Tunable, address: str, names: Mapping[str, str]
) -> Iterator[Diagnostic]:  # fmt: skip
    """Yield the positions of a device that are no values of the tunable, each at its place."""
    for code, position in names.items():
        value = value_at(tunable, position)
        if value is None or (tunable.choices and position not in tunable.choices):
            known = tunable.choices or (("on", "off") if tunable.datatype == "bool" else ())
            hint = did_you_mean(position[:40], known) or "its name is a number, in the unit of the tunable"
            at = where(document, "devices", name, "settings", "positions", code)
            yield error("value", f"`{position[:40]}` is no value of {address}", hint=hint, source=at)


def _unit(wired: Wired, own: str, unit: str, address: str, driver: str) -> tuple[str, str] | None:
    """Return what is wrong with the units of a map, and a hint; None if nothing is."""
    what = f"{wired.property} of {driver}"
    if wired.unit is not None and not same_dimension(wired.unit, unit):
        return None  # told already, at the unit
    if same_dimension(own, unit):
        if wired.unit is None and wired.scale != 1 and own != unit:
            text = f"{address} is in {unit}, {what} in {own}, and it is not stated which of them `scale` leads to"
            return text, f"state it: `unit: {unit}`, or `unit: {own}`; without `scale` PICO converts by itself"
        return None
    text = f"{address} is in {unit}, of {_dimension(unit)}, and {what} in {own}, of {_dimension(own)}"
    if wired.unit is not None and wired.scale != 1:
        return None  # so many of the one a unit of the other, as the lab says
    axes = {_dimension(own), _dimension(unit)} == {"length", "angle"}
    does = f"; if a mechanism makes the one of the other, state `scale` in {unit} per {own}, and `unit: {unit}`"
    return text, ("choose a driver of a rotation mount or of a linear stage" if axes else "map another property") + does


def _dimension(unit: str) -> str:
    try:
        return dimension(unit)
    except QuantityError:
        return unit


def declared(devices: Mapping[str, DeviceEntry]) -> dict[str, tuple[DeviceEntry, Declaration]]:
    """Return the devices whose drivers declare themselves, with what these do."""
    found = ((name, entry, declaration(entry.driver)[0]) for name, entry in devices.items())
    return {name: (entry, about) for name, entry, about in found if about is not None}
