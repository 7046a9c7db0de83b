"""The xArm driver at real pace against its emulator: set-points at 250 Hz, and how soon a lost control box is noticed.

    python benchmarks/xarm_link.py --seconds 10 --losses 10

Set-points: how many were sent, at what mean rate, how many the control box refused. Losses: a process that is frozen,
killed, or started anew under a motion, or while nobody asks anything, from that until the driver says so, and whether
it is ready again afterwards.
The exit code is 1 where a set-point was refused or an arm was not found again, 3 where only a loss was told later than
after 1 s.
"""

from __future__ import annotations

import argparse
import asyncio
import sys
import time
from itertools import product
from typing import Any

import numpy as np

from pico.diagnostics import PicoError
from pico.drivers.bus import Bus
from pico.drivers.xarm.arm import DRIVER, XArm
from pico.emulators.xarm.server import XArmEmulator
from pico.model.wiring import DeviceEntry

HOME = (0.0, -0.5, 0.0, 0.5, 0.0, 1.0, 0.0)
SERIAL = "XI130500000000"
LATEST = 1.0


def path(emulator: XArmEmulator, by: float, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    share = np.linspace(0.0, 1.0, 100)
    joints = np.tile(emulator.joints, (100, 1))
    joints[:, 0] += by * (3 * share**2 - 2 * share**3)
    return seconds * share, joints


async def streamed(arm: XArm, emulator: XArmEmulator, seconds: float) -> bool:
    times, joints = path(emulator, 1.5, seconds)
    before, began = emulator.box.requested[29], time.monotonic()
    try:
        await arm.follow(times, joints)
        refused = 0
    except PicoError as exc:
        print(exc)
        refused = 1
    spent, taken = time.monotonic() - began, emulator.box.requested[29] - before
    print(f"set-points: {taken} in {spent:.2f} s, {taken / spent:.1f} a second, {refused} refused")
    return not refused


async def lost(arm: XArm, bus: Bus[Any], emulator: XArmEmulator, how: str, idle: bool) -> tuple[float, bool]:
    """How long after the loss the driver said so [s], and whether the arm is ready again."""
    took = await (until_told(bus, emulator, how) if idle else until_failed(arm, emulator, how))
    if how == "freeze":
        emulator.thaw()
    elif how == "kill":
        emulator.restart()
    for _ in range(3):
        try:
            return took, (await arm.recover(by_person=True)).enabled
        except PicoError as exc:
            print(f"  after {how}: {exc}")
    return took, False


async def until_told(bus: Bus[Any], emulator: XArmEmulator, how: str) -> float:
    """How long after the loss the bus knows of it, of which nobody asks anything [s]."""
    bus.lost, began = "", time.monotonic()
    await asyncio.to_thread(getattr(emulator, how))
    while not bus.lost and time.monotonic() - began < 10.0:
        await asyncio.sleep(0.01)
    return time.monotonic() - began if bus.lost else float("inf")


async def until_failed(arm: XArm, emulator: XArmEmulator, how: str) -> float:
    """How long after the loss a motion ends with that [s]."""
    moving = asyncio.create_task(arm.follow(*path(emulator, 0.5 if emulator.joints[0] < 1.0 else -0.5, 10.0)))
    await asyncio.sleep(0.3)
    began = time.monotonic()
    await asyncio.to_thread(getattr(emulator, how))
    try:
        await moving
    except PicoError:
        return time.monotonic() - began
    return float("inf")


async def run(seconds: float, losses: int) -> int:
    emulator = XArmEmulator(joints=HOME, serial=SERIAL)
    emulator.start()
    entry = DeviceEntry(driver="xarm.arm", address=emulator.address, identity={"serial": SERIAL})
    bus: Bus[Any] = Bus(lambda: DRIVER.opened(entry), DRIVER.closed, DRIVER.alive)
    arm = XArm("arm1", entry, bus)
    try:
        await arm.connect()
        await arm.ready()
        good, late = await streamed(arm, emulator, seconds), False
        for how, idle in product(("freeze", "kill", "restart"), (False, True)):
            found = [await lost(arm, bus, emulator, how, idle) for _ in range(losses)]
            took = sorted(t for t, _ in found)
            ready = sum(r for _, r in found)
            often = f"{took[len(took) // 2]:.2f} s (median), {took[-1]:.2f} s at most"
            print(f"{how}{', idle' if idle else ''}: noticed after {often}; ready again {ready} of {losses}")
            good, late = good and ready == losses, late or took[-1] > LATEST
        print(f"registers that the emulator does not know: {emulator.box.unknown or 'none'}")
        return 1 if not good else 3 if late else 0
    finally:
        await arm.close()
        emulator.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=10.0, help="how long set-points are sent")
    parser.add_argument("--losses", type=int, default=10, help="of each kind")
    asked = parser.parse_args()
    sys.exit(asyncio.run(run(asked.seconds, asked.losses)))


if __name__ == "__main__":
    main()
