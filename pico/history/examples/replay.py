"""The history of an example lab as data: which commits, and what each changes in the manifests."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

Files = Mapping[str, bytes]
"""Files by path in the repository."""


@dataclass(frozen=True, slots=True)
class ExampleCommit:
    """One commit to make: its tag, its branch, the tag of the commit it follows (None for the first), all its files."""

    tag: str
    branch: str
    follows: str | None
    message: str
    files: Files


def replay(history: Sequence[Mapping[str, Any]], files: Files) -> Iterator[ExampleCommit]:
    """Yield the commits of `history`, in order, starting from `files`.

    A commit follows `from` (a tag) where it is given, else the last one on its branch; `changes` holds for each
    component its `slot`, `pose` (of which only what is written changes) and values. Raises PicoError where a change
    can't be written into the manifests, KeyError for a `from` that comes later.
    """
    steps: dict[str, ExampleCommit] = {}
    last: dict[str, str] = {}
    for commit in history:
        tag, branch = commit["tag"], commit["branch"]
        follows = commit.get("from") or last.get(branch)
        before = steps[follows].files if follows else files
        steps[tag] = ExampleCommit(tag, branch, follows, commit["message"], changed(before, commit["changes"]))
        last[branch] = tag
        yield steps[tag]


def changed(files: Files, changes: Mapping[str, Mapping[str, Any]]) -> Files:
    """Return `files` with the values of components changed in the manifests that hold them."""
    from pico.manifest.edit import set_values

    result = dict(files)
    for path, components in _states(files):
        mine = {name: _whole(components[name] or {}, new) for name, new in changes.items() if name in components}
        if mine:
            result[path] = set_values(files[path].decode(), mine).encode()
    return result


def _states(files: Files) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield each LabState among `files`: its path, and its components as plain data."""
    from pico.manifest.text.source import Source
    from pico.manifest.text.tree import parse, plain

    for path, data in files.items():
        documents = parse(Source(path, data.decode()))[0] if path.endswith(".yaml") else []
        for content in (plain(document.root) for document in documents):
            if isinstance(content, dict) and content.get("kind") == "LabState":
                yield path, content["components"]


def _whole(component: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    """Return `new` with its pose filled up from where the component stands."""
    from pico.model.pose import Pose

    if "pose" not in new:
        return dict(new)
    pose = replace(Pose(**component["pose"]), **new["pose"]) if "pose" in component else Pose(**new["pose"])
    return dict(new) | {"pose": pose}
