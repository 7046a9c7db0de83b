"""An xArm7 that is well: it gets ready, follows paths, halts, stops, and holds what it grips."""

from __future__ import annotations

import asyncio
import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from xarm_rig import HOME, SERIAL, Rig, rigged

from pico.diagnostics import PicoError
from pico.drivers.xarm.streaming import BRAKE, rate
from pico.emulators.xarm import registers

SYSTEM_RESET = (35, 36, 37)


def test_it_says_who_it_is(rig: Rig) -> None:
    found = rig.do(rig.arm.connect())
    assert (found.model, found.serial, found.firmware) == ("xArm7", SERIAL, "2.7.1")


def test_mode_and_state_come_after_all_that_resets_the_box(rig: Rig) -> None:
    rig.emulator.transcript = []
    rig.do(rig.arm.ready())
    asked = [(frame[6], frame[7:]) for frame, _ in rig.emulator.transcript if frame[6] in (*SYSTEM_RESET, 11, 19, 12)]
    rig.emulator.transcript = None
    assert [register for register, _ in asked[-3:]] == [11, 19, 12]
    assert asked[-2][1][0] == 1 and asked[-1][1] == b"\0"
    assert set(SYSTEM_RESET) <= {register for register, _ in asked[:-3]}
    assert (rig.emulator.box.mode, rig.emulator.box.state, rig.emulator.box.enabled) == (1, 2, True)


def test_what_it_is_told_is_what_the_box_has(rig: Rig) -> None:
    has = rig.emulator.box.settings
    assert has.sensitivity == 3 and has.self_collision and has.fence and has.reduced and not has.rebound
    assert np.allclose((*has.offset, *has.load), (0, 0, 172, 0, 0, 0, 0.8, 0, 0, 60))
    assert has.boundary == (900, -900, 900, -900, 1300, -100)


def test_what_its_hand_holds_hangs_beside_its_load_and_it_goes_on_moving(rig: Rig) -> None:
    """Another load is a system reset: mode and state are set again, or set-points would be refused."""
    rig.do(rig.arm.carry(0.4, (0.0, 0.0, 210.0)))
    assert np.allclose(rig.emulator.box.settings.load, (1.2, 0, 0, (0.8 * 60 + 0.4 * 210) / 1.2))
    assert (rig.emulator.box.mode, rig.emulator.box.state) == (1, 2)
    refused = rig.emulator.box.invalid[:]
    assert rig.do(rig.arm.follow(*rig.turn(1, 0.05))).enabled
    assert rig.emulator.box.invalid == refused
    rig.do(rig.arm.carry(0.0, (0.0, 0.0, 0.0)))
    assert np.allclose(rig.emulator.box.settings.load, (0.8, 0, 0, 60))
    rig.do(rig.arm.follow(*rig.turn(1, -0.05)))


@pytest.mark.parametrize(
    ("register", "what"),
    [(36, "load"), (35, "tool offset"), (37, "collision sensitivity"), (77, "self-collision"), (51, "gravity"),
     (47, "speed of the tool"), (48, "speed of the joints"), (52, "fence"), (59, "fence"), (50, "reduced mode"),
     (58, "range of joint 2")],
)  # fmt: skip
def test_what_the_box_does_not_take_is_read_back_and_told(
    rig: Rig, monkeypatch: pytest.MonkeyPatch, register: int, what: str
) -> None:
    taken = dict(registers.REGISTERS) | {register: lambda box, frame: b""}
    rig.emulator.box.settings = type(rig.emulator.box.settings)(sensitivity=0, gravity=(1.0, 0.0, 0.0))
    rig.emulator.box.settings.reduced_tool_speed = rig.emulator.box.settings.reduced_joint_speed = 0.1
    rig.emulator.box.settings.joint_range = (-9.0, 9.0) * 7
    monkeypatch.setattr(registers, "REGISTERS", taken)
    with pytest.raises(PicoError, match=f"arm1 did not take its .*{what}"):
        rig.do(rig.arm.ready())
    monkeypatch.undo()
    assert rig.do(rig.arm.ready()).enabled


