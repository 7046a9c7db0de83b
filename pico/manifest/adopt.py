"""Parts that stand on the table taken into the manifests: an entry in the inventory, and where each stands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.edit import largest_state, set_values
from pico.manifest.files import decode
from pico.manifest.load import load_files
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.splice import Editor, apply_splices
from pico.manifest.text.tree import Document, Map, parse
from pico.model.pose import Pose
from pico.model.record import record


@record
class Adopted:
    """A part that is new in the inventory: its name, type and marker, its home slot, and where it stands now: in a
    `slot`, or at `pose`."""

    name: str
    type: str
    marker: int
    home: str
    slot: str | None = None
    pose: Pose | None = None


def adopt(files: Mapping[str, bytes], parts: Sequence[Adopted]) -> dict[str, bytes]:
    """Return the manifests that must change for `parts` to be in the inventory and in the state, by path.

    What is written there stays as it is. Raises PicoError where the result would not be right.
    """
    lab_path, document = _lab(files)
    state_path = largest_state(files)
    texts = dict(files)
    texts[lab_path] = _with_inventory(document, parts).encode("utf-8")
    places: dict[str, dict[str, Any]] = {p.name: {"slot": p.slot} if p.slot else {"pose": p.pose} for p in parts}
    texts[state_path] = set_values(texts[state_path].decode("utf-8"), places).encode("utf-8")
    load_files(texts).require()
    return {path: texts[path] for path in dict.fromkeys((lab_path, state_path))}


def _lab(files: Mapping[str, bytes]) -> tuple[str, Document]:
    for path, data in sorted(files.items()):
        source = decode(path, data)[0] if b"Lab" in data else None
        for document in parse(source)[0] if source else ():
            if kind_of(document)[0] == "Lab":
                return path, document
    raise PicoError(error("no-lab", "no Lab here", hint="`pico init` makes one"))


def _with_inventory(document: Document, parts: Sequence[Adopted]) -> str:
    root, editor = document.root, Editor(document)
    new = {p.name: {"type": p.type, "marker": p.marker, "home": p.home} for p in parts}
    if not isinstance(root, Map) or "inventory" not in root.entries:
        raise PicoError(_unusual())
    key, node = root.entries["inventory"]
    editor.insert(key, node, new, lambda name: name in new, flow=root.flow)
    return apply_splices(document.source.content, editor.splices)


def _unusual() -> Diagnostic:
    return error("edit", "the Lab has no `inventory` to write into", hint="add `inventory: {}` to it")
