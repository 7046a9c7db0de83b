"""The motion test of the driver: what it measures, and what it refuses."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest
from xarm_rig import Rig

from pico.diagnostics import PicoError, error
from pico.drivers import motion_test as testing
from pico.drivers.protocols import ArmState


def test_the_arm_turns_its_last_joint_is_stopped_and_stands_where_it_stood(rig: Rig) -> None:
    before = rig.do(rig.arm.state()).joints
    found = rig.do(rig.arm.motion_test())
    assert found["off_deg"] < 0.2 and 0 < found["stop_deg"] < 2.0
    state = rig.do(rig.arm.state())
    assert state.enabled and not state.fault
    assert np.allclose(state.joints, before, atol=testing.EXACT)


class Bad:
    """An arm that comes to rest `off` its goal [rad], or that no stop stops."""

    def __init__(self, off: float = 0.0, stops: bool = True) -> None:
        self.joints, self.off, self.stops, self.stopped = (0.0,) * 7, off, stops, False

    async def ready(self) -> ArmState:
        self.stopped = False
        return await self.state()

    async def state(self) -> ArmState:
        return ArmState(joints=self.joints, age=0.0, moving=False, enabled=True)

    async def follow(self, times: Any, joints: Any, *, doing: str = "") -> ArmState:
        for row in joints:
            await asyncio.sleep(0.001)
            if self.stopped and self.stops:
                raise PicoError(error("device-stopped", "it was stopped"))
            self.joints = tuple(float(q) for q in row)
        self.joints = (*self.joints[:-1], self.joints[-1] + self.off)
        return await self.state()

    async def stop(self) -> None:
        self.stopped = True


@pytest.mark.parametrize(
    ("arm", "said"),
    [(Bad(off=0.01), "stopped 0.573 deg from where it was sent to"), (Bad(stops=False), "after it was stopped")],
)
def test_an_arm_that_misses_its_goal_or_does_not_stop_has_failed(arm: Any, said: str) -> None:
    with pytest.raises(PicoError, match=said):
        asyncio.run(testing.motion_test("arm1", arm))


def test_a_good_arm_passes() -> None:
    found = asyncio.run(testing.motion_test("arm1", Bad()))  # type: ignore[arg-type]
    assert found["off_deg"] == 0 and found["stop_deg"] < 2
