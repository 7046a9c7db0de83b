"""The rail beside the log, as git draws it."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.history.git.commit import Commit
from pico.history.git.lanes import lanes, places, topological


def commits(text: str) -> list[Commit]:
    """Return commits from `child:parent,parent ...`, newest first."""
    words = text.split()
    found = []
    for number, word in enumerate(words):
        name, _, parents = word.partition(":")
        when = datetime.fromtimestamp(1_000_000 - number, UTC)
        found.append(Commit(name, tuple(p for p in parents.split(",") if p), name, name, "me", when))
    return found


def drawn(text: str) -> list[str]:
    return [f"{r.rail} {r.commit.id if r.commit else ''}".rstrip() for r in lanes(commits(text))]


@pytest.mark.parametrize(
    ("history", "rail"),
    [
        ("c:b b:a a", ["* c", "* b", "* a"]),
        ("y:b x:b b:a a", ["*   y", "| * x", "|/", "*   b", "*   a"]),
        ("m:b,x x:a b:a a", ["*   m", "|\\", "| * x", "* | b", "|/", "*   a"]),
        (
            "z:a y:b x:c b:a c:a a",
            ["*     z", "| *   y", "| | * x", "| * | b", "|/ /", "| *   c", "|/", "*     a"],
        ),
        ("z:a y:b x:a b:a a", ["*     z", "| *   y", "| | * x", "| |/", "|/|", "| *   b", "|/", "*     a"]),
        ("b y:a a", ["* b", "* y", "* a"]),
        ("o:a,b,c c:a b:a a", ["*     o", "|\\", "|\\ \\", "| | * c", "| |/", "|/|", "| *   b", "|/", "*     a"]),
        ("", []),
    ],
)
def test_rails(history: str, rail: list[str]) -> None:
    assert drawn(history) == rail


def test_a_line_of_history_stays_in_one_stretch() -> None:
    interleaved = commits("y2:y1 x2:x1 y1:a x1:a a")
    assert [c.id for c in topological(interleaved)] == ["y2", "y1", "x2", "x1", "a"]


@st.composite
def histories(draw: st.DrawFn) -> list[Commit]:
    count = draw(st.integers(1, 12))
    words = []
    for i in range(count):
        older = st.integers(i + 1, count - 1)
        parents = draw(st.lists(older, max_size=3, unique=True)) if i < count - 1 else []
        words.append(f"c{i}:" + ",".join(f"c{p}" for p in parents))
    return commits(" ".join(words))


@given(histories())
def test_every_commit_has_one_row_with_one_star(history: list[Commit]) -> None:
    ordered = topological(history)
    place = {c.id: i for i, c in enumerate(ordered)}
    assert len(place) == len(history)
    assert all(place[c.id] < place[p] for c in ordered for p in c.parents)
    rows = lanes(ordered)
    assert [r.commit for r in rows if r.commit] == ordered
    assert all(r.rail.count("*") == (r.commit is not None) for r in rows)
    assert len({len(r.rail) for r in rows}) == 1


@given(histories())
def test_the_links_of_a_commit_lead_to_its_parents(history: list[Commit]) -> None:
    ordered = topological(history)
    found = places(ordered)
    for at, commit in enumerate(ordered):
        met, lanes_now = set[str](), {found[commit.id].lane}
        for here, below in zip(ordered[at:], ordered[at + 1 :], strict=False):
            lanes_now = {to for start, to in found[here.id].links if start in lanes_now}
            if found[below.id].lane in lanes_now and below.id in commit.parents:
                met.add(below.id)
                lanes_now -= {found[below.id].lane}
        assert met == set(commit.parents)
    assert all(len(set(found[c.id].links)) == len(found[c.id].links) for c in ordered)


def test_lanes_as_numbers_join_where_a_branch_began() -> None:
    found = places(commits("y:b x:b b:a a"))
    assert [(found[n].lane, found[n].links) for n in "yxba"] == [
        (0, ((0, 0),)),
        (1, ((0, 0), (1, 0))),
        (0, ((0, 0),)),
        (0, ()),
    ]
