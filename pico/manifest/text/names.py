"""The rule for names: lower case, so that they are alike in files, addresses and commands."""

from __future__ import annotations

import re

from pico.diagnostics import Diagnostic, error
from pico.manifest.text.kinds import NAME, PATH_NAME
from pico.manifest.text.places import find
from pico.manifest.text.tree import Document, Map, Scalar


def name_problem(name: str, *, path: bool = False) -> str:
    """Return what to write in place of `name`, or '' where it is a proper name (`path`: of parts joined by `/`)."""
    if (PATH_NAME if path else NAME).fullmatch(name) and len(name) <= 64:
        return ""
    better = re.sub(r"[^a-z0-9_/]" if path else r"[^a-z0-9_]", "_", name.lower())[:40].strip("_/")
    example = f", for example `{better}`" if (PATH_NAME if path else NAME).fullmatch(better) else ""
    return f"a lower-case letter, then lower-case letters, digits and `_`{example}"


def check_names(document: Document, *path: str, parts: bool = False) -> list[Diagnostic]:
    """Return what is wrong with the keys of the mapping at `path`."""
    found = find(document, *path)
    if not found or not isinstance(found[1], Map):
        return []
    return [d for key, _ in found[1].entries.values() if (d := check_name(document, key, parts=parts))]


def check_own_name(document: Document) -> list[Diagnostic]:
    """Return what is wrong with the name that a document's metadata give it."""
    found = find(document, "metadata", "name")
    wrong = check_name(document, found[1]) if found and isinstance(found[1], Scalar) else None
    return [wrong] if wrong else []


def check_name(document: Document, node: Scalar, *, parts: bool = False) -> Diagnostic | None:
    """Return what is wrong with a name that stands in a document, or None."""
    problem = name_problem(node.text, path=parts)
    if not problem:
        return None
    where = document.source.range(node.start, node.end)
    return error("name", f"`{node.text[:40]}` is not a name", hint=f"expected {problem}", source=where)
