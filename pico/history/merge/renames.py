"""Parts that one side of a merge renamed (`formerly:` in its inventory): the other versions call them so, too.

Then the merge sees one part under one name, and what the other side changed of it is merged with the rest. The same
holds for a renaming that one side takes back. A part is paired only if the base and the other side have one of the two
names, and the side that renamed it the other.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import PurePosixPath

from pico.history.merge.groups import is_lab
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.places import find
from pico.manifest.text.splice import Splice, apply_splices
from pico.manifest.text.tree import Document, List, Map, Scalar, parse

Files = dict[str, bytes]
_NAMED: Mapping[str, str] = {"Lab": "inventory", "LabState": "components"}
"""The block of a manifest whose keys are names of parts, by kind."""
_BOM = "\ufeff"


def called_alike(base: Files, ours: Files, theirs: Files, labs: Collection[str]) -> tuple[Files, Files, Files]:
    """Return three versions of files in which a part that one side renamed has its new name in all of them. `labs`: the
    folders of labs, each with names of its own."""
    names = {lab: found for lab in labs if (found := _renamed(lab, base, ours, theirs, labs))}
    if not names:
        return base, ours, theirs

    def called(files: Files) -> Files:
        return {p: _called(data, names.get(_lab_of(p, labs) or "", {})) for p, data in files.items()}

    return called(base), called(ours), called(theirs)


def _renamed(lab: str, base: Files, ours: Files, theirs: Files, labs: Collection[str]) -> dict[str, str]:
    """Return the names that one side gave to parts of a lab, by those that they have in the base and the other side: a
    new one, or, if that side takes a renaming back, the former one."""
    was, mine, other = (_inventory(lab, files, labs) for files in (base, ours, theirs))
    found: dict[str, str] = {}
    for side, beside in ((mine, other), (other, mine)):
        for declared, goes_back in ((side, False), (was, True)):
            for new, former in declared.items():
                for old in former:
                    before, after = (new, old) if goes_back else (old, new)
                    there = all(before in parts and after not in parts for parts in (was, beside))
                    if there and after in side and before not in side:
                        found[before] = after
    names = list(found.values())
    return {before: after for before, after in found.items() if names.count(after) == 1}


def _inventory(lab: str, files: Files, labs: Collection[str]) -> dict[str, tuple[str, ...]]:
    """Return the parts of a lab by name, each with its former names, as far as its files can be read."""
    found: dict[str, tuple[str, ...]] = {}
    for path, data in files.items():
        for document in _documents(data) if is_lab(data) and _lab_of(path, labs) == lab else ():
            entry = find(document, "inventory")
            parts = entry[1].entries if kind_of(document)[0] == "Lab" and entry and isinstance(entry[1], Map) else {}
            for name in parts:
                former = find(document, "inventory", name, "formerly")
                listed = former[1].items if former and isinstance(former[1], List) else ()
                found[name] = tuple(str(one.value) for one in listed if isinstance(one, Scalar))
    return found


def _called(data: bytes, names: Mapping[str, str]) -> bytes:
    """Return a manifest that calls parts by other names."""
    if not names:
        return data
    splices: list[Splice] = []
    text = ""
    for document in _documents(data):
        text, entry = document.source.content, find(document, _NAMED.get(kind_of(document)[0] or "", ""))
        for old, (key, _) in (entry[1].entries if entry and isinstance(entry[1], Map) else {}).items():
            if old in names:
                splices.append(Splice(key.start, key.end, names[old]))
    mark = _BOM if data.startswith(_BOM.encode()) else ""
    return (mark + apply_splices(text, splices)).encode() if splices else data


def _documents(data: bytes) -> list[Document]:
    source, _ = decode("manifest", data)
    documents, wrong = parse(source) if source else ([], True)
    return [] if wrong else list(documents)


def _lab_of(path: str, labs: Collection[str]) -> str | None:
    """Return the folder of the lab that a file belongs to: the nearest above it."""
    return next((str(folder) for folder in PurePosixPath(path).parents if str(folder) in labs), None)
