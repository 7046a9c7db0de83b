"""Each way in which there can be no order of moves, and each contact, in words: on tables made for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
from planning_benches import Places, bench, moves, one, part, planned, see, want

from pico.diagnostics import Diagnostic, PicoError, Position, SourceRange, error, warning
from pico.model.catalog import Footprint
from pico.model.lab import Box2, KeepOut, Margins, Part, Slot
from pico.model.observation import Observation, UnknownObject
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, Plan
from pico.model.pose import Pose
from pico.model.request import place_after
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.types import Blocked
from pico.planning import PlanGoal, set_values
from pico.planning.checks.bolted import check_bolted
from pico.planning.checks.contacts import Contact, ends_of, spot_of, starts_of
from pico.planning.explaining.blocking import blocks_of
from pico.planning.explaining.explain import why_after
from pico.planning.explaining.refusal import before, explain
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.paths import NoPath
from pico.planning.ordering.search import OrderedMove
from pico.planning.ordering.solve import Refusal
from pico.planning.parts.movers import Hold
from pico.planning.parts.phrases import listed
from pico.planning.passes.actors import actors
from pico.planning.passes.comparison import compared
from pico.planning.passes.draft import Draft

LINE = SourceRange("state/table.yaml", Position(3, 1), Position(3, 9), "p")


class Reach:
    """An arm that reaches what `far` does not say."""

    def __init__(self, far: Mapping[float, Blocked]) -> None:
        self.far = far

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        return self.far.get(pose.x)


def table(
    parts: Mapping[str, Part | str], seen: Places, wanted: Places, motion: Any = None, **lab: Any
) -> Conflicts:  # fmt: skip
    setup = bench(parts, **lab)
    now = see(setup, seen)
    goal = PlanGoal(want(wanted), source=lambda _: LINE)
    movers, obstacles, _ = actors(compared(Draft(setup, motion, now, goal)))
    return Conflicts(setup, movers, obstacles, motion, False)


def refused(made: Conflicts, core: tuple[int, ...] = (), **more: Any) -> Diagnostic:
    asked: list[str] = []

    def source(address: str) -> SourceRange:
        asked.append(address)
        return LINE

    closest = more.pop("closest", (0,) * len(made.movers))
    (found,) = explain(Refusal(made, core, closest, more.pop("proven", False), **more), source)
    assert found.source is (LINE if asked else None)
    return found


def no_path(made: Conflicts, mover: int, start: int, goal: int, blocked: Blocked) -> NoPath:
    return NoPath(OrderedMove(mover, start, goal, made.movers[mover].holds[0], 0), blocked, None)


TWO: Places = {"a": (200, 300), "b": (600, 300)}
AWAY: Places = {"a": (300, 300), "b": (500, 300)}
BLOCKS = {"a": "block", "b": "block"}


def test_of_the_paths_of_one_part_the_direct_one_is_told_and_of_several_parts_the_last() -> None:
    made = table(BLOCKS, TWO, AWAY)
    detour = no_path(made, 0, 3, 1, Blocked("collision", "link 2 would hit it", "lift", "b", 3.0))
    direct = no_path(made, 0, 0, 1, Blocked("collision", "link 4 would hit it", "transit", "wall", 12.0))
    other = no_path(made, 1, 0, 1, Blocked("reach", "too far", help="use another arm"))
    found = refused(made, (0,), blocked=(other, detour, direct))
    assert found.summary == "move of a to (300, 300, 0°) has no free path during transit: link 4 would hit it"
    assert (found.code, found.detail, found.hint) == ("blocked", "in the way: wall by 12 mm", "choose another place")
    found = refused(made, (0,), blocked=(other, detour))
    assert "link 2 would hit it" in found.summary and found.address == "a.pose"
    found = refused(made, (), blocked=(direct, detour, other))
    assert (found.code, found.summary) == ("unreachable", "move of b to (500, 300, 0°) has no free path: too far")
    assert (found.detail, found.hint, found.address) == ("", "use another arm", "b.pose")


def test_a_path_into_a_slot_is_that_of_a_stow_and_what_stays_may_be_moved_away() -> None:
    made = table(
        {"a": "block", "wall": "block"}, {"a": (200, 300), "wall": (600, 300)}, {"a": "s1", "wall": (600, 300)}
    )
    found = refused(made, (0,), blocked=(no_path(made, 0, 0, 1, Blocked("collision", "no", "lower", "wall")),))
    assert found.summary == "stow of a to s1 has no free path during lower: no"
    assert (found.detail, found.hint) == ("in the way: wall", "move wall away first")


def test_a_part_that_no_free_gripper_can_take_is_told() -> None:
    made = table(BLOCKS, TWO, AWAY)
    made.movers = (replace(made.movers[0], holds=()), made.movers[1])
    found = refused(made, (0,))
    assert (found.code, found.summary) == ("blocked", "a can't be moved: no robot has its gripper free")


def test_a_part_whose_grasps_are_free_at_one_end_each_needs_storage_or_room() -> None:
    walls = {"south": (300.0, 236.0), "east": (564.0, 300.0)}
    parts = {"a": part("block"), **dict.fromkeys(walls, part(seating="bolted"))}
    for stage, says, turn in (
        ("never", "a: stage: never", "allow staging of a, with a storage slot free"),
        ("allowed", "a: no storage slot where it could", "free a storage slot"),
    ):
        parts["a"] = part("block", stage=stage)
        made = table(parts, {"a": (300, 300), **walls}, {"a": (500, 300), **walls})
        found = refused(made, (0,))
        assert found.summary == "a can't go from (300, 300, 0°) to (500, 300, 0°): no one grasp is free at both ends"
        assert found.detail.startswith(says) and found.address == "a.pose"
        assert found.hint == f"{turn}, or leave more room on one side of it"


def test_a_part_that_one_arm_must_hand_to_another_needs_a_slot_that_both_reach() -> None:
    class Halves:
        """Two arms, each of which reaches its own half of the table."""

        def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
            return None if (pose.x < 400) == (robot == "arm1") else Blocked("reach", "too far")

    arms = {name: Robot(model="gantry", mount=Mount(x=0, y=0)) for name in ("arm1", "arm2")}
    for stage, more in (("allowed", ""), ("never", ", and allow staging of a")):
        made = table({"a": part(stage=stage)}, {"a": (200, 300)}, {"a": (600, 300)}, Halves(), robots=arms)
        found = refused(made, (0,))
        assert found.code == "unreachable"
        assert found.summary == (
            "a can't go from (200, 300, 0°) to (600, 300, 0°): "
            "only arm1 reaches where it stands, and only arm2 where it is to go"
        )
        assert found.hint == (f"give arm1 and arm2 a free slot that both reach, or a region with `staging: true`{more}")


def test_a_part_in_the_mouth_of_a_slot_is_told_and_a_capture_that_leaves_it_out_helps() -> None:
    slots = {"s1": Slot(x=60, y=60, capture=40), "s2": Slot(x=130, y=60, capture=45)}
    places = {"a": "s1", "b": (300, 300)}

    def answer(capture: float) -> Plan:
        given = slots | {"s2": replace(slots["s2"], capture=capture)}
        setup = bench({"a": part(seating="bolted"), "b": part()}, given)
        return planned(setup, see(setup, places), want({"a": (60, 60), "b": "s2"}))

    (found,) = answer(45).diagnostics
    assert found.summary == "b can't be put down in s2: a stands in its mouth"
    assert found.hint == "give s2 a `capture` of less than 40 mm, or move a away first"
    assert not answer(39.9).errored


def test_who_swaps_what_only_people_move_is_told_to_put_one_aside() -> None:
    spots = {"a": (300, 300), "b": (400, 300)}
    setup = bench({n: part(seating="bolted") for n in spots})
    swapped = want({"a": spots["b"], "b": spots["a"]})
    (found,) = planned(setup, see(setup, spots), swapped).diagnostics
    assert found.hint == "put a at x = 165, y = 300 for now (`pico move a x=165 y=300`), then plan again"
    aside = planned(setup, see(setup, {**spots, "a": (165, 300)}), swapped)
    assert not aside.errored and moves(aside) == [("b", "300,300"), ("a", "400,300")]
    assert not planned(setup, see(setup, spots | {"a": (600, 300)}), swapped).errored


def test_fingers_that_would_come_near_are_told_apart_from_fingers_that_would_touch() -> None:
    far = {"left": (200.0, 100.0)}
    for gap, says in ((36.0, "by 3 mm"), (41.0, "(only 2 mm apart)")):
        wall = {"wall": (300.0 + 30 + gap, 300.0)}
        parts = {"a": part("one_way"), "wall": part(seating="bolted"), "left": part(seating="bolted")}
        made = table(parts, {"a": (300, 300), **wall, **far}, {"a": (500, 100), **wall, **far},
                     margins=Margins(body=2, fingers=4))  # fmt: skip
        found = refused(made, (0,))
        assert found.summary == (
            f"a can't be picked up at (300, 300, 0°): a finger of the gripper would touch wall {says}, "
            "every grasp yaw tried"
        )
        assert found.hint == "move wall away first, or leave more room there" and found.code == "blocked"
        ((name, apart),) = {*made.finger_hits(0, 0, made.movers[0].holds[0])}
        assert (name, apart) == ("wall", pytest.approx(gap - 39.0))
    assert not [*made.finger_hits(0, 0, Hold(None))]


def test_two_walls_are_both_named_and_a_low_one_is_not() -> None:
    walls = {"east": (364.0, 300.0), "west": (236.0, 300.0), "south": (300.0, 200.0)}
    parts = {"a": part("one_way"), "east": part(seating="bolted"), "west": part(seating="bolted"),
             "south": part("low", seating="bolted")}  # fmt: skip
    made = table(parts, {"a": (300, 300), **walls}, {"a": (500, 100), **walls})
    found = refused(made, (0,))
    assert "would touch east and west by 5 mm" in found.summary
    assert found.hint == "move east or west away first, or leave more room there"
    parts["east"] = parts["west"] = part("low", seating="bolted")
    assert not [*table(parts, {"a": (300, 300), **walls}, {"a": (500, 100), **walls}).finger_hits(0, 0, Hold("arm1"))]


def test_out_of_reach_comes_before_fingers_where_another_grasp_would_have_room() -> None:
    far = Reach({500.0: Blocked("reach", "80 mm too far"), 300.0: Blocked("reach", "too near", help="turn it")})
    made = table(BLOCKS, {"a": (200, 300), "b": (600, 100)}, {"a": (500, 300), "b": (300, 100)}, far)
    found = refused(made, (0,))
    assert (found.code, found.summary) == ("unreachable", "a can't be put down at (500, 300, 0°): 80 mm too far")
    assert found.hint == "bring it nearer to the arm, or turn it"
    assert refused(made, (1,)).hint == "turn it"
    made = table({"a": part("one_way"), "wall": part(seating="bolted")}, {"a": (200, 300), "wall": (564, 300)},
                 {"a": (500, 300), "wall": (564, 300)}, far)  # fmt: skip
    found = refused(made, (0,))
    assert found.code == "blocked" and "would touch wall by 5 mm" in found.summary


def test_a_zone_that_leaves_no_room_for_fingers_is_told() -> None:
    zone = KeepOut(area=Box2(x=(532, 560), y=(290, 310)), z=(100, 300))
    made = table({"a": part("one_way")}, {"a": (200, 300)}, {"a": (500, 300)}, keep_out={"lamp": zone})
    found = refused(made, (0,))
    assert found.summary == "a can't be put down at (500, 300, 0°): a keep-out leaves no room for the fingers"


SWAP: tuple[Places, Places] = ({"a": (300, 300), "b": (500, 300)}, {"a": (500, 300), "b": (300, 300)})


def ring(
    a: Part | str = "block", motion: Any = None, slots: Mapping[str, Slot] | None = None, **seen: Any
) -> list[str]:
    still = {n: part(seating="bolted") for n in seen}
    made = table({"a": a, "b": part(stage="never"), **still}, {**SWAP[0], **seen}, {**SWAP[1], **seen}, motion,
                 slots=slots or {"s1": Slot(x=60, y=60)})  # fmt: skip
    found = refused(made, (0, 1))
    assert found.summary == "a and b block one another in a ring that no storage slot breaks"
    return found.detail.splitlines()


def test_why_storage_breaks_no_ring() -> None:
    waits = ["a must leave before b arrives (bodies overlap by 60 mm)",
             "b must leave before a arrives (bodies overlap by 60 mm)"]  # fmt: skip
    tight = {"s1": Slot(x=60, y=60, fits=40)}
    assert ring("block") == [*waits, "a: s1 would take it, but others need it too", "b: stage: never"]
    both = {"s1": Slot(x=60, y=60), "s2": Slot(x=60, y=160)}
    assert ring("block", slots=both)[2] == "a: s1 and s2 would take it, but others need them too"
    assert ring("block", slots=tight)[2] == "a: no slot takes it"
    assert ring("block", kept="s1")[2] == "a: every slot that takes it is occupied"
    assert ring("block", Reach({60.0: Blocked("reach", "no")}))[2] == "a: the free slots s1 are out of reach"
    assert ring("block", kept=(119, 60))[2] == "a: in s1 it would come too near to kept"
    beside = {"w": (124, 60), "n": (60, 124)}
    assert ring("block", **beside)[2] == "a: the free slots s1 are without room for the fingers"
    assert ring(part(seating="bolted"))[2] == "a: only a person can move it"


def test_a_refusal_says_how_sure_it_is_and_what_would_help() -> None:
    made = table(BLOCKS, TWO, AWAY)
    proven = refused(made, (0, 1), proven=True, slots=3)
    assert proven.summary == "a and b can't all reach their places in any order"
    assert proven.hint == "free 3 slots within reach that take them, or leave more room between them"
    unknown = refused(made, (), closest=(0, 1))
    assert unknown.summary == "found no order in which a reach their places, within the limit of the search"
    assert (unknown.address, unknown.hint) == ("a.pose", "free one slot within reach, or leave more room between them")


def test_who_must_leave_first_by_body_and_by_finger() -> None:
    made = table(BLOCKS, {"a": (300, 300), "b": (500, 300)}, {"a": (600, 100), "b": (325, 300)})
    assert before(made, 0, 1) == "a must leave before b arrives (bodies overlap by 35 mm)"
    assert before(made, 1, 0) == ""
    near = table(BLOCKS, {"a": (300, 300), "b": (500, 300)}, {"a": (600, 100), "b": (361, 300)},
                 margins=Margins(body=2, fingers=0))  # fmt: skip
    assert before(near, 0, 1) == "a must leave before b arrives (bodies come within 1 mm)"
    jaws = table({"a": "block", "b": "one_way"}, {"a": (300, 300), "b": (500, 300)}, {"a": (600, 100), "b": (364, 300)})
    assert before(jaws, 0, 1).endswith("(a finger of the gripper would touch a, every grasp yaw tried)")
    apart = table(BLOCKS, {"a": (300, 300), "b": (500, 300)}, {"a": (600, 100), "b": (364, 300)})
    assert before(apart, 0, 1) == "", "the jaws may close the other way"


def test_names_are_listed_as_in_a_sentence_and_many_are_counted() -> None:
    said = ["", "a", "a and b", "a, b and c", "a, b, c and d", "a, b, c, d and e", "a, b, c, d, e and f"]
    assert [listed("abcdefgh"[:n]) for n in range(7)] == said
    assert (listed("abcdefg"), listed("abcdefgh", "or")) == ("a, b, c, d and 3 more", "a, b, c, d or 4 more")


@pytest.mark.parametrize(
    ("kind", "overlap", "says"),
    [
        ("base", 3.25, "their bases would overlap by 3.25 mm"),
        ("base", 0.0, "their bases would touch"),
        ("base", -0.5, "their bases would be only 0.5 mm apart, and 2 mm must stay free"),
        ("finger", 3.0, "a finger of the gripper would overlap it by 3 mm"),
        ("finger", 0.0, "a finger of the gripper would touch it"),
        ("finger", -1.0, "a finger of the gripper would be only 1 mm from it, and 2 mm must stay free"),
        ("slot", 4.0, "it would stand 4 mm inside the mouth of the slot"),
        ("slot", -0.1, "it would stand 0 mm inside the mouth of the slot"),
    ],
)
def test_a_contact_in_words(kind: Any, overlap: float, says: str) -> None:
    assert Contact(kind=kind, overlap=overlap, margin=2.0).text == says


def test_places_as_plans_hold_them() -> None:
    setup = bench(BLOCKS)
    for where, pose, slot in (
        ("s2", Pose(160, 60), "s2"), ({"x": 1, "y": 2}, Pose(1, 2), None),
        ({"x": 1, "y": 2, "yaw": 9}, Pose(1, 2, 9), None),
        ({"slot": "s1"}, Pose(60, 60), "s1"), ({"pose": {"x": 1, "y": 2}}, Pose(1, 2), None),
        ({"pose": {"x": 1, "y": 2}, "slot": "s1"}, Pose(1, 2), "s1"),
    ):  # fmt: skip
        spot = spot_of(setup, where)
        assert spot is not None and (spot.pose, spot.slot) == (pose, slot)
        assert str(spot) == (slot or str(pose))
    for nowhere in ("s9", None, 3, {}, {"x": 1}, {"slot": "s9"}):
        assert spot_of(setup, nowhere) is None


def test_where_parts_start_and_end_is_read_from_the_plan_and_of_what_is_bolted_from_the_lab() -> None:
    setup = bench({**BLOCKS, "c": "block", "post": part(pose=Pose(700, 100), seating="bolted")})
    seen = see(setup, {"a": (200, 300), "b": (300.2, 300), "post": (700, 100)})
    made = planned(setup, seen, want({"a": (400, 300), "b": (300, 300)}))
    made = replace(made, base=Base(state={**made.base.state, "post": {}, "c": {}, "gone": {"pose": {"x": 1, "y": 1}}}))
    starts, ends = starts_of(setup, made), ends_of(setup, made)
    assert {n: s.pose for n, s in starts.items()} == {
        "a": Pose(200, 300),
        "b": Pose(300.2, 300),
        "post": Pose(700, 100),
    }
    assert {n: s.pose for n, s in ends.items()} == {"a": Pose(400, 300), "b": Pose(300.2, 300), "post": Pose(700, 100)}


def test_bolted_parts_that_overlap_are_told_and_such_that_only_stand_close_are_not() -> None:
    for x, count in ((355.0, 1), (360.5, 0), (360.0, 0), (500.0, 0)):
        poses = {"p": Pose(300, 300), "q": Pose(x, 300)}
        setup = bench({n: part(pose=p, seating="bolted") for n, p in poses.items()} | {"free": "block"},
                      margins=Margins(body=2, fingers=2))  # fmt: skip
        found = list(check_bolted(setup))
        assert len(found) == count
    (one,) = check_bolted(bench({n: part(pose=Pose(x, 300), seating="bolted") for n, x in (("p", 300), ("q", 355))}))
    assert one.summary == "p is bolted at (300, 300, 0°) and q at (355, 300, 0°): their bases would overlap by 5 mm"
    assert (one.severity, one.address) == ("warning", "q.pose")


def test_what_was_wrong_with_what_was_seen_is_an_error_only_where_the_goal_names_it() -> None:
    setup = bench(BLOCKS)
    problems = (
        error("marker-hidden", "b's is hidden", address="b"), error("marker-hidden", "a's is hidden", address="a"),
        error("odd", "b is odd", address="b"), error("odd", "all is odd"), warning("odd", "b is odd, too", address="b"),
    )  # fmt: skip
    seen = replace(see(setup, {"a": (300, 300)}), problems=problems)
    found = compared(Draft(setup, None, seen, PlanGoal(want({"a": (300, 300)})))).diagnostics
    assert [(d.severity, d.summary) for d in found] == [
        ("error", "a's is hidden"), ("warning", "b is odd"), ("error", "all is odd"), ("warning", "b is odd, too"),
    ]  # fmt: skip


def test_a_part_that_is_missing_is_told_once_with_where_it_belongs() -> None:
    setup = bench({"a": "block", "b": "block", "c": "block"})
    told = replace(see(setup, {}), problems=(error("odd", "a is odd", address="a"),))
    wanted = want({"a": (300, 300), "b": (400, 300), "c": "s1"})
    found = compared(Draft(setup, None, told, PlanGoal(wanted))).diagnostics
    assert [d.summary for d in found] == [
        "a is odd", "nobody sees b, which belongs at (400, 300, 0°)", "nobody sees c, which belongs in s1",
    ]  # fmt: skip


def test_a_part_that_lies_is_told_though_something_else_is_wrong_with_it() -> None:
    setup = bench({"a": "block"})
    seen = see(setup, {"a": (300, 300)})
    lying = {"a": replace(seen.components["a"], presence="toppled")}
    told = replace(seen, components=lying, problems=(error("odd", "a is odd", address="a"),))
    found = compared(Draft(setup, None, told, PlanGoal(want({"a": (300, 300)})))).diagnostics
    assert [d.code for d in found] == ["odd", "toppled"]


def test_where_a_part_ends_is_where_the_last_of_its_moves_puts_it() -> None:
    setup = bench(BLOCKS)
    seen = see(setup, {"a": (200, 300), "b": (600, 300)})
    made = planned(setup, seen, want({"a": (400, 300), "b": (600, 300)}))
    ends = ends_of(setup, replace(made, changes=()))
    assert {n: s.pose for n, s in ends.items()} == {"a": Pose(400, 300), "b": Pose(600, 300)}


def test_a_target_pulls_in_nothing_that_is_left_out() -> None:
    setup = bench(BLOCKS)
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (700, 300)})
    assert not planned(setup, seen, wanted, targets=["a"]).errored
    made = planned(setup, seen, wanted, targets=["a"], exclude=["b"])
    assert not made.operations and any("b" in d.summary for d in made.diagnostics)


def test_nothing_is_placed_behind_what_nobody_knows_the_place_of() -> None:
    setup = bench(BLOCKS)
    seen = see(setup, {"a": (300, 300)})
    nowhere = replace(seen, components={"a": replace(seen.components["a"], pose=None)})
    with pytest.raises(KeyError, match="a"):
        place_after(setup, nowhere, "b", "a", 100)


def test_a_value_that_there_is_not_or_that_nobody_reads_back_can_not_be_set() -> None:
    setup = bench(BLOCKS)
    seen: Observation = see(setup, {"a": (300, 300)}, {"a": {"angle": 0.0}})
    with pytest.raises(PicoError, match="a has no tunable `angel`") as caught:
        one(set_values, setup, seen, "a", {"angel": 1.0})
    assert "angle" in str(caught.value.diagnostics[0].hint) and caught.value.diagnostics[0].address == "a"
    with pytest.raises(PicoError, match=r"does not model a\.exposure"):
        one(set_values, setup, seen, "a", {"exposure": 1.0})
    for presence, hint in (("missing", "pico drift"), ("held", "pico recover")):
        there = {**seen.components, "b": replace(seen.components["a"], presence=presence)}
        with pytest.raises(PicoError, match=f"b is {presence}") as caught:
            one(set_values, setup, replace(seen, components=there), "b", {"angle": 1.0})
        assert hint in str(caught.value.diagnostics[0].hint)
    with pytest.raises(PicoError, match="b is missing"):
        one(set_values, setup, seen, "b", {"angle": 1.0})


def test_a_person_takes_a_minute() -> None:
    setup: Setup = bench({"a": part(seating="bolted")})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (450, 300)}))
    assert [(o.primitive, o.seconds) for o in made.operations] == [("operator", 60.0)]


def test_a_stranger_in_the_way_is_taken_away_by_hand() -> None:
    setup = bench({"a": "block"})
    disc = UnknownObject(pose=Pose(500, 300), footprint=Footprint(disc=30), height=100)
    made = planned(setup, see(setup, {"a": (300, 300)}, unknown={"u1": disc}), want({"a": (540, 300)}))
    (found,) = made.diagnostics
    assert found.summary == "a cannot stand at (540, 300, 0°): it would overlap u1 by 20 mm"
    assert found.detail == "u1 stands at (500, 300); the bases need 62 mm between centers along x"
    assert found.hint == "nearest free place along x is x = 562; or take u1 away by hand"


def test_by_how_much_a_goal_is_too_near_is_told_to_the_last_millimetre() -> None:
    setup = bench(BLOCKS, margins=Margins(body=4, fingers=0))
    seen = see(setup, {"a": (100, 420), "b": (520, 420)})
    for x, says in ((460.5, "it would overlap b by 0.5 mm"), (460.0, "it would touch b"),
                    (459.5, "it would come within 0.5 mm of b, and 4 mm must stay free")):  # fmt: skip
        (found,) = planned(setup, seen, want({"a": (x, 420), "b": (520, 420)})).diagnostics
        assert found.summary == f"a cannot stand at ({x:g}, 420, 0°): {says}"
    assert not planned(setup, seen, want({"a": (455.9, 420), "b": (520, 420)})).errored


def test_a_slot_must_be_empty_though_what_stands_in_its_mouth_would_not_touch_the_part() -> None:
    """A mouth of 90 mm, and a part of 60 that stands in it at its rim."""
    setup = bench(BLOCKS, {"wide": Slot(x=200, y=200, capture=90)})
    rim, away, slot = {"pose": {"x": 290, "y": 200}}, {"pose": {"x": 600, "y": 200}}, {"slot": "wide"}

    def moved(name: str, start: Any, goal: Any) -> Operation:
        return Operation(id=name, primitive="move", component=name, robot="arm1", reason=Reason(kind="changed"),
                         arguments={"from": start, "to": goal, "grasp_yaw": 90.0})  # fmt: skip

    (leaves,) = why_after(setup, moved("b", rim, away), moved("a", away, slot))
    assert leaves.text == "wide must be empty first: it would stand 30 mm inside the mouth of the slot"
    assert leaves.contact == Contact(kind="slot", overlap=30.0, margin=0.0)
    far = {"pose": {"x": 600, "y": 400}}
    (stays,) = why_after(setup, moved("a", far, slot), moved("b", away, rim))
    assert stays.text == (
        "wide must be empty until a is there: with b at (290, 200, 0°), "
        "it would stand 30 mm inside the mouth of the slot"
    )
    (gone,) = why_after(setup, moved("a", slot, far), moved("b", away, rim))
    assert gone.text == (
        "a must have left wide: with b at (290, 200, 0°), it would stand 30 mm inside the mouth of the slot"
    )
    (path,) = why_after(setup, moved("a", far, away), moved("b", rim, {"pose": {"x": 100, "y": 450}}))
    assert (path.kind, path.contact) == ("path", None)
    body, *_ = why_after(setup, moved("a", far, {"pose": {"x": 330, "y": 200}}), moved("b", away, rim))
    assert body.text.startswith(
        "if b already stood at (290, 200, 0°) when a is put down at (330, 200, 0°), their bases"
    )


def test_a_grasp_that_a_wall_excludes_does_not_count_and_where_walls_exclude_all_every_one_does() -> None:
    wall, east = {"wall": (500.0, 364.0)}, {"east": (564.0, 364.0)}
    for walls, grasps in ((wall, "block"), (east, "block")):
        parts = {"a": "block", "b": grasps, **dict.fromkeys(walls, part(seating="bolted"))}
        setup = bench(parts)
        seen = see(setup, {"a": (564, 300), "b": (300, 300), **walls})
        made = planned(setup, seen, want({"a": (700, 100), "b": (500, 300), **walls}))
        found = {(b.blocker, b.blocked, b.every_grasp) for b in blocks_of(setup, made)}
        assert found == ({("a", "b", True)} if walls is wall else set()), walls
    setup = bench({"a": "block", "b": "one_way", "wall": part(seating="bolted")})
    walls = {"wall": (436.0, 300.0)}
    seen = see(setup, {"a": (564, 300), "b": (300, 300), **walls})
    made = planned(setup, seen, want({"a": (700, 100), "b": (500, 300), **walls}))
    assert made.errored
    assert {(b.blocker, b.blocked, b.every_grasp) for b in blocks_of(setup, made)} == {("a", "b", True)}
