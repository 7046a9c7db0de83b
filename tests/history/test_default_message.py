"""The message of a commit for which nobody said why: what moved, the most of it in one line, all of it below."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from pico.history.messages.default import WIDTH, default_message
from pico.model.diff import Change

MOVED = Change(
    component="p2", tunable="pose", before={"x": 0, "y": 0, "yaw": 0}, after={"x": 5, "y": 0, "yaw": 30},
    text="moved 5 mm (dx +5), turned +30°",
)  # fmt: skip
STOWED = Change(component="lx", tunable="pose", before={"x": 1, "y": 2, "yaw": 0}, after="a/1", text="stowed in a/1")
SET = Change(component="p1", tunable="angle", before=90, after=1, text="90 → 1 deg")
FIRST = Change(component="cam", tunable="exposure", before=None, after=10, text="unknown → 10 ms")


def test_moves_come_first_and_everything_is_plain_text() -> None:
    assert default_message((SET, MOVED)).splitlines() == [
        "p2 moved 5 mm, turned +30 deg; p1.angle 90 -> 1 deg",
        "",
        "p2 moved 5 mm (dx +5), turned +30 deg, from (0, 0, 0 deg) to (5, 0, 30 deg)",
        "p1.angle 90 -> 1 deg",
    ]
    assert default_message((FIRST, STOWED)).splitlines()[0] == "lx stowed in a/1; cam.exposure set to 10 ms"


NAMES = st.text("abcdefghij_", min_size=1, max_size=40)


@given(st.lists(st.tuples(NAMES, st.sampled_from([MOVED, STOWED, SET, FIRST])), min_size=1, max_size=12))
def test_the_first_line_fits_and_nothing_is_left_out_below(drawn: list[tuple[str, Change]]) -> None:
    from dataclasses import replace

    changes = [replace(change, component=name) for name, change in drawn]
    subject, _, body = default_message(changes).partition("\n\n")
    assert 0 < len(subject) <= WIDTH and subject.isascii()
    assert len((body or subject).splitlines()) == len(changes)


def test_where_nothing_moved_it_says_what_changed_else() -> None:
    assert default_message((), ("state/table.yaml",)).startswith(
        "Nothing on the table changed: comments or layout of state/table.yaml\n\n"
    )
    assert default_message((), ("notes/p1.md",)).startswith("Nothing on the table changed: notes\n")
    assert default_message((), ("runs/2026/11/r/run.json",)).startswith("Nothing on the table changed: runs\n")
    assert all(len(line) <= WIDTH for line in default_message((), ("x" * 60, "y")).splitlines())
