"""An xArm7 at real pace, and one that is a process of its own."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from xarm_rig import HOME, SERIAL, rigged

from pico.base.awake import Awake
from pico.diagnostics import PicoError
from pico.drivers.xarm.link import PAUSE, Link
from pico.drivers.xarm.streaming import PERIOD, Stream
from pico.emulators.xarm.server import XArmEmulator


@pytest.mark.slow
def test_ten_seconds_of_set_points_at_250_hz_and_none_is_refused() -> None:
    """How many come through depends on the machine: a thread that was late goes on by three periods at most, and ends
    later by what it lost."""
    emulator = XArmEmulator(joints=HOME, serial=SERIAL)
    emulator.start()
    loop = asyncio.new_event_loop()
    rig = rigged(emulator, loop, pace=1.0)
    rig.do(rig.arm.connect())
    rig.do(rig.arm.ready())
    targets: list[float] = []
    follow = emulator.box.follow
    emulator.box.follow = lambda target: (targets.append(target[0]), follow(target))[1]  # type: ignore[func-returns-value]
    times, joints = rig.turn(1, 1.5, seconds=10.0)
    rig.do(rig.arm.follow(times, joints))
    assert rig.arm._stream is not None and len(targets) == rig.arm._stream.sent == emulator.box.requested[29]
    assert 10.0 / PERIOD / 3 <= len(targets) <= 10.0 / PERIOD * 1.2
    fastest = float(np.max(np.diff(joints[:, 0]) / np.diff(times)))
    assert max(np.diff(targets)) <= 3 * PERIOD * fastest * 1.01
    assert emulator.box.error == 0 and emulator.box.unknown == []
    rig.do(rig.arm.close())
    emulator.close()
    loop.close()


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGSTOP, signal.SIGKILL])
def test_a_process_that_is_frozen_or_killed_is_noticed(how: signal.Signals) -> None:
    run = [sys.executable, "-m", "pico.emulators.xarm", "--serial", SERIAL, "--pace", "10"]
    with subprocess.Popen(run, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdin is not None
        address = json.loads(process.stdout.readline())
        loop = asyncio.new_event_loop()
        emulator = XArmEmulator(joints=HOME)  # stands in for where the drivers of the rig look only
        emulator._host, emulator._port = address["host"], address["port"]
        rig = rigged(emulator, loop)
        rig.do(rig.arm.connect())
        at = np.array(rig.do(rig.arm.ready()).joints)
        process.stdin.write("fault 24\n")
        process.stdin.flush()
        while not rig.do(rig.arm.state()).fault:
            pass
        rig.do(rig.arm.recover())
        path = np.linspace(0.0, 30.0, 50), at + np.linspace(0.0, 1.0, 50)[:, None] * np.eye(7)[0]

        async def lost() -> None:
            moving = asyncio.create_task(rig.arm.follow(*path, doing="op1"))
            await asyncio.sleep(0.1)
            process.send_signal(how)
            with pytest.raises(PicoError, match="arm1 was lost during op1"):
                await moving

        rig.do(lost())
        rig.do(rig.arm.close())
        process.kill()
        loop.close()


def test_an_answer_of_which_the_library_makes_no_sense_is_a_lost_link_and_no_crash() -> None:
    def garbled(*asked: object, **how: object) -> None:
        raise IndexError("index out of range")

    link: Any = SimpleNamespace(require_heard=lambda: None, ask=garbled, arm=None)
    path: Any = SimpleNamespace(at=lambda place: [0.0] * 7, seconds=1.0)
    stream = Stream("arm1", link, path, doing="op3", pace=1.0, set_points=True)
    stream.start()
    with pytest.raises(ConnectionError, match="makes no sense: index out of range"):
        stream.done.result(5)


class Reported:
    """A link at a clock that is set, to a box that reports when it is told to."""

    connected = True

    def __init__(self) -> None:
        self.at = 100.0
        self.link = Link(self)
        self.link._clock = Awake(lambda: self.at, PAUSE)
        self.reports(None)

    def register_report_callback(self, call: Any) -> None:
        self.reports = call

    def after(self, seconds: float) -> None:
        self.at += seconds
        self.link.require_heard()


def test_time_in_which_this_process_did_not_run_is_no_silence_of_the_box() -> None:
    """It stood still for a second, and what was reported meanwhile is not read yet; a box that says nothing for long is
    lost all the same, also for a process that stands still again and again."""
    box = Reported()
    box.after(0.2)
    box.after(1.0)
    box.reports(None)
    for _ in range(2):
        box.after(0.2)
    with pytest.raises(ConnectionError, match=r"reported nothing for 0\.7 s"):
        box.after(5.0)


def test_an_answer_counts_as_a_report_and_none_does_not() -> None:
    box = Reported()
    for _ in range(10):
        box.after(0.2)
        box.link.ask("arm1", "take a set-point", lambda: 0)
    for code in (3, -1):
        box.after(0.2)
        with pytest.raises(ConnectionError, match="gave no answer"):
            box.link.ask("arm1", "take a set-point", lambda code=code: code)  # type: ignore[misc]
    assert box.link.age == pytest.approx(0.4)
