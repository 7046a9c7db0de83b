"""Another specimen in the housing of a part: its serial, type and parameters written into the inventory."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.splice import Editor, apply_splices
from pico.manifest.text.tree import Document, Map, Scalar, parse, plain
from pico.model.lab import Known
from pico.model.quantities import Value
from pico.model.record import as_json

_ORDER = {name: n for n, name in enumerate(("type", "marker", "serial", "home", "pose", "parameters", "measured"))}


def exchanged(
    files: Mapping[str, bytes], name: str, serial: str, kind: str | None, parameters: Mapping[str, Value],
    known: Known | None = None,
) -> dict[str, bytes]:  # fmt: skip
    """Return the one manifest that changes for part `name` to have another specimen, by its path: all else in it stays
    byte for byte. `kind`: its type, None for the same; `parameters`: of this specimen; `known`: when and how well these
    were measured. What was measured of another specimen goes. Raises PicoError."""
    wrong: list[Diagnostic] = []
    for path, data in sorted(files.items()):
        source = decode(path, data)[0] if b"Lab" in data else None
        documents, mistakes = parse(source) if source else ([], [])
        wrong += mistakes
        for document in documents:
            if kind_of(document)[0] == "Lab":
                return {path: _with(document, name, serial, kind, parameters, known).encode()}
    raise PicoError(wrong or error("no-lab", "no Lab here", hint="`pico init` makes one"))


def _with(
    document: Document, name: str, serial: str, kind: str | None, parameters: Mapping[str, Value], known: Known | None
) -> str:  # fmt: skip
    inventory = document.root.get("inventory") if isinstance(document.root, Map) else None
    entries = inventory.entries if isinstance(inventory, Map) else {}
    if name not in entries:
        hint = did_you_mean(name[:40], entries) or "`pico catalog parts` lists them"
        raise PicoError(error("unknown-component", f"there is no component `{name[:40]}`", hint=hint))
    key, part = entries[name]
    if not isinstance(part, Map):
        raise PicoError(error("edit", f"{name} is no mapping in the inventory", hint="write its `type:` first"))
    editor, wanted = Editor(document), {"serial": serial, **({"type": kind} if kind else {})}
    added: dict[str, Any] = {}
    for entry, value in wanted.items():
        if entry in part.entries:
            editor.set_scalar(*part.entries[entry], value)
        else:
            added[entry] = value
    own = part.entries.get("parameters")
    if parameters and own and isinstance(own[1], Map) and own[1].entries:
        fresh = {k: v for k, v in parameters.items() if k not in own[1].entries}
        for entry in parameters.keys() & own[1].entries.keys():
            editor.set_scalar(*own[1].entries[entry], parameters[entry])
        if fresh:
            editor.insert(own[0], own[1], fresh, str, flow=part.flow)
    elif parameters:
        added["parameters"] = dict(parameters)
    was = part.entries.get("serial")
    other = was is None or not isinstance(was[1], Scalar) or was[1].text != serial
    added |= _measured(editor, part, parameters, as_json(known) if known else None, other)
    if added:
        editor.insert(key, part, added, lambda entry: _ORDER.get(entry, 9), flow=part.flow)
    return apply_splices(document.source.content, editor.splices)


def _measured(
    editor: Editor, part: Map, parameters: Mapping[str, Value], known: dict[str, Any] | None, other: bool
) -> dict[str, Any]:  # fmt: skip
    """Return what is added of how well numbers of a part are known, once what no longer holds is taken out: what was
    measured of another specimen, and of numbers that are given anew."""
    fresh = dict.fromkeys(parameters, known) if known else {}
    before = part.entries.get("measured")
    if before is None:
        return {"measured": fresh} if fresh else {}
    kept = plain(before[1]) if not other and isinstance(before[1], Map) else {}
    now = {**{name: one for name, one in kept.items() if name not in parameters}, **fresh}
    if now:
        editor.replace(*before, "measured", now, flow=part.flow, step=2)
    else:
        editor.remove(part, "measured")
    return {}
