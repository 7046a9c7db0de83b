"""Whether a lab's instruments fit it: drivers that are installed, parts and tunables that there are, units."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from pico.diagnostics import Diagnostic, did_you_mean, error, warning
from pico.manifest.checks.addresses import check_addresses
from pico.manifest.checks.devices import check_entry, declaration, declared
from pico.manifest.checks.doubles import check_doubles
from pico.manifest.text.names import check_names
from pico.manifest.text.places import find, where, where_key
from pico.manifest.text.tree import Document
from pico.model.quantities import QuantityError, dimension
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wiring
from pico.plug_ins.known import entries

LOST = 1.0
"""Within this a link that is lost ends light [s]."""


def whole_wiring(read: Sequence[tuple[Document, Wiring]], setup: Setup) -> tuple[Wiring, list[Diagnostic]]:
    """Return the instruments that documents of kind Devices give a lab together, and all that is wrong with them."""
    found: list[Diagnostic] = []
    whole = Wiring(lab=setup.lab.name)
    drivers, emulators = _names("pico.drivers"), _names("pico.emulators")
    first: dict[tuple[str, str], Document] = {}
    for document, wiring in read:
        found += check_names(document, "devices") + check_names(document, "safety_inputs")
        found += _other_lab(document, wiring, setup)
        for kind, names in (("devices", wiring.devices), ("safety_inputs", wiring.safety_inputs)):
            found += _twice(document, kind, names, first)
        for name, entry in wiring.devices.items():
            found += _device(document, name, entry, setup, drivers, emulators)
        whole = replace(
            whole, devices={**whole.devices, **wiring.devices},
            safety_inputs={**whole.safety_inputs, **wiring.safety_inputs},
        )  # fmt: skip
    for document, wiring in read:
        found += _safety(document, wiring, whole, setup)
    known, documents = declared(whole.devices), {n: d for d, wiring in read for n in wiring.devices}
    found += check_addresses(known, documents)
    found += check_doubles(known, documents, setup)
    return whole, found


def _names(group: str) -> Collection[str]:
    return entries(group).keys()


def _other_lab(document: Document, wiring: Wiring, setup: Setup) -> Iterator[Diagnostic]:
    if wiring.lab != setup.lab.name:
        at = where(document, "metadata", "lab")
        text = f"these are the devices of `{wiring.lab[:40]}`, and the lab is `{setup.lab.name}`"
        yield error("lab", text, hint=f"write `metadata: {{lab: {setup.lab.name}}}`", source=at)


def _twice(
    document: Document, kind: str, names: Collection[str], first: dict[tuple[str, str], Document]
) -> Iterator[Diagnostic]:  # fmt: skip
    for name in names:
        if (kind, name) in first:
            detail = f"first at {where_key(first[kind, name], kind, name)}"
            at = where_key(document, kind, name)
            yield error("duplicate", f"{name} is given twice", detail=detail, hint="keep one of the two", source=at)
        first.setdefault((kind, name), document)


def _device(
    document: Document, name: str, entry: DeviceEntry, setup: Setup, drivers: Collection[str],
    emulators: Collection[str],
) -> Iterator[Diagnostic]:  # fmt: skip
    for key, chosen, known in (("driver", entry.driver, drivers), ("emulator", entry.emulator, emulators)):
        if chosen is not None and chosen not in known:
            yield _absent(document, name, key, chosen, known, entry.package)
    about, wrong = declaration(entry.driver)
    yield from (replace(one, severity="warning", source=where(document, "devices", name, "driver")) for one in wrong)
    if about is not None:
        yield from check_entry(document, name, entry, about, setup)
    lab, owner = setup.lab, entry.of or name
    parts = [*lab.inventory, *lab.robots, *lab.cameras]
    if entry.of is not None and owner not in parts:
        hint = did_you_mean(owner[:40], parts) or "a component, a robot or a camera of the lab"
        at = where(document, "devices", name, "of")
        yield error("unknown-component", f"the lab has no `{owner[:40]}`", hint=hint, source=at)
    elif owner in lab.inventory:
        yield from _map(document, name, entry, setup, owner)
    elif entry.map:
        what = "is no component of the lab" if owner not in parts else "has no tunables"
        at = where_key(document, "devices", name, "map")
        yield error("value", f"{owner} {what}", hint="name the component by `of:`", source=at)


def _absent(
    document: Document, name: str, key: str, chosen: str, known: Collection[str], package: str | None
) -> Diagnostic:  # fmt: skip
    """Return what is wrong with a driver or emulator that is not installed: an error if others of its family are, for
    it is misspelt then; else a warning, for the package that brings it may be absent here, and the simulator needs
    none."""
    at, near = where(document, "devices", name, key), did_you_mean(chosen[:40], known)
    if chosen.partition(".")[0] in {one.partition(".")[0] for one in known}:
        return error(key, f"there is no {key} `{chosen[:40]}`", hint=near or "a plug-in may bring it", source=at)
    install = f"`pip install {package}`" if package else "install the package that brings it"
    text = f"{name} can't be reached here: its {key} `{chosen[:40]}` is not installed; the simulator does not need it"
    return warning(key, text, hint=f"{near} Or {install}" if near.startswith("did") else install, source=at)


def _map(document: Document, name: str, entry: DeviceEntry, setup: Setup, owner: str) -> Iterator[Diagnostic]:
    kind = setup.type_of(owner)
    units = {n: t.unit for n, t in kind.tunables.items()} | {n: m.unit for n, m in kind.measurables.items()}
    for key, wired in entry.map.items():
        path = ("devices", name, "map", key)
        if key not in units:
            hint = did_you_mean(key[:40], units) or "a tunable or a measurable of its type"
            yield error("unknown-tunable", f"{owner} has no `{key[:40]}`", hint=hint, source=where_key(document, *path))
        elif wired.unit is not None:
            yield from _unit(document, path, wired.unit, units[key])


def _unit(document: Document, path: tuple[str, ...], unit: str, wanted: str) -> Iterator[Diagnostic]:
    try:
        have, want = dimension(unit), dimension(wanted)
    except QuantityError as exc:
        yield error("unit", str(exc), hint=exc.hint, source=where(document, *path, "unit"))
        return
    if have != want:
        text = f"`{unit}` is of {have}, and {path[-1]} is in {wanted}, of {want}"
        yield error("unit", text, hint="say the unit of the device's number", source=where(document, *path, "unit"))


def _safety(document: Document, own: Wiring, whole: Wiring, setup: Setup) -> Iterator[Diagnostic]:
    for name, entry in own.safety_inputs.items():
        if entry.heartbeat > LOST:
            text = f"the `heartbeat` of {name} is {entry.heartbeat:g} s, and a lost link ends light within {LOST:g} s"
            at = where(document, "safety_inputs", name, "heartbeat")
            yield error("value", text, hint=f"write {LOST:g} s or less", source=at)
        if entry.device not in whole.devices:
            hint = did_you_mean(entry.device[:40], whole.devices) or "name one of `devices:`"
            at = where(document, "safety_inputs", name, "device")
            yield error("unknown-device", f"there is no device `{entry.device[:40]}`", hint=hint, source=at)
        if entry.of is not None and entry.of not in setup.lab.inventory:
            hint = did_you_mean(entry.of[:40], setup.lab.inventory)
            at = where(document, "safety_inputs", name, "of")
            yield error("unknown-component", f"the lab has no component `{entry.of[:40]}`", hint=hint, source=at)
        if entry.kind == "shutter" and entry.of is None and find(document, "safety_inputs", name):
            at = where_key(document, "safety_inputs", name)
            yield error("missing-key", f"{name} does not say of which shutter it is", hint="add `of:`", source=at)
