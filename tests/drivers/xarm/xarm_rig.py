"""An emulated xArm7 behind the driver, at ten times real pace; what it was asked, it knows."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from pico.drivers.bus import Bus
from pico.drivers.xarm.arm import DRIVER, XArm
from pico.drivers.xarm.gripper import DRIVER as GRIPPER
from pico.drivers.xarm.gripper import XArmGripper
from pico.emulators.xarm.server import XArmEmulator
from pico.model.wiring import DeviceEntry

T = TypeVar("T")
HOME = (0.0, -0.5, 0.0, 0.5, 0.0, 1.0, 0.0)
SERIAL = "XI130512345678"
PACE = 10.0


@dataclass
class Rig:
    """An emulator with the drivers of its arm and its gripper on one bus, and the loop that they run in."""

    emulator: XArmEmulator
    bus: Bus[Any]
    arm: XArm
    gripper: XArmGripper
    loop: asyncio.AbstractEventLoop

    def do(self, work: Coroutine[Any, Any, T]) -> T:
        return self.loop.run_until_complete(work)

    @property
    def link(self) -> Any:
        return self.arm._link

    def turn(self, joint: int, by: float, seconds: float = 2.0) -> tuple[np.ndarray, np.ndarray]:
        """A path from where it stands: one joint turned by so much [rad]."""
        share = np.linspace(0.0, 1.0, 60)
        joints = np.tile(self.emulator.joints, (60, 1))
        joints[:, joint - 1] += by * (3 * share**2 - 2 * share**3)
        return seconds * share, joints


def rigged(emulator: XArmEmulator, loop: asyncio.AbstractEventLoop, **settings: Any) -> Rig:
    entry = DeviceEntry(
        driver="xarm.arm", address=emulator.address, identity={"serial": SERIAL},
        settings={"pace": PACE, "tool_z": 172.0, "load": 0.8, "load_z": 60.0} | settings,
    )  # fmt: skip
    bus: Bus[Any] = Bus(lambda: DRIVER.opened(entry), DRIVER.closed, DRIVER.alive)
    arm = XArm("arm1", entry, bus)
    hand = DeviceEntry(driver="xarm.gripper", address=emulator.address, identity={"serial": SERIAL})
    made = GRIPPER.made("hand", hand, bus)
    assert isinstance(made, XArmGripper)
    return Rig(emulator, bus, arm, made, loop)
