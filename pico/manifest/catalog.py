"""Component types as files: the packaged catalog, of which only what is needed is read, and a lab's own types."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.manifest.checks.components import check_type
from pico.manifest.files import decode, shown_path
from pico.manifest.records import read_record
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.tree import Document, parse
from pico.model.catalog import Catalog, ComponentType, lifted
from pico.resources import catalog_dir


def catalog_names() -> tuple[str, ...]:
    """Return the names of the packaged component types, sorted."""
    return tuple(sorted(path.stem for path in catalog_dir().glob("*.yaml")))


def load_catalog(names: Iterable[str] | None = None, extra: Mapping[str, ComponentType] | None = None) -> Catalog:
    """Return component types by name: those of `names` (all, where None) from the package, and a lab's own (`extra`).

    Raises PicoError for a name that nobody has, one that both have, and a packaged type that is wrong.
    """
    extra = extra or {}
    known = catalog_names()
    found: list[Diagnostic] = []
    catalog: dict[str, ComponentType] = dict(extra)
    for name in sorted(set(known) if names is None else set(names) - extra.keys()):
        try:
            catalog[name] = packaged_type(name)
        except PicoError as exc:
            found.extend(exc.diagnostics)
    found += [both(name) for name in extra if name in known]
    if found:
        raise PicoError(found)
    return catalog


def both(name: str) -> Diagnostic:
    """Return the diagnostic of a lab's own type that is called as a packaged one."""
    packaged = shown_path(catalog_dir() / f"{name}.yaml")
    hint = "give the lab's own type another name"
    return error("duplicate", f"the type `{name}` is also in the catalog", detail=f"at {packaged}", hint=hint)


def unknown_type(name: str, known: Iterable[str]) -> Diagnostic:
    """Return the diagnostic of a component type that neither the catalog nor the lab has."""
    hint = did_you_mean(name[:40], known) or "`pico catalog list` shows the types; a lab may add its own ComponentType"
    return error("unknown-type", f"there is no component type `{name[:40]}`", hint=hint)


def packaged_type(name: str) -> ComponentType:
    """Return one type of the packaged catalog; raises PicoError where it does not exist or is wrong."""
    path = catalog_dir() / f"{name}.yaml"
    if not name.isidentifier() or not path.is_file():
        raise PicoError(unknown_type(name, catalog_names()))
    return _read(path, path.stat().st_mtime_ns)


@cache
def _read(path: Path, changed: int) -> ComponentType:
    source, found = decode(shown_path(path), path.read_bytes())
    documents: list[Document] = []
    if source:
        documents, wrong = parse(source)
        found += wrong
    if not found and len(documents) == 1:
        record, found = read_type(documents[0])
        if record and record.name == path.stem and not found:
            return record
    hint = f"it must hold one ComponentType called `{path.stem}`"
    raise PicoError(found or [error("catalog", f"{shown_path(path)} is not a catalog file", hint=hint)])


def read_type(document: Document) -> tuple[ComponentType | None, list[Diagnostic]]:
    """Return the component type that a document holds, or why it holds none."""
    kind, found = kind_of(document)
    if kind != "ComponentType" or found:
        return None, found
    record, found = read_record(document, "ComponentType", ComponentType)
    if record:
        found = found + check_type(document, record)
    return record and lifted(record), found
