"""Notes on parts: a line each, which merges keep from both sides."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pico.history.git.attributes import GITATTRIBUTES
from pico.history.lab.notes import Note, notes, with_note

Git = Callable[..., str]


def test_they_are_appended_and_read_back_by_day() -> None:
    data = with_note(b"- 2026-03-02 A: later\nby hand, without an end", "2026-01-01", "B: C", "two\n lines ")
    assert data.decode() == "- 2026-03-02 A: later\nby hand, without an end\n- 2026-01-01 B C: two lines\n"
    assert notes({"notes/p1.md": data}, "p1") == (
        Note(text="by hand, without an end"),
        Note(text="two lines", day="2026-01-01", author="B C"),
        Note(text="later", day="2026-03-02", author="A"),
    )
    assert notes({}, "p1") == ()


def test_appends_on_two_branches_never_conflict(repo: Path, git: Git) -> None:
    (repo / ".gitattributes").write_text(GITATTRIBUTES)
    path = repo / "notes" / "p1.md"
    path.parent.mkdir()

    def note(text: str) -> None:
        path.write_bytes(with_note(path.read_bytes() if path.exists() else b"", "2026-01-01", "A", text))
        git("add", "-A")
        git("commit", "-q", "-m", text)

    note("both")
    git("checkout", "-q", "-b", "other")
    note("theirs")
    git("checkout", "-q", "main")
    note("ours")
    git("merge", "-q", "-m", "merged", "other")
    assert sorted(n.text for n in notes({"notes/p1.md": path.read_bytes()}, "p1")) == ["both", "ours", "theirs"]
