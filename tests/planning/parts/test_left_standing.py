"""An arm that was stopped with an empty hand is told of where no operation of a plan uses it."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from planning_benches import bench, planned, see, want

from pico.model.lab import Robot
from pico.model.observation import ObservedRobot

SETUP = bench({"a": "block"})
NAME = next(iter(SETUP.lab.robots))
ARM = replace(SETUP.lab.robots[NAME], model="xarm7")
SETUP = replace(SETUP, lab=replace(SETUP.lab, robots={NAME: ARM}))


def parked(arm: Robot) -> tuple[float, ...]:
    return tuple(math.radians(angle) for angle in arm.park)


@pytest.mark.parametrize(
    ("off", "goal", "told"), [(0.0, 300, []), (0.01, 300, []), (0.3, 300, [NAME]), (0.3, 400, [])]
)  # the last one moves something, and parks
def test_an_arm_that_stays_where_it_was_stopped_is_told_of(off: float, goal: float, told: list[str]) -> None:
    first, *rest = parked(ARM)
    seen = see(SETUP, {"a": (300, 300)})
    seen = replace(seen, robots={NAME: ObservedRobot(joints=(first + off, *rest))})
    made = planned(SETUP, seen, want({"a": (goal, 300)}))
    assert not made.errored
    assert [d.address for d in made.diagnostics if d.code == "not-parked"] == told
    assert [o for o in made.operations if o.primitive == "park"] == ([] if goal == 300 else [made.operations[-1]])
