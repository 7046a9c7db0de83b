"""The motion test of an arm: its last joint turns, so that the tool stays where it is."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Mapping

import numpy as np

from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Arm, ArmState

TURN, SPEED = math.radians(5.0), math.radians(5.0)
"""By how much the last joint turns [rad], and how fast at the most [rad/s]."""
EXACT = math.radians(0.2)
"""How far from its goal it may come to rest [rad]."""
GONE = 0.3
"""The share of its way after which it is stopped."""
RUNS_ON = math.radians(2.0)
"""By how much it may go on after a stop [rad]."""
LOOKS = 0.02


async def motion_test(name: str, arm: Arm) -> Mapping[str, float]:
    """Turn the last joint out and back, and out again until a stop; return how far off it was [deg], how far it went on
    after the stop [deg] and for how long [s]. Raises PicoError."""
    start = (await arm.ready()).joints  # tells all limits, and reads them back
    there = (*start[:-1], start[-1] + (TURN if start[-1] < 0 else -TURN))
    off = max(await _turned(name, arm, there), await _turned(name, arm, start))
    gone, seconds = await _stopped(name, arm, there)
    await arm.ready()
    off = max(off, await _turned(name, arm, start))
    return {"off_deg": _deg(off), "stop_deg": _deg(gone), "stop_s": round(seconds, 3)}


async def _turned(name: str, arm: Arm, goal: tuple[float, ...]) -> float:
    """Bring the arm to a posture, and return how far from it a joint comes to rest [rad]."""
    state = await arm.follow(*_path((await arm.state()).joints, goal), doing="its motion test")
    off = max(abs(a - b) for a, b in zip(state.joints, goal, strict=True))
    if off > EXACT:
        raise PicoError(error("motion-test", f"{name} stopped {_deg(off)} deg from where it was sent to"))
    return off


async def _stopped(name: str, arm: Arm, goal: tuple[float, ...]) -> tuple[float, float]:
    """Stop the arm on its way; return how far its last joint went on [rad], and for how long [s]."""
    begun = (await arm.state()).joints
    going = asyncio.create_task(arm.follow(*_path(begun, goal), doing="its motion test"))
    here = begun
    while not going.done() and abs(here[-1] - begun[-1]) < GONE * TURN:
        await asyncio.sleep(LOOKS)
        here = (await arm.state()).joints
    at = time.monotonic()
    await arm.stop()
    seconds = time.monotonic() - at
    (ended,) = await asyncio.gather(going, return_exceptions=True)
    rest: ArmState = await arm.state()
    gone = abs(rest.joints[-1] - here[-1])
    if not isinstance(ended, PicoError) or rest.moving or gone > RUNS_ON:
        text = f"{name} went on by {_deg(gone)} deg after it was stopped"
        hint = "find out why, with a hand on the hard-wired stop"
        raise PicoError(error("motion-test", text, hint=hint, address=name))
    return gone, seconds


def _path(start: tuple[float, ...], goal: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (n,) [s] and joints (n, 7) [rad] of a way that begins and ends at rest."""
    seconds = max(1.0, math.pi / 2 * max(abs(a - b) for a, b in zip(start, goal, strict=True)) / SPEED)
    turn = np.linspace(0.0, math.pi, 101)
    share = (1 - np.cos(turn)) / 2
    begin, end = np.array(start), np.array(goal)
    return seconds * turn / math.pi, begin + share[:, None] * (end - begin)


def _deg(angle: float) -> float:
    return round(math.degrees(angle), 3)
