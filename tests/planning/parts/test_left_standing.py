"""An arm that was stopped with an empty hand is parked before anything else, or told of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
from planning_benches import bench, planned, see, want

from pico.model.observation import ObservedRobot, left_standing
from pico.model.robot import Robot
from pico.motion.types import Blocked, MovePath, Segment
from pico.planning.parts.setdown import parked_first

SETUP = bench({"a": "block"})
NAME = next(iter(SETUP.lab.robots))
ARM = replace(SETUP.lab.robots[NAME], model="xarm7")
SETUP = replace(SETUP, lab=replace(SETUP.lab, robots={NAME: ARM}))


def parked(arm: Robot) -> tuple[float, ...]:
    return tuple(math.radians(angle) for angle in arm.park)


@pytest.mark.parametrize(("off", "goal", "parks"), [(0.0, 300, 0), (0.01, 300, 0), (0.3, 300, 1), (0.3, 400, 1)])
def test_an_arm_that_was_stopped_on_its_way_is_parked_by_the_next_plan(off: float, goal: float, parks: int) -> None:
    first, *rest = parked(ARM)
    seen = see(SETUP, {"a": (300, 300)})
    seen = replace(seen, robots={NAME: ObservedRobot(joints=(first + off, *rest))})
    made = planned(SETUP, seen, want({"a": (goal, 300)}))
    assert not made.errored
    assert [o for o in made.operations if o.primitive == "park"] == list(made.operations[-1:])[:parks]
    assert not [d for d in made.diagnostics if d.code == "not-parked"]
    assert [d.code for d in left_standing(SETUP, seen)] == ["not-parked"] * parks


class Meeting:
    """Two arms of which the first parks only where the second is parked."""

    def park(self, robot: str, joints: object, standing: object, others: Mapping[str, Any]) -> MovePath | Blocked:
        if robot == "arm1" and not ARM.is_parked(others["arm2"]):
            return Blocked("collision", "it would hit arm2", obstacle="arm2")
        return MovePath(robot, None, (Segment("park", (0.0, 1.0), (parked(ARM), parked(ARM)), 0.0),))


def test_an_arm_that_another_keeps_from_parking_parks_after_that() -> None:
    setup = replace(SETUP, lab=replace(SETUP.lab, robots={"arm1": ARM, "arm2": ARM}))
    first, *rest = parked(ARM)
    stopped = ObservedRobot(joints=(first + 0.3, *rest))
    seen = replace(see(setup, {"a": (300, 300)}), robots={"arm1": stopped, "arm2": stopped})
    motion: Any = Meeting()
    assert [o.robot for o in parked_first(setup, seen, (), motion)] == ["arm2", "arm1"]
    blocked: Any = type("Stuck", (), {"park": lambda *_: Blocked("reach", "no")})()
    assert parked_first(setup, seen, (), blocked) == ()
