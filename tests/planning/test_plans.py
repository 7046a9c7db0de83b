"""What a plan does: which parts move, in which order, why; each plan also passes the independent checker."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from checker import check
from planning_benches import SLOTS, bench, moves, part, planned, see, want

from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp
from pico.model.lab import Margins, Slot
from pico.model.observation import ObservedRobot, UnknownObject
from pico.model.plan import Staging
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot


def test_what_is_right_stays() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300), "b": (168, 63, 37)})  # b: in its slot's capture radius, askew
    made = planned(setup, seen, want({"a": (300.3, 300), "b": "s2"}))
    assert made.operations == ()
    assert [c.tolerated for c in made.changes] == [True]
    assert made.staging.proven


def test_an_edit_below_tolerance_is_moved_when_asked_for_exactly() -> None:
    setup = bench({"a": "block"})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (300.3, 300)}), exact=True)
    assert moves(made) == [("a", "300.3,300")]


def test_a_part_that_the_state_does_not_name_goes_home() -> None:
    setup = bench({"a": part(home="s2")})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({}))
    assert moves(made) == [("a", "s2")]
    assert (made.operations[0].primitive, made.operations[0].reason.kind) == ("stow", "stowed")
    assert made.operations[-1].reason.kind == "parked"


def test_a_swap_puts_one_of_the_two_down_in_storage() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (300, 300)})
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    assert len(moves(made)) == 3
    assert made.staging == Staging(count=1, lower_bound=1, proven=True)
    staged = made.operations[0].reason
    assert staged.kind == "staged" and staged.overlap == 60
    assert "makes room for" in staged.text


def test_the_part_that_had_better_not_be_staged_is_not() -> None:
    for loath, other in (("a", "b"), ("b", "a")):
        setup = bench({loath: part(stage="avoid"), other: "block"})
        seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (300, 300)})
        assert moves(planned(setup, seen, wanted))[0][0] == other


def test_a_chain_needs_no_staging_and_says_who_waits_for_whom() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (700, 300)})
    made = planned(setup, seen, wanted)
    assert moves(made) == [("b", "700,300"), ("a", "500,300")]
    second = made.operations[1]
    assert second.after == (made.operations[0].id,)
    assert second.reason.of == ("b",)
    assert second.reason.text == "after b: its base would overlap by 60 mm"


def test_independent_moves_do_not_wait_for_one_another() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen, wanted = see(setup, {"a": (200, 300), "b": (500, 300)}), want({"a": (300, 300), "b": (600, 300)})
    assert [o.after for o in planned(setup, seen, wanted).operations if o.primitive == "move"] == [(), ()]


def test_the_arm_parks_when_all_that_it_moves_has_been_moved() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen, wanted = see(setup, {"a": (200, 300), "b": (500, 300)}), want({"a": (300, 300), "b": (600, 300)})
    *moved, park = planned(setup, seen, wanted).operations
    assert park.primitive == "park" and set(park.after) == {o.id for o in moved}


def test_a_chain_of_moves_is_waited_for_by_its_last() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (700, 300)})
    _, second, park = planned(setup, seen, wanted).operations
    assert park.primitive == "park" and park.after == (second.id,)


def test_who_leaves_by_less_than_the_margin_must_leave_before_the_other_arrives() -> None:
    for margin, waits in ((2.0, True), (0.5, False)):
        setup = bench({"a": part("one_way"), "b": part("one_way")}, margins=Margins(body=margin, fingers=0))
        seen, wanted = see(setup, {"a": (300, 100), "b": (300, 361)}), want({"a": (300, 300), "b": (500, 361)})
        made = planned(setup, seen, wanted)
        first, second, _ = made.operations
        assert (first.component == "b" and second.after == (first.id,)) is waits, margin
        assert check(setup, seen, wanted, made) == []


DISC = ComponentType(
    name="disc", title="Disc", geometry=Geometry(
        footprint=Footprint(disc=58), height=60, mass=0.3, grasp=Grasp(height=50, width=40, yaws=(0.0, 90.0)),
    ),
)  # fmt: skip
PIN = ComponentType(
    name="pin", title="Pin", geometry=Geometry(
        footprint=Footprint(disc=8), height=60, mass=0.1, grasp=Grasp(height=50, width=16, yaws=(0.0, 90.0)),
    ),
)  # fmt: skip


def test_a_part_may_be_put_down_meanwhile_over_the_mouth_of_a_slot_that_nobody_needs() -> None:
    slots = {f"s{n}": Slot(x=100 + 65 * n, y=60) for n in range(6)}
    setup = bench({"a": "disc", "b": "disc"}, slots)
    setup = replace(setup, catalog={**setup.catalog, "disc": DISC})
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (500, 300), "b": (300, 300)})
    made = planned(setup, seen, wanted)
    assert made.diagnostics == () and made.staging == Staging(count=1, lower_bound=1, proven=True)
    assert check(setup, seen, wanted, made) == []


def test_who_covers_a_slot_meanwhile_is_not_there_while_another_is_in_it() -> None:
    """A pin in s1, whose mouth a block in s2 covers without touching it: the swap of two blocks is done before the pin
    comes, or after it has left; where it stays, there is no slot for them."""
    slots = {"s1": Slot(x=60, y=60, capture=20), "s2": Slot(x=102, y=60)}
    vacuum = {"arm1": Robot(mount=Mount(x=400, y=500), gripper=Gripper(fingers="none"))}
    setup = bench({"a": "block", "b": "block", "pin": part("pin", stage="never")}, slots, robots=vacuum)
    setup = replace(setup, catalog={**setup.catalog, "pin": PIN})
    swap = {"a": (500, 300), "b": (300, 300)}
    for before, then, order in (((150, 150), "s1", -1), ("s1", (700, 300), 0), ("s1", "s1", None)):
        seen = see(setup, {"a": (300, 300), "b": (500, 300), "pin": before})
        wanted = want({**swap, "pin": then})
        made = planned(setup, seen, wanted)
        assert made.errored == (order is None)
        if order is not None:
            assert [o.component for o in made.operations if o.kind.carries][order] == "pin"
            assert check(setup, seen, wanted, made) == []
    assert "in s2 it would cover the mouth of s1, in which something stays" in made.diagnostics[0].detail


def test_a_state_may_have_a_part_over_the_mouth_of_a_slot_in_use() -> None:
    slots = {"s1": Slot(x=60, y=60, capture=20)}
    setup = bench({"a": "block", "pin": "pin"}, slots)
    setup = replace(setup, catalog={**setup.catalog, "pin": PIN})
    seen, wanted = see(setup, {"a": (300, 300), "pin": (700, 300)}), want({"a": (102, 60), "pin": "s1"})
    made = planned(setup, seen, wanted)
    assert [name for name, _ in moves(made)] == ["pin", "a"] and check(setup, seen, wanted, made) == []


def test_turning_in_place_is_one_move() -> None:
    setup = bench({"a": "block"})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (300, 300, 30)}))
    assert len(moves(made)) == 1


def test_a_part_that_is_right_is_moved_aside_and_put_back_only_where_it_must() -> None:
    # a leaves a gap of 4 mm along x on both sides; its jaws close along x only, and both neighbors are right
    setup = bench({"a": part("one_way"), "left": "block", "right": "block"})
    seen = see(setup, {"a": (300, 300), "left": (236, 300), "right": (364, 300)})
    wanted = want({"a": (500, 300), "left": (236, 300), "right": (364, 300)})
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    aside = [o for o in made.operations if o.reason.kind == "in_the_way"]
    assert {o.component for o in aside} == {"left", "right"}
    assert aside[0].reason.of == ("a",)
    assert made.staging.count == 2


def test_fingers_decide_the_order_where_bodies_do_not() -> None:
    # beside tall b the fingers that place low a would touch it; above low a those that place b are free
    setup = bench({"a": part("low"), "b": part("tall_one_way")})
    seen, wanted = see(setup, {"a": (200, 400), "b": (600, 400)}), want({"a": (300, 300), "b": (364, 300)})
    made = planned(setup, seen, wanted)
    assert moves(made) == [("a", "300,300"), ("b", "364,300")]
    assert made.operations[1].after == (made.operations[0].id,)


def test_a_part_is_stowed_turned_where_the_fingers_need_it() -> None:
    # beside the slot stands a tall part along x; the jaws close along the part's x only: it must be turned by 90
    setup = bench({"a": part("one_way", home="s1"), "wall": "block"})
    seen = see(setup, {"a": (300, 300, 90), "wall": (124, 60)})
    wanted = want({"a": "s1", "wall": (124, 60)})
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    assert made.operations[0].arguments["to"]["pose"]["yaw"] == 90


def test_a_bolted_part_asks_a_person_and_others_wait_for_it() -> None:
    setup = bench({"a": part(seating="bolted"), "b": "block"})
    seen, wanted = see(setup, {"a": (300, 300), "b": (600, 300)}), want({"a": (450, 300), "b": (300, 300)})
    made = planned(setup, seen, wanted)
    first, second = made.operations[:2]
    assert (first.primitive, first.reason.kind, first.robot) == ("operator", "operator", None)
    assert "arm1" in first.resources
    assert second.after == (first.id,)
    assert [d.code for d in made.diagnostics] == ["operator"] and not made.errored


def test_people_alone_work_where_two_arms_have_nothing_to_do() -> None:
    arms = {f"arm{n}": Robot(mount=Mount(x=100 * n, y=500)) for n in (1, 2)}
    setup = bench({"a": part(seating="bolted")}, robots=arms)
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (450, 300)}))
    assert [(o.primitive, o.resources) for o in made.operations] == [("operator", ("a", "arm1", "arm2"))]


def test_a_missing_part_stops_nothing_else() -> None:
    setup = bench({"a": "block", "lost": "block"})
    made = planned(setup, see(setup, {"a": (300, 300)}), want({"a": (500, 300), "lost": (300, 300)}))
    assert moves(made) == [("a", "500,300")]
    assert [(d.severity, d.code, d.address) for d in made.diagnostics] == [("warning", "missing", "lost")]


def test_what_has_toppled_stops_only_what_would_stand_there() -> None:
    setup = bench({"a": "block", "b": "block", "fallen": "block"})
    seen = see(setup, {"a": (100, 300), "b": (100, 430), "fallen": (600, 300)})
    fallen = replace(seen.components["fallen"], presence="toppled")
    seen = replace(seen, components={**seen.components, "fallen": fallen})
    made = planned(setup, seen, want({"a": (200, 300), "b": (600, 300), "fallen": (600, 300)}))
    assert moves(made) == [("a", "200,300")]
    assert sorted(d.code for d in made.diagnostics) == ["blocked", "toppled"]
    assert not made.errored


def test_a_full_hand_puts_moves_off_but_not_motors() -> None:
    setup = bench({"a": "block", "b": "block"})
    seen = see(setup, {"a": (300, 300)}, {"a": {"angle": 0.0}}, robots={"arm1": ObservedRobot(joints=(), holding="b")})
    made = planned(setup, seen, want({"a": (500, 300)}, {"a": {"angle": 90.0}}))
    assert [o.primitive for o in made.operations] == ["set"]
    assert sorted(d.code for d in made.diagnostics) == ["blocked", "held"]


def test_strangers_are_obstacles() -> None:
    setup = bench({"a": "block"})
    stranger = UnknownObject(pose=Pose(500, 300), footprint=Footprint(disc=30), height=100)
    seen = see(setup, {"a": (300, 300)}, unknown={"unknown/17": stranger})
    made = planned(setup, seen, want({"a": (520, 300)}))
    assert made.errored and "unknown/17" in made.diagnostics[0].summary


def test_a_slot_is_free_only_if_no_footprint_meets_it() -> None:
    setup = bench({"a": "block", "b": "block", "edge": "block"}, {"s1": Slot(x=60, y=60)})
    seen = see(setup, {"a": (300, 300), "b": (500, 300), "edge": (95, 60)})  # edge covers the slot's middle
    swap = want({"a": (500, 300), "b": (300, 300), "edge": (95, 60)})
    made = planned(setup, seen, swap)
    assert made.errored and made.diagnostics[0].code == "impossible"


def test_several_robots_take_turns_and_each_does_what_it_can_reach() -> None:
    class Halves:
        """Two arms that reach one half of the table each; motion itself is left to nominal times."""

        def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> object:
            from pico.motion.types import Blocked

            near = pose.x < 400 if robot == "left" else pose.x > 400
            return None if near else Blocked("reach", f"{robot} does not reach {pose}")

        def move(self, robot: str, component: str, *_: object) -> object:
            from pico.motion.types import MovePath, Segment

            return MovePath(robot, component, (Segment("transit", (0.0, 7.0), ((), ()), 50.0),))

        def park(self, robot: str, *_: object) -> object:
            return self.move(robot, "")

    robots = {"left": Robot(mount=Mount(x=0, y=250)), "right": Robot(mount=Mount(x=800, y=250))}
    setup = bench({"a": "block", "b": "block"}, robots=robots)
    seen, wanted = see(setup, {"a": (300, 300), "b": (500, 300)}), want({"a": (200, 300), "b": (600, 300)})
    made = planned(setup, seen, wanted, Halves())  # type: ignore[arg-type]
    assert [(o.robot, o.primitive) for o in made.operations] == [
        ("left", "move"), ("left", "park"), ("right", "move"), ("right", "park"),
    ]  # fmt: skip
    assert made.operations[1].id in made.operations[2].after
    assert made.makespan == 28


def test_a_vacuum_gripper_packs_closer_than_fingers_can() -> None:
    parts = {"a": part("one_way"), "b": part("one_way")}
    places = {"a": (300, 300), "b": (363, 300)}
    start = {"a": (200, 400), "b": (600, 400)}
    fingers = bench(parts)
    vacuum = bench(parts, robots={"arm1": Robot(mount=Mount(x=400, y=500), gripper=Gripper(fingers="none"))})
    assert planned(fingers, see(fingers, start), want(places)).errored
    assert len(moves(planned(vacuum, see(vacuum, start), want(places)))) == 2


def test_a_gantry_may_have_its_storage_beside_the_table() -> None:
    gantry = Robot(model="gantry", mount=Mount(x=0, y=0), gripper=Gripper(fingers="none"))
    beside = {"s1": Slot(x=-200, y=100)}
    seen, wanted = {"a": (300, 300), "b": (500, 300)}, want({"a": (500, 300), "b": (300, 300)})
    setup = bench({"a": "block", "b": "block"}, beside, robots={"arm1": gantry})
    made = planned(setup, see(setup, seen), wanted)
    assert check(setup, see(setup, seen), wanted, made) == []
    assert made.staging.count == 1
    with_an_arm = bench({"a": "block", "b": "block"}, beside)
    assert planned(with_an_arm, see(with_an_arm, seen), wanted).errored


@pytest.mark.parametrize("margin", [0.0, 2.0])
def test_touching_counts_and_a_margin_is_the_least_distance_kept(margin: float) -> None:
    setup = bench({"a": "block", "b": "block"}, margins=Margins(body=margin, fingers=0))
    seen = see(setup, {"a": (300, 300), "b": (600, 300)})
    near = 360 + margin - 0.01 if margin else 360.0
    assert planned(setup, seen, want({"a": (300, 300), "b": (near, 300)})).errored
    assert not planned(setup, seen, want({"a": (300, 300), "b": (360.01 + margin, 300)})).errored


def test_the_same_bench_gives_the_same_plan_however_it_is_listed() -> None:
    parts = {"a": "block", "b": "block", "c": "block"}
    start = {"a": (300, 300), "b": (500, 300), "c": (400, 400)}
    goal = {"a": (500, 300), "b": (300, 300), "c": (400, 200)}
    setup = bench(parts)
    back = bench(dict(reversed(parts.items())), dict(SLOTS))
    one = planned(setup, see(setup, start), want(goal))
    two = planned(back, see(back, dict(reversed(start.items()))), want(dict(reversed(goal.items()))))
    assert one.to_json() == two.to_json()


def test_a_plan_without_moves_imports_nothing_heavy() -> None:
    code = (
        "import sys; sys.path.insert(0, 'tests/planning'); from planning_benches import *;"
        "s = bench({'a': 'block'}); w = want({'a': (300, 300)}); planned(s, see(s, {'a': (300, 300)}), w);"
        "print([m for m in ('numpy', 'mujoco', 'networkx', 'scipy', 'cv2', 'highspy') if m in sys.modules])"
    )
    root = Path(__file__).resolve().parents[2]
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root)
    assert out.stdout.strip() == "[]"
