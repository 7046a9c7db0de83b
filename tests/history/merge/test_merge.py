"""Three-way merges of manifests: what both sides did is in the result, or stands between markers."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from merging_cases import Case, Leaf, case, faults
from merging_cases import state_of as state

from examples import examples
from pico.history.merge.manifests import Merged, merge
from pico.history.merge.markers import Labels, view

BASE = """apiVersion: pico/v1
kind: LabState
metadata: {lab: bench}
components:
  # the source
  laser:
    pose:
      x: 120
      y: 420
      yaw: 0
    emission: true
  m1:
    slot: storage/a1
    tip: 1.0  # mrad
    tilt: 2
"""


def merged(ours: str, theirs: str, base: str = BASE, **options: Any) -> Merged:
    return merge(base.encode(), ours.encode(), theirs.encode(), **options)


def leaves(found: Merged) -> set[Leaf]:
    return {(c.path[2], ".".join(c.path[3:])) for c in found.conflicts}


def check(c: Case) -> None:
    """Demand of a case what the merge promises, for either side called ours."""
    forth, back = merged(c.ours, c.theirs, c.base), merged(c.theirs, c.ours, c.base)
    assert not faults(c, forth.data.decode())
    assert state(view(back.data.decode(), "theirs")) == state(view(forth.data.decode(), "ours"))
    assert forth.data == back.data or c.conflicting


@settings(max_examples=examples(30), deadline=None)
@given(st.integers(0, 10**6))
def test_different_tunables_unite_the_same_one_conflicts_and_comments_survive(seed: int) -> None:
    check(case(seed))


def test_a_clean_merge_changes_the_lines_of_the_edits_only() -> None:
    ours, theirs = BASE.replace("x: 120", "x: 130"), BASE.replace("tilt: 2", "tilt: 3.5   # was 2")
    assert merged(ours, theirs).data.decode() == theirs.replace("x: 120", "x: 130")


def test_a_conflict_says_what_each_side_did_and_keeps_everything_else() -> None:
    found = merged(BASE.replace("x: 120", "x: 132.5"), BASE.replace("x: 120", "x: 110").replace("tilt: 2", "tilt: 3"))
    assert "<<<<<<< ours: laser.pose.x 132.5 (+12.5)\n      x: 132.5\n=======\n      x: 110\n" in found.data.decode()
    assert ">>>>>>> theirs: laser.pose.x 110 (-10)\n" in found.data.decode()
    assert found.data.count(b"tilt: 3") == 1
    assert [(c.address, c.base) for c in found.conflicts] == [("laser.pose.x", "120")]


def test_labels_and_the_length_of_markers_are_gits() -> None:
    found = merged(
        BASE.replace("tilt: 2", "tilt: 3"), BASE.replace("tilt: 2", "tilt: 4"), labels=Labels("E1", "", "C3", 9)
    )
    assert "<<<<<<<<< E1: m1.tilt 3 (+1)\n" in found.data.decode() and ">>>>>>>>> C3: " in found.data.decode()


def test_the_same_value_written_in_two_ways_is_no_conflict() -> None:
    found = merged(BASE.replace("tilt: 2", "tilt: 3"), BASE.replace("tilt: 2", "tilt: 3.0"))
    assert found.clean and state(found.data.decode())["m1", "tilt"] == 3


def test_a_slot_against_a_pose_is_one_conflict_over_the_place() -> None:
    pose = "pose:\n      x: 1\n      y: 2\n      yaw: 0"
    found = merged(BASE.replace("slot: storage/a1", pose), BASE.replace("storage/a1", "storage/a2"))
    assert [(c.address, c.ours, c.theirs) for c in found.conflicts] == [
        ("m1.pose", "{x: 1, y: 2, yaw: 0}", "storage/a2")
    ]
    assert ("m1", "slot") not in state(view(found.data.decode(), "ours"))
    assert ("m1", "pose.x") not in state(view(found.data.decode(), "theirs"))


def test_a_component_taken_out_here_and_changed_there_conflicts() -> None:
    found = merged(BASE[: BASE.index("  m1:")], BASE.replace("tilt: 2", "tilt: 3"))
    assert not found.clean and [c.address for c in found.conflicts] == ["m1"]
    assert ("m1", "tilt") not in state(view(found.data.decode(), "ours"))
    assert state(view(found.data.decode(), "theirs"))["m1", "tilt"] == 3


def test_a_component_that_said_nothing_and_is_given_two_places_keeps_both_between_markers() -> None:
    base = BASE + "  p1:\n"
    found = merged(base + "    slot: a\n    angle: 44\n", base + "    slot: b\n    tip: 1\n", base)
    mine, other = (state(view(found.data.decode(), side)) for side in ("ours", "theirs"))
    assert [c.address for c in found.conflicts] == ["p1"] and found.data.count(b"m1:") == 1
    assert (mine["p1", "slot"], mine["p1", "angle"], other["p1", "slot"], other["p1", "tip"]) == ("a", 44, "b", 1)


def test_both_sides_adding_one_component_agree_or_conflict_value_by_value() -> None:
    found = merged(
        BASE + "  p1:\n    slot: storage/b1\n    angle: 1\n", BASE + "  p1:\n    slot: storage/b1\n    angle: 2\n"
    )
    assert [c.address for c in found.conflicts] == ["p1.angle"] and found.data.count(b"storage/b1") == 1


def test_comments_of_both_sides_at_one_value_are_kept() -> None:
    found = merged(BASE.replace("# mrad", "# glued"), BASE.replace("# mrad", "# loose").replace("1.0", "1.5"))
    assert found.clean and b"# glued" in found.data and b"# loose" in found.data and b"1.5" in found.data


def test_what_each_side_adds_to_the_comments_of_one_entry_is_there_whoever_merges() -> None:
    ours = BASE.replace("  # the source\n", "  # the source\n  # by us\n").replace("x: 120", "x: 130")
    theirs = BASE.replace("  # the source\n", "  # the source\n  # by them\n").replace("tilt: 2", "tilt: 3")
    for found in (merged(ours, theirs), merged(theirs, ours)):
        assert not found.conflicts
        assert all(found.data.decode().count(f"# {who}") == 1 for who in ("the source", "by us", "by them"))


def test_a_comment_on_what_the_other_side_took_out_survives() -> None:
    found = merged(BASE.replace("    tilt: 2\n", ""), BASE.replace("    tilt: 2\n", "    tilt: 2  # drifts\n"))
    assert found.clean and b"# drifts" in found.data and ("m1", "tilt") not in state(found.data.decode())


def test_comments_in_a_list_that_both_sides_changed_are_a_conflict_and_never_lost() -> None:
    base = BASE + "expect:\n  - that: m1.tip > 0\n  - that: m1.tilt > 0  # since May\n"
    ours, theirs = base.replace("# since May", "# by ours"), base.replace("# since May", "# by theirs")
    found = merged(ours, theirs, base)
    assert not found.clean and b"# by ours" in found.data and b"# by theirs" in found.data


@pytest.mark.parametrize(("ours", "theirs"), [("true", "1"), ("false", "0"), ("1", '"1"')])
def test_what_only_looks_the_same_to_python_is_a_conflict(ours: str, theirs: str) -> None:
    found = merged(
        *(BASE.replace("emission: true", f"emission: {value}") for value in (ours, theirs)),
        BASE.replace("emission: true", "emission: null"),
    )
    assert not found.clean and [c.address for c in found.conflicts] == ["laser.emission"]


GROUPS = {"m1": (("tip", "tilt"),)}


def test_coupled_tunables_are_reported_and_conflict_where_strict() -> None:
    ours, theirs = BASE.replace("tip: 1.0", "tip: 1.5"), BASE.replace("tilt: 2", "tilt: 3")
    found = merged(ours, theirs, groups=GROUPS)
    assert found.clean and [(c.component, c.ours, c.theirs) for c in found.coupled] == [("m1", ("tip",), ("tilt",))]
    strict = merged(ours, theirs, groups=GROUPS, strict=True)
    assert not strict.clean and {c.address for c in strict.conflicts} == {"m1.tip", "m1.tilt"}
    assert view(strict.data.decode(), "ours") == ours and view(strict.data.decode(), "theirs") == theirs


@pytest.mark.parametrize(("mine", "other", "together"), [
    ({"tip"}, {"tilt"}, True), ({"tip"}, {"slot"}, False), ({"slot"}, {"tilt"}, False),
    ({"tip", "tilt"}, {"slot"}, False),
    ({"tip", "slot"}, {"tilt"}, True), ({"tip"}, {"x"}, False), ({"tip"}, set(), False), ({"tip"}, {"tip"}, False),
])  # fmt: skip
def test_a_group_is_told_of_only_where_each_side_changed_a_part_of_it(
    mine: set[str], other: set[str], together: bool
) -> None:
    edits = {"tip": ("tip: 1.0", "tip: 1.5"), "tilt": ("tilt: 2", "tilt: 3"), "x": ("x: 120", "x: 130"),
             "slot": ("storage/a1", "storage/a2")}  # fmt: skip

    def edited(names: set[str]) -> str:
        text = BASE
        for name in sorted(names):
            text = text.replace(*edits[name])
        return text

    found = merged(edited(mine), edited(other), groups=GROUPS)
    assert found.clean and [c.component for c in found.coupled] == (["m1"] if together else [])


def test_a_pose_is_always_one_group() -> None:
    found = merged(BASE.replace("x: 120", "x: 1"), BASE.replace("yaw: 0", "yaw: 9"))
    assert found.clean and [(c.ours, c.theirs) for c in found.coupled] == [(("pose.x",), ("pose.yaw",))]


def test_line_ends_and_byte_order_mark_stay_as_ours_has_them() -> None:
    ours, theirs = BASE.replace("x: 120", "x: 130"), BASE.replace("tilt: 2", "tilt: 3")
    found = merge(*(b"\xef\xbb\xbf" + t.replace("\n", "\r\n").encode() for t in (BASE, ours, theirs)))
    assert found.clean and found.data.startswith(b"\xef\xbb\xbf")
    assert found.data.count(b"\r\n") == found.data.count(b"\n") == BASE.count("\n")


@pytest.mark.parametrize("base", [b"", None, b"<<<<<<< a\nkind: [\n"])
def test_without_a_readable_base_nothing_is_lost(base: bytes | None) -> None:
    ours, theirs = BASE.replace("x: 120", "x: 130"), BASE.replace("tilt: 2", "tilt: 3")
    found = merge(base, ours.encode(), theirs.encode())
    assert not found.clean
    assert "x: 130" in view(found.data.decode(), "ours") and "tilt: 3" in view(found.data.decode(), "theirs")


def test_other_files_are_merged_by_lines() -> None:
    found = merge(b"a\nb\nc\nd\n", b"A\nb\nc\nd\n", b"a\nb\nc\nD\n")
    assert found.clean and found.data == b"A\nb\nc\nD\n"
    assert not merge(b"a\n", b"b\n", b"c\n").clean


def test_what_lines_unite_to_nonsense_is_a_conflict() -> None:
    base = "a: 1\n\n\n\n\nb: 2\n"
    found = merge(
        base.encode(), base.replace("a: 1", "c: 1\na: 1").encode(), base.replace("b: 2", "b: 2\nc: 2").encode()
    )
    assert not found.clean and found.data.startswith(b"<<<<<<< ours\n")


def test_a_file_that_holds_the_words_of_a_conflict_is_merged_by_lines() -> None:
    odd = BASE.replace("storage/a1", "__pico_conflict_0__")
    found = merged(odd.replace("x: 120", "x: 1"), odd.replace("x: 120", "x: 2"), odd)
    assert not found.clean and b"__pico_conflict_0__" in found.data
