"""An arm that was stopped with an empty hand is parked before anything else, or told of."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from planning_benches import bench, planned, see, want

from pico.model.observation import ObservedRobot, left_standing
from pico.model.robot import Robot

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
