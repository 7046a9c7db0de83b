"""The process that sends set-points: what becomes of a motion if it, or who wants it, is gone or stands still."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from xarm_rig import HOME, SERIAL, Rig, rigged

from pico.diagnostics import PicoError
from pico.drivers.xarm import sender
from pico.drivers.xarm.sender import SentStream
from pico.emulators.xarm.server import XArmEmulator

HALTS = 1.0
"""How long it may take until the arm stands [s]: the silence of 0.5 s, and 0.25 s in which it comes to rest."""


def pid(rig: Rig) -> int:
    assert rig.arm._sender is not None
    return rig.arm._sender.pid


def alive(process: int) -> bool:
    """Whether it runs; one that nobody has waited for yet does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


async def _meanwhile(rig: Rig, trouble: Callable[[], object]) -> str:
    """What a motion raises under which there is trouble."""
    path = rig.turn(1, 1.0 if rig.emulator.joints[0] < 0.5 else -1.0, 20.0)
    moving = asyncio.create_task(rig.arm.follow(*path, doing="op3: move lx_100"))
    while abs(rig.emulator.joints[0] - path[1][0][0]) < 0.02 and not moving.done():
        await asyncio.sleep(0.002)
    trouble()
    with pytest.raises(PicoError) as failed:
        await moving
    return str(failed.value)


def still(rig: Rig) -> bool:
    """Whether nothing moves for an emulated second."""
    rest, until = rig.emulator.joints, rig.emulator.box.now + 1.0
    while rig.emulator.box.now < until:
        rig.do(asyncio.sleep(0.01))
    return rig.emulator.joints == rest


@pytest.mark.parametrize(
    ("how", "said"), [(signal.SIGKILL, r"ended \(exit code -9\)"), (signal.SIGSTOP, r"said nothing for 0\.\d s")]
)
def test_a_sender_that_is_gone_or_frozen_ends_the_operation_with_the_arm_at_rest(
    rig: Rig, how: signal.Signals, said: str
) -> None:
    rig.do(rig.arm.follow(*rig.turn(1, 0.02)))
    before = pid(rig)
    told = rig.do(_meanwhile(rig, lambda: os.kill(before, how)))
    assert re.search(f"arm1 was stopped during op3: move lx_100: the process that sends its set-points {said}", told)
    assert rig.emulator.box.state == 4 and still(rig)
    assert not alive(before)
    assert rig.do(rig.arm.follow(*rig.turn(1, -0.05))).enabled, "the next command starts another process"
    assert pid(rig) != before and still(rig)


def test_an_arm_comes_to_rest_on_its_path_while_nobody_says_that_it_is_wanted(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sender, "BEAT", 30.0)  # this process stands still, as far as the other one hears
    told = rig.do(_meanwhile(rig, lambda: None))
    assert re.search(r"arm1 was halted on its way during op3: move lx_100: PICO itself did not run for 3\.\d s", told)
    assert rig.emulator.box.error == 0 and still(rig)


def hold_interpreter(seconds: float) -> None:
    """Let no other thread of this process run: a call in C that gives the interpreter to nobody."""
    began = time.perf_counter()
    sum(range(1_000_000))
    sum(range(int(1_000_000 * seconds / (time.perf_counter() - began))))


@pytest.mark.parametrize("how", ["silent", "busy"])
def test_an_arm_goes_on_where_it_was_once_it_is_wanted_again(rig: Rig, how: str) -> None:
    """Nothing is heard for a second: of a process that has nobody who speaks, or of one in which nothing else runs, the
    emulator included."""

    async def interrupted() -> list[float]:
        path = rig.turn(1, 0.6 if rig.emulator.joints[0] < 0.5 else -0.6, 12.0)
        moving = asyncio.create_task(rig.arm.follow(*path))
        while abs(rig.emulator.joints[0] - path[1][0][0]) < 0.05:
            await asyncio.sleep(0.002)
        sending, rest = rig.arm._sender, []
        assert sending is not None
        if how == "busy":
            hold_interpreter(0.7)
        else:
            say = sending._next
            sending._next = lambda: (time.sleep(1.2), say())[1]  # type: ignore[func-returns-value,method-assign]
            await asyncio.sleep(0.8)
            rest = [rig.emulator.joints[0]]
            await asyncio.sleep(0.1)
            rest.append(rig.emulator.joints[0])
            del sending._next
        return [(await moving).joints[0], path[1][-1][0], *rest]

    ended, goal, *rest = rig.do(interrupted())
    assert ended == pytest.approx(goal, abs=2e-3)
    if rest:
        assert rest[0] == pytest.approx(rest[1], abs=1e-9) and abs(rest[0] - goal) > 0.05


def test_one_process_serves_a_session_and_says_how_much_it_sent(rig: Rig) -> None:
    rig.do(rig.arm.ready())
    before, asked = pid(rig), rig.emulator.box.requested[29]
    for by in (0.05, -0.05):
        rig.do(rig.arm.follow(*rig.turn(1, by)))
        assert isinstance(rig.arm._stream, SentStream)
        assert 0 < rig.arm._stream.sent == rig.emulator.box.requested[29] - asked
        asked = rig.emulator.box.requested[29]
    assert pid(rig) == before


def test_the_process_ends_with_the_driver_and_with_who_started_it(rig: Rig) -> None:
    fresh = rigged(rig.emulator, rig.loop)
    rig.do(fresh.arm.connect())
    rig.do(fresh.arm.ready())
    one = pid(fresh)
    rig.do(fresh.arm.close())
    until = time.monotonic() + 5.0
    while alive(one) and time.monotonic() < until:
        time.sleep(0.01)
    assert not alive(one)
    rig.do(rig.arm.ready())


DRIVING = """
import asyncio, sys
sys.path.insert(0, sys.argv[3])
import numpy as np
from xarm_rig import SERIAL, DeviceEntry, Bus, DRIVER, XArm
entry = DeviceEntry(driver="xarm.arm", address={"host": sys.argv[1], "port": int(sys.argv[2])},
                    identity={"serial": SERIAL}, settings={"pace": 10.0, "tool_z": 172.0, "load": 0.8, "load_z": 60.0})
arm = XArm("arm1", entry, Bus(lambda: DRIVER.opened(entry), DRIVER.closed, DRIVER.alive))
async def drive():
    await arm.connect()
    at = np.array((await arm.ready()).joints)
    print(arm._sender.pid, flush=True)
    await arm.follow(np.linspace(0.0, 60.0, 50), at + np.linspace(0.0, 1.5, 50)[:, None] * np.eye(7)[0])
asyncio.run(drive())
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
def test_an_arm_stands_soon_after_who_drives_it_was_killed_or_frozen(how: signal.Signals) -> None:
    emulator = XArmEmulator(joints=HOME, serial=SERIAL, pace=10.0)
    emulator.start()
    where = [str(emulator.address["host"]), str(emulator.address["port"]), str(Path(__file__).parent)]
    with subprocess.Popen([sys.executable, "-c", DRIVING, *where], stdout=subprocess.PIPE, text=True) as driving:
        assert driving.stdout is not None
        sending = int(driving.stdout.readline())
        while emulator.joints[0] < 0.1:
            time.sleep(0.005)
        driving.send_signal(how)
        time.sleep(HALTS)
        rest = emulator.joints
        time.sleep(0.3)
        assert emulator.joints == rest and 0.1 < rest[0] < 1.4 and emulator.box.error == 0
        assert alive(sending) == (how == signal.SIGSTOP)
        driving.kill()
    emulator.close()
