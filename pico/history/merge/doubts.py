"""What git's own merge could not see: a component that one side took out and the other moved, and that is there now.

Git merges file by file: in one file both took the component out, in the other one side put something new.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.messages.trailers import STATE, values
from pico.history.repository.repository import Repository
from pico.manifest.load import Manifests, load_files
from pico.manifest.text.places import find
from pico.model.state import LabState


def require_settled(
    repository: Repository | None, root: Path, manifests: Manifests, commit: str | None, named: Collection[str]
) -> None:
    """Raise PicoError where what is wanted (of the components `named`, or at all) came out of a merge that nobody has
    looked at; see `unsettled`."""
    about = {address.partition(".")[0] for address in named}
    if found := [d for d in unsettled(repository, root, manifests, commit) if not about or d.address in about]:
        raise PicoError(found)


def doubts_in(root: Path, manifests: Manifests) -> list[Diagnostic]:
    """Return what `unsettled` says of the lab in `root`; nothing where the repository around it can't be read."""
    try:
        return unsettled(Repository.discover(root), root, manifests)
    except PicoError:
        return []


def unsettled(
    repository: Repository | None, root: Path, manifests: Manifests, commit: str | None = None
) -> list[Diagnostic]:
    """Return an error for each component of `manifests` that one side of a merge took out and the other moved.

    `manifests` are those of the lab in `root` at `commit`, or of the working tree. Only a merge that plain git made
    there, or that is under way, is asked: what PICO committed was looked at, and so was what a person edited or
    committed upon.
    """
    if repository is None or repository.handle.head_is_unborn:
        return []
    handle = repository.handle
    at = commit or str(handle.head.target)
    begun = repository.own / "MERGE_HEAD"
    underway = commit is None and begun.is_file()
    sides = (
        [at, *begun.read_text(encoding="utf-8").split()]
        if underway
        else [str(parent) for parent in handle[at].parent_ids]
    )
    if len(sides) != 2 or (not underway and values(handle[at].message, STATE)):
        return []
    found = _moved_and_out(repository, root, sides)
    there = {n for n in found if any(find(d, "components", n) for d in manifests.documents.get("LabState", ()))}
    if there and not underway:
        merged = load_files(repository.files(at, root), setup=manifests.setup).state
        there = set() if _later(repository, at) else there - _edited(merged, manifests.state)
    return [_told(name, *found[name], "" if underway else at, manifests) for name in sorted(there)]


def _edited(merged: LabState | None, wanted: LabState | None) -> set[str]:
    """Return the components that are not wanted as the merge left them; none where either can't be read."""
    if merged is None or wanted is None:
        return set()
    return {name for name, part in merged.components.items() if wanted.components.get(name) != part}


def _moved_and_out(repository: Repository, root: Path, sides: Sequence[str]) -> dict[str, tuple[str, str, str]]:
    """Return the components that one of two commits took out and the other moved: by whom, and to which file."""
    from pico.history.merge.trees import alike

    handle, inside = repository.handle, repository.relative(root)
    base = handle.merge_base(*sides) if all(side in handle for side in sides) else None
    if base is None:  # no history in common, or a clone that has not all of it
        return {}
    made = alike(handle, [handle[str(name)].tree for name in (base, *sides)])
    here = [c for path, c in made.conflicts if c.out is not None and (not inside or path.startswith(f"{inside}/"))]
    return {c.path[2]: (sides[c.out], sides[1 - c.out], c.files[0]) for c in here if c.out is not None}


def _later(repository: Repository, commit: str) -> bool:
    """Return whether a branch or tag goes on from a commit."""
    tips = {repository.resolve(name).id for name in repository.tips()}
    return any(tip != commit and repository.handle.descendant_of(tip, commit) for tip in tips)


def _told(name: str, took: str, moved: str, path: str, merge: str, manifests: Manifests) -> Diagnostic:
    ends = '`git commit --allow-empty -m "why"`' if merge else "`pico commit`, which ends the merge"
    kept = f"git's merge {merge[:7]}" if merge else "git's merge"
    return error(
        "merge-conflict",
        f"{name}: {took[:7]} took it out, {moved[:7]} moved it to {path}, and {kept} kept it",
        detail="git merges file by file, and in no file did both change it",
        hint=f"if it shall go, take it out of {path}; if it shall stay, say so with {ends}",
        address=name,
        source=manifests.source(name),
    )
