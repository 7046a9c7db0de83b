"""The step in which the driver of each arm tries its own motion test on the device."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.backends.attempt import Failed
from pico.bench.commissioning.standing import NO_ARM, AtBench, Found
from pico.bench.commissioning.swinging import attended
from pico.diagnostics import PicoError, error
from pico.drivers.protocols import MotionTested
from pico.model.commissioning import CODE
from pico.model.record import as_json


def motion(at: AtBench) -> Found:
    """The driver of each arm tries its motion, its stop and its limits; from then on plans run whole on devices with
    this serial number and firmware. Raises PicoError for the first that is not as it should be."""
    devices = at.device.links.arm_devices()
    if not devices:
        return NO_ARM
    bench = at.bench.wait(at.device.links.instruments())
    found: dict[str, Any] = {}
    for robot, device in sorted(devices.items()):
        arm = bench.arms[robot]
        if not isinstance(arm, MotionTested):
            text = f"the driver of {device} has no motion test: {robot} makes one motion a command"
            raise PicoError(error(CODE, text, hint="its driver needs `test` and `motion_test`", address=device))
        at.require_hand_on_stop(f"{robot}: {arm.test}")
        identity = as_json(bench.who[device])
        measured = attended(at, _tried(at, robot))
        entry = at.device.links.entries[device]
        found[device] = {"passed": True, "robot": robot, "driver": entry.driver, **identity, "measured": dict(measured)}
    told = ", ".join(
        f"{one['robot']} ({one['serial']}, firmware {one.get('firmware') or 'none'})" for one in found.values()
    )
    return Found(told=f"moved, stopped, limits read back: {told}", data={"devices": found})


async def _tried(at: AtBench, robot: str) -> Mapping[str, float]:
    """Take the bench for the test of an arm; raises PicoError."""
    lease = await at.edge.acquire("pico commission")
    try:
        return await at.device.try_motion(robot)
    except Failed as exc:
        raise PicoError(exc.diagnostic) from exc
    finally:
        await at.edge.release(lease)
