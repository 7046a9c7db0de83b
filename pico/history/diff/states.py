"""What differs between two states in full: what moves, what is expected, the bench itself, text that says the same."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.diff.manifests import diff_files
from pico.history.diff.surroundings import components_in
from pico.history.lab.folder import LabFolder, between
from pico.history.lab.scope import Scope
from pico.history.repository.ranges import ends_of
from pico.manifest.files import read_folder, states_alone
from pico.model.address import renaming_of
from pico.model.diff import Change
from pico.model.record import record


@record
class StateDiff:
    """From state `a` to state `b`: revisions, `b` None for the working tree.

    `expected`: expectations that only one of the two has, (`+` or `-`, the expression). `bench`: files in which the lab
    itself differs. `text`: files that differ in text alone, comments and layout.
    """

    a: str
    b: str | None = None
    changes: tuple[Change, ...] = ()
    expected: tuple[tuple[str, str], ...] = ()
    bench: tuple[str, ...] = ()
    text: tuple[str, ...] = ()

    @property
    def same(self) -> bool:
        """Whether nothing differs, text included."""
        return not (self.changes or self.expected or self.bench or self.text)


def compare(folder: LabFolder, a: str | None = None, b: str | None = None, scope: Scope | None = None) -> StateDiff:
    """Return what differs from revision `a` (HEAD) to `b` (the working tree), exactly; raises PicoError.

    `a` may be a range, `A..B` or `A...B`. `scope`: only what it names, which one of the two states must know.
    """
    asked = scope or Scope()
    first, last = ends_of(folder.history(), a, b)
    first = first or "HEAD"
    if last is None and folder.wrong is not None:
        raise folder.wrong
    sides = folder.historic(first), folder.historic(last) if last else (folder.setup, folder.state)
    known = {name for setup, state in sides for name in (*setup.lab.inventory, *state.components)}
    known |= renaming_of(folder.setup.lab).keys() & asked.parts.keys()
    if wrong := [_unknown(name, known) for name in asked.parts if name not in known]:
        raise PicoError(wrong)
    old, new = _files(folder, first), _files(folder, last)
    differing = [p for p in sorted(old.keys() | new.keys()) if old.get(p) != new.get(p)]
    covered = [p for p in differing if asked.covers(p) and not asked.parts]
    held = {
        n
        for files in (old, new)
        for p, data in files.items()
        if asked.paths and asked.covers(p)
        for n in components_in(data)
    }
    text = tuple(p for p in covered if _only_text(old.get(p, b""), new.get(p, b""), folder.root / p))
    bench = tuple(p for p in covered if p not in text and (_of_bench(old.get(p)) or _of_bench(new.get(p))))
    return StateDiff(
        a=first,
        b=last,
        changes=asked.keep(between(*sides), held),
        expected=() if asked else _expected([e.that for e in sides[0][1].expect], [e.that for e in sides[1][1].expect]),
        bench=bench,
        text=text,
    )


def _files(folder: LabFolder, revision: str | None) -> Mapping[str, bytes]:
    """Return the manifests of a revision, or of the working tree, by path relative to the lab."""
    if revision:
        return folder.history().files(revision, folder.root)
    found, _ = read_folder(folder.root)
    return {Path(path).resolve().relative_to(folder.root).as_posix(): data for path, data in found.items()}


def _of_bench(data: bytes | None) -> bool:
    return data is not None and b"pico/" in data and not states_alone(data)


def _only_text(old: bytes, new: bytes, path: Path) -> bool:
    found = diff_files(old, new, path)
    return found is not None and not found.changes and not found.others


def _expected(old: Iterable[str], new: Iterable[str]) -> tuple[tuple[str, str], ...]:
    was, now = list(old), list(new)
    gone = tuple(("-", that) for that in was if that not in now)
    return gone + tuple(("+", that) for that in now if that not in was)


def _unknown(name: str, known: Iterable[str]) -> Diagnostic:
    hint = did_you_mean(name, known) or "`pico catalog parts` lists them"
    return error("unknown-component", f"neither state has a component `{name}`", hint=hint)
