"""Single components, or single tunables of them, taken from a revision into the manifests; the rest stays as it is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.history.lab.files import write_files
from pico.history.lab.folder import LabFolder
from pico.manifest.changes import Change as Entry
from pico.manifest.changes import entries
from pico.manifest.edit import set_values
from pico.manifest.files import read_folder, shown_path
from pico.manifest.load import Manifests, load_files
from pico.model.address import addresses, read_addresses
from pico.model.diff import Change, diff_states
from pico.model.state import LabState

_GONE = ("unknown-component", "unknown-slot")


@dataclass(frozen=True)
class SelectedParts:
    """Values of a revision as the manifests would hold them. `names`: what was asked for; `files`: those that must be
    written, by path, and what they hold `before`; `changes`: from the manifests as they are; `manifests`: what the lab
    then says."""

    revision: str
    names: tuple[str, ...]
    files: Mapping[str, bytes]
    before: Mapping[str, bytes]
    changes: tuple[Change, ...]
    manifests: Manifests

    def write(self, folder: LabFolder) -> None:
        """Write the files; raises PicoError, nothing written, where one of them was edited since this was computed."""
        with folder.writing("pico checkout"):
            now, _ = read_folder(folder.root)
            other = [path for path, data in self.before.items() if now.get(path) != data]
            if other:
                raise PicoError(error("edited", f"{', '.join(other)} was edited meanwhile", hint="try again"))
            write_files(Path(), self.files, folder.root / ".pico")
            folder.reload()


def select_parts(folder: LabFolder, revision: str, names: Iterable[str]) -> SelectedParts:
    """Return what the manifests must say for `names` (`p2`, `p1.angle`) to be as in a revision. Writes nothing.

    A component that the revision does not have goes home. Raises PicoError for what the lab does not have, for tunables
    of which an edit that is not committed would be lost (save to HEAD, for that can mean nothing else), and where the
    result is no valid state of this bench.
    """
    named = read_addresses(folder.setup, names)
    _, then = folder.historic(revision)
    wanted = {name: entries(folder.setup, name, some, then, folder.state) for name, some in named.items()}
    edits = {name: change for name, change in wanted.items() if change != {}}
    files, _ = read_folder(folder.root)
    written = _written(files, _owners(folder, revision, then, edits), edits)
    manifests = load_files({**files, **written}, setup=folder.setup)
    changes = diff_states(folder.setup, folder.state, manifests.require()[1])
    if revision not in ("HEAD", "@"):
        _refuse_edited(folder, changes)
    before = {path: files[path] for path in written}
    return SelectedParts(revision, tuple(addresses(named)), written, before, changes, manifests)


def state_for(folder: LabFolder, manifests: Manifests, revision: str, names: Iterable[str]) -> LabState:
    """Return the state of a revision, whose `manifests` were read against this bench, for a plan for `names` only.

    Other parts and slots that the bench has no more are no obstacle: they are left out. Raises PicoError.
    """
    named = read_addresses(folder.setup, names)
    wrong = [d for d in manifests.diagnostics if d.severity == "error"]
    gone = [d for d in wrong if d.code in _GONE and d.address.partition(".")[0] not in named]
    if not wrong or len(gone) < len(wrong):
        return manifests.require()[1]
    lab, state = folder.setup.lab, folder.historic(revision)[1]
    parts = {n: p for n, p in state.components.items() if n in lab.inventory and (not p.slot or p.slot in lab.slots)}
    return replace(state, components=parts)


def _owners(
    folder: LabFolder, revision: str, then: LabState, edits: Mapping[str, Mapping[str, Entry] | None]
) -> dict[str, str]:
    """Return the file to write each component to: where it is; else where the revision has it; else the first."""
    documents = folder.manifests.documents.get("LabState", ())
    states = sorted({document.source.path for document in documents})
    old: Manifests | None = None
    found = {}
    for name in edits:
        here = folder.manifests.source(name) if name in folder.state.components else None
        path = here.path if here else states[0]
        if here is None and name in then.components:
            old = old or folder.manifests_at(revision)
            there = old.source(name)
            same = shown_path(folder.root / there.path.removeprefix(f"{revision}:")) if there else ""
            path = same if same in states else path
        found[name] = path
    return found


def _written(
    files: Mapping[str, bytes], owners: Mapping[str, str], edits: Mapping[str, Mapping[str, Entry] | None]
) -> dict[str, bytes]:
    by_file: dict[str, dict[str, Mapping[str, Entry] | None]] = {}
    for name, change in edits.items():
        by_file.setdefault(owners[name], {})[name] = change
    return {path: set_values(files[path].decode(), part).encode() for path, part in by_file.items()}


def _refuse_edited(folder: LabFolder, changes: tuple[Change, ...]) -> None:
    """Raise PicoError where a change would overwrite an edit that is not committed."""
    edited = {(c.component, c.tunable): c for c in folder.diff("HEAD")}
    lost = [edited[c.component, c.tunable] for c in changes if (c.component, c.tunable) in edited]
    if lost:
        keep = '`pico commit --planned -m "why"` keeps the edit'
        hint = f"{keep}, `pico checkout HEAD -- COMPONENT` drops it; others may stay"
        raise PicoError(
            [
                error(
                    "edited",
                    f"{c.component}.{c.tunable} was edited since the last commit ({c.text}): that would be lost",
                    hint=hint, address=f"{c.component}.{c.tunable}",
                )
                for c in lost
            ]
        )  # fmt: skip
