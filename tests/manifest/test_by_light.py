"""Set-points that light finds: read with all that is wrong with them, laid out and captured without a change."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.manifest.capture import capture
from pico.manifest.edit import set_values
from pico.manifest.fmt import format_text
from pico.manifest.load import load_files, load_folder
from pico.model.diff import diff_states
from pico.model.pose import Pose
from pico.model.state import ComponentState, LabState, LightReference, references_of, state_from_json
from pico.resources import labs_dir

SETUP = load_folder(labs_dir() / "shel").require()[0]
HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n"
NULL = "{null_of: [p1, p2], offset: 1.0}"


def text_of(reference: str, more: str = "") -> str:
    """Return a manifest in which p2 stands in the beam at an angle that light finds."""
    first = "  p1:\n    pose: {x: 290, y: 420}\n    angle: 90\n"
    return f"{HEAD}{first}  p2:\n    pose: {{x: 520, y: 420}}\n    angle: {reference}{more}\n"


def read(reference: str) -> tuple[LabState | None, list[str]]:
    """Return the state and what is wrong with it."""
    found = load_files({"state.yaml": text_of(reference).encode()}, setup=SETUP)
    return found.state, [d.summary for d in found.diagnostics if d.severity == "error"]


@pytest.mark.parametrize(
    ("written", "offset"),
    [
        (NULL, 1.0),
        ("{null_of: [p1, p2], offset: 1 deg}", 1.0),
        ("{null_of: [p1, p2], offset: 17.453292519943 mrad}", 1.0),
        ("{null_of: [p1, p2]}", 0.0),
    ],
)
def test_an_offset_is_in_the_unit_of_its_tunable(written: str, offset: float) -> None:
    state, wrong = read(written)
    assert not wrong and state is not None
    one = references_of(state)["p2.angle"]
    assert one.null_of == ("p1", "p2") and one.offset == pytest.approx(offset)
    assert "angle" not in state.components["p2"].values


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("{null_of: [p1, p3]}", "refers to `p3`, which is not in the inventory"),
        ("{null_of: [p1, lx_100]}", "lx_100 (plano_convex_100) is neither a polarizer nor a waveplate"),
        ("{null_of: [p1, p1]}", "names p1 twice"),
        ("{null_of: [hwp, p1]}", "turning p2 finds no null of hwp and p1"),
        ("{null_of: [p1]}", "a list of 1, not two parts"),
        ("{null_of: p1}", "`p1`, not two parts"),
        ("{null_of: }", "is empty, not two parts"),
        ("{null_off: [p1, p2]}", "unknown key `null_off`"),
        ("{null_of: [p1, p2], ofset: 1}", "unknown key `ofset`"),
        ("{null_of: [p1, p2], offset: 3 mm}", "is an angle, not a length"),
        ("{null_of: [p1, p2], offset: .nan}", "no finite number"),
        ("{null_of: [p1, p2], offset: 360}", "more than its period"),
        ("{null_of: [p1, p2], through: [p1, p2]}", "has both"),
        ("{through: [p1, p2]}", "finds the tip and tilt of a mirror, not p2.angle"),
        ("{x: 3}", "is a mapping, not a number"),
        ("\n      null_of: [p1, p2]", "is not on one line"),
        ("{null_of: [p1,\n      p2]}", "is not on one line"),
    ],
)
def test_what_is_wrong_with_one_is_told(written: str, said: str) -> None:
    state, wrong = read(written)
    assert state is None and any(said in one for one in wrong), wrong


def test_a_wave_plate_alone_has_no_null() -> None:
    laid = text_of("90").replace("  p1:", "  hwp:\n    angle: {null_of: [hwp, hwp]}\n  p1:", 1)
    assert any("names hwp twice" in d.summary for d in load_files({"s.yaml": laid.encode()}, setup=SETUP).diagnostics)


def test_one_is_a_value_of_the_digest_and_comes_back_from_json() -> None:
    state, _ = read(NULL)
    number, _ = read("1.0")
    assert state is not None and number is not None and state.digest() != number.digest()
    assert state_from_json("shel", state.as_json()) == replace(state, expect=())
    same, _ = read("{offset: 1 deg, null_of: [p1, p2]}")
    assert same is not None and same.digest() == state.digest()


def test_a_difference_says_it_in_words() -> None:
    number, named, other = (read(text)[0] for text in ("90", NULL, "{null_of: [p1, p2]}"))
    assert number and named and other
    said = [diff_states(SETUP, a, b)[0].text for a, b in ((number, named), (named, number), (named, other))]
    assert said == [
        "90 deg → 1° from the null of p1 and p2",
        "1° from the null of p1 and p2 → 90 deg",
        "1° from the null of p1 and p2 → at the null of p1 and p2",
    ]


@given(
    offset=st.floats(-170, 170).map(lambda x: round(x, 3)),
    flip=st.booleans(),
    comment=st.sampled_from(["", "   # why", "  # {null_of: [x]}"]),
    spaces=st.sampled_from(["{{null_of: [{0}, {1}], offset: {2}}}", "{{ null_of: [ {0},{1} ],  offset:  {2} }}"]),
)
def test_neither_layout_nor_capture_changes_what_is_referred_to(
    offset: float, flip: bool, comment: str, spaces: str
) -> None:
    names = ("p2", "p1") if flip else ("p1", "p2")
    text = text_of(spaces.format(*names, offset), comment)
    before = load_files({"s.yaml": text.encode()}, setup=SETUP).require()[1]
    laid = format_text(text)
    assert format_text(laid) == laid
    assert load_files({"s.yaml": laid.encode()}, setup=SETUP).require()[1] == before
    parts = {"p1": ComponentState(pose=Pose(290, 420, 0), values={"angle": 12.5}),
             "p2": ComponentState(pose=Pose(560, 420, 0), values={"angle": 33.0})}  # fmt: skip
    written = capture({"s.yaml": text.encode()}, SETUP, before, LabState(lab="shel", components=parts))
    after = load_files(written, setup=SETUP).require()[1]
    assert references_of(after) == references_of(before)
    assert after.components["p1"].values["angle"] == 12.5
    assert [a for a in text.splitlines() if "null_of" in a] == [
        a for a in written["s.yaml"].decode().splitlines() if "null_of" in a
    ]


@given(offset=st.floats(-170, 170).map(lambda x: round(x, 3)), back=st.booleans())
def test_one_is_written_into_a_manifest_as_one_value_and_taken_out_again(offset: float, back: bool) -> None:
    goal = LightReference(null_of=("p1", "p2"), offset=offset).as_json()
    text = text_of("90", "   # why")
    made = set_values(text, {"p2": {"angle": goal}})
    assert len(made.splitlines()) == len(text.splitlines()) and "# why" in made
    assert references_of(load_files({"s.yaml": made.encode()}, setup=SETUP).require()[1])["p2.angle"].as_json() == goal
    if back:
        assert set_values(made, {"p2": {"angle": 90}}) == text


def test_block_style_becomes_one_line_with_its_comments() -> None:
    laid = format_text(text_of("  # why\n      null_of: [p1, p2]\n      offset: 1.0   # one"))
    assert "    # why\n    angle: {null_of: [p1, p2], offset: 1.0}   # one\n" in laid


def test_two_at_the_null_of_the_same_two_parts_are_one_too_many() -> None:
    text = text_of("{null_of: [p2, p1]}").replace("angle: 90", "angle: {null_of: [p1, p2], offset: 2}", 1)
    found = load_files({"state.yaml": text.encode()}, setup=SETUP)
    (wrong,) = [d for d in found.diagnostics if d.severity == "error"]
    assert "p1.angle and p2.angle are both at the null of p2 and p1, and one of them does" in wrong.summary
    assert wrong.address == "p2.angle" and str(wrong.source).startswith("state.yaml:10:")


def test_a_third_mirror_is_one_too_many_for_two_irises() -> None:
    lab = f"""{LAB}  m3: {{type: mirror_tip_tilt, pose: {{x: 400, y: 600}}}}
