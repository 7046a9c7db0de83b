"""What a live bench changes in manifests, by the names that parts have now or, in older files, had before."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pico.manifest.changes import NONE, Changes, differences
from pico.manifest.edit import components_of, spliced
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.places import find
from pico.manifest.text.splice import Splice, apply_splices
from pico.manifest.text.tree import Map, parse
from pico.model.address import Named, Renaming, renaming_of
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import LabState


def capture(
    files: Mapping[str, bytes], setup: Setup, wanted: LabState, live: LabState, named: Named | None = None,
    known: Collection[str] | None = None, found: Mapping[str, Value] = NONE,
) -> dict[str, bytes]:  # fmt: skip
    """Return the manifests that must change for the files' state (`wanted`) to say what `live` is.

    Only values that differ beyond tolerance change, those that light `found` (by address) also within it, and of these
    only those `named`. A component that no file names is put into the file that holds most. `known`: the parts of the
    Lab that the files describe, if it is not that of `setup`. Raises PicoError for files that hold no LabState, or one
    that can't be written to.
    """
    return with_changes(files, setup, differences(setup, wanted, live, named, found), known)


def with_changes(
    files: Mapping[str, bytes], setup: Setup, changes: Changes, known: Collection[str] | None = None
) -> dict[str, bytes]:
    """Return the manifests that must change for `changes` to be made in them, components by their present names if the
    Lab that the files describe has those (its parts: `known`). Raises PicoError as `capture` does."""
    names, parts = renaming_of(setup.lab), setup.lab.inventory if known is None else known
    made = spliced(files, _as_files_name(files, changes, names, parts))
    return {**made, **_with_present_names({**files, **made}, names, parts)} if made else {}


def _as_files_name(files: Mapping[str, bytes], changes: Changes, names: Renaming, known: Collection[str]) -> Changes:
    """Return changes by the names that the files use: those of a component that stands there under a former name, and
    of one that the files' own Lab (its parts: `known`) has under a former name only."""
    if not names:
        return changes
    held = frozenset().union(*(components_of(data) for data in files.values()))
    return {_called(name, names, held, known): wanted for name, wanted in changes.items()}


def _called(name: str, names: Renaming, held: Collection[str], known: Collection[str]) -> str:
    former = [old for old, new in names.items() if new == name]
    if name in held or not former:
        return name
    there = next((old for old in former if old in held), "")
    return there or next((old for old in former if name not in known and old in known), name)


def _with_present_names(files: Mapping[str, bytes], names: Renaming, known: Collection[str]) -> dict[str, bytes]:
    """Return the manifests that must change for each component that the files' own Lab has (`known`) to stand there
    under its present name."""
    wanted = {old: new for old, new in names.items() if new in known}
    held = {path: components_of(data) & wanted.keys() for path, data in files.items()} if wanted else {}
    return {path: _renamed(files[path], {old: wanted[old] for old in found}) for path, found in held.items() if found}


def _renamed(data: bytes, names: Renaming) -> bytes:
    source, _ = decode("manifest", data)
    assert source is not None  # it holds components
    splices = []
    for document in parse(source)[0]:
        entry = find(document, "components") if kind_of(document)[0] == "LabState" else None
        for old, (key, _) in (entry[1].entries if entry and isinstance(entry[1], Map) else {}).items():
            if old in names:
                splices.append(Splice(key.start, key.end, names[old]))
    mark = "\ufeff" if data.startswith("\ufeff".encode()) else ""
    return (mark + apply_splices(source.content, splices)).encode("utf-8")
