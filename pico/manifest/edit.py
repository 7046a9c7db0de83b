"""Writing a state into manifests: only the values that differ, so that one changed tunable is a one-line diff."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.changes import Change, Changes
from pico.manifest.files import decode
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.places import find
from pico.manifest.text.source import Source
from pico.manifest.text.splice import Editor, apply_splices
from pico.manifest.text.tree import Document, Map, Node, Scalar, parse, plain
from pico.model.pose import Pose
from pico.model.quantities import QuantityError, convert

_UNITS = {"x": "mm", "y": "mm", "yaw": "deg"}
_ORDER = {"slot": 0, "pose": 1}
_ROOT_ORDER = {"apiVersion": 0, "kind": 1, "metadata": 2, "components": 3, "expect": 4}


def set_values(text: str, changes: Changes) -> str:
    """Return a LabState manifest with `changes` made: comments, quotes, layout and line ends elsewhere untouched.

    A component that the text does not have is put in by name. Setting `pose` takes the place of `slot`, and the other
    way round. Raises PicoError for a text that is no LabState, and where the result would not hold what was asked.
    """
    mark = "\ufeff" if text.startswith("\ufeff") else ""
    content = text[len(mark) :]
    states = _states(content)
    editors = [(state, Editor(state)) for state in states]
    missing: dict[str, Mapping[str, Change]] = {}
    for name, wanted in changes.items():
        for state, editor in editors:
            components = _components(state)
            if components and name in components.entries:
                _edit_component(editor, components, name, wanted)
                break
        else:
            if wanted is not None:
                missing[name] = wanted
    if missing:
        _add(*editors[0], missing)
    result = apply_splices(content, [splice for _, editor in editors for splice in editor.splices])
    _verify(states, result, changes)
    return mark + result


def spliced(files: Mapping[str, bytes], changes: Changes) -> dict[str, bytes]:
    """Return the manifests that must change for `changes` to be made in them, each in the file that names its
    component, else in the one that names most. Raises PicoError for files that hold no LabState, or one that can't be
    written to."""
    if not changes:
        return {}
    texts = {path: data.decode("utf-8") for path, data in sorted(files.items()) if _is_state(path, data)}
    if not texts:
        raise PicoError(error("no-state", "the lab has no LabState", hint="add a file with `kind: LabState`"))
    held = {path: _named(text) for path, text in texts.items()}
    owner = {name: path for path, names in held.items() for name in names}
    largest = max(texts, key=lambda path: len(held[path]))
    by_file: dict[str, dict[str, Mapping[str, Change] | None]] = {}
    for name, entries in changes.items():
        by_file.setdefault(owner.get(name, largest), {})[name] = entries
    return {path: set_values(texts[path], part).encode("utf-8") for path, part in by_file.items()}


def largest_state(files: Mapping[str, bytes]) -> str:
    """Return the path of the LabState that names most components; raises PicoError where there is none."""
    texts = {path: data.decode("utf-8") for path, data in sorted(files.items()) if _is_state(path, data)}
    if not texts:
        raise PicoError(error("no-state", "the lab has no LabState", hint="add a file with `kind: LabState`"))
    return max(texts, key=lambda path: len(_named(texts[path])))


def components_of(data: bytes, lab: str = "") -> frozenset[str]:
    """Return the components that the LabStates (of a `lab`) in a file name; none of a file that can't be read."""
    source = decode("manifest", data)[0] if b"LabState" in data else None
    documents = parse(source)[0] if source else []
    states = [d for d in documents if kind_of(d)[0] == "LabState" and (not lab or _lab(d) == lab)]
    return frozenset(name for d in states for name, _ in _parts(d))


def _lab(document: Document) -> str:
    node = find(document, "metadata", "lab")
    return node[1].text if node and isinstance(node[1], Scalar) else ""


def _is_state(path: str, data: bytes) -> bool:
    source = decode(path, data)[0] if b"LabState" in data else None
    return source is not None and any(kind_of(d)[0] == "LabState" for d in parse(source)[0])


def _named(text: str) -> set[str]:
    return {name for state in _states(text.removeprefix("\ufeff")) for name, _ in _parts(state)}


def _states(content: str) -> list[Document]:
    documents, found = parse(Source("manifest", content))
    states = [d for d in documents if kind_of(d)[0] == "LabState"]
    if found or not states:
        raise PicoError(found or [error("edit", "no LabState to write to", hint="begin it with `kind: LabState`")])
    return states


def _components(document: Document) -> Map | None:
    node = document.root.get("components") if isinstance(document.root, Map) else None
    return node if isinstance(node, Map) else None


def _edit_component(editor: Editor, components: Map, name: str, wanted: Mapping[str, Change] | None) -> None:
    key, node = components.entries[name]
    if wanted is None:
        editor.remove(components, name)
        return
    if not isinstance(node, Map) and plain(node) is not None:
        raise PicoError(_cannot({name: wanted}))
    part = node if isinstance(node, Map) else Map(node.start, False, node.end)
    added: dict[str, Any] = {}
    leaving: set[str] = set()
    for entry, value in wanted.items():
        other = {"slot": "pose", "pose": "slot"}.get(entry, "")
        if value is None:
            if entry in part.entries:
                editor.remove(part, entry)
                leaving.add(entry)
        elif entry in part.entries:
            _edit_entry(editor, *part.entries[entry], value, flow=part.flow)
            if other in part.entries:
                editor.remove(part, other)
                leaving.add(other)
        elif other in part.entries:
            editor.replace(*part.entries[other], entry, _data(value), flow=part.flow, step=editor.step(key, part))
        else:
            added[entry] = _data(value)
    if added:
        target = part if part.entries else node
        editor.insert(key, target, added, _entry_order, flow=components.flow, leaving=frozenset(leaving))


