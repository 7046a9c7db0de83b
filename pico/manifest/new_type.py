"""A component type of a lab's own, begun from one that is there: its text, with another name and other parameters."""

from __future__ import annotations

import json
from collections.abc import Mapping
from itertools import count
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.disk import write_whole
from pico.manifest.catalog import catalog_names, read_type, unknown_type
from pico.manifest.files import decode, shown_path
from pico.manifest.load import find_lab, load_folder, own_types
from pico.manifest.text.places import find
from pico.manifest.text.tree import Document, Node, parse
from pico.model.catalog import value_of
from pico.model.quantities import QuantityError, Value
from pico.resources import catalog_dir

FOLDER = "types"


def new_type(start: Path, name: str, base: str, given: Mapping[str, str]) -> Path:
    """Write `types/NAME.yaml` in the lab that `start` lies in and return its path: the type `base` of the catalog or
    the lab, with the parameters `given` in their unit or with one.

    Raises PicoError where the lab has such a type or file, for a base and parameters that there are not, and for what
    would be no valid type.
    """
    root = find_lab(start)
    documents = {d.name: d for d in _own(root)}
    if name in documents or name in catalog_names():
        hint = f"`pico catalog show {name}` shows it; choose another name"
        raise PicoError(error("duplicate", f"there is a type `{name}` already", hint=hint))
    path = root / FOLDER / f"{name}.yaml"
    if path.exists():
        raise PicoError(error("file", f"{shown_path(path)} is there already", hint="choose another name"))
    document = documents[base].document if base in documents else _packaged(base, [*documents, *catalog_names()])
    text = _edited(document, name, given)
    _require_valid(text, shown_path(path))
    write_whole(path, text.encode(), folders=True)
    return path


def line_of_part(start: Path, name: str) -> str:
    """Return a line of `inventory` with a part of the lab's own type `name`: with a free marker and slot if an arm
    moves it, else bolted in the middle of the table."""
    setup = load_folder(find_lab(start)).setup
    if setup is None:
        return f"{name}_1: {{type: {name}, pose: {{x: 0, y: 0, yaw: 0}}}}"
    lab, kind = setup.lab, setup.catalog.get(name)
    part = next(f"{name}_{n}" for n in count(1) if f"{name}_{n}" not in lab.inventory)
    free = lab.slots.keys() - {one.home for one in lab.inventory.values()}
    slots = sorted(free, key=lambda slot: (not slot.startswith("storage/"), slot))  # others may lie in a beam
    moved = kind and kind.seating != "bolted" and kind.pose.mover == "arm" and kind.geometry.grasp is not None
    if not (moved and slots and lab.robots):
        x, y = (round(side / 2) for side in lab.table.size)
        return f"{part}: {{type: {name}, pose: {{x: {x}, y: {y}, yaw: 0}}}}"
    taken = {one.marker for one in lab.inventory.values()}
    marker = next(n for n in count(1) if n not in taken)
    return f"{part}: {{type: {name}, marker: {marker}, home: {slots[0]}}}"


class _Named:
    """A document of a lab's own type, by its name."""

    def __init__(self, document: Document, name: str) -> None:
        self.document, self.name = document, name


def _own(root: Path) -> list[_Named]:
    documents = own_types(root)
    return [_Named(d, kind.name) for d in documents if (kind := read_type(d)[0]) is not None]


def _packaged(name: str, known: list[str]) -> Document:
    if name not in catalog_names():
        raise PicoError(unknown_type(name, known))
    source, found = decode(f"{name}.yaml", (catalog_dir() / f"{name}.yaml").read_bytes())
    if source is None:
        raise PicoError(found)
    return parse(source)[0][0]


def _edited(document: Document, name: str, given: Mapping[str, str]) -> str:
    """Return the text of a document with another name and other parameters; all else, comments too, as it is."""
    kind = read_type(document)[0]
    assert kind is not None
    content = document.source.content
    begin, end = _extent(document)
    changes: list[tuple[Node, str]] = [(_value(document, "metadata", "name"), name)]
    said = []
    for parameter, text in given.items():
        if parameter not in kind.parameters:
            hint = did_you_mean(parameter, kind.parameters) or f"known: {', '.join(kind.parameters) or 'none'}"
            raise PicoError(error("unknown-parameter", f"{kind.name} has no parameter `{parameter}`", hint=hint))
        own = kind.parameters[parameter]
        try:
            value = value_of(own, text if isinstance(own.value, str) else _read(text))
        except QuantityError as exc:
            hint = f"{kind.name} has {_written(own.value)} {own.unit}".rstrip()
            raise PicoError(error("value", f"`{parameter}`: {exc}", hint=hint)) from exc
        changes.append((_value(document, "parameters", parameter, "value"), _written(value)))
        said.append(f"{parameter} {_written(value).strip(chr(34))} {own.unit}".rstrip())
    if said:
        changes.append((_value(document, "metadata", "title"), json.dumps(f"{kind.title}; {', '.join(said)}")))
    for node, text in sorted(changes, key=lambda change: -change[0].start):
        content = content[: node.start] + text + content[node.end :]
        end += len(text) - (node.end - node.start)
    return content[begin:end].strip("\n") + "\n"


def _extent(document: Document) -> tuple[int, int]:
    """Return where a document's text begins and ends, where its file holds several."""
    content, at = document.source.content, document.root.start
    begin = content.rfind("\n---", 0, at)
    after = content.find("\n---", at)
    return (content.find("\n", begin + 1) + 1 if begin >= 0 else 0), (after if after >= 0 else len(content))


def _value(document: Document, *path: str) -> Node:
    found = find(document, *path)
    assert found is not None
    return found[1]


def _written(value: Value) -> str:
    return f"{value:.12g}" if isinstance(value, float) else json.dumps(value)


def _read(text: str) -> Value:
    if text in ("true", "false"):
        return text == "true"
    try:
        return float(text)
    except ValueError:
        return text


def _require_valid(text: str, path: str) -> None:
    source, found = decode(path, text.encode())
    wrong: list[Diagnostic] = [d for d in found if d.severity == "error"]
    if source is not None:
        wrong += [d for d in read_type(parse(source)[0][0])[1] if d.severity == "error"]
    if wrong:
        raise PicoError(wrong)
