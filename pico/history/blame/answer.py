"""What a blame comes to, for the cache and for whoever shows it: each leaf with its value, unit and nodes, as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from pico.history.blame.follow import Address, Blame, LeafNode, Units
from pico.history.blame.how import RunBrief, brief_from
from pico.history.blame.leaves import POSE, Leaf, canonical


@dataclass(frozen=True, slots=True)
class BlamedRow:
    """One leaf: its value in `unit` (None: it is gone), and its node."""

    value: Leaf | None
    unit: str
    node: LeafNode


@dataclass(frozen=True, slots=True)
class Unread:
    """A manifest that can't be read at a commit, and why."""

    commit: str
    path: str
    why: str


@dataclass(frozen=True, slots=True)
class Answer:
    """All leaves of a commit, those that are gone included; what could not be read on the way; the runs that the
    commits which changed a leaf brought along."""

    rows: Mapping[Address, BlamedRow] = field(default_factory=dict)
    unread: tuple[Unread, ...] = ()
    runs: Mapping[str, tuple[RunBrief, ...]] = field(default_factory=dict)


def answer(blame: Blame, packaged: Units, unread: Iterable[Unread] = ()) -> Answer:
    """Return the answer of a walk that ended in `blame`, without runs."""
    rows: dict[Address, BlamedRow] = {}
    now = {name: blame.leaves(name) for name in blame.components()}
    for at, node in sorted(blame.nodes.items(), key=lambda item: (item[0][0], item[0][1] != POSE, item[0][1])):
        unit = blame.unit(*at, packaged)
        value = canonical(at[1], now.get(at[0], {}).get(at[1]), unit)
        rows[at] = BlamedRow(value, unit or "", node)
    return Answer(rows, tuple(unread))


def dumps(answer: Answer) -> str:
    """Return an answer as JSON, for `loads`."""
    commits: dict[str, int] = {}
    numbers: dict[LeafNode, int] = {}
    nodes: list[tuple[Leaf | None, int, int]] = []
    for row in answer.rows.values():
        fresh = []
        for node in row.node.chain():
            if node in numbers:
                break
            fresh.append(node)
        for node in reversed(fresh):
            before = numbers[node.before] if node.before else -1
            numbers[node] = len(nodes)
            nodes.append((node.value, commits.setdefault(node.commit, len(commits)), before))
    rows = [(*at, row.value, row.unit, numbers[row.node]) for at, row in answer.rows.items()]
    unread = [(u.commit, u.path, u.why) for u in answer.unread]
    runs = {commit: [brief.as_list() for brief in found] for commit, found in answer.runs.items()}
    return json.dumps([list(commits), nodes, rows, unread, runs], separators=(",", ":"))


def loads(text: str) -> Answer:
    """Return what `dumps` wrote; raises ValueError, TypeError or IndexError for anything else."""
    commits, stored, rows, unread, runs = json.loads(text)
    nodes: list[LeafNode] = []
    for value, commit, before in stored:
        nodes.append(LeafNode(value, commits[commit], nodes[before] if before >= 0 else None))
    return Answer(
        {(component, tunable): BlamedRow(value, unit, nodes[at]) for component, tunable, value, unit, at in rows},
        tuple(Unread(*entry) for entry in unread),
        {commit: tuple(brief_from(data) for data in found) for commit, found in runs.items()},
    )
