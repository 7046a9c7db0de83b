"""Arrays that stay at the edge when something speaks of them: which, and how they come into the checkout's store."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pico.content.store import store_of
from pico.edge.link.line import Line
from pico.edge.link.pictures import unpacked
from pico.edge.network.remotes import Far
from pico.model.measurement import ArrayRef

_FIELDS = frozenset(ArrayRef.__dataclass_fields__)


def refs(document: Any) -> Iterator[str]:
    """Yield the SHA-256 of each array that a document speaks of."""
    if isinstance(document, Mapping):
        if document.keys() >= _FIELDS:
            yield str(document["sha256"])
        for value in document.values():
            yield from refs(value)
    elif isinstance(document, list):
        for value in document:
            yield from refs(value)


def missing(far: Far, found: Iterable[str]) -> list[str]:
    """Return which arrays the checkout does not have yet."""
    store = store_of(far.root)
    return [one for one in dict.fromkeys(found) if not store.has(one)]


def keep(far: Far, sha256: str, packed: str) -> None:
    """Keep an array that came; raises PicoError for one that came damaged."""
    store_of(far.root).put(unpacked(packed), expected=sha256)


def bring(far: Far, line: Line, found: Iterable[str]) -> None:
    """Bring arrays into the store of the checkout that are not there yet; raises PicoError."""
    for one in missing(far, found):
        keep(far, one, line.call("array", one))
