"""Edits change what they are asked to change, and not a byte more."""

from __future__ import annotations

import difflib
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from manifest_samples import GOOD, STATE

from pico.diagnostics import PicoError
from pico.manifest.capture import capture
from pico.manifest.edit import set_values
from pico.manifest.load import load_files
from pico.manifest.text.source import Source
from pico.manifest.text.tree import parse, plain
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState

HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\n"
FLOW = HEAD + "components: {p1: {slot: storage/a1, angle: 3}, p2: {pose: {x: 1, y: 2, yaw: 3}}}  # all\n"
COMMENTED = HEAD.replace("\n", "\r\n") + (
    "# the table\r\ncomponents:   # all of them\r\n\r\n    # the first\r\n    p1:   # polarizer\r\n"
    "        slot: 'storage/a1'   # stowed\r\n        # crossed\r\n        angle: \"2\"\t# deg\r\n    p2:\r\n"
    "        pose: {x: 1, y: 2, yaw: 3}   # placed\r\n    # the end\r\n"
)


def leaves(text: str) -> dict[str, dict[str, object]]:
    (document,), found = parse(Source("x", text.removeprefix("\ufeff")))
    assert not found
    return {name: part or {} for name, part in (plain(document.root).get("components") or {}).items()}


def changed_lines(old: str, new: str) -> list[str]:
    diff = difflib.unified_diff(old.splitlines(keepends=True), new.splitlines(keepends=True), n=0)
    return [line.rstrip("\r\n") for line in diff if line[0] in "+-" and not line.startswith(("+++", "---"))]


def test_one_changed_tunable_is_a_one_line_diff() -> None:
    assert changed_lines(STATE, set_values(STATE, {"p1": {"angle": 1.0}})) == ["-    angle: 90.0", "+    angle: 1.0"]


def test_a_slot_gives_way_to_a_pose_and_back() -> None:
    placed = set_values(STATE, {"p2": {"pose": Pose(500, 420, 30)}})
    assert changed_lines(STATE, placed) == [
        "-    slot: storage/a2", "+    pose:", "+      x: 500", "+      y: 420", "+      yaw: 30",
    ]  # fmt: skip
    assert set_values(placed, {"p2": {"slot": "storage/a2"}}) == STATE


def test_of_a_pose_only_the_moved_axis_changes() -> None:
    assert changed_lines(STATE, set_values(STATE, {"p1": {"pose": Pose(295.5, 420, 0)}})) == [
        "-      x: 290",
        "+      x: 295.5",
    ]


def test_a_new_component_stands_in_its_place_by_name() -> None:
    text = set_values(STATE, {"lens": {"slot": "storage/a1"}, "zoom": {"pose": Pose(1, 2, 3), "open": True}})
    assert list(leaves(text)) == ["laser", "lens", "p1", "p2", "zoom"]
    assert all(line[0] == "+" for line in changed_lines(STATE, text))


@pytest.mark.parametrize(
    "empty", ["", "components:\n", "components: {}\n", "components: ~  # none\n", "components:  # none\n"]
)
def test_a_state_without_components_gets_its_first(empty: str) -> None:
    text = set_values(HEAD + empty, {"p1": {"slot": "storage/a1"}})
    assert leaves(text) == {"p1": {"slot": "storage/a1"}}
    assert "  p1:\n    slot: storage/a1\n" in text


def test_comments_quotes_and_line_ends_stay() -> None:
    text = set_values(COMMENTED, {"p1": {"pose": Pose(5, 6, 7), "angle": 9.5}, "p2": {"pose": Pose(1, 2, 4)}})
    assert text.count("\r\n") == text.count("\n")
    for comment in (
        "# the table",
        "# all of them",
        "# the first",
        "# polarizer",
        "# crossed",
        "# deg",
        "# placed",
        "# the end",
    ):
        assert comment in text
    assert "pose: {x: 1, y: 2, yaw: 4}   # placed\r\n" in text
    assert leaves(text)["p1"] == {"pose": {"x": 5, "y": 6, "yaw": 7}, "angle": 9.5}


def test_flow_style_stays_flow() -> None:
    text = set_values(FLOW, {"p1": {"pose": Pose(1, 2, 0)}, "p2": {"angle": 4.0}, "p0": {"slot": "storage/a2"}})
    assert text.count("\n") == FLOW.count("\n")
    assert text.endswith("}  # all\n")


def test_entries_and_components_can_be_taken_out() -> None:
    assert leaves(set_values(STATE, {"p1": {"angle": None}, "p2": None})).keys() == {"laser", "p1"}
    assert leaves(set_values(FLOW, {"p1": {"angle": None}, "p2": None})) == {"p1": {"slot": "storage/a1"}}


def test_text_that_is_no_state_is_refused() -> None:
    for text in ("apiVersion: pico/v1\nkind: Lab\nmetadata: {name: x}\n", "a: [", ""):
        with pytest.raises(PicoError):
            set_values(text, {"p1": {"slot": "a"}})


