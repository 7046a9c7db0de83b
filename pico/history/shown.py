"""One revision as `pico show` has it: the commit, what it did, and the state that it holds, or one component of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.lab.folder import CommitEntry, LabFolder
from pico.history.lab.notes import Note, note_path, notes
from pico.history.runs.committed import runs_added
from pico.history.runs.proof import Standings
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.state import LabState


@record
class Shown:
    """A commit with the bench and the state as it holds them; of `component` alone, where one was named.

    `notes`: by component, those that it holds on what it changed, or on `component`.
    """

    entry: CommitEntry
    setup: Setup
    state: LabState
    component: str | None = None
    notes: dict[str, tuple[Note, ...]]


def show(folder: LabFolder, what: str) -> Shown:
    """Return what `REV` or `REV:COMPONENT` names; raises PicoError."""
    revision, component = _split(folder, what)
    repository = folder.history()
    commit = repository.resolve(revision)
    setup, state = folder.historic(commit.id)
    if component is not None and component not in setup.lab.inventory:
        raise PicoError(_no_component(revision, component, setup.lab.inventory))
    entry = folder.entry(commit)
    runs = runs_added(repository, commit, folder.root)
    kept = tuple(c for c in entry.changes if component in (None, c.component))
    entry = replace(entry, changes=kept, runs=runs, standing=Standings(folder).of(commit, state.digest()))
    about = [component] if component else sorted({c.component for c in kept})
    return Shown(entry=entry, setup=setup, state=state, component=component, notes=_notes(folder, commit.id, about))


def _split(folder: LabFolder, what: str) -> tuple[str, str | None]:
    """Return the revision and the component; a colon in braces or first is git's (`HEAD^{/fix: p2}`, `:/fix`)."""
    revision, sign, component = what.rpartition(":")
    if not sign or not revision or "}" in component or what.startswith(":"):
        return what, None
    return revision, component


def _no_component(revision: str, name: str, known: Iterable[str]) -> Diagnostic:
    if "/" in name or name.endswith((".yaml", ".md")):
        return error("unknown-component", f"`{name}` is a file", hint=f"`git show {revision}:./{name}` prints it")
    hint = did_you_mean(name, known) or f"`pico show {revision}` lists them"
    return error("unknown-component", f"the lab had no component `{name}` at {revision}", hint=hint)


def _notes(folder: LabFolder, commit: str, parts: Iterable[str]) -> dict[str, tuple[Note, ...]]:
    repository = folder.history()
    inside, tree = repository.relative(folder.root), repository.handle[commit].tree
    found = {}
    for part in parts:
        path = f"{inside}/{note_path(part)}" if inside else note_path(part)
        try:
            data = bytes(tree[path].data)
        except (KeyError, AttributeError):  # none, or no file
            continue
        if said := notes({note_path(part): data}, part):
            found[part] = said
    return found
