"""The short way through a LabState in its plainest form, which nearly every one has: line by line.

Whatever is not exactly of that form is left to the parser, so that both say the same or this says nothing. Lines are
remembered: from one version of a manifest to the next, hardly one is new.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from pico.history.blame.leaves import POSE, Leaf, leaf_of, leaves_of, place_of, pose_of
from pico.manifest.text.kinds import API
from pico.manifest.text.scalars import resolve
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Map, parse

_HEADER = (f"?apiVersion: {API}", "?kind: LabState", "metadata", "?components:")
_NAME = r"[a-z][a-z0-9_]{0,63}"
_VALUE = r"-?\d{1,12}(?:\.\d{1,12})?(?: [a-zA-Z]{1,8})?"
_FLOW = r"\{[a-zA-Z0-9_/ .,:{}-]{0,300}\}"
_LINE = re.compile(
    rf"(?:metadata: (?P<metadata>{{lab: {_NAME}}})|  (?P<component>{_NAME}):|    (?P<pose>pose):|"
    rf"      (?P<axis>x|y|yaw): (?P<number>{_VALUE})|"
    rf"    (?P<tunable>{_NAME}): (?P<value>{_VALUE}|[a-z][a-z0-9_/]{{0,63}})|"
    rf"    pose: (?P<flow>{_FLOW})|  (?P<whole>{_NAME}): {_FLOW})(?: +#[ -~]*| *)"
)
_COMMENT = re.compile(r" *(?:#[ -~]*)?")


def read_lines(data: bytes) -> dict[str, dict[str, Leaf]] | None:
    """Return the leaves of each component of one LabState; None where the parser must tell."""
    if not data.isascii():
        return None
    lines = [line for line in map(_line, data.decode("ascii").split("\n")) if line[0] != "comment"]
    if tuple(kind for kind, _, _ in lines[: len(_HEADER)]) != _HEADER:
        return None
    reader = _Reader()
    plain = all(reader.add(kind, key, leaf) for kind, key, leaf in lines[len(_HEADER) :])
    return reader.components if plain and reader.end() and reader.components else None


class _Reader:
    """Collects components line by line; a method answers false where the form is not the plainest."""

    def __init__(self) -> None:
        self.components: dict[str, dict[str, Leaf]] = {}
        self.leaves: dict[str, Leaf] | None = None  # of the component that is open
        self.axes: dict[str, Leaf] | None = None  # of the pose that is open
        self.slot = ""

    def add(self, kind: str, key: str, leaf: Any) -> bool:
        if kind == "axis":
            if self.axes is None or key in self.axes:
                return False
            self.axes[key] = leaf
            return True
        if not self.end_pose():
            return False
        if kind in ("component", "whole"):
            return self.begin(key, leaf, whole=kind == "whole")
        if self.leaves is None or key in self.leaves or (key == "slot" and self.slot):
            return False
        if kind == "slot":
            self.slot = leaf
        elif kind == "tunable":
            self.leaves[key] = leaf
        elif kind == "pose":
            self.axes = {}
        return kind in ("slot", "tunable", "pose")

    def begin(self, name: str, leaves: dict[str, Leaf], *, whole: bool) -> bool:
        self.end()
        if name in self.components:
            return False
        self.components[name] = dict(leaves)
        self.leaves = None if whole else self.components[name]
        return True

    def end_pose(self) -> bool:
        if self.axes is None or self.leaves is None:
            return True
        axes, self.axes = self.axes, None
        self.leaves[POSE] = pose_of(*(axes.get(axis, "0") for axis in ("x", "y", "yaw")))
        return bool(axes)

    def end(self) -> bool:
        """End the component that is open: its slot counts as its pose where it gives none."""
        fit = self.end_pose()
        if self.slot and self.leaves is not None:
            self.leaves.setdefault(POSE, self.slot)
        self.slot = ""
        return fit


@lru_cache(maxsize=1 << 16)
def _line(line: str) -> tuple[str, str, Any]:
    """Return what a line is, its key, and its leaf: that of a tunable or an axis, all of a component on one line.

    Of a line that may be anything else, `?` and the line.
    """
    if _COMMENT.fullmatch(line):
        return "comment", "", ""
    match = _LINE.fullmatch(line)
    if match is None:
        return f"?{line.rstrip()}", "", ""
    if match["axis"]:
        return "axis", match["axis"], leaf_of(resolve(match["number"]))
    if match["tunable"]:
        kind = "slot" if match["tunable"] == "slot" else "tunable"
        return kind, match["tunable"], leaf_of(resolve(match["value"]))
    if match["flow"] or match["whole"]:
        return _flow(line)
    kind = next(k for k in ("metadata", "component", "pose") if match[k])
    return kind, match[kind].rstrip(":"), {}


def _flow(line: str) -> tuple[str, str, Any]:
    documents, found = parse(Source("", line))
    root = documents[0].root if documents and not found else None
    if not isinstance(root, Map):
        return "?", "", ""
    key, (_, node) = next(iter(root.entries.items()))
    if line.startswith("    "):
        return "tunable", POSE, place_of(root, "")
    return "whole", key, leaves_of(node)
