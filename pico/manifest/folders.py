"""What is asked of a whole folder of manifests: is it valid, bring it into normal form, which types it knows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.disk import write_all
from pico.manifest.catalog import catalog_names, load_catalog, read_type, unknown_type
from pico.manifest.files import read_folder, shown_path
from pico.manifest.load import Manifests, find_lab, load_files, own_types
from pico.model.catalog import Catalog, ComponentType
from pico.model.record import record

Beside = Callable[[Path, Mapping[str, bytes], Sequence[Diagnostic]], list[Diagnostic]]
"""Says what a lab's folder should hold beside the files that were read of it, and what was said of others."""


@record
class FolderVerdict:
    """The verdict on a folder's manifests."""

    folder: str
    lab: str = ""
    files: int = 0
    parts: int = 0
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def exit_code(self) -> ExitCode:
        """What `pico validate` ends with."""
        wrong = {d.code for d in self.diagnostics if d.severity == "error"}
        if not wrong:
            return ExitCode.DONE
        return ExitCode.IMPOSSIBLE if wrong <= _BEYOND_THE_BENCH else ExitCode.ERROR


_BEYOND_THE_BENCH = frozenset(("payload", "set-point"))
"""What is well written, and what the bench can't do: a plan says it with the same exit code."""
Asked = Callable[[Path, Manifests], Sequence[Diagnostic]]
"""What else is asked of a lab's folder and its manifests, in which nothing else is wrong."""


def check_folder(start: Path, also: Asked = lambda *_: (), beside: Beside = lambda *_: []) -> FolderVerdict:
    """Return the verdict on the lab that `start` lies in; on `start` itself where no lab is found.

    `beside`: what is known of files that are not there.
    """
    try:
        root = find_lab(start)
    except PicoError:
        if not any(start.glob("**/*.yaml")):
            raise
        root = start
    files, unread = read_folder(root)
    manifests = load_files(files, [*unread, *beside(root, files, unread)], root=shown_path(root))
    lab = manifests.setup.lab if manifests.setup else None
    found = [*manifests.diagnostics, *expression_errors(manifests)]
    if not any(d.severity == "error" for d in manifests.diagnostics):
        found += also(root, manifests)
    return FolderVerdict(
        folder=shown_path(root) if root.resolve() != Path.cwd() else ".",
        lab=lab.name if lab else "",
        files=len(files),
        parts=len(lab.inventory) if lab else 0,
        diagnostics=tuple(found),
    )


def expression_errors(manifests: Manifests) -> list[Diagnostic]:
    """Return what is wrong with the rules and expectations of manifests, read only where there are any."""
    lab, state = manifests.setup and manifests.setup.lab, manifests.state
    if lab and (lab.policy.rules or lab.policy.ignore or lab.goals or lab.claims or (state and state.expect)):
        from pico.manifest.expression_checks import (
            check_claims,
            check_expectations,
            check_goals,
            check_ignored,
            check_rules,
        )

        rules = [*check_rules(manifests), *check_ignored(manifests)]
        return [*rules, *check_goals(manifests), *check_claims(manifests), *check_expectations(manifests)]
    return []


def check_files(
    start: Path, files: Sequence[Path], also: Asked = lambda *_: (), beside: Beside = lambda *_: []
) -> FolderVerdict:
    """Return the verdict on the labs that `files` lie in, together: a manifest is right or wrong only among the others.

    Files that lie in no lab and don't claim to be PICO's are passed over; raises PicoError for those that do.
    """
    roots: dict[Path, None] = {}
    for path in files:
        try:
            roots[find_lab(start / path)] = None
        except PicoError:
            if "apiVersion: pico/" in _read(start / path):
                raise
    found = [check_folder(root, also, beside) for root in roots]
    return FolderVerdict(
        folder=", ".join(c.folder for c in found),
        lab=", ".join(c.lab for c in found),
        files=sum(c.files for c in found),
        parts=sum(c.parts for c in found),
        diagnostics=tuple(d for c in found for d in c.diagnostics),
    )


def format_folder(start: Path, files: Sequence[Path] = (), *, write: bool = True) -> tuple[str, ...]:
    """Bring manifests (`files`, or all of the lab that `start` lies in) into the normal form; return which changed.

    Files that don't claim to be manifests are passed over. Raises PicoError, before anything is written, for files
    that can't be read.
    """
    named = {str(path): _read(path) for path in files}
    texts = {p: text for p, text in named.items() if "apiVersion" in text} if files else _manifests(find_lab(start))
    changed: dict[str, str] = {}
    found: list[Diagnostic] = []
    for path, text in texts.items():
        try:
            formatted = _format(path, text)
        except PicoError as exc:
            found += exc.diagnostics
            continue
        if formatted != text:
            changed[path] = formatted
    if found:
        raise PicoError(found)
    if write:
        write_all({Path(path).resolve(): text.encode() for path, text in changed.items()})
    return tuple(sorted(shown_path(Path(path)) for path in changed))


def _format(path: str, text: str) -> str:
    from pico.manifest.fmt import format_text

    try:
        return format_text(text)
    except PicoError as exc:
        raise PicoError(
            replace(d, source=replace(d.source, path=path) if d.source else None) for d in exc.diagnostics
        ) from exc


def _read(path: Path) -> str:
    try:
        return path.read_bytes().decode()
    except (OSError, UnicodeDecodeError) as exc:
        reason = exc.strerror if isinstance(exc, OSError) and exc.strerror else "it is not UTF-8 text"
        raise PicoError(error("file", f"{path} can't be read: {reason.lower()}")) from exc


def _manifests(root: Path) -> dict[str, str]:
    files, found = read_folder(root)
    if any(d.severity == "error" for d in found):
        raise PicoError(found)
    return {path: data.decode() for path, data in files.items() if b"apiVersion" in data}


def catalog_of(start: Path) -> Catalog:
    """Return the packaged component types, and the own ones of the lab that `start` lies in, where there is one."""
    try:
        root = find_lab(start)
    except PicoError:
        return load_catalog()
    documents = own_types(root)
    own = {kind.name: kind for document in documents if (kind := read_type(document)[0]) is not None}
    return load_catalog(extra={name: kind for name, kind in own.items() if name not in catalog_names()})


def component_type(start: Path, name: str) -> ComponentType:
    """Return one component type; raises PicoError for a name that neither catalog nor lab has."""
    catalog = catalog_of(start)
    if name not in catalog:
        raise PicoError(unknown_type(name, catalog))
    return catalog[name]
