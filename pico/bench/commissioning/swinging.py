"""Steps in which arms move with an empty hand: the first time, slowly, and to be stopped on the way."""

from __future__ import annotations

import asyncio
import math
import signal
from collections.abc import Coroutine
from contextlib import suppress
from dataclasses import replace
from typing import Any, TypeVar

from pico.backends import checks, ways
from pico.backends.attempt import Failed
from pico.backends.hardware.walking import FIRST_SPEED, speed_of
from pico.bench.commissioning.standing import NO_ARM, AtBench, Found
from pico.bench.running.attending import listen
from pico.diagnostics import PicoError, error
from pico.model.commissioning import CODE, NEAR
from pico.model.observation import Observation
from pico.motion.deferred import DeferredMotion
from pico.motion.kinematics import tool_pose
from pico.motion.types import Blocked, MovePath

TURNS = (60.0, -60.0, 30.0, -30.0, 15.0, -15.0)
"""By how much an arm may turn about its base, the first that is free [deg]."""
GONE = 0.2
"""Which share of its way a tool has gone when it is stopped."""
TRIES = 3
T = TypeVar("T")
LOOKS = 0.005
"""Seconds of wall time between two questions where an arm is."""


def first_move(at: AtBench) -> Found:
    """Each arm parks, turns about its base and comes back, slowly. Raises PicoError."""
    if not _arms(at):
        return NO_ARM
    found = {}
    for robot in _arms(at):
        speed = FIRST_SPEED if robot in at.bench.wait(at.device.untried()) else NEAR
        _parked(at, robot, speed)
        out = _way(at, robot)
        at.require_hand_on_stop(f"{robot} turns about its base, its tool at {speed:g} mm/s at most")
        seconds = attended(at, _walked(at, robot, out, speed))
        _parked(at, robot, speed)
        found[robot] = {"speed_mm_s": round(min(speed, speed_of(at.edge.setup, out)), 1), "seconds": round(seconds, 2)}
    told = ", ".join(f"{robot} at {one['speed_mm_s']:g} mm/s" for robot, one in found.items())
    return Found(told=f"turned and parked again: {told}", data={"arms": found})


def stop_distance(at: AtBench) -> Found:
    """Each arm is stopped on its way, as `pico stop --now` does, and how far its tool goes on is measured; a person
    tries the hard-wired stop besides. Raises PicoError."""
    if not _arms(at):
        return NO_ARM
    found = {}
    for robot in _arms(at):
        speed = FIRST_SPEED if robot in at.bench.wait(at.device.untried()) else NEAR
        for left in reversed(range(TRIES)):
            _parked(at, robot, speed)
            out = _way(at, robot)
            at.require_hand_on_stop(f"{robot} turns at {speed:g} mm/s at most, and is stopped on its way")
            stopped = attended(at, _stopped(at, robot, out, speed))
            _parked(at, robot, speed)
            if stopped is not None:
                found[robot] = {**stopped, "speed_mm_s": round(min(speed, speed_of(at.edge.setup, out)), 1)}
                break
            if not left:
                raise PicoError(error(CODE, f"{robot} came to its end before it was stopped", address=robot))
    told = ", ".join(f"{r} within {one['mm']:.0f} mm, {one['seconds']:.2f} s" for r, one in found.items())
    hand = "not tried: this bench is emulated"
    if at.device.bench == "hardware":
        at.asks.say("Press the hard-wired stop now, look whether arms and lasers are without power, then release it.")
        at.require("Were they?", by_person=True)
        hand = "tried by hand"
    return Found(told=f"{told}; the hard-wired stop: {hand}", data={"arms": found, "hard_wired": hand})


def attended(at: AtBench, work: Coroutine[Any, Any, T]) -> T:
    """Return what comes of a motion; a signal stops the arm, and does what it would have done once that stands."""
    came: list[int] = []

    def heard(number: int, _: object) -> None:
        came.append(number)
        if len(came) == 1:
            at.bench.thread.submit(at.edge.stop())

    before = listen(heard)
    try:
        return at.bench.wait(work)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            signal.raise_signal(came[0])


