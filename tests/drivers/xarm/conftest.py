"""One emulated arm for a module's tests, ready once, and the arm as it is when nothing is wrong with it."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import pytest
from xarm_rig import HOME, PACE, SERIAL, Rig, rigged

from pico.diagnostics import PicoError
from pico.drivers.xarm import library
from pico.drivers.xarm.arm import XArm
from pico.emulators.xarm.server import XArmEmulator


@pytest.fixture(scope="module")
def shared() -> Iterator[Rig]:
    """One arm for a module's tests, ready once. A machine that is busy may be slower than a link that is alive."""
    emulator = XArmEmulator(joints=HOME, serial=SERIAL, pace=PACE)
    emulator.start()
    loop = asyncio.new_event_loop()
    rig = rigged(emulator, loop)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(library, "ANSWER", 1.5)
        for _ in range(3):
            if rig.do(_ready(rig.arm)):
                break
        yield rig
    rig.do(rig.arm.close())
    rig.do(rig.gripper.close())
    loop.close()
    emulator.close()
    assert emulator.box.unknown == [], "the driver asked for a register that the emulator does not know"
    assert emulator.box.invalid == [], "the driver asked for what is answered as invalid"


@pytest.fixture
def rig(shared: Rig) -> Rig:
    """The arm as it is when nothing is wrong with it."""
    shared.emulator.thaw()
    shared.emulator.release()
    shared.emulator.faults.clear()
    if not shared.do(_fine(shared.arm)):
        shared.do(shared.arm.recover(by_person=True))
    return shared


async def _ready(arm: XArm) -> bool:
    try:
        await arm.connect()
        return (await arm.ready()).enabled
    except PicoError:
        return False


async def _fine(arm: XArm) -> bool:
    try:
        return (await arm.state()).enabled
    except PicoError:
        return False
