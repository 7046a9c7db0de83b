"""What is said of a change that is carried: messages of commits, and what stands in the way."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from pico.diagnostics import Diagnostic, error
from pico.history.git.commit import Commit
from pico.history.merge.leaves import Conflict
from pico.history.merge.markers import Labels
from pico.history.merge.trees import Union
from pico.history.messages.trailers import trailers, without_trailers
from pico.history.restoring.last_change import last_change, value_at

_DELTA = re.compile(r" \((?:[+-][0-9.e+-]+|unchanged)\)$")


def labels(way: str, head: Commit, name: str) -> Labels:
    """Return what the two sides are called, and what they come from."""
    theirs = f"the revert of {name}" if way == "revert" else name
    return Labels(head.label, name, theirs)


def revert_message(commit: Commit, parent: Commit | None, message: str) -> str:
    """Return the message of a commit that takes another one back: `message`, else as git writes it."""
    title = message.strip() or _title(commit.summary)
    merge = f", reversing\nchanges made to {parent.id}" if parent and len(commit.parents) > 1 else ""
    return f"{title}\n\nThis reverts commit {commit.id}{merge}."


def _title(summary: str) -> str:
    again = re.fullmatch(r'Revert "(.+)"', summary)
    return f'Reapply "{again[1]}"' if again else f'Revert "{summary}"'


def cherry_message(commit: Commit) -> str:
    """Return the message of a commit as its copy has it: what PICO said of the state does not hold there."""
    text = without_trailers(commit.message)
    joint = "\n" if trailers(text) else "\n\n"
    return f"{text}{joint}(cherry picked from commit {commit.id})"


def rootless(name: str) -> Diagnostic:
    """Return why the first commit can't be taken back."""
    text = f"{name} is the first commit of this lab: there is no state before it to go back to"
    return error("first-commit", text, hint="`pico move COMPONENT home` takes single parts off the table")


def mainline_needed(name: str, sides: Sequence[Commit], given: int | None) -> Diagnostic:
    """Return that a merge needs a side that counts as what was there before, or that there is no such side."""
    if len(sides) < 2:
        return error("mainline", f"{name} is no merge: it has no side {given}", hint="leave --mainline out")
    ways = "; ".join(f'`--mainline {i}`: against {s.short} "{s.summary}"' for i, s in enumerate(sides, 1))
    what = f"has no side {given}" if given else "was made from several sides: which of them counts as before?"
    return error("mainline", f"{name} is a merge and {what}", hint=ways)


def conflicts(
    handle: Any, union: Union, way: str, here: tuple[Commit, str], made: tuple[str, Commit], parent: Commit | None
) -> list[Diagnostic]:
    """Return an error for each tunable that was changed otherwise, naming both commits, and for files as a whole.

    `here`: HEAD, and the tree of manifests that the change met, which others carried before it may have made.
    """
    (head, _), (name, commit) = here, made
    called = f"{name} ({commit.short})" if name != commit.short else name
    source = parent.short if way == "revert" and parent else name
    found = [_conflict(handle, path, c, way, here, called, source) for path, c in union.conflicts]
    hint = f"`git {way} {commit.short}` writes both between markers; edit, `git add`, `git {way} --continue`"
    return found + [
        error("carry-conflict", f"{path}: {called} and {head.label} changed it in ways that can't be united", hint=hint)
        for path in sorted(set(union.files))
    ]


def _conflict(
    handle: Any, path: str, c: Conflict, way: str, here: tuple[Commit, str], called: str, source: str
) -> Diagnostic:
    ours, theirs = (_DELTA.sub("", text) for text in (c.ours, c.theirs))
    later = here[0].label if c.files else _later(handle, here, path, c)
    if c.base in (ours, theirs):
        summary = f"{c.address}: {called} and {later} changed parts of one thing"
        detail = f"in {path}; `policy: {{merge: strict}}` of the lab refuses that"
    elif way == "revert":
        summary = f"{c.address}: {called} made it {c.base}, and {later} since then {ours}"
        detail = f"in {path}; before {called} it was {theirs}"
    else:
        summary = f"{c.address}: {called} changed it from {c.base} to {theirs}, but here {later} made it {ours}"
        detail = f"in {path}"
    return error("carry-conflict", summary, detail=detail, hint=_way_out(c, source, path), address=c.address)


def _later(handle: Any, here: tuple[Commit, str], path: str, c: Conflict) -> str:
    head, onto = here
    leaf = c.path if not c.keys or c.path[-1] != "pose" else c.path[:-1]
    if value_at(handle, handle[onto], path, leaf) != value_at(handle, handle[head.id].tree, path, leaf):
        return "what was carried before it"
    found = handle[last_change(handle, head.id, path, leaf)]
    return f'{str(found.id)[:7]} "{found.message.strip().partition(chr(10))[0]}"'


def _way_out(c: Conflict, source: str, path: str) -> str:
    if c.path[1:2] != ("components",) or len(c.path) < 3:
        return f"nothing was written; edit {path} by hand"
    tunable = "pose" if c.path[3:4] in (("slot",), ("pose",)) else ".".join(c.path[3:4])
    address = f"{c.path[2]}.{tunable}" if tunable else c.path[2]
    return f"nothing was written; `pico checkout {source} -- {address}` takes the value of {source}"
