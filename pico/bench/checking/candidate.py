"""The two sides of a check: the lab as a change leaves it, and as it was before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError
from pico.history.lab.missing_files import missing_files
from pico.history.merge.checked import overlapping
from pico.history.merge.doubts import unsettled
from pico.history.repository.comparison_base import ComparisonBase
from pico.history.repository.repository import Repository
from pico.manifest.files import read_folder, shown_path
from pico.manifest.folders import expression_errors
from pico.manifest.load import Manifests, load_files
from pico.model.setup import Setup
from pico.model.state import LabState, home_state
from pico.policy.freshness import edited


@dataclass(frozen=True)
class Candidate:
    """A lab to be checked: its manifests as bytes by path, and as they read."""

    root: Path
    files: Mapping[str, bytes]
    manifests: Manifests = field(repr=False)

    @property
    def name(self) -> str:
        """The lab's name, or that of its folder where the Lab can't be read."""
        return self.manifests.setup.lab.name if self.manifests.setup else self.root.name

    @property
    def valid(self) -> bool:
        """Whether there is no error in the manifests."""
        return not any(d.severity == "error" for d in self.manifests.diagnostics)


@dataclass(frozen=True)
class Origin:
    """A lab as it was before: its bench and state where they can be read, and what to know about that."""

    against: ComparisonBase
    files: Mapping[str, bytes] = field(default_factory=dict)
    setup: Setup | None = None
    state: LabState | None = None
    notes: tuple[str, ...] = ()


def in_folder(root: Path, repository: Repository | None = None) -> Candidate:
    """Return the lab of the folder `root` as its files are now, and as a merge in its repository left them. Never
    raises for what they hold."""
    files, found = read_folder(root)
    read = _read(root, files, [*found, *missing_files(root, files, found)])
    doubts = unsettled(repository, root, read.manifests)
    return replace(read, manifests=replace(read.manifests, diagnostics=(*read.manifests.diagnostics, *doubts)))


def in_memory(root: Path, files: Mapping[str, bytes]) -> Candidate:
    """Return the lab of the folder `root` as `files` say, by path below it."""
    return _read(root, {str(Path(shown_path(root)) / path): data for path, data in files.items()}, [])


def _read(root: Path, files: Mapping[str, bytes], found: list[Diagnostic]) -> Candidate:
    manifests = load_files(files, found)
    everything = (*manifests.diagnostics, *expression_errors(manifests))
    return Candidate(root, files, replace(manifests, diagnostics=everything))


def origin(repository: Repository | None, base: ComparisonBase, root: Path) -> Origin:
    """Return the lab of the folder `root` as the commit `base` has it."""
    if repository is None or base.commit is None:
        return Origin(base, notes=("there is nothing to compare with: from every part at home",))
    unread: list[Diagnostic] = []
    try:
        files = repository.files(base.commit, root, unread)
    except PicoError:  # the folder came later
        files = {}
    if not files:
        return Origin(base, notes=(f"the lab is new: {base.name} does not have it; from every part at home",))
    try:
        named = {f"{base.commit[:7]}:{path}": data for path, data in files.items()}
        setup, state = load_files(named, unread).require()
    except PicoError as exc:
        note = f"the lab is not valid at {base.name}, so from every part at home: {exc.diagnostics[0].summary}"
        return Origin(base, files, notes=(note,))
    return Origin(base, files, setup, state)


def start(setup: Setup, before: Origin) -> tuple[LabState, tuple[str, ...]]:
    """Return the state that the simulated bench `setup` starts from, whole, and what to know about it.

    That is the state before, with every part at home that was not there then; every part at home where the state before
    could not stand on this bench.
    """
    homes = home_state(setup)
    if before.state is None:
        return homes, before.notes
    fitting = {
        name: replace(part, slot=part.slot or (None if part.pose else homes.components[name].slot))
        for name, part in before.state.components.items()
        if name in setup.lab.inventory and (part.slot is None or part.slot in setup.lab.slots)
    }
    whole = LabState(lab=setup.lab.name, components={**homes.components, **fitting})
    wrong = overlapping(Manifests(setup, whole, ()))
    if wrong:
        note = f"{before.against.name} itself can't stand, so from every part at home: {wrong[0].summary}"
        return homes, (*before.notes, note)
    return whole, before.notes


def bench_changes(setup: Setup, before: Origin) -> tuple[str, ...]:
    """Return what differs in the lab and in its component types: `table.beam_height 70 → 75`."""
    return tuple(edited(before.setup, setup)) if before.setup else ()
