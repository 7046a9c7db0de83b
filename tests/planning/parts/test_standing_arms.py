"""Arms that stay where arms meet, a part in the hand or no way to park: no other comes there, and what only they could
move is left."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

from planning_benches import GRASP, TALL, TYPES, bench, part, planned, see, want

from pico.model.catalog import ComponentType, Footprint
from pico.model.lab import Slot, Table
from pico.model.observation import Observation, ObservedRobot, UnknownObject
from pico.model.plan import Blocking, Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import columns

SLOTS = {"left": Slot(x=300, y=250), "middle": Slot(x=700, y=450)}
PARTS = {"a": (300.0, 450.0), "b": (1200.0, 450.0), "held": "middle"}
MIDDLE = (740.0, 450.0)
ELSEWHERE = (1200.0, 550.0)


@cache
def benches() -> tuple[Setup, ArmMotion]:
    """Two arms that meet in the middle of a long table: `a` is for arm1 alone, `b` for arm2."""
    robots = {"arm1": Robot(mount=Mount(x=300, y=820, yaw=-90)), "arm2": Robot(mount=Mount(x=1150, y=80, yaw=90))}
    setup = bench({n: part(home="left") for n in PARTS}, SLOTS, robots=robots, table=Table(size=(1400, 900)))
    held_tight = replace(TALL, grasp=replace(GRASP, width=60))
    setup = replace(setup, catalog={**TYPES, "block": replace(TYPES["block"], geometry=held_tight)})
    return setup, ArmMotion(setup)


def over_the_middle(robot: str) -> tuple[float, ...]:
    """Return the joints of an arm whose hand is above the middle."""
    arm, lift = benches()[0].lab.robots[robot], 240.0
    found = (column.at(lift) for column in columns(arm, 700.0, 450.0, 0.0))
    return next(q for q in found if q is not None)


def with_a_full_hand() -> Observation:
    """arm1 holds a part above the middle, and there is no place for it: something lies in every slot."""
    setup, _ = benches()
    seen = see(setup, PARTS)
    parts = {**seen.components, "held": replace(seen.components["held"], presence="held", how="gripper")}
    boxes = {
        f"unknown/{n}": UnknownObject(pose=s.pose, footprint=Footprint(disc=25.0), height=60.0)
        for n, s in SLOTS.items()
    }  # fmt: skip
    hand = ObservedRobot(joints=over_the_middle("arm1"), holding="held")
    return replace(seen, components=parts, unknown=boxes, robots={"arm1": hand})


def goes(seen: Observation, **goals: tuple[float, float]) -> Plan:
    setup, motion = benches()
    return planned(setup, seen, want({**PARTS, **goals}), motion)


def test_an_arm_that_holds_something_is_not_parked_and_keeps_others_from_where_arms_meet() -> None:
    made = goes(with_a_full_hand(), b=MIDDLE)
    assert made.operations == () and not made.errored
    told = {d.address: d.summary for d in made.diagnostics}
    assert told == {
        "held": "arm1 holds held and can't set it down: no storage slot is free",
        "b": "b is not moved: arm1 stays where arms meet: it holds held and can't set it down",
    }
    empty = see(benches()[0], {**PARTS, "held": "left"})
    free = planned(benches()[0], empty, want({**PARTS, "held": "left", "b": MIDDLE}), benches()[1])
    assert [o.robot for o in free.operations] == ["arm2", "arm2"]


def test_what_only_a_full_hand_could_move_is_left_and_the_rest_planned() -> None:
    made = goes(with_a_full_hand(), a=(300, 550), b=ELSEWHERE)
    assert [(o.primitive, o.component, o.robot) for o in made.operations] == [
        ("move", "b", "arm2"), ("park", "arm2", "arm2"),
    ]  # fmt: skip
    told = {d.address: d.summary for d in made.diagnostics}
    assert told["a"] == "a is not moved: no arm with a free gripper gets to it"


def test_what_nobody_could_move_is_refused_as_ever() -> None:
    (found,) = [d for d in goes(with_a_full_hand(), b=(1200, 860)).diagnostics if d.severity == "error"]
    assert found.code == "unreachable" and "from arm2's base" in found.summary


def around_the_middle() -> dict[str, Pose]:
    """Where what is as tall as an arm keeps one from parking whose hand is above the middle."""
    angles = {n: n * math.pi / 3 for n in range(6) if n not in (1, 2)}
    return {f"t{n}": Pose(700 + 150 * math.cos(a), 450 + 150 * math.sin(a)) for n, a in angles.items()}


STOPPED = "arm1 stays where arms meet: it was stopped there and can't park, as link 5 of arm1 would hit unknown/t3"


def test_where_an_arm_can_not_park_the_refusal_says_so_and_what_it_takes() -> None:
    setup, motion = benches()
    seen, rest = see(setup, {**PARTS, "held": "left"}), {**PARTS, "held": "left"}
    ring = {
        f"unknown/{n}": UnknownObject(pose=p, footprint=Footprint(disc=20.0), height=700.0)
        for n, p in around_the_middle().items()
    }
    seen = replace(seen, unknown=ring, robots={"arm1": ObservedRobot(joints=over_the_middle("arm1"))})
    made = planned(setup, seen, want({**rest, "b": MIDDLE}), motion)
    (found,) = [d for d in made.diagnostics if d.severity == "error"]
    assert STOPPED in found.summary and found.hint == "move unknown/t3 away first"
    assert made.blocking == (Blocking(kind="reach", of="b"),)
    aside = planned(setup, seen, want({**rest, "b": ELSEWHERE}), motion)
    assert [(o.primitive, o.component) for o in aside.operations] == [("move", "b"), ("park", "arm2")]
    away = replace(seen, unknown={})
    assert [o.component for o in planned(setup, away, want({**rest, "b": MIDDLE}), motion).operations][-1] == "arm2"


def test_an_arm_that_a_part_shuts_in_keeps_others_out_as_well_and_the_refusal_is_certified() -> None:
    setup, _ = benches()
    towers = {"t3": part("tower", home="left")}
    tower = ComponentType(name="tower", title="", geometry=replace(TALL, footprint=Footprint(disc=20.0), height=700.0))
    setup = replace(
        setup, catalog={**setup.catalog, "tower": tower},
        lab=replace(setup.lab, inventory={**setup.lab.inventory, **towers}),
    )  # fmt: skip
    rest = {**PARTS, "held": "left", "t3": (550.0, 450.0)}
    seen = replace(see(setup, rest), robots={"arm1": ObservedRobot(joints=over_the_middle("arm1"))})
    made = planned(setup, seen, want({**rest, "b": MIDDLE}), ArmMotion(setup))
    (found,) = [d for d in made.diagnostics if d.severity == "error"]
    assert "has no free path: arm1 was stopped where it would have to pass, and can't park, as" in found.summary
    assert found.hint.startswith("move t") and found.hint.endswith(" away first")
    assert made.blocking is not None and Blocking(kind="path", of="b") in made.blocking
