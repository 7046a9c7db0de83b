"""The version of PICO that a lab requires: whether the specifier is valid, and whether this PICO satisfies it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from pico import version
from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.text.places import find, where
from pico.manifest.text.tree import Document, Scalar

KEY = "requires_pico"
CODE = "requires-pico"


def check_requirement(document: Document) -> Iterator[Diagnostic]:
    """Yield an error for a `requires_pico` of a lab that is text, but not a version specifier."""
    if (requirement := _requirement(document)) is None:
        return
    try:
        version.satisfies(requirement)
    except ValueError:
        text = f"{KEY} is `{requirement[:40]}`, which is not a version specifier"
        named = re.search(r"[0-9]+(\.[0-9]+)*", requirement)
        least = named[0] if named else "0.2"
        hint = f'write one or more comparisons with a version, in quotes: `{KEY}: ">={least}"`, `{KEY}: ">=0.2,<0.4"`'
        yield error("value", text, hint=hint, source=where(document, KEY))


def unsatisfied(documents: Iterable[Document]) -> list[Diagnostic]:
    """Return an error for the first lab that requires another version of PICO than this one; none if all can be read.

    An older PICO must not read such a lab: whatever else it finds wrong there may be right in the version required.
    """
    for document in documents:
        requirement = _requirement(document)
        try:
            if requirement is None or version.satisfies(requirement):
                continue
        except ValueError:  # reported by `check_requirement`
            continue
        text = f"this lab requires PICO {requirement}, and this is PICO {version.__version__}"
        way = version.needed(requirement)
        return [error(CODE, text, hint=_hint(way, requirement), source=where(document, KEY))]
    return []


def _hint(way: str, requirement: str) -> str:
    """Return what to do about a requirement that this PICO does not satisfy."""
    if way == "never":
        return f"no version satisfies all of it: correct `{KEY}`"
    if way == "newer":
        return f"install that version: `{version.upgrade_command(requirement)}`"
    kind = "an older PICO" if way == "older" else "another PICO"
    command = (version.downgrade_command if way == "older" else version.upgrade_command)(requirement)
    does = f"`{command}` lists those of this clone" if " tag " in command else f"`{command}`"
    return f"install {kind}: {does}; or change `{KEY}` if the lab works with this one"


def require_satisfied(found: Iterable[Diagnostic]) -> None:
    """Raise PicoError if the lab that diagnostics are about requires another version of PICO."""
    if wrong := [d for d in found if d.code == CODE]:
        raise PicoError(wrong)


def _requirement(document: Document) -> str | None:
    entry = find(document, KEY)
    return entry[1].value if entry and isinstance(entry[1], Scalar) and isinstance(entry[1].value, str) else None
