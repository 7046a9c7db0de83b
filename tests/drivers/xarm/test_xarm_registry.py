"""An arm and its gripper opened by name, as a bench opens them: one emulator, one link, one thread for both."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest
from xarm_rig import HOME, SERIAL

from pico.drivers.registry import Buses, driver, known
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.model.wiring import DeviceEntry


def entry(name: str, **more: Any) -> DeviceEntry:
    return DeviceEntry(
        driver=name, address={"host": "192.0.2.1"}, identity={"serial": SERIAL}, of="arm1", emulator="xarm", **more
    )


def test_a_bench_opens_them_and_they_share_a_link() -> None:
    devices = {"arm": entry("xarm.arm", settings={"pace": 10.0}), "hand": entry("xarm.gripper")}
    behind = Alone(
        {"joints": HOME, "width": 60.0, "pace": 10.0, "fingers": lambda joints, wanted, now: max(wanted, 20.0)}
    )
    bench, buses = EmulatedBench(devices, lambda name, entry: behind), Buses()
    arm, hand = (buses.opened(name, bench.entries[name]) for name in devices)
    times, joints = np.array([0.0, 1.0]), np.array([HOME, (0.1, *HOME[1:])])

    async def all_of_it() -> None:
        await asyncio.gather(arm.connect(), hand.connect())
        await arm.ready()
        assert (await hand.grip()).width == pytest.approx(60.0, abs=0.1)
        assert (await arm.follow(times, joints)).joints == pytest.approx(joints[-1], abs=2e-3)
        held = await hand.move_to(0.0)
        assert (held.holds, round(held.width)) == (True, 20)
        await arm.close()
        await hand.close()
        await buses.close()

    try:
        asyncio.run(all_of_it())
        emulator = behind.read("emulator")
        assert emulator.joints[0] == pytest.approx(0.1, abs=2e-3) and emulator.box.unknown == []
    finally:
        bench.close()


@pytest.mark.parametrize("name", ["xarm.arm", "xarm.gripper"])
def test_what_a_driver_says_of_itself(name: str) -> None:
    found = driver(name)
    assert name in known() and found.maturity == "emulated" and found.needs == ("xarm", "xarm")
    assert found.link == "xarm" and found.bus == ("host",)
