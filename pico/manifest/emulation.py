"""The scenario of an emulated bench, `kind: Emulation`: read, and held to the devices of its lab."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.manifest.files import decode_all, read_folder
from pico.manifest.records import read_record
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document, Map, Scalar, parse
from pico.model.instruments.emulation import Emulation
from pico.model.setup import Setup

KIND = "Emulation"


def is_emulation(document: Document) -> bool:
    """Return whether a document is a scenario of an emulated bench."""
    kind = document.root.get("kind") if isinstance(document.root, Map) else None
    return isinstance(kind, Scalar) and kind.text == KIND


def read_emulation(documents: Iterable[Document], setup: Setup) -> tuple[Emulation | None, list[Diagnostic]]:
    """Return the scenario among the documents of a lab, None without one, and all that is wrong with it."""
    scenarios = [one for one in documents if is_emulation(one)]
    if not scenarios:
        return None, []
    first, *more = scenarios
    found = [
        error("duplicate", "a second Emulation", detail=f"the first at {where(first, 'kind')}",
              hint="keep one of the two", source=where(other, "kind"))
        for other in more
    ]  # fmt: skip
    scenario, wrong = read_record(first, KIND, Emulation)
    found += wrong
    if scenario is None:
        return None, found
    if scenario.lab != setup.lab.name:
        text = f"this scenario is of `{scenario.lab[:40]}`, and the lab is `{setup.lab.name}`"
        hint = f"write `metadata: {{lab: {setup.lab.name}}}`"
        found.append(error("lab", text, hint=hint, source=where(first, "metadata", "lab")))
    known = setup.wiring.devices if setup.wiring else {}
    for name in scenario.devices:
        if name not in known:
            hint = did_you_mean(name[:40], known) or "name a device of the file of kind Devices"
            text = f"the lab has no device `{name[:40]}`"
            found.append(error("unknown-device", text, hint=hint, source=where_key(first, "devices", name)))
    inputs = {one.device for one in setup.wiring.safety_inputs.values()} if setup.wiring else set()
    for name, one in scenario.devices.items():
        if one.unsafe is not None and name in known and name not in inputs:
            text, hint = f"`unsafe` does nothing: {name} reads no safety input", "name a device of `safety_inputs:`"
            found.append(error("value", text, hint=hint, source=where_key(first, "devices", name, "unsafe")))
    return (None if found else scenario), found


def emulation_of(root: Path, setup: Setup) -> Emulation:
    """Return the scenario in the folder of a lab, one in which nothing goes wrong without one. Raises PicoError with
    all that is wrong with it."""
    sources, _ = decode_all({path: data for path, data in read_folder(root)[0].items() if KIND.encode() in data})
    scenario, wrong = read_emulation([one for source in sources for one in parse(source)[0]], setup)
    if wrong:
        raise PicoError(wrong)
    return scenario or Emulation(lab=setup.lab.name)
