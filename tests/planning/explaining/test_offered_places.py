"""What a refusal offers instead can be done: an arm has a path to the place, or nobody offers one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
from planning_benches import bench, part, planned, see, want
from random_labs import Case
from tall_labs import tall_case

from pico.model.lab import Slot
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.state import ComponentState, LabState
from pico.motion.arms import ArmMotion
from pico.motion.types import Blocked, MovePath, Segment
from pico.planning import PlanGoal, Planner
from pico.planning.checks.free_places import TRIES

PLACE = re.compile(r"nearest free place (?:along ([xy]) )?is (?:x = (\d+), y = (\d+)|[xy] = (\d+))")


def offered(hint: str, goal: Pose) -> Pose:
    """Return the place that a hint offers."""
    found = PLACE.match(hint)
    assert found is not None, hint
    axis, x, y, along = found.groups()
    return replace(goal, **{axis: float(along)}) if axis else replace(goal, x=float(x), y=float(y))


def brought(case: Case, motion: ArmMotion, name: str, goal: Pose) -> Plan:
    """Plan for one part, all else staying where it is."""
    stands = {n: ComponentState(pose=c.pose) for n, c in case.seen.components.items()}
    wanted = LabState(lab="tall", components=stands | {name: ComponentState(pose=goal)})
    return Planner(case.setup, motion, case.seen).plan(PlanGoal(wanted))


@pytest.mark.parametrize(
    ("seed", "name", "goal"), [(5001, "c4", Pose(664, 354, 0)), (5023, "c3", Pose(392, 414, 90))]
)  # fmt: skip
def test_a_place_is_offered_where_an_arm_sets_the_part_down_beside_what_is_tall(
    seed: int, name: str, goal: Pose
) -> None:
    case, _ = tall_case(seed)
    motion = ArmMotion(case.setup)
    (found,) = brought(case, motion, name, goal).diagnostics
    made = brought(case, motion, name, offered(found.hint, goal))
    assert not made.errored and [o.component for o in made.operations] == [name, "arm1"]


def test_for_what_nobody_picks_up_no_place_is_offered() -> None:
    case, _ = tall_case(5016)
    found = brought(case, ArmMotion(case.setup), "c4", Pose(420, 417, 90)).diagnostics[0]
    assert found.hint.startswith("no other place would do: c4 is 300 mm tall; to leave it arm1 must rise to 310 mm")


class Fence:
    """An arm that sets a part down only where `free` says so; `asked`: how many paths it was asked for."""

    def __init__(self, free: Any) -> None:
        self.free, self.asked = free, 0

    def reach(self, *_: object) -> None:
        return None

    def move(self, robot: str, component: str, start: Pose, goal: Pose, *_: object) -> MovePath | Blocked:
        self.asked += 1
        path = MovePath(robot, component, (Segment("transit", (0.0, 1.0), ((0.0,), (0.0,)), 0.0),))
        return path if self.free(goal) else Blocked("collision", "a fence", obstacle="fence")

    def park(self, robot: str, *_: object) -> MovePath:
        return MovePath(robot, None, (Segment("park", (0.0, 1.0), ((0.0,), (0.0,)), 0.0),))


def beside(free: Any, goal: Any = (505, 420), slots: Mapping[str, Slot] | None = None) -> tuple[str, int]:
    """Return the hint where `a` is to stand on what is bolted, and how many paths were asked for."""
    setup = bench({"a": part(home="s1"), "wall": part(seating="bolted", home="s1")}, slots or {"s1": Slot(x=60, y=60)})
    setup = replace(setup, lab=replace(setup.lab, robots={"arm1": Robot(model="gantry", mount=Mount(x=0, y=0))}))
    motion: Any = Fence(free)
    seen = see(setup, {"a": (200, 200), "wall": (520, 420)})
    (found,) = planned(setup, seen, want({"a": goal, "wall": (520, 420)}), motion).diagnostics
    return found.hint, motion.asked


def test_behind_a_fence_the_next_place_is_looked_for_and_in_the_end_none() -> None:
    assert beside(lambda goal: True) == ("nearest free place along x is x = 458", 1)
    hint, asked = beside(lambda goal: goal.x > 520)
    assert hint == "nearest free place is x = 522, y = 358" and asked <= TRIES
    hint, asked = beside(lambda goal: False)
    assert hint == "choose a place farther away: no arm was found to bring it to one near by" and asked == TRIES


def test_a_slot_is_offered_where_an_arm_brings_the_part() -> None:
    slots = {"on_it": Slot(x=520, y=420), "s1": Slot(x=60, y=60), "s2": Slot(x=160, y=60)}
    assert beside(lambda goal: True, "on_it", slots)[0] == "choose a free slot: s2 or s1"
    assert beside(lambda goal: goal.x < 100, "on_it", slots)[0] == "choose a free slot: s1"
