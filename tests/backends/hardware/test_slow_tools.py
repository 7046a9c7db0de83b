"""How fast tools move where a person may be near, and an arm that a person tries out."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from emulated_lab import wired_lab
from test_hardware_session import Bench, Curtain, executed, move, session

from pico.backends.attempt import Failed
from pico.backends.hardware.session import HardwareSession
from pico.backends.hardware.walking import speed_of
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.types import Joints, MovePath


@pytest.fixture
def setup(tmp_path: Path) -> Setup:
    return wired_lab(tmp_path)


class Timed(Bench):
    """A bench that keeps how long each leg was told to take."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.took: list[float] = []

    async def follow(self, times: object, joints: object, *, doing: str = "") -> object:  # type: ignore[override]
        found = await super().follow(times, joints, doing=doing)  # type: ignore[arg-type]
        self.took.append(self.seconds)
        return found


def took(setup: Setup, most: float | None, untried: frozenset[str] = frozenset()) -> list[float]:
    bench = Timed(setup)
    one = session(bench, untried=untried)
    one._most = most
    assert executed(one, move()).outcome == "done"
    return bench.took


def test_until_a_stop_was_tried_each_leg_takes_so_much_longer(setup: Setup) -> None:
    usual = took(setup, None)
    fastest = setup.lab.robots["arm1"].fastest
    assert took(setup, 250.0) == pytest.approx([seconds * fastest / 250 for seconds in usual])
    assert took(setup, 250.0, frozenset(["arm1"])) == pytest.approx([seconds * fastest / 50 for seconds in usual])


def turned(setup: Setup) -> tuple[Joints, MovePath]:
    """A way from where an arm is turned about its base to where it parks."""
    first, *rest = setup.lab.robots["arm1"].park_joints
    there = (first + math.radians(60), *rest)
    path = ArmMotion(setup).park("arm1", there, {})
    assert isinstance(path, MovePath)
    return there, path


def walked(setup: Setup, speed: float, curtain: Callable[[Bench], Curtain] | None = None) -> Timed:
    bench, (there, path) = Timed(setup), turned(setup)
    bench.joints = there
    one = session(bench, curtain=curtain(bench) if curtain else None)
    asyncio.run(one.walk(path, speed))
    return bench


def test_an_arm_that_is_tried_out_goes_no_faster_than_asked(setup: Setup) -> None:
    _, path = turned(setup)
    fastest = speed_of(setup, path)
    assert fastest > 250
    for speed in (250.0, 50.0):
        assert sum(walked(setup, speed).took) == pytest.approx(
            path.segments[0].moving.seconds * fastest / speed, rel=0.2
        )
    assert sum(walked(setup, 1000.0).took) == pytest.approx(sum(walked(setup, fastest).took)), "nor faster than planned"


def test_it_does_not_go_where_a_curtain_is_not_safe(setup: Setup) -> None:
    with pytest.raises(Failed) as raised:
        walked(setup, 250.0, lambda bench: Curtain(bench, safe=False))
    assert raised.value.diagnostic.code == "unsafe"


def test_it_is_told_as_stopped_where_somebody_stopped_it_and_stands_where_nobody_waits_any_more(setup: Setup) -> None:
    bench, (there, path) = Timed(setup), turned(setup)
    bench.joints, bench.slow = there, True

    async def on_its_way(one: HardwareSession) -> asyncio.Task[None]:
        going = asyncio.create_task(one.walk(path, 250.0))
        await bench.under_way.wait()
        return going

    async def stopped() -> None:
        one = session(bench)
        going = await on_its_way(one)
        await one.stop()
        with pytest.raises(Failed) as raised:
            await going
        assert raised.value.diagnostic.code == "stopped"
        with pytest.raises(Failed):
            await one.walk(path, 250.0)

    async def cancelled() -> None:
        bench.stopped, bench.under_way = False, asyncio.Event()
        going = await on_its_way(session(bench))
        going.cancel()
        with pytest.raises(asyncio.CancelledError):
            await going

    asyncio.run(stopped())
    asyncio.run(cancelled())
    assert bench.stopped and bench.legs == 2
