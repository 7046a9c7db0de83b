"""What HEAD has of a lab and its folder has not: what somebody deleted, and what git keeps out of the folder; and what
a revision has no more that the one before it had."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, PicoError
from pico.history.git import command as git
from pico.history.git.trees import Odd, manifests
from pico.history.git.unread import content_of, no_copies, submodule
from pico.history.git.unread import modules as modules_of
from pico.history.lab.unread_states import unread_states
from pico.manifest.edit import components_of
from pico.manifest.file_names import AWAY, GONE, about, declares_api, is_recipe, left_out, set_aside
from pico.manifest.files import shown_path
from pico.manifest.links import small_state

if TYPE_CHECKING:
    from pico.history.repository.repository import Repository

_GOES = "if its parts are to go home: `git rm --cached --sparse {0}`, and commit"
_SPARSE = f"bring it back: `git sparse-checkout disable`, or `git update-index --no-skip-worktree {{0}}`; {_GOES}"
_ASSUMED = f"bring it back: `git update-index --no-assume-unchanged {{0}}` and `git restore {{0}}`; {_GOES}"


def missing_files(
    root: Path,
    files: Mapping[str, bytes],
    found: Sequence[Diagnostic],
    around: Callable[[], Repository | None] | None = None,
) -> list[Diagnostic]:
    """Return an error for each manifest that HEAD has and git keeps out of the lab's folder `root`, and for submodules
    that are not checked out; a note for what somebody deleted, of the parts that go home by that.

    `files` were read, by shown path; of the paths in `found` an error is told already. Nothing without Git, or where
    the repository (`around` it) can't be read.
    """
    from pico.history.repository.repository import Repository

    try:
        repository = around() if around else Repository.discover(root)
    except PicoError:
        return []
    tree = repository.tree_at("HEAD", root) if repository and repository.head().commit else None
    return _missing(repository, root, tree, files, found) if repository and tree else []


def _missing(
    repository: Repository, root: Path, tree: Any, files: Mapping[str, bytes], found: Sequence[Diagnostic]
) -> list[Diagnostic]:
    from pygit2.enums import FileMode

    shown = shown_path(root)
    read = {os.path.relpath(path, shown): data for path, data in files.items()}
    told = [os.path.relpath(d.source.path, shown) for d in found if d.source and d.severity == "error"]
    odd: list[Odd] = []
    aside: list[Odd] = []
    there = dict(manifests(tree, odd, aside=aside))
    away = {p: e for p, e in there.items() if p not in read and not any(f"{p}/".startswith(f"{t}/") for t in told)}
    modules = {p: e for p, e in odd if e.filemode == FileMode.COMMIT and _empty(root / p)}
    said = _in_folders_with_a_dot(root, no_copies([(p, e) for p, e in aside if "/." in f"/{p}"], read))
    gone = named_no_more({p: e for p, e in there.items() if p in read}, read)
    if not (away or modules):
        return [*said, *_gone(root, gone, files)]
    lead = f"{inside}/" if (inside := repository.relative(root)) else ""
    tags = {p.removeprefix(lead): tag for p, tag in _tags(repository, inside).items()}
    lost = [(path, content_of(entry) or b"") for path, entry in sorted(away.items())]
    lost = [(path, data) for path, data in lost if declares_api(data) and not is_recipe(data)]
    kept_out = [_kept_out(root, path, tags.get(path, ""), there.keys()) for path, _ in lost]
    gone |= {path: components_of(data) for (path, data), d in zip(lost, kept_out, strict=True) if d is None}
    kept_out += [submodule(repository, lead + p, str(e.id), _shown(root, p)) for p, e in modules.items() if p in tags]
    return [*said, *(d for d in kept_out if d), *_gone(root, gone, files)]


def named_no_more(there: Mapping[str, Any], files: Mapping[str, bytes]) -> dict[str, frozenset[str]]:
    """Return the parts that each manifest of a tree (`there`) names which names none in `files`, or is not there."""
    import pygit2

    emptied = {
        path: entry
        for path, entry in there.items()
        if path not in files or (pygit2.hash(files[path]) != entry.id and not components_of(files[path]))
    }
    return {path: components_of(content_of(entry) or b"") for path, entry in emptied.items()}


def gone_at(repository: Repository, root: Path, revision: str, files: Mapping[str, bytes]) -> list[Diagnostic]:
    """Return a note for each manifest of the lab in `root` that a revision, which has `files`, deleted or emptied
    against its first parent, of the parts that go home by that."""
    try:
        tree = repository.tree_at(f"{revision}^", root)
    except PicoError:  # the first commit, or one whose parents a shallow clone lacks
        return []
    there = dict(manifests(tree, module=modules_of(repository, repository.relative(root)))) if tree else {}
    hint = f"`git diff {revision}^ {revision}` shows it"
    homeless = _homeless(named_no_more(there, files), files)
    return [_note(f"{revision}:{p}", p in files, "in this commit", parts, hint) for p, parts in homeless.items()]


def _in_folders_with_a_dot(root: Path, aside: Iterable[Odd]) -> list[Diagnostic]:
    """Return what to weigh of files of HEAD in folders that are not read."""
    found: list[Diagnostic] = []
    for path, _ in aside:
        if left_out(path):
            with suppress(OSError):
                found += set_aside(_shown(root, path), small_state(root / path))
    return found


def _empty(folder: Path) -> bool:
    try:
        return not any(folder.iterdir())
    except FileNotFoundError:
        return True
    except OSError:  # no folder, or one that is told to be unreadable
        return False


def _tags(repository: Repository, inside: str) -> dict[str, str]:
    """Return what git holds of each file that it knows in a folder: `H`, `S` where sparse checkout leaves it out, in
    lower case where it is taken for unchanged."""
    arguments = ["ls-files", "-v", "-z", "--", inside or "."]
    extra = {"GIT_LITERAL_PATHSPECS": "1"}
    listed = git.run(repository.root, arguments, doing="list the files that it knows", extra=extra)
    return {line[2:]: line[0] for line in listed.split("\0") if line}


def _kept_out(root: Path, path: str, tag: str, there: Iterable[str]) -> Diagnostic | None:
    """Return why a manifest of HEAD is not in the folder; None where somebody deleted it."""
    shown = _shown(root, path)
    if tag in ("S", "s"):
        return about(shown, "withheld", "HEAD has it, and sparse checkout leaves it out", _SPARSE.format(path))
    if tag.islower():
        text = "HEAD has it, and git is told to take it for unchanged; but it is not there"
        return about(shown, "withheld", text, _ASSUMED.format(path))
    if tag and any(p != path and p.lower() == path.lower() for p in there) and os.path.lexists(root / path):
        hint = "rename one of the two, where case counts, and commit"
        return about(shown, "withheld", "HEAD has another file that differs in case alone", hint)
    return None


def _gone(root: Path, gone: Mapping[str, frozenset[str]], files: Mapping[str, bytes]) -> list[Diagnostic]:
    """Return a note for each file of HEAD that is not there or empty, of its parts that no other file names; an error
    where a link may hide it, or a file that is not read names them."""
    homeless = _homeless(gone, files)
    emptied = {path for path in homeless if _shown(root, path) in files}
    sought = {part for path, parts in homeless.items() if path not in emptied for part in parts}
    kept = unread_states(root, sought) if sought else {}
    return [
        (None if path in emptied else _hidden(root, path)) or _lost(root, path, parts, kept, emptied=path in emptied)
        for path, parts in homeless.items()
    ]


def _homeless(gone: Mapping[str, frozenset[str]], files: Mapping[str, bytes]) -> dict[str, list[str]]:
    """Return of the parts in each file that is `gone` those that no other file names."""
    if not any(gone.values()):
        return {}
    named = frozenset().union(*(components_of(data) for data in files.values()))
    return {path: sorted(parts - named) for path, parts in gone.items() if parts - named}


def _lost(root: Path, path: str, parts: Sequence[str], kept: Mapping[str, str], *, emptied: bool) -> Diagnostic:
    """Return what to say of the `parts` of a file of HEAD that is gone; some are `kept` in other files."""
    shown = _shown(root, path)
    if holder := next((kept[part] for part in parts if part in kept), None):
        names = ", ".join(part for part in parts if kept.get(part) == holder)
        text = f"a state with {names} that is not read, and {shown} of HEAD is not there"
        goes = f"if {names} shall go home: {AWAY}"
        hint = f"`mv {quote(holder)} {quote(path)}`; {goes}"
        return about(_shown(root, holder), "name", text, hint)
    return _note(shown, emptied, "since HEAD", parts, f"`git restore --staged --worktree {path}` brings it back")


def _note(shown: str, emptied: bool, since: str, parts: Sequence[str], hint: str) -> Diagnostic:
    done = "no part is left" if emptied else "deleted"
    text = f"{done} {since}, and no other file names {', '.join(parts)}: not wanted on the table"
    return replace(about(shown, GONE, text, hint), severity="note")


def _hidden(root: Path, path: str) -> Diagnostic | None:
    """Return what to say of a file of HEAD where a link is in place of a folder above it."""
    above = [root.joinpath(*Path(path).parts[:n]) for n in range(1, len(Path(path).parts))]
    link = next((folder for folder in above if folder.is_symlink()), None)
    hint = f"put the folder itself there: `git restore {path}`"
    text = "HEAD has it, and it is not read: {} is a link"
    return about(_shown(root, path), "withheld", text.format(link.name), hint) if link else None


def _shown(root: Path, path: str) -> str:
    return str(Path(shown_path(root)) / path)
