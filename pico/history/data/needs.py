"""Which objects the runs of a lab need, and which run needs which."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error
from pico.history.git import command as git
from pico.history.repository.repository import Repository
from pico.model.record import as_json, record
from pico.places.bench import local_benches
from pico.places.lab import FOLDER

_RUN = re.compile(r"(?:.*/)?runs/\d{4}/\d{2}/([^/]+)/run\.json")
LARGEST = 16 << 20
"""Bytes above which nothing is the document of a run; `pico.runs.reading` is stricter."""
_SHA256 = re.compile(r"[0-9a-f]{64}")
# What Git does not know: files of runs that were not committed yet, and the journal of a bench.
_JOURNALS = ":(glob)**/.pico/benches/*/journal.sqlite"
_LOOSE = (":(glob)**/runs/*/*/*/run.json", ":(glob)**/.pico/journal.sqlite", _JOURNALS)


@record
class Need:
    """An object of `size` bytes, and the runs (their ids) that name it as their artifact, called `name`."""

    sha256: str
    size: int
    name: str
    runs: tuple[str, ...]


Needs = Mapping[str, Need]
"""By SHA-256, sorted."""


def needs(repository: Repository, revisions: Iterable[str] = ("--all",)) -> Needs:
    """Return what the runs in the commits of every ref need, or those in the commits of `revisions`.

    Raises PicoError where the history can't be walked.
    """
    return united(_needed_by(run, data) for run, data in _committed(repository, tuple(revisions)))


def kept_needs(repository: Repository) -> Needs:
    """Return what anything here may need still: runs of every ref, reflog, index and working tree, and runs in the
    journal of a bench that no commit has yet. Raises PicoError where that can't be told for sure.
    """
    committed = _committed(repository, ("--all", "--reflog", "--indexed-objects"))
    found = [_needed_by(run, data) for run, data in committed]
    for tree in _worktrees(repository):
        labs = set[Path]()
        for path in _loose(tree):
            if path.name == "run.json":
                found.append(_needed_by(path.parent.name, path.read_bytes() if _readable(path) else b""))
            else:
                labs.add(next(one for one in path.parents if one.name == FOLDER).parent)
        for lab in sorted(labs):
            found += _waiting(lab)
    return united(found)


def united(found: Iterable[Iterable[Need]]) -> Needs:
    """Return what is needed altogether, each object once, with all runs that need it."""
    objects: dict[str, Need] = {}
    for need in (n for several in found for n in several):
        known = objects.get(need.sha256, need)
        runs = tuple(sorted({*known.runs, *need.runs}))
        objects[need.sha256] = Need(sha256=need.sha256, size=known.size, name=known.name, runs=runs)
    return dict(sorted(objects.items()))


def _committed(repository: Repository, revisions: tuple[str, ...]) -> Iterator[tuple[str, bytes]]:
    """Yield id and document of each run in the trees of commits; git passes over trees that it has seen."""
    repository.complete(documents=True)
    arguments = ["rev-list", "--objects", "--missing=allow-promisor", *revisions]
    listed = git.run(repository.root, arguments, doing="list what commits hold")
    for line in listed.split("\n"):
        name, _, path = line.partition(" ")
        if path.endswith("/run.json") and (match := _RUN.fullmatch(path)):
            found = repository.handle[name]
            if found.type_str == "blob" and found.size <= LARGEST:
                yield match[1], found.data


def _needed_by(run: str, document: bytes) -> tuple[Need, ...]:
    """Return what a run needs as its document says; nothing where that is no document of a run.

    Read more generously than `pico.runs.reading` does: what the run of a newer PICO needs must be kept, too.
    """
    try:
        artifacts = json.loads(document).get("artifacts", ())
        return tuple(_need(run, a) for a in artifacts if _SHA256.fullmatch(str(a["sha256"])))
    except (ValueError, TypeError, KeyError, AttributeError, ArithmeticError, RecursionError):
        return ()


def _need(run: str, artifact: Mapping[str, Any]) -> Need:
    name, size = _plain(str(artifact["name"])), max(0, int(artifact["size"]))
    return Need(sha256=artifact["sha256"], size=size, name=name, runs=(_plain(run),))


def _plain(name: str) -> str:
    """Return a name as it may be shown: a repository of somebody else could hold one that rules a terminal."""
    return "".join(c if c.isprintable() else "?" for c in name[:100])


def _worktrees(repository: Repository) -> Iterator[Path]:
    listed = git.run(repository.root, ["worktree", "list", "--porcelain", "-z"], doing="list the worktrees")
    for entry in listed.split("\0"):
        path = Path(entry.removeprefix("worktree "))
        if entry.startswith("worktree ") and path.is_dir():
            yield path


def _loose(tree: Path) -> Iterator[Path]:
    found = git.run(tree, ["ls-files", "-z", "--others", "--", *_LOOSE], doing="list the files that are not committed")
    yield from (tree / name for name in found.split("\0") if name)


def _readable(path: Path) -> bool:
    return path.is_file() and not path.is_symlink() and path.stat().st_size <= LARGEST


def _waiting(root: Path) -> list[tuple[Need, ...]]:
    """Return what the runs in the journals of the benches in `root` need that no commit has yet."""
    from pico.history.lab.folder import LabFolder
    from pico.history.runs import unrecorded

    try:
        runs = [run for place in local_benches(root) for run in unrecorded(LabFolder(root, place=place))]
    except PicoError as exc:
        text = f"nobody can tell what the runs of the benches in {root} need still, so nothing is removed"
        hint = "`pico validate` there says what is wrong with it"
        raise PicoError((error("data-needs", text, hint=hint), *exc.diagnostics)) from exc
    return [tuple(_need(run.document.id, as_json(a)) for a in run.document.artifacts) for run in runs]
