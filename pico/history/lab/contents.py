"""What a commit takes: the manifests and notes that differ from HEAD, all or those that hold some components."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, error
from pico.history.lab.notes import is_note, note_path
from pico.manifest.edit import components_of
from pico.manifest.load import load_files
from pico.manifest.which import is_manifest
from pico.model.address import Named
from pico.model.record import record
from pico.model.state import LabState

if TYPE_CHECKING:
    from pico.history.lab.folder import LabFolder


_BESIDE = (".gitattributes", ".gitignore")
"""What `pico init` writes beside the manifests: the first commit of a lab takes it along, so that clones have it."""


@record
class Contents:
    """What a commit takes: `paths` from the top of the repository, and the state that it then holds.

    `components`: those in the manifests among them; None for all there are.
    """

    paths: tuple[str, ...]
    state: LabState
    components: frozenset[str] | None = None


def contents(folder: LabFolder, named: Named | None = None) -> Contents:
    """Return what a commit would take; raises PicoError.

    `named`: only the files that hold these components, now or at HEAD, and the notes on them. What the other files say
    at HEAD must then make a valid state with these.
    """
    repository = folder.history()
    inside = repository.relative(folder.root)
    lead = f"{inside}/" if inside else ""
    own = {lead + name for name in _BESIDE} if named is None else set()
    paths = repository.changed(folder.root, lambda p: is_manifest(p) or is_note(p.removeprefix(lead)) or p in own)
    head = repository.head().commit
    known = head is not None and repository.holds(head, folder.root)
    unread: list[Diagnostic] = []
    asked = head and known and (named or own.intersection(paths))
    files = repository.files(head, folder.root, unread) if head and asked else {}
    if named is None:
        return Contents(paths=tuple(p for p in paths if not (files and p in own)), state=folder.state)
    texts = {path: _text(folder, path.removeprefix(lead)) for path in paths}
    holding = [p for p, text in texts.items() if _holds(named, p.removeprefix(lead), text, files)]
    held: set[str] = set()
    for path in (p.removeprefix(lead) for p in holding if is_manifest(p)):
        held |= components_of(files.pop(path, b""))
        text = texts[lead + path]
        if text is not None:
            files[path] = text
            held |= components_of(text)
    whole = {f"the commit:{path}": data for path, data in files.items()}
    state = load_files(whole, unread, setup=folder.setup).require()[1]
    return Contents(paths=tuple(holding), state=state, components=frozenset(held))


def nothing(named: Named | None) -> Diagnostic:
    """Return what to say where there is nothing to commit."""
    what = f"the files that hold {', '.join(sorted(named))}" if named else "the manifests"
    hint = "`pico status` shows the bench, `pico log` what there is"
    return error("nothing-to-commit", f"nothing to commit: {what} are as in HEAD", hint=hint)


def _text(folder: LabFolder, path: str) -> bytes | None:
    """Return a file of the working tree, by its path from the lab; None where there is none."""
    place = folder.root / path
    return place.read_bytes() if place.is_file() else None


def _holds(named: Named, path: str, text: bytes | None, then: Mapping[str, bytes]) -> bool:
    if is_note(path):
        return any(path == note_path(name) for name in named)
    return any(named.keys() & components_of(data) for data in (text, then.get(path)) if data)
