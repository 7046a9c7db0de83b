"""Manifests that call components as they were called before: what is written into them, and under which name."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pico.manifest.changes import Changes
from pico.manifest.edit import components_of
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.places import find
from pico.manifest.text.splice import Splice, apply_splices
from pico.manifest.text.tree import Map, parse
from pico.model.renaming import Renaming


def as_files_name(files: Mapping[str, bytes], changes: Changes, names: Renaming, known: Collection[str]) -> Changes:
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


def with_present_names(files: Mapping[str, bytes], names: Renaming, known: Collection[str]) -> dict[str, bytes]:
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
