"""Whether the devices of a lab can be told apart: one device a place at a link, one driver family a link, one device a
serial number, and identities where several share a line."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from itertools import pairwise, product

from pico.diagnostics import Diagnostic, SourceRange, error
from pico.manifest.text.places import find, where, where_key
from pico.manifest.text.tree import Document
from pico.model.instruments.declaration import Declaration
from pico.model.wiring import DeviceEntry

Devices = Mapping[str, tuple[DeviceEntry, Declaration]]


def check_addresses(devices: Devices, documents: Mapping[str, Document]) -> Iterator[Diagnostic]:
    """Yield what is wrong with the addresses and identities of devices; `documents`: the one that names each."""
    links = _links(devices)
    for wire, names in links.items():
        yield from _one_family(devices, documents, wire, names)
        yield from _one_place(devices, documents, wire, names)
        yield from _known(devices, documents, wire, names)
    yield from _serials(devices, documents)


def _links(devices: Devices) -> dict[tuple[str, ...], list[str]]:
    """Return the devices by physical link."""
    links = defaultdict[tuple[str, ...], list[str]](list)
    for name, (entry, about) in devices.items():
        if wire := about.physical_link(entry):
            links[wire].append(name)
    return links


def _one_family(
    devices: Devices, documents: Mapping[str, Document], wire: tuple[str, ...], names: list[str]
) -> Iterator[Diagnostic]:  # fmt: skip
    """Two drivers that can't share a link would each open it, and hear each other's replies."""
    first = names[0]
    for name in names[1:]:
        one, other = devices[first], devices[name]
        families = {one[1].link or f"{one[0].driver} of {first}", other[1].link or f"{other[0].driver} of {name}"}
        same_driver = one[0].driver == other[0].driver
        if len(families) == 2 and not same_driver:
            text = f"{name} ({other[0].driver}) is at {_said(wire)}, where {first} ({one[0].driver}) is"
            hint = "give each its own address: these drivers can't share a link"
            yield error("device-address", text, hint=hint, source=_at(documents[name], name))


def _one_place(
    devices: Devices, documents: Mapping[str, Document], wire: tuple[str, ...], names: list[str]
) -> Iterator[Diagnostic]:  # fmt: skip
    """Two devices at one place are one, and what is meant for the one turns the other."""
    for index, name in enumerate(names):
        entry, about = devices[name]
        for first in names[:index]:
            other, of = devices[first]
            same_driver = entry.driver == other.driver
            pairs = product(about.places_of(entry), of.places_of(other))
            both = [shared for here, there in pairs if (shared := _shared(here, there, same_driver, about)) is not None]
            if both:
                place = " ".join(f"{key} {said}" for key, said in both[0].items())
                text = f"{name} is at {' '.join(filter(None, (_said(wire), place)))}, where {first} is"
                hint = f"one of the two addresses is wrong: `pico devices identify {name}` says who answers"
                yield error("device-address", text, hint=hint, source=_at(documents[name], name))
                break


def _shared(
    here: Mapping[str, str], there: Mapping[str, str], same_driver: bool, about: Declaration
) -> dict[str, str] | None:  # fmt: skip
    """Return what two places at a link have in common if they are one; None if they are two."""
    shared = {key: said for key, said in here.items() if there.get(key) == said}
    if not same_driver and not (shared and _drives(here, there)):
        return None
    return shared if here == there or (about.one_identity and "relay" in shared) else None


def _drives(here: Mapping[str, str], there: Mapping[str, str]) -> bool:
    """Whether two places of different drivers at one link are the same: several inputs may read one contact, but only
    one device drives a relay, or answers to a name or a number."""
    return here == there or "relay" in here.keys() & there.keys()


def _known(
    devices: Devices, documents: Mapping[str, Document], wire: tuple[str, ...], names: list[str]
) -> Iterator[Diagnostic]:  # fmt: skip
    """Where several devices share a line, any of them may answer: each needs to be known."""
    if len(names) < 2:
        return
    for name in names:
        entry, about = devices[name]
        if not about.one_identity and not entry.identity.get("serial"):
            others = ", ".join(other for other in names if other != name)
            text = f"{name} shares {_said(wire)} with {others}, and has no `identity` by which it is known"
            hint = f'`pico devices identify {name}` says what to write: `identity: {{serial: "..."}}`'
            yield error("missing-key", text, hint=hint, source=where_key(documents[name], "devices", name))


def _serials(devices: Devices, documents: Mapping[str, Document]) -> Iterator[Diagnostic]:
    """A serial number is of one device; those at one box, which have the identity of the box, share it."""
    serials = defaultdict[tuple[str, str], list[str]](list)
    for name, (entry, about) in devices.items():
        if serial := entry.identity.get("serial", "").strip():
            family = entry.identity.get("vendor", "").lower() or about.link or entry.driver.partition(".")[0]
            serials[family, serial].append(name)
    for (_, serial), names in serials.items():
        for first, name in pairwise(names):
            one, other = devices[first], devices[name]
            if (
                one[1].one_identity
                and other[1].one_identity
                and one[1].physical_link(one[0]) == other[1].physical_link(other[0])
            ):
                continue
            text = f"{name} has the serial number {serial} of {first}"
            hint = f"one of the two is wrong: `pico devices identify {name}` says who answers"
            at = where(documents[name], "devices", name, "identity", "serial")
            yield error("device-identity", text, hint=hint, source=at)


def _at(document: Document, name: str) -> SourceRange:
    return (
        where_key(document, "devices", name, "address")
        if find(document, "devices", name, "address")
        else where_key(document, "devices", name)
    )


def _said(wire: tuple[str, ...]) -> str:
    return ":".join(wire)
