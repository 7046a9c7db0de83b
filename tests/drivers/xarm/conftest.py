"""One emulated arm for a module's tests, ready once, and the arm as it is when nothing is wrong with it."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import pytest
from xarm_rig import HOME, PACE, SERIAL, Rig, rigged

from pico.diagnostics import PicoError
from pico.drivers.xarm.arm import XArm
from pico.emulators.xarm.server import XArmEmulator


@pytest.fixture(scope="module")
def shared() -> Iterator[Rig]:
    """One arm for a module's tests, ready once."""
    emulator = XArmEmulator(joints=HOME, serial=SERIAL, pace=PACE)
    emulator.start()
    loop = asyncio.new_event_loop()
    rig = rigged(emulator, loop)
    rig.do(rig.arm.connect())
    rig.do(rig.arm.ready())
    yield rig
    rig.do(rig.arm.close())
    rig.do(rig.gripper.close())
    loop.close()
    emulator.close()
    assert emulator.box.unknown == [], "the driver asked for a register that the emulator does not know"


@pytest.fixture
def rig(shared: Rig) -> Rig:
    """The arm as it is when nothing is wrong with it."""
    shared.emulator.thaw()
    shared.emulator.release()
    shared.emulator.faults.clear()
    if not shared.do(_fine(shared.arm)):
        shared.do(shared.arm.recover(by_person=True))
    return shared


async def _fine(arm: XArm) -> bool:
    try:
        return (await arm.state()).enabled
    except PicoError:
        return False