def test_it_follows_a_path_and_rests_at_its_end(rig: Rig) -> None:
    times, joints = rig.turn(1, 0.4)
    found = rig.do(rig.arm.follow(times, joints, doing="op1"))
    assert np.allclose(found.joints, joints[-1], atol=2e-3) and not found.moving
    assert rig.emulator.box.error == 0


def test_the_boxs_own_moves_lead_along_a_paths_corners(rig: Rig) -> None:
    by_moves = rigged(rig.emulator, rig.loop, follow="moves")
    rig.do(by_moves.arm.ready())
    times, joints = rig.turn(1, 0.3)
    joints[30:, 3] += np.linspace(0.0, 0.2, 30)
    before = rig.emulator.box.requested[23]
    found = rig.do(by_moves.arm.follow(times, joints))
    assert np.allclose(found.joints, joints[-1], atol=2e-3)
    assert 2 <= rig.emulator.box.requested[23] - before < 20
    rig.do(by_moves.arm.close())
    rig.do(rig.arm.ready())


async def _interrupted(rig: Rig, path: tuple[np.ndarray, np.ndarray], how: str) -> str:
    moving = asyncio.create_task(rig.arm.follow(*path, doing="op7: move lx_100"))
    while abs(rig.emulator.joints[0] - path[1][0][0]) < 0.05:
        await asyncio.sleep(0.002)
    await getattr(rig.arm, how)()
    with pytest.raises(PicoError) as failed:
        await moving
    return str(failed.value)


@pytest.mark.parametrize(("how", "word"), [("halt", "halted"), ("stop", "stopped")])
def test_it_comes_to_rest_on_its_path_and_nothing_moves_after(rig: Rig, how: str, word: str) -> None:
    path = rig.turn(1, 1.2, seconds=20.0)
    said = rig.do(_interrupted(rig, path, how))
    assert f"arm1 was {word} on its way during op7: move lx_100" in said
    rest, until = rig.emulator.joints, rig.emulator.box.now + 3.0
    assert 0.05 <= rest[0] - path[1][0][0] < 1.1
    assert np.allclose(rest[1:], path[1][0][1:], atol=1e-6)
    while rig.emulator.box.now < until:
        rig.do(asyncio.sleep(0.01))
    assert rig.emulator.joints == rest
    if how == "stop":
        assert rig.emulator.box.state == 4
    back = rig.turn(1, -0.1)
    assert rig.do(rig.arm.follow(*back)).joints[0] == pytest.approx(back[1][-1][0], abs=2e-3)


def test_who_no_longer_waits_for_a_motion_has_it_come_to_rest(rig: Rig) -> None:
    path = rig.turn(1, -1.2, seconds=20.0)

    async def given_up() -> None:
        moving = asyncio.create_task(rig.arm.follow(*path))
        while abs(rig.emulator.joints[0] - path[1][0][0]) < 0.05:
            await asyncio.sleep(0.002)
        moving.cancel()
        with pytest.raises(asyncio.CancelledError):
            await moving
        await rig.arm.halt()

    rig.do(given_up())
    rest, until = rig.emulator.joints, rig.emulator.box.now + 2.0
    while rig.emulator.box.now < until:
        rig.do(asyncio.sleep(0.01))
    assert rig.emulator.joints == rest and rest[0] > path[1][-1][0] + 0.1


def test_a_stop_needs_no_motion_to_stop(rig: Rig) -> None:
    rig.do(rig.arm.stop())
    assert rig.emulator.box.state == 4 and not rig.do(rig.arm.state()).enabled


