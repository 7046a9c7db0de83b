"""Edits of manifests compose: steps add up and cancel, absolute values overwrite, different tunables commute.

As `pico set`, `move` and `do` with --manifest write them: read by `asked` against what the manifest says, written as
the least change. T_d2 after T_d1 is T_(d1+d2); T_-d after T_d gives the bytes of before.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import examples
from pico.diagnostics import PicoError
from pico.manifest.changes import asked_for
from pico.manifest.edit import spliced
from pico.manifest.load import load_files
from pico.model.request import as_stated, asked
from pico.model.state import ComponentState, LabState, with_values
from pico.resources import labs_dir

LAB = {"lab.yaml": (labs_dir() / "shel" / "lab.yaml").read_bytes()}
TABLE = b"""# comments and layout stay
apiVersion: pico/v1
kind: LabState
metadata: {lab: shel}
components:
  cam: {exposure: 10}
  hwp: {pose: {x: 230, y: 420, yaw: 0}, angle: 22.75}   # the first
  p1:
    pose:
      x: 290
      y: 420
      yaw: 10
    angle: 90
  p2:
    angle: 12.5
    pose: {x: 520, y: 420, yaw: -20}
  ly_150: {pose: {x: 700, y: 420, yaw: 0}, stage_y: 0.1, stage_z: -0.2}
"""
SETUP, _ = load_files({**LAB, "table.yaml": TABLE}).require()
Edit = tuple[str, str, dict[str, str]]


def state_of(table: bytes) -> LabState:
    return load_files({"table.yaml": table}, setup=SETUP).require()[1]


def edited(table: bytes, edit: Edit) -> bytes:
    """Return a manifest after one edit, as the commands make it: what is named alone changes, from what it says."""
    component, primitive, arguments = edit
    state = state_of(table)
    request = asked(SETUP, as_stated(SETUP, state), component, primitive, arguments)
    if primitive == "set":
        goal = with_values(state, {f"{component}.{name}": value for name, value in request.values.items()})
    else:
        own = state.components.get(component, ComponentState())
        goal = replace(state, components={**state.components, component: replace(
            own, pose=request.pose, slot=request.slot)})  # fmt: skip
    named = {component: frozenset(arguments if primitive == "set" else ["pose"])}
    return spliced({"table.yaml": table}, asked_for(SETUP, state, goal, named)).get("table.yaml", table)


def run(table: bytes, *edits: Edit) -> bytes:
    for edit in edits:
        table = edited(table, edit)
    return table


STEPPED = st.sampled_from([
    ("p1", "set", "angle"), ("p2", "set", "angle"), ("hwp", "set", "angle"), ("cam", "set", "exposure"),
    ("ly_150", "set", "stage_y"), ("p1", "move", "x"), ("p1", "move", "yaw"), ("p2", "move", "turn"),
    ("p2", "move", "y"), ("hwp", "move", "turn"), ("ly_150", "move", "x"),
])  # fmt: skip
FINEST = {"stage_y": 0.001, "exposure": 0.02}
"""Of a step, 0.1 mm or deg for all others: so that no range is left, and no resolution is too coarse."""
BY = st.integers(-90, 90)


def step(axis: tuple[str, str, str], by: int) -> Edit:
    """Return the edit that steps along an axis so many times its finest step."""
    component, primitive, key = axis
    size = f"{round(abs(by) * FINEST.get(key, 0.1), 6)}"
    sign = "+" if by >= 0 else "-"
    return component, primitive, {key: f"{sign}{size}" if key == "turn" else f"{sign}={size}"}


@settings(max_examples=examples(60))
@given(STEPPED, BY, BY)
def test_two_steps_are_their_sum(axis: tuple[str, str, str], one: int, two: int) -> None:
    assert run(TABLE, step(axis, one), step(axis, two)) == run(TABLE, step(axis, one + two))


@settings(max_examples=examples(60))
@given(STEPPED, BY, BY)
def test_a_step_back_gives_the_bytes_of_before(axis: tuple[str, str, str], first: int, by: int) -> None:
    table = run(TABLE, step(axis, first))
    assert run(table, step(axis, by), step(axis, -by)) == table
    assert run(TABLE, step(axis, by), step(axis, -by)) == TABLE


@settings(max_examples=examples(60))
@given(STEPPED, STEPPED, BY, BY)
def test_steps_of_different_tunables_commute_and_leave_one_another_alone(
    one: tuple[str, str, str], two: tuple[str, str, str], by: int, other: int
) -> None:
    first, second = step(one, by), step(two, other)
    assert run(TABLE, first, second) == run(TABLE, second, first)
    assert run(TABLE, first, second, step(one, -by)) == run(TABLE, second)


@settings(max_examples=examples(60))
@given(
    st.sampled_from([("p1", "set", "angle"), ("p1", "move", "x"), ("p2", "move", "yaw"), ("hwp", "move", "y")]),
    STEPPED, BY, st.integers(1, 17000), st.integers(1, 17000),
)  # fmt: skip
def test_absolute_values_overwrite_and_change_only_what_is_named(
    axis: tuple[str, str, str], other: tuple[str, str, str], by: int, one: int, two: int
) -> None:
    component, primitive, key = axis
    earlier = step(other, by)
    first, second = ((component, primitive, {key: str(n / 100)}) for n in (one, two))
    assert run(TABLE, first, second) == run(TABLE, second)
    if other[::2] not in (axis[::2], ("p2", "turn")):
        assert run(TABLE, earlier, second) == run(TABLE, second, earlier)


def test_the_edits_of_the_reproduction_keep_one_another() -> None:
    table = run(TABLE, ("p2", "move", {"x": "540"}), ("p2", "move", {"turn": "5"}), ("p2", "move", {"turn": "5"}))
    assert table == TABLE.replace(b"{x: 520, y: 420, yaw: -20}", b"{x: 540, y: 420, yaw: -10}")


def test_what_the_manifest_does_not_say_has_no_steps_and_places_count_from_it() -> None:
    """The bench may know p1's angle; a step of the manifest counts from the manifest. A lens goes behind p2 there."""
    silent = TABLE.replace(b"    angle: 90\n", b"")
    with pytest.raises(PicoError, match="the value of angle of p1 is unknown"):
        run(silent, ("p1", "set", {"angle": "+=5"}))
    assert b"angle: 5" in run(silent, ("p1", "set", {"angle": "5"}))
    placed = state_of(
        run(TABLE, ("p2", "move", {"x": "540", "yaw": "0"}), ("ly_150", "move", {"after": "p2", "distance": "150"}))
    )
    pose = placed.components["ly_150"].pose
    assert pose is not None and (pose.x, pose.y) == (690, 420)


def test_an_angle_is_compared_by_its_period_and_stays_as_it_was_typed() -> None:
    typed = TABLE.replace(b"angle: 90\n", b"angle: 400\n").replace(b"angle: 12.5", b"angle: -10")
    state = state_of(typed)
    assert (state.components["p1"].values["angle"], state.components["p2"].values["angle"]) == (40, 350)
    same = state_of(TABLE.replace(b"angle: 90\n", b"angle: 40\n").replace(b"angle: 12.5", b"angle: 350"))
    assert state == same
    assert edited(typed, ("p1", "set", {"angle": "40"})) == typed  # the value is the same
    assert edited(typed, ("p1", "set", {"angle": "41"})) == typed.replace(b"angle: 400", b"angle: 41")
    assert b"angle: 400" in edited(typed, ("p2", "set", {"angle": "3"}))
