"""From manifests to the model: a folder or a Git tree in, the bench and its desired state out, or all that is wrong."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, SourceRange, error
from pico.manifest.bench_view import BenchView, type_names, view_of, view_of_broken
from pico.manifest.catalog import both, catalog_names, packaged_type, read_type, unknown_type
from pico.manifest.checks.labs import check_lab, check_setup
from pico.manifest.checks.own_parameters import check_own_parameters
from pico.manifest.checks.required_version import require_satisfied, unsatisfied
from pico.manifest.emulation import read_emulation
from pico.manifest.file_names import TOLD, misnamed_manifest, named_as_manifest
from pico.manifest.files import begin_or_restore, decode_all, read_folder, shown_path, shut
from pico.manifest.records import read_record
from pico.manifest.state import read_states
from pico.manifest.text.kinds import headless, kind_of
from pico.manifest.text.places import find, where, where_key
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Document, Map, Scalar, parse
from pico.manifest.weighing import weighed
from pico.model.address import former_names
from pico.model.catalog import ComponentType
from pico.model.lab import Lab
from pico.model.setup import Setup
from pico.model.state import LabState

_IS_LAB = re.compile(rb"^kind:[ \t]*[\"']?Lab[\"']?[ \t]*(?:#.*)?\r?$", re.MULTILINE)
_IS_RECIPE = re.compile(r"^kind:[ \t]*[\"']?Recipe\b", re.MULTILINE)
_NO_LAB = "`pico init d` makes one in folder d, `pico init --example minimal d` an example"


@dataclass(frozen=True)
class Manifests:
    """What a folder's manifests hold. `setup` and `state` are None where there is an error in them."""

    setup: Setup | None
    state: LabState | None
    diagnostics: tuple[Diagnostic, ...]
    documents: Mapping[str, tuple[Document, ...]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def told(self) -> tuple[Diagnostic, ...]:
        """What a plan tells of the files though it is no error: of those not read or gone, and of another bench."""
        return tuple(d for d in self.diagnostics if d.code in TOLD and d.severity != "error")

    def source(self, address: str) -> SourceRange | None:
        """Return where an address stands: `p1`, `p1.angle`, `p1.pose.x`, `inventory.p1`, `slots.storage/a1`.

        A key that is not there falls back to what holds it; a component that no state names, to the inventory.
        """
        head, *rest = address.split(".")
        called = (head, *(former_names(self.setup.lab, head) if self.setup else ()))
        for document, name in ((d, name) for d in self.documents.get("LabState", ()) for name in called):
            if find(document, "components", name):
                return where(document, "components", name, *rest) if rest else where_key(document, "components", name)
        for document in self.documents.get("Lab", ()):
            path = [head, *rest] if find(document, head) else ["inventory", head, *rest]
            if entry := find(document, *path[:2]):
                named = len(path) == 2 and isinstance(entry[1], Map)
                return where_key(document, *path) if named else where(document, *path)
        return None

    def require(self) -> tuple[Setup, LabState]:
        """Return the bench and its state; raises PicoError with all diagnostics where there is any error."""
        if self.setup is None or self.state is None or any(d.severity == "error" for d in self.diagnostics):
            raise PicoError(self.diagnostics)
        return self.setup, self.state


def find_lab(start: Path) -> Path:
    """Return the nearest folder, from `start` upward, that holds a manifest of kind Lab; raises PicoError for none."""
    folder = start.resolve()
    try:
        if not folder.exists():
            raise PicoError(error("no-lab", f"there is no folder {start}", hint=_NO_LAB))
        for candidate in [folder, *folder.parents] if folder.is_dir() else folder.parents:
            if (candidate / "lab.yaml").is_file() or any(_is_lab(path) for path in sorted(candidate.glob("*.yaml"))):
                return candidate
        names = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
        for candidate in (folder, *folder.parents):
            if candidate.name != ".git" and all((candidate / name).exists() for name in ("HEAD", "objects", "refs")):
                raise PicoError(bare_repository(candidate))
    except OSError as exc:
        raise PicoError(shut(str(start), exc)) from exc
    missed = [misnamed_manifest(name) for name in names if named_as_manifest(name) and _is_lab(folder / name)]
    raise PicoError([error("no-lab", f"no lab in {start} or any folder above it", hint=_NO_LAB), *missed])


def find_lab_of_bench(start: Path) -> Path:
    """Return the folder of the lab as `find_lab` does; if its manifest is gone, the nearest folder upward in which PICO
    keeps a bench. Raises PicoError as `find_lab` does."""
    try:
        return find_lab(start)
    except PicoError:
        folder = start.resolve()
        for candidate in (folder, *folder.parents):
            if (candidate / ".pico" / "benches").is_dir():
                return candidate
        raise


def bare_repository(folder: Path) -> Diagnostic:
    """Return that a folder is a bare repository, and how to get files to work on."""
    hint = f"clone it, and work in the clone: `git clone {folder} DIR`"
    return error("git-bare", f"{folder} is a bare repository (a bare clone): history, without files to edit", hint=hint)


def labs_below(start: Path) -> list[Path]:
    """Return the folders below `start` that hold a manifest of kind Lab, sorted; not in dot-folders or in `runs`."""
    found = []
    for folder, folders, names in os.walk(start.resolve()):
        folders[:] = sorted(n for n in folders if not n.startswith(".") and n != "runs")
        here = Path(folder)
        if "lab.yaml" in names or any(_is_lab(here / name) for name in sorted(names) if name.endswith(".yaml")):
            found.append(here)
            folders.clear()
    return found


def _is_lab(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return bool(_IS_LAB.search(file.read(100_000)))
    except OSError:
        return False


def load_folder(root: Path) -> Manifests:
    """Return the manifests of a lab: every `*.yaml` below `root` that declares PICO's apiVersion.

    Dot-folders and folders called `runs` are left out. Never raises for what a file holds: that is in the diagnostics.
    """
    return load_files(*read_folder(root), root=shown_path(root))


def own_types(root: Path) -> tuple[Document, ...]:
    """Return the component types that a lab's folder holds; raises PicoError if the lab requires another PICO."""
    manifests = load_folder(root)
    require_satisfied(manifests.diagnostics)
    return manifests.documents.get("ComponentType", ())


def load_files(
    files: Mapping[str, bytes], found: Iterable[Diagnostic] = (), *, setup: Setup | None = None, root: str = "",
    without: Collection[str] = (),
) -> Manifests:  # fmt: skip
    """Return the manifests of files in memory, by path, as a Git tree has them.

    `found`: what was said of files that are not among them. With `setup` given, Lab and ComponentType documents are
    skipped and the state is read against that bench. `root`: how diagnostics call the lab's folder. `without`:
    components that are left out of the state where the bench has no such part.
    """
    return _load(files, [*found], root, setup, without)


def _load(
    files: Mapping[str, bytes], found: list[Diagnostic], root: str, setup: Setup | None, without: Collection[str]
) -> Manifests:
    documents, others = _documents(files, found)
    if unmet := unsatisfied(documents["Lab"]):
        return Manifests(None, None, tuple(unmet), {kind: tuple(of_kind) for kind, of_kind in documents.items()})
    setup, view = (setup, replace(view_of(setup), without=without)) if setup else _bench(documents, found, root)
    if view:
        found.extend(wrong for other in others for wrong in headless(other, view.kinds))
    if setup:  # a scenario that can't be read keeps nobody from the bench, but for the emulated one
        found.extend(replace(wrong, severity="warning") for wrong in read_emulation(others, setup)[1])
    state = None
    if documents["LabState"]:
        state, wrong = read_states(documents["LabState"], view) if view else (None, [])
        found.extend(wrong)
    elif not any(d.severity == "error" for d in found):
        hint = "if one was deleted, `git status` names it and `git restore FILE` brings it back; else add a file with "
        hint += "`kind: LabState` and `components:`"
        found.append(error("no-state", "the lab has no LabState", hint=hint, source=_somewhere(documents, root)))
    kept = {kind: tuple(of_kind) for kind, of_kind in documents.items()}
    return Manifests(setup, state, tuple(sorted(weighed(found, setup, state), key=_order)), kept)


def _documents(files: Mapping[str, bytes], found: list[Diagnostic]) -> tuple[dict[str, list[Document]], list[Document]]:
    """Return the documents by kind, and those that are meant for others."""
    others: list[Document] = []
    by_kind: dict[str, list[Document]] = {"Lab": [], "LabState": [], "ComponentType": [], "Devices": []}
    sources, wrong = decode_all(files)
    found.extend(wrong)
    for source in sources:
        documents, wrong = parse(source)
        if wrong and _IS_RECIPE.search(source.content):  # a recipe that can't be read keeps nobody from the bench
            wrong = [replace(d, severity="warning") for d in wrong]
        found.extend(wrong)
        if not documents and not wrong:
            hint = begin_or_restore(source.path)
            found.append(error("empty", f"{source.path}: nothing but comments", hint=hint, source=source.range(0)))
        for document in documents:
            kind, wrong = kind_of(document)
            found.extend(wrong)
            if kind:
                by_kind[kind].append(document)
            elif not wrong:
                others.append(document)
    return by_kind, others


def _bench(
    documents: Mapping[str, list[Document]], found: list[Diagnostic], root: str
) -> tuple[Setup | None, BenchView | None]:
    own, wrong_ones = _own_types(documents["ComponentType"], found)
    if not documents["Lab"]:
        if not any(d.severity == "error" for d in found):
            hint = f"add lab.yaml with `kind: Lab`; {_NO_LAB}"
            found.append(error("no-lab", "no Lab here", hint=hint, source=_somewhere(documents, root)))
        return None, None
    document = documents["Lab"][0]
    for other in documents["Lab"][1:]:
        detail = f"the first at {where(document, 'kind')}"
        hint = "a lab is one folder: remove one of the two, or run in the folder of the one you mean"
        found.append(error("duplicate", "a second Lab", detail=detail, hint=hint, source=where(other, "kind")))
    lab, wrong = read_record(document, "Lab", Lab)
    catalog = _types(document, own, wrong_ones, wrong)
    if lab:
        wrong += check_lab(document, lab)
    found.extend(wrong)
    if lab is None or wrong or any(part.type not in catalog for part in lab.inventory.values()):
        return None, view_of_broken(document, catalog)
    setup = Setup(lab=lab, catalog=catalog)
    if documents["Devices"]:
        setup = _wired(documents["Devices"], setup, found)
    if impossible := [*check_own_parameters(document, setup)]:
        found.extend(impossible)
        return None, view_of_broken(document, catalog)
    misfits = check_setup(document, setup)
    found.extend(misfits)
    misfit = any(d.severity == "error" for d in misfits)
    return (None if misfit else setup), view_of(setup)


def _wired(documents: list[Document], setup: Setup, found: list[Diagnostic]) -> Setup:
    """Return the bench with its instruments, where nothing is wrong with those."""
    from pico.manifest.checks.wiring import whole_wiring
    from pico.model.wiring import Wiring

    read = [(document, *read_record(document, "Devices", Wiring)) for document in documents]
    wiring, wrong = whole_wiring([(document, own) for document, own, _ in read if own], setup)
    wrong += [d for _, _, misread in read for d in misread]
    found.extend(wrong)
    return setup if any(one.severity == "error" for one in wrong) else replace(setup, wiring=wiring)


def _own_types(documents: list[Document], found: list[Diagnostic]) -> tuple[dict[str, ComponentType], set[str]]:
    """Return a lab's own types by name, and the names of those that are wrong."""
    own: dict[str, ComponentType] = {}
    wrong_ones: set[str] = set()
    first: dict[str, Document] = {}
    for document in documents:
        kind, wrong = read_type(document)
        found.extend(wrong)
        if kind is None:
            name = find(document, "metadata", "name")
            wrong_ones |= {name[1].text} if name and isinstance(name[1], Scalar) else set()
            continue
        at = where(document, "metadata", "name")
        if kind.name in first:
            detail = f"first at {where(first[kind.name], 'metadata', 'name')}"
            hint = "keep one of the two"
            found.append(
                error("duplicate", f"the type `{kind.name}` is given twice", detail=detail, hint=hint, source=at)
            )
        elif kind.name in catalog_names():
            found.append(_placed(both(kind.name), at))
        first.setdefault(kind.name, document)
        own.setdefault(kind.name, kind)
    return own, wrong_ones


def _types(
    document: Document, own: Mapping[str, ComponentType], wrong_ones: set[str], found: list[Diagnostic]
) -> dict[str, ComponentType]:
    catalog = dict(own)
    used = type_names(document)
    for name in sorted(used - own.keys() - wrong_ones):
        try:
            catalog[name] = packaged_type(name)
        except PicoError as exc:
            if exc.diagnostics[0].code == "unknown-type":
                found.extend(_unknown_types(document, name, [*catalog_names(), *own]))
            else:
                found.extend(exc.diagnostics)
    return {name: kind for name, kind in catalog.items() if name in used}


def _unknown_types(document: Document, name: str, known: list[str]) -> list[Diagnostic]:
    entry = find(document, "inventory")
    assert entry and isinstance(entry[1], Map)
    parts = [part for part in entry[1].entries if _type_of(document, part) == name]
    return [_placed(unknown_type(name, known), where(document, "inventory", part, "type")) for part in parts]


def _type_of(document: Document, part: str) -> str:
    entry = find(document, "inventory", part, "type")
    return entry[1].text if entry and isinstance(entry[1], Scalar) else ""


def _placed(diagnostic: Diagnostic, source: SourceRange) -> Diagnostic:
    return replace(diagnostic, source=source)


def _somewhere(documents: Mapping[str, list[Document]], root: str) -> SourceRange:
    for document in documents["Lab"]:
        return where(document, "kind")
    path = str(Path(root) / "lab.yaml") if root else "lab.yaml"
    return Source(path, "").range(0)


def _order(diagnostic: Diagnostic) -> tuple[bool, str, int, int]:
    """What can't be read stands first: others may follow from it."""
    at = diagnostic.source
    return (diagnostic.code != "yaml", *((at.path, at.start.line, at.start.column) if at else ("", 0, 0)))