def _arms(at: AtBench) -> list[str]:
    return [name for name, arm in sorted(at.edge.setup.lab.robots.items()) if arm.model == "xarm7"]


def _seen(at: AtBench, robot: str) -> Observation:
    seen = at.bench.observe()
    try:
        checks.require_empty(seen, robot)
    except Failed as exc:
        raise PicoError(exc.diagnostic) from exc
    return seen


def _parked(at: AtBench, robot: str, speed: float) -> None:
    """Bring an arm to its park pose where it is not there; raises PicoError where it has no way."""
    seen = _seen(at, robot)
    if at.edge.setup.lab.robots[robot].is_parked(seen.robots[robot].joints):
        return
    found = ways.parking(at.edge.setup, DeferredMotion(at.edge.setup), seen, robot)
    if isinstance(found, Blocked):
        raise PicoError(checks.blocked(robot, found).diagnostic)
    at.require_hand_on_stop(f"{robot} goes to its park pose, its tool at {speed:g} mm/s at most")
    attended(at, _walked(at, robot, found, speed))


def _way(at: AtBench, robot: str) -> MovePath:
    """Return the way of a parked arm to where it is turned about its base: the way back from there, backwards. Raises
    PicoError where nothing is free."""
    setup, seen, motion = at.edge.setup, _seen(at, robot), DeferredMotion(at.edge.setup)
    first, *rest = setup.lab.robots[robot].park_joints
    said = ""
    for turn in TURNS:
        there = (first + math.radians(turn), *rest)
        turned = replace(seen.robots[robot], joints=there)
        found = ways.parking(setup, motion, replace(seen, robots={**seen.robots, robot: turned}), robot)
        if not isinstance(found, Blocked):
            return ways.backwards(found, seen.robots[robot].joints)
        said = found.text
    raise PicoError(error(CODE, f"{robot} can't turn about its base: {said}", hint="clear the table", address=robot))


async def _walked(at: AtBench, robot: str, path: MovePath, speed: float) -> float:
    """Have an arm go along a path, and return how long that took [s]; raises PicoError."""
    lease = await at.edge.acquire("pico commission")
    try:
        began = at.device.links.now()
        await at.device.walk(path, speed)
        return at.device.links.now() - began
    except Failed as exc:
        raise PicoError(exc.diagnostic) from exc
    finally:
        await at.edge.release(lease)


async def _stopped(at: AtBench, robot: str, path: MovePath, speed: float) -> dict[str, float] | None:
    """Stop an arm on its way, and return how far its tool went on from where it last was before [mm], and how long it
    took until it was at rest [s]; None where it was at its end before."""
    arm = (await at.device.links.instruments()).arms[robot]
    built = at.edge.setup.lab.robots[robot]
    start, end = (tool_pose(built, q)[:3] for q in (path.segments[0].joints[0], path.end))
    lease = await at.edge.acquire("pico commission")
    try:
        going = asyncio.create_task(at.device.walk(path, speed))
        here = start
        while not going.done() and math.dist(start, here) < GONE * math.dist(start, end):
            await asyncio.sleep(LOOKS)
            here = tool_pose(built, (await arm.state()).joints)[:3]
        began = at.device.links.now()
        if not going.done():
            await at.edge.stop()
        seconds = at.device.links.now() - began
        failure: Failed | None = None
        with suppress(PicoError):
            try:
                await going
                return None
            except Failed as exc:
                failure = exc
        if failure is not None and failure.diagnostic.code != checks.STOPPED.code:
            raise PicoError(failure.diagnostic)
        rest = tool_pose(built, (await arm.state()).joints)[:3]
        return {"mm": round(math.dist(here, rest), 2), "seconds": round(seconds, 3)}
    finally:
        await at.edge.release(lease)