NAMES = st.sampled_from(["a", "laser", "lens_2", "p1", "p11", "p2", "zz"])
NUMBERS = st.floats(-1e6, 1e6).map(lambda x: round(x, 3)) | st.integers(-999, 999).map(float)
WORDS = st.sampled_from(["open", "true", "null", "1e3", "on", "a: b", "x # y", "-", "", "it's", "é", "0x1f"])
POSES = st.builds(Pose, NUMBERS, NUMBERS, NUMBERS)
PLACES = st.one_of(
    st.fixed_dictionaries({"slot": st.sampled_from(["storage/a1", "b/2"])}), st.fixed_dictionaries({"pose": POSES})
)
TUNABLES = st.dictionaries(
    st.sampled_from(["angle", "emission", "shutter", "z"]), NUMBERS | st.booleans() | WORDS, max_size=3
)
PARTS = st.builds(lambda a, b: a | b, PLACES, TUNABLES)


@given(
    st.sampled_from([STATE, FLOW, COMMENTED, HEAD, "\ufeff" + STATE, STATE.rstrip("\n"), STATE.replace("\n", "\r\n")]),
    st.dictionaries(NAMES, PARTS, max_size=4),
    st.dictionaries(NAMES, TUNABLES, max_size=2),
)
def test_any_edits_give_the_leaves_asked_for(text: str, first: dict, second: dict) -> None:
    expected = leaves(text)
    for changes in (first, {n: v for n, v in second.items() if n in expected or n in first}):
        text = set_values(text, changes)
        for name, part in changes.items():
            place = {k: vars_of(v) for k, v in part.items()}
            kept = {
                k: v
                for k, v in expected.get(name, {}).items()
                if k not in ("slot", "pose") or not place.keys() & {"slot", "pose"}
            }
            expected[name] = kept | place
        assert with_yaw(leaves(text)) == with_yaw(expected)
    assert set_values(text, first | second if second.keys() <= first.keys() and not second else {}) == text


def vars_of(value: object) -> object:
    return {"x": value.x, "y": value.y, "yaw": value.yaw} if isinstance(value, Pose) else value


def with_yaw(state: dict) -> dict:
    def full(part: dict) -> dict:
        return part | {"pose": {"yaw": 0} | part["pose"]} if "pose" in part else part

    return {name: full(part) for name, part in state.items()}


def bench() -> tuple[Setup, LabState]:
    return load_files(GOOD).require()


def captured(change: Callable[[dict[str, ComponentState]], None]) -> list[str]:
    setup, wanted = bench()
    components = dict(wanted.components)
    change(components)
    written = capture(GOOD, setup, wanted, LabState(lab="bench", components=components))
    assert written.keys() <= {"state/table.yaml"}
    return changed_lines(STATE, written.get("state/table.yaml", STATE.encode()).decode())


def test_capture_of_the_wanted_state_changes_nothing() -> None:
    assert captured(lambda parts: None) == []


def test_capture_keeps_what_is_within_tolerance() -> None:
    def nudge(parts: dict[str, ComponentState]) -> None:
        parts["p1"] = ComponentState(pose=Pose(290.3, 419.8, 0.4), values={"angle": 90.05})

    assert captured(nudge) == []


def test_capture_writes_what_differs_rounded_to_resolution() -> None:
    def move(parts: dict[str, ComponentState]) -> None:
        parts["p1"] = ComponentState(pose=Pose(295.00391, 420.1, 0.2), values={"angle": 91.23456})

    assert captured(move) == ["-      x: 290", "+      x: 295", "-    angle: 90.0", "+    angle: 91.23"]


def test_capture_counts_periods() -> None:
    def turn(parts: dict[str, ComponentState]) -> None:
        parts["p1"] = ComponentState(pose=Pose(290, 420, 360), values={"angle": 270.0})

    assert captured(turn) == []


def test_capture_leaves_what_nobody_saw() -> None:
    assert captured(lambda parts: parts.clear()) == []


def test_capture_adds_what_no_file_names_to_the_largest_file() -> None:
    setup, _ = bench()
    head, rest = STATE.split("  p2:\n    slot: storage/a2\n    angle: 1\n")
    small = HEAD + "components: {}\n"
    files = GOOD | {"state/table.yaml": (head + rest).encode(), "state/a.yaml": small.encode()}
    wanted = load_files(files).require()[1]
    home = dict(wanted.components) | {"p2": ComponentState(slot="storage/a2", values={"angle": 7.0})}
    assert capture(files, setup, wanted, LabState(lab="bench", components=home)) == {}
    placed = home | {"p2": ComponentState(pose=Pose(600, 420, 0), values={"angle": 7.0})}
    written = capture(files, setup, wanted, LabState(lab="bench", components=placed))
    assert written.keys() == {"state/table.yaml"}
    assert leaves(written["state/table.yaml"].decode())["p2"] == {"pose": {"x": 600, "y": 420, "yaw": 0}, "angle": 7}


def test_a_component_with_both_keeps_only_what_is_set() -> None:
    text = HEAD + "components:\n  p1:\n    slot: storage/a1  # stowed\n    pose: {x: 1, y: 2}\n    angle: 3\n"
    assert leaves(set_values(text, {"p1": {"slot": "storage/a2"}})) == {"p1": {"slot": "storage/a2", "angle": 3}}


def test_a_layout_that_can_not_be_edited_is_refused_unchanged() -> None:
    with pytest.raises(PicoError) as caught:
        set_values(HEAD + "components:\n  p1:\n    - slot: storage/a1\n", {"p1": {"angle": 3.0}})
    assert "p1" in caught.value.diagnostics[0].summary
