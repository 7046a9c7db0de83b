"""The components of one manifest as lines of text, with their comments: read, taken out, put into another manifest."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.splice import Editor, Splice, apply_splices, write_flow
from pico.manifest.text.tree import Document, Map, Scalar, parse, plain

_BOM = "\ufeff"
_COMPONENTS = "components"
_BREAK = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class ComponentLines:
    """A component as it stands in a file: its lines, as far to the left as they go, and what it comes after."""

    lines: tuple[str, ...]
    after: tuple[str, ...] = ()


@dataclass(frozen=True)
class Parts:
    """The `names` of the components of a file; as `lines` where the file can be taken apart, which braces prevent."""

    names: tuple[str, ...] = ()
    lines: Mapping[str, ComponentLines] | None = None


def read(data: bytes) -> Parts | None:
    """Return what a file holds of states; None for one that can't be read."""
    if b"LabState" not in data:
        return Parts()
    source, _ = decode("manifest", data)
    documents, wrong = parse(source) if source else ([], [])
    if source is None or wrong:
        return None
    found = [d for d in documents if kind_of(d)[0] == "LabState"]
    names = tuple(name for d in found for name in _names(d))
    return Parts(names, dict(_parts(found[0])) if len(found) == 1 and _mapping(found[0]) else None)


def without(data: bytes, names: Iterable[str]) -> bytes:
    """Return a manifest that has `lines` without components, whose comments go with them."""
    document, key, components = _state(data)
    editor = Editor(document)
    return _spliced(data, document, [Splice(*editor.block(key, components, name), "") for name in names])


def bare(data: bytes) -> bytes:
    """Return what the least manifest like one says that has `lines`: neither components nor comments."""
    document, key, _ = _state(data)
    assert isinstance(document.root, Map)
    header = {k: plain(v) for k, (_, v) in document.root.entries.items() if k in ("apiVersion", "kind", "metadata")}
    lines = [f"{k}: {write_flow(v)}" for k, v in header.items()]
    return Editor(document).newline.join([*lines, f"{key.text}:", ""]).encode()


def put(data: bytes, parts: Mapping[str, ComponentLines]) -> bytes:
    """Return a manifest that has `lines` with components put in, each after the last one that it comes `after`."""
    document, key, components = _state(data)
    editor, splices = Editor(document), []
    first = next(iter(components.entries.values()), None)
    indent = " " * (editor.column(first[0]) if first else editor.column(key) + 2)
    for _, part in sorted(parts.items(), key=lambda p: (len(p[1].after), p[0])):
        at = editor.below(key, components, next((n for n in reversed(part.after) if n in components.entries), None))
        text = "".join(f"{indent}{line}{editor.newline}" if line else editor.newline for line in part.lines)
        closed = editor.content[at - 1] in "\r\n"
        splices.append(Splice(at, at, text if closed else editor.newline + text.removesuffix(editor.newline)))
    return _spliced(data, document, splices)


def _names(document: Document) -> Iterable[str]:
    node = document.root.get(_COMPONENTS) if isinstance(document.root, Map) else None
    return node.entries if isinstance(node, Map) else ()


def _parts(document: Document) -> Iterator[tuple[str, ComponentLines]]:
    found = _mapping(document)
    if found is None:
        return
    key, components = found
    editor = Editor(document)
    before: tuple[str, ...] = ()
    for name, (at, _) in components.entries.items():
        start, end = editor.block(key, components, name)
        text = _BREAK.split(editor.content[start:end])
        lines = text[:-1] if not text[-1] else text
        yield name, ComponentLines(tuple(_left(line, editor.column(at)) for line in lines), before)
        before = (*before, name)


def _left(line: str, column: int) -> str:
    return line[min(column, len(line) - len(line.lstrip(" "))) :] if line.strip() else ""


def _mapping(document: Document) -> tuple[Scalar, Map] | None:
    """Return the components with their key where they are lines of their own, or none yet; None where they are not."""
    root = document.root
    if not isinstance(root, Map) or root.flow or _COMPONENTS not in root.entries:
        return None
    key, node = root.entries[_COMPONENTS]
    if isinstance(node, Scalar) and node.start == node.end:
        node = Map(node.start, False, node.end)
    return (key, node) if isinstance(node, Map) and not node.flow else None


def _state(data: bytes) -> tuple[Document, Scalar, Map]:
    source, _ = decode("manifest", data)
    documents = parse(source)[0] if source else []
    for document in documents:
        found = _mapping(document) if kind_of(document)[0] == "LabState" else None
        if found:
            return document, *found
    raise ValueError("no components that are lines of their own")


def _spliced(data: bytes, document: Document, splices: list[Splice]) -> bytes:
    mark = _BOM if data.startswith(_BOM.encode()) else ""
    return (mark + apply_splices(document.source.content, splices)).encode()
