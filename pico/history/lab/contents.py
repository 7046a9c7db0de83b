"""A commit of a lab, and what it takes: manifests and notes that differ from HEAD, all or those of some components."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.lab.folder import LabFolder
from pico.history.lab.notes import is_note, note_path
from pico.history.lab.run_files import run_trailers, write_once
from pico.history.messages.trailers import (
    BENCH,
    EVIDENCE,
    HAND,
    LAB,
    META,
    NO_HAND,
    RUN,
    STATE,
    require_meta,
    with_trailers,
)  # fmt: skip
from pico.history.writing.in_progress import require_resolved
from pico.manifest.edit import components_of
from pico.manifest.file_names import is_manifest
from pico.manifest.load import load_files
from pico.model.address import Named
from pico.model.diff import Change
from pico.model.record import record
from pico.model.state import LabState
from pico.model.trace.report import Committed

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


def commit(
    folder: LabFolder,
    message: str,
    captured: tuple[Change, ...],
    evidence: str,
    *,
    runs: Mapping[str, bytes] = MappingProxyType({}),
    meta: Mapping[str, str] = MappingProxyType({}),
    named: Named | None = None,
    hands: Iterable[str] | None = None,
    empty: bool = False,
) -> Committed:
    """Commit the manifests as they are, with notes and the files of runs, and return the commit; raises PicoError.

    `runs`: files by path relative to the lab, `runs/YYYY/MM/<run id>/...`; written here, never over another file.
    `meta`: what `--meta key=value` gave. `named`: only files that hold these components. Trailers say the digest of
    the state and of the lab, the `evidence`, the runs with their plans, and `meta`; they go into the block of
    trailers that `message` has. Where a merge is under way, this ends it. `hands`: what was changed on the bench by
    hand, of that which no run changed, by address; None where runs changed all. `empty`: also where nothing changed.
    """
    require_meta(meta)
    repository = folder.history()
    with folder.writing("pico commit"):
        ending = require_resolved(repository.root, repository.own)
        content = contents(folder, None if ending else named)
        if not (content.paths or runs or ending or empty):
            raise PicoError([*repository.noticed, nothing(named)])
        written = [write_once(folder.root, path, data) for path, data in sorted(runs.items())]
        digest, lab = content.state.digest(), folder.setup.lab
        added = [(STATE, digest), (EVIDENCE, evidence), (LAB, f"{lab.name} {folder.described.digest()}")]
        added += [(BENCH, folder.place.title)] if folder.place is not None and evidence != "planned" else []
        added += [] if hands is None else [(HAND, ", ".join(sorted(hands)) or NO_HAND)]
        added += [*run_trailers(runs), *((META, f"{key}={value}") for key, value in sorted(meta.items()))]
        text = with_trailers(message, added)
        before = repository.head().commit
        made = repository.commit(content.paths, text, ignored=written, whole=bool(ending), empty=empty)
    return Committed(
        commit=made.id,
        message=message.strip(),
        branch=repository.head().branch,
        state=digest,
        changes=folder.since(before, (folder.setup, content.state)),
        captured=captured,
        realized=evidence != "planned",
        evidence=evidence,
        bench=folder.place.title if folder.place is not None and evidence != "planned" else None,
        runs=tuple(value for key, value in run_trailers(runs) if key == RUN),
        meta=meta,
        diagnostics=repository.noticed,
    )


def nothing(named: Named | None) -> Diagnostic:
    """Return what to say where there is nothing to commit."""
    what = f"the files that hold {', '.join(sorted(named))}" if named else "manifests and notes"
    hint = "`pico status` shows the bench; `--allow-empty` commits all the same"
    text = f"nothing to commit: {what} are as in HEAD, and there is no run for it"
    return error("nothing-to-commit", text, hint=hint)


def _text(folder: LabFolder, path: str) -> bytes | None:
    """Return a file of the working tree, by its path from the lab; None where there is none."""
    place = folder.root / path
    return place.read_bytes() if place.is_file() else None


def _holds(named: Named, path: str, text: bytes | None, then: Mapping[str, bytes]) -> bool:
    if is_note(path):
        return any(path == note_path(name) for name in named)
    return any(named.keys() & components_of(data) for data in (text, then.get(path)) if data)