def test_braking_is_smooth_and_ends() -> None:
    shares = [rate(BRAKE * i / 50) for i in range(51)]
    assert shares[0] == 1.0 and shares[-1] == 0.0 and shares == sorted(shares, reverse=True)
    slowest = max(a - b for a, b in pairwise(shares)) / (BRAKE / 50)
    assert math.pi * slowest <= 20.5  # rad/s2 of a joint at its greatest speed


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda times, joints: (times, joints + 0.1), "does not stand where its path begins"),
        (lambda times, joints: (times, joints[:, :6]), "7 joints"),
        (lambda times, joints: (times[::-1], joints), "times do not grow"),
        (lambda times, joints: (times, joints * np.nan), "no numbers"),
        (lambda times, joints: (times / 100, joints), "deg/s, more than 180 deg/s"),
        (lambda times, joints: (times * 50, joints + np.outer(np.linspace(0, 3, 60), np.eye(7)[1])), "joint 2 goes to"),
    ],
)
def test_what_is_no_path_for_it_moves_nothing(rig: Rig, change: Any, word: str) -> None:
    before = rig.emulator.joints
    with pytest.raises(PicoError, match=word):
        rig.do(rig.arm.follow(*change(*rig.turn(1, 0.2))))
    assert rig.emulator.joints == before


def test_a_second_path_does_not_mix_with_the_first(rig: Rig) -> None:
    path = rig.turn(1, 0.3, seconds=10.0)

    async def both() -> None:
        first = asyncio.create_task(rig.arm.follow(*path))
        await asyncio.sleep(0.05)
        with pytest.raises(PicoError, match="moving already"):
            await rig.arm.follow(*path)
        await first

    rig.do(both())


def test_the_gripper_goes_where_it_is_sent_and_says_what_it_holds(rig: Rig) -> None:
    rig.do(rig.gripper.connect())
    claw = rig.emulator.box.claw
    claw.fingers = lambda wanted, now: wanted
    opened = rig.do(rig.gripper.move_to(60.0))
    assert opened.width == pytest.approx(60.0, abs=0.1) and opened.holds is False
    claw.fingers = lambda wanted, now: max(wanted, 25.4)
    held = rig.do(rig.gripper.move_to(10.0))
    assert held.width == pytest.approx(25.4, abs=0.1) and held.holds is True
    assert rig.do(rig.gripper.grip()) == held
    rig.do(rig.gripper.stop())
    assert rig.do(rig.gripper.grip()) == held


def test_the_gripper_tells_what_it_can_not_do(rig: Rig) -> None:
    for call, word in ((lambda: rig.gripper.move_to(99.0), "opens to 84 mm"),
                       (lambda: rig.gripper.move_to(9.0, force=5.0), "force")):  # fmt: skip
        with pytest.raises(PicoError, match=word):
            rig.do(call())
    rig.emulator.box.claw.error = 23
    with pytest.raises(PicoError, match=r"G23: .*something blocks it"):
        rig.do(rig.gripper.move_to(50.0))
    rig.emulator.box.claw.error = 0


def test_the_tool_stops_at_the_fence(rig: Rig) -> None:
    with rig.emulator.lock:
        rig.emulator.box.settings.boundary = (900, -900, 100, -900, 1300, -100)
    with pytest.raises(PicoError, match="during op9 with fault C35: the tool is beyond the fence"):
        rig.do(rig.arm.follow(*rig.turn(1, 1.0, seconds=10.0), doing="op9"))
    rig.emulator.box.joints = HOME


def test_a_fence_that_the_tool_stands_outside_of_is_not_put_up(rig: Rig) -> None:
    high = rigged(rig.emulator, rig.loop, tool_z=-1100.0)
    rig.emulator.box.settings.fence = False
    fences = rig.emulator.box.requested[59]
    with pytest.raises(PicoError, match=r"outside its fence: z is 1.* mm, of -100 to 1300"):
        rig.do(high.arm.ready())
    assert rig.emulator.box.requested[59] == fences and rig.emulator.box.error == 0
    rig.do(high.arm.close())
