"""Whether each tunable, measurable, arm, hand and camera has one device: of two, only one would be asked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pico.diagnostics import Diagnostic, error
from pico.manifest.text.places import find, where, where_key
from pico.manifest.text.tree import Document
from pico.model.instruments.declaration import Declaration
from pico.model.instruments.kinds import kind_of
from pico.model.instruments.mapping import mapped
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry


def check_doubles(
    devices: Mapping[str, tuple[DeviceEntry, Declaration]], documents: Mapping[str, Document], setup: Setup
) -> Iterator[Diagnostic]:  # fmt: skip
    """Yield each device that stands for something that another stands for; `documents`: the one that names each."""
    first: dict[str, str] = {}
    for name, (entry, about) in devices.items():
        for thing, path in _stands_for(name, entry, about, setup).items():
            if (other := first.setdefault(thing, name)) != name:
                hint = "one device is read and switched, the other would be left as it is: delete one, or correct its "
                hint += "`map`" if path[0] == "map" else "`of`"
                document = documents[name]
                at = ("devices", name, *path)
                source = where(document, *at) if find(document, *at) else where_key(document, "devices", name)
                yield error("duplicate", f"{name} is {thing}, and {other} is, too", hint=hint, source=source)
                break


def _stands_for(
    name: str, entry: DeviceEntry, about: Declaration, setup: Setup
) -> dict[str, tuple[str, ...]]:  # fmt: skip
    """Return what a device stands for, with the keys of its entry that say so."""
    owner, role = entry.of or name, kind_of(about.kind).role
    if owner in setup.lab.inventory:
        known = setup.type_of(owner).tunables.keys() | setup.measurables_of(owner).keys()
        keys = mapped(setup, about, entry, owner).keys() & known
        return {f"{owner}.{key}": ("map", key) if key in entry.map else ("of",) for key in sorted(keys)}
    words = {"arm": "the arm", "gripper": "the hand of", "camera": "the camera"}
    return {f"{words[role]} {owner}": ("of",)} if role in words else {}