def _edit_entry(editor: Editor, key: Scalar, node: Node, value: Change, *, flow: bool) -> None:
    if not isinstance(value, Pose):
        if not _equal(node, value, None):
            editor.set_scalar(key, node, value)
        return
    if not isinstance(node, Map):
        if plain(node) is not None:
            raise PicoError(_cannot({key.text: None}))
        editor.insert(key, node, _data(value), _axis_order, flow=flow)
        return
    added: dict[str, float] = {}
    for axis, number in _data(value).items():
        entry = node.entries.get(axis)
        if entry is None:
            if axis != "yaw" or number != 0:
                added[axis] = number
        elif not _equal(entry[1], number, _UNITS[axis]):
            editor.set_scalar(*entry, number)
    if added:
        editor.insert(key, node, added, _axis_order, flow=flow)


def _equal(node: Node, value: Any, unit: str | None) -> bool:
    have = plain(node)
    if unit and isinstance(have, str):
        try:
            have = convert(have, unit)
        except QuantityError:
            return False
    return isinstance(have, bool) == isinstance(value, bool) and bool(have == value)


def _add(state: Document, editor: Editor, missing: Mapping[str, Mapping[str, Change]]) -> None:
    root = state.root
    assert isinstance(root, Map)
    new = {name: _ordered(wanted) for name, wanted in missing.items()}
    if "components" in root.entries:
        key, node = root.entries["components"]
        if not isinstance(node, Map) and plain(node) is not None:
            raise PicoError(_cannot(missing))
        editor.insert(key, node, new, str, flow=root.flow)
    else:
        sorted_new = {name: new[name] for name in sorted(new)}
        editor.insert(None, root, {"components": sorted_new}, lambda k: _ROOT_ORDER.get(k, 9), flow=root.flow)


def _ordered(wanted: Mapping[str, Change]) -> dict[str, Any]:
    return {k: _data(wanted[k]) for k in sorted(wanted, key=_entry_order) if wanted[k] is not None}


def _data(value: Any) -> Any:
    return {"x": value.x, "y": value.y, "yaw": value.yaw} if isinstance(value, Pose) else value


def _entry_order(key: str) -> tuple[int, str]:
    return _ORDER.get(key, 2), key


def _axis_order(key: str) -> int:
    return list(_UNITS).index(key) if key in _UNITS else 3


def _verify(before: Iterable[Document], result: str, changes: Changes) -> None:
    """Demand that the result holds what was asked, and everything else as it was."""
    expected = {name: _clean(part) for document in before for name, part in _parts(document)}
    for name, wanted in changes.items():
        if wanted is None:
            expected.pop(name, None)
        else:
            expected[name] = _changed(expected.get(name, {}), wanted)
    documents, found = parse(Source("manifest", result))
    got = {name: _clean(part) for document in documents for name, part in _parts(document)}
    if found or not _alike(got, expected):
        raise PicoError(_cannot(changes))


def _parts(document: Document) -> list[tuple[str, Any]]:
    components = _components(document)
    return list(plain(components).items()) if components else []


def _clean(part: Any) -> dict[str, Any]:
    return dict(part) if isinstance(part, dict) else {}


def _changed(part: dict[str, Any], wanted: Mapping[str, Change]) -> dict[str, Any]:
    result = dict(part)
    for entry, value in wanted.items():
        result.pop({"slot": "pose", "pose": "slot"}.get(entry, "") if value is not None else entry, None)
        if value is not None:
            result[entry] = _data(value)
    return result


def _alike(a: Any, b: Any) -> bool:
    """Whether two leaves say the same: a yaw of 0 may be left out, and a length may be written with its unit."""
    if isinstance(a, dict) and isinstance(b, dict):
        keys = a.keys() | b.keys()
        return all(_alike(*_defaults(k, a, b)) for k in keys)
    if isinstance(a, str) != isinstance(b, str):
        return any(_same_quantity(a, b, unit) for unit in ("mm", "deg"))
    return isinstance(a, bool) == isinstance(b, bool) and bool(a == b)


def _defaults(key: str, a: dict[str, Any], b: dict[str, Any]) -> tuple[Any, Any]:
    default = 0 if key == "yaw" else None
    return a.get(key, default), b.get(key, default)


def _same_quantity(a: Any, b: Any, unit: str) -> bool:
    try:
        x, y = convert(a, unit), convert(b, unit)
    except QuantityError:
        return False
    return isinstance(x, int | float) and isinstance(y, int | float) and math.isclose(x, y)


def _cannot(changes: Changes) -> Diagnostic:
    names = ", ".join(sorted(changes)[:5])
    hint = "its layout is unusual: run `pico fmt` on the file, then try again"
    return error("edit", f"can't write {names} into this manifest without disturbing it", hint=hint)