"""
    bench = load_files({"lab.yaml": lab.encode()}).setup
    lines = [
        f"  {name}:\n    tip: {{through: [near, far]}}\n    tilt: {{through: [far, near]}}\n"
        for name in ("m1", "m2", "m3")
    ]
    text = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: irises}\ncomponents:\n" + "".join(lines)
    found = load_files({"state.yaml": text.encode()}, setup=bench).diagnostics
    assert [d.summary for d in found] == ["m1, m2, m3 are all to bring a beam through far and near, and two of them do"]
    assert str(found[0].source).endswith("state.yaml:13:11") and found[0].address == "m3.tilt"
    two = load_files({"state.yaml": text.replace(lines[2], "").encode()}, setup=bench)
    assert two.state is not None and not two.diagnostics


LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: irises}
table: {size: [1500, 900], beam_height: 70}
robots: {arm1: {model: xarm7, mount: {x: 750, y: 850, yaw: -90}}}
inventory:
  m1: {type: mirror_tip_tilt, pose: {x: 400, y: 260, yaw: -45}}
  m2: {type: mirror_tip_tilt, pose: {x: 400, y: 440, yaw: 135}}
  near: {type: iris, pose: {x: 560, y: 440, yaw: 0}}
  far: {type: iris, pose: {x: 1000, y: 440, yaw: 0}}
"""
