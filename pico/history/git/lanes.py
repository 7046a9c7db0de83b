"""The commit rail of `pico log --graph`: which line of history each commit stands on, as text or as numbers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from pico.history.git.commit import Commit


@dataclass(frozen=True, slots=True)
class RailRow:
    """One line of the rail: of a commit (`| * `), or of an edge between lines of history (`|/`), without a commit."""

    rail: str
    commit: Commit | None = None


@dataclass(frozen=True, slots=True)
class Place:
    """Where a commit is drawn: the `lane` it stands on, from the left, and the `links` from its row to the next one
    below, from lane to lane."""

    lane: int
    links: tuple[tuple[int, int], ...]


def topological(commits: Sequence[Commit]) -> list[Commit]:
    """Return the commits with children before parents and each line of history in one stretch.

    The newest tip comes first; the order given breaks ties. This is what `git log --topo-order` does.
    """
    known = {c.id: c for c in commits}
    children = dict.fromkeys(known, 0)
    for commit in commits:
        for parent in commit.parents:
            if parent in children:
                children[parent] += 1
    ready = sorted((c for c in commits if not children[c.id]), key=lambda c: c.time)
    ordered = []
    while ready:
        commit = ready.pop()
        ordered.append(commit)
        for parent in reversed(commit.parents):
            if parent in children:
                children[parent] -= 1
                if not children[parent]:
                    ready.append(known[parent])
    return ordered


def places(commits: Iterable[Commit]) -> dict[str, Place]:
    """Return where each commit is drawn, children before parents; parents that are not among them end their line."""
    shown = list(commits)
    known = {c.id for c in shown}
    expected: list[str] = []  # the commit that each lane waits for
    found = {}
    for commit in shown:
        if commit.id not in expected:
            expected.append(commit.id)
        lane, below, links = expected.index(commit.id), list[str](), list[tuple[int, int]]()
        for at, awaited in enumerate(expected):
            for follows in (p for p in commit.parents if p in known) if at == lane else (awaited,):
                if follows not in below:
                    below.append(follows)
                links.append((at, below.index(follows)))
        found[commit.id] = Place(lane, tuple(links))
        expected = below
    return found


def lanes(commits: Iterable[Commit]) -> list[RailRow]:
    """Return the rail for `commits`, children before parents: one row a commit, and rows for the edges between.

    Parents that are not among the commits end their line. All rails are equally wide.
    """
    shown = list(commits)
    known = {c.id for c in shown}
    expected: list[str] = []  # the commit that each line of history, left to right, waits for
    rows: list[RailRow] = []
    for commit in shown:
        if commit.id not in expected:
            expected.append(commit.id)
        here = expected.index(commit.id)
        rows.append(RailRow(" ".join("*" if i == here else "|" for i in range(len(expected))), commit))
        parents = [p for p in commit.parents if p in known]
        if not parents:
            rows += _closed(expected, here)
            continue
        expected[here] = parents[0]
        for parent in reversed(parents[1:]):
            rows.append(_split(len(expected), here))
            expected.insert(here + 1, parent)
        rows += _joined(expected)
    while rows and rows[-1].commit is None:
        rows.pop()
    width = max((len(r.rail) for r in rows), default=0)
    return [RailRow(r.rail.ljust(width), r.commit) for r in rows]


def _closed(expected: list[str], here: int) -> list[RailRow]:
    """End the line `here`; the lines right of it move one to the left."""
    rows = [_shift(len(expected), here, joining=False)] if here < len(expected) - 1 else []
    del expected[here]
    return rows


def _split(count: int, here: int) -> RailRow:
    """Return the row in which a line leaves `here` to the right and the lines beyond make room."""
    cells = [" "] * (2 * count + 1)
    for i in range(count):
        cells[2 * i if i <= here else 2 * i + 1] = "|" if i <= here else "\\"
    cells[2 * here + 1] = "\\"
    return RailRow("".join(cells).rstrip())


def _joined(expected: list[str]) -> list[RailRow]:
    """Join lines that wait for the same commit, the right one running to the left one, and return the rows."""
    rows = []
    while len(set(expected)) < len(expected):
        right = next(i for i, name in enumerate(expected) if name in expected[:i])
        left = expected.index(expected[right])
        rows.append(_shift(len(expected), right, joining=True))
        del expected[right]
        for at in range(right - 1, left, -1):  # the edge crosses the lines between
            cells = list(" ".join("|" for _ in expected))
            cells[2 * at - 1] = "/"
            rows.append(RailRow("".join(cells)))
    return rows


def _shift(count: int, gone: int, *, joining: bool) -> RailRow:
    """Return the row in which line `gone` vanishes (to the left where `joining`) and those right of it follow."""
    cells = [" "] * (2 * count)
    for i in range(count):
        if i < gone:
            cells[2 * i] = "|"
        elif i > gone or joining:
            cells[2 * i - 1] = "/"
    return RailRow("".join(cells).rstrip())
