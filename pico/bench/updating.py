"""The bench's own Lab against the one that the working tree describes: what differs, and adopting it.

No bench need be open for it: a state that names a part of the new Lab can't be read against the old one.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from pico.bench.opened import Opened
from pico.bench.running.loop import LoopThread
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.disk import write_all
from pico.edge import own_lab
from pico.edge.network.opening import opened
from pico.edge.network.opening import own_lab as kept
from pico.edge.protocol import OwnLab
from pico.model.address import renaming_of
from pico.model.lab import Known
from pico.model.quantities import Value
from pico.model.record import record
from pico.policy.freshness import edited

if TYPE_CHECKING:
    from pico.bench.importing import Imported
    from pico.edge.network.remotes import Place
    from pico.model.setup import Setup

DOING = "pico bench update"


@dataclass(frozen=True)
class Swap:
    """Another specimen for a part: serials before and after, the Labs of bench and tree with it, and the tree's as a
    unified diff. `kind`, `parameters` and `known` as they were asked for. `stays`: parameters of the part's own that
    nobody gave anew; `same`: it is what is there already."""

    name: str
    before: str
    after: str
    own: OwnLab
    tree: OwnLab
    patch: str
    stays: Mapping[str, Value]
    kind: str | None = None
    parameters: Mapping[str, Value] = field(default_factory=dict)
    known: Known | None = None
    same: bool = False


@record
class Proposal:
    """What the working tree would have the bench be: the digests of both, what differs in words (the first few) and as
    a unified diff of the files, from the bench to the tree. Comments alone may differ; the digests are then one.
    `renamed`: parts that the tree seems to call otherwise, and does not say so."""

    bench: str
    tree: str
    differences: tuple[str, ...] = ()
    patch: str = ""
    renamed: tuple[Diagnostic, ...] = ()

    @property
    def new(self) -> bool:
        """Whether there is anything to adopt."""
        return bool(self.patch)


def proposal(place: Place) -> Proposal:
    """Return what the working tree proposes to a bench; nothing new if that keeps no Lab yet. Raises PicoError."""
    tree = own_lab.proposed(place.root)
    wanted = own_lab.setup_of(tree)
    try:
        own = kept(place) or tree
        now = own_lab.setup_of(own)
    except PicoError as exc:
        if exc.diagnostics[0].code != own_lab.CODE:
            raise
        lost = exc.diagnostics[0].summary
        return Proposal(bench="", tree=wanted.digest(), differences=(lost,), patch="".join(_patch({}, tree.files)))
    patch = "".join(_patch(own.files, tree.files))
    told = tuple(edited(now, wanted))
    alike = tuple(_alike(now, wanted))
    return Proposal(bench=now.digest(), tree=wanted.digest(), differences=told, patch=patch, renamed=alike)


def _alike(now: Setup, wanted: Setup) -> Iterator[Diagnostic]:
    """Yield a warning for each part that vanishes while a new one has its marker and its home, or its fixed pose."""
    names = renaming_of(wanted.lab)
    gone = {n: p for n, p in now.lab.inventory.items() if n not in wanted.lab.inventory and n not in names}
    for new, part in sorted(wanted.lab.inventory.items()):
        for old, before in gone.items() if new not in now.lab.inventory else ():
            if (before.marker, before.home, before.pose) == (part.marker, part.home, part.pose):
                text = f"{new} has the marker and the place of {old}, which is gone: is it the same part?"
                hint = (
                    f"if so, write `formerly: [{old}]` below `{new}:` in the inventory first: then it keeps its values"
                )
                hint = f"{hint}, and old commits, notes and recipes still find it"
                yield warning("renamed", text, hint=hint, address=new)


def waiting(place: Place) -> tuple[Diagnostic, ...]:
    """Return that the working tree of a lab proposes another bench than `place` keeps, if so."""
    with suppress(PicoError):
        found = proposal(place)
        if found.differences:
            told = ", ".join(found.differences)
            hint = "`pico bench update` shows it, and lets the bench adopt it; until then plans go by the old one"
            return (Diagnostic("note", own_lab.CODE, f"the bench has not adopted what was edited: {told}", hint=hint),)
    return ()


def update(place: Place) -> None:
    """Let a bench adopt what the working tree describes; raises PicoError as
    `Edge.adopt`."""
    tree = own_lab.proposed(place.root)
    try:
        own = kept(place) or tree
        setup = own_lab.setup_of(own)
    except PicoError as exc:
        if exc.diagnostics[0].code != own_lab.CODE:
            raise
        own, setup = tree, own_lab.setup_of(tree)
    thread = LoopThread()
    edge = opened(setup, place, setup.lab.sim.fidelity, own)
    try:
        thread.wait(edge.adopt(tree, DOING))
    finally:
        thread.wait(edge.close())
        thread.close()


def swapped(
    place: Place, name: str, serial: str, kind: str | None, parameters: Mapping[str, Value], known: Known | None = None,
) -> Swap:  # fmt: skip
    """Return what exchanging the specimen of a part changes in the bench's own Lab and in the tree's files; nothing is
    written. Raises PicoError for what would not be right in either, or in the state beside them."""
    from pico.manifest.exchange import exchanged

    tree = own_lab.proposed(place.root)
    own = kept(place) or tree
    made = []
    for lab in (own, tree):
        files = exchanged(lab.as_bytes(), name, serial, kind, parameters, known)
        new = replace(lab, files={**lab.files, **own_lab.of_files(files).files})
        own_lab.setup_of(replace(new, at=""))  # what it would be: nothing that is kept is wrong
        made.append(new)
    _require_state(place.root, made[1], name)
    setup = own_lab.setup_of(own)
    before = setup.lab.inventory[name]
    kept_as = {k: v for k, v in (before.parameters or {}).items() if k not in parameters}
    patch = "".join(_patch(tree.files, made[1].files))
    same = made[0].files == own.files and not patch
    return Swap(name, before.serial, serial, made[0], made[1], patch, kept_as, kind, parameters, known, same)


def _require_state(root: Path, tree: OwnLab, name: str) -> None:
    """Raise PicoError for what is wrong in the files of a lab with another Lab, and is right without."""
    from pico.manifest.files import read_folder
    from pico.manifest.load import load_files

    files, _ = read_folder(root)
    known = [d.summary for d in load_files(files).diagnostics if d.severity == "error"]
    after = load_files({**files, **tree.as_bytes()}).diagnostics
    if wrong := [d for d in after if d.severity == "error" and d.summary not in known]:
        text = f"what the manifests say of {name} does not go with another specimen like that"
        hint = "change what is named here so that it goes with both, or take it out; then swap, then say it anew"
        raise PicoError([error("swap", text, hint=hint), *wrong])


def swap(place: Place, change: Swap) -> None:
    """Write the specimen into the tree of the lab, and let its bench have it; raises PicoError, of a bench
    that does not take it with the tree as it was, and where either was changed since `change` was made.

    The tree is written first: killed in between, it proposes the specimen to the bench, and `pico bench update` does
    the rest. The other way round that would put the one before back."""
    root = place.root
    again = swapped(place, change.name, change.after, change.kind, change.parameters, change.known)
    if again != change:
        text = "lab.yaml or the bench was changed meanwhile, so nothing was swapped"
        raise PicoError(error("edit", text, hint="the same `pico swap` once more starts from what is there now"))
    setup = own_lab.setup_of(kept(place) or own_lab.proposed(root))
    before = own_lab.proposed(root).as_bytes()
    written = {path: data for path, data in change.tree.as_bytes().items() if before.get(path) != data}
    thread = LoopThread()
    edge = opened(setup, place, setup.lab.sim.fidelity, kept(place))
    try:
        write_all({root / path: data for path, data in written.items()})
        thread.wait(edge.adopt(change.own, "pico swap"))
    except PicoError:
        _put_back(root, {path: (data, before[path]) for path, data in written.items() if path in before})
        raise
    finally:
        thread.wait(edge.close())
        thread.close()


def _put_back(root: Path, written: Mapping[str, tuple[bytes, bytes]]) -> None:
    """Let files be what they were before they were written, but for those that somebody has changed since."""
    still = {root / path: old for path, (new, old) in written.items() if (root / path).read_bytes() == new}
    write_all(still)


class BenchLab:
    """The Lab of a bench that is open, to be changed under it."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def adopt(self) -> None:
        """Let the bench adopt what the working tree describes; raises PicoError as `Edge.adopt` does."""
        tree = own_lab.proposed(self.opened.root)
        self.opened.wait(self.opened.edge.adopt(tree, DOING))
        self.opened.folder.adopt(tree)

    def import_parts(self, types: Sequence[str] = (), *, write: bool = True) -> Imported:
        """Take what stands on the table and is not in the inventory into it; see `pico.bench.importing`."""
        from pico.bench import importing

        wanted = importing.read_types(types)
        look = self.opened.wait(self.opened.edge.look())
        found = importing.take_in(self.opened.folder, importing.importable(self.opened.folder, look, wanted), write)
        if found.parts and write:
            self.adopt()
        return found


def _patch(before: Mapping[str, str], after: Mapping[str, str]) -> Iterator[str]:
    for name in sorted(before.keys() | after.keys()):
        old, new = (files.get(name, "").splitlines(keepends=True) for files in (before, after))
        for line in difflib.unified_diff(old, new, f"bench/{name}", f"tree/{name}", n=2):
            yield line if line.endswith("\n") else f"{line}\n"
