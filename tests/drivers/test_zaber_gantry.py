"""A gantry of Zaber stages, driven over the wire with nothing behind its stages."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

from pico.diagnostics import PicoError
from pico.drivers.registry import Buses
from pico.drivers.zaber_gantry import AXES
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.model.wiring import DeviceEntry

pytestmark = pytest.mark.skipif(not find_spec("zaber_motion"), reason="the extra zaber")
ENTRY = DeviceEntry(
    driver="zaber.gantry", emulator="zaber", address={"host": "192.0.2.30", "port": 55550},
    identity={"serial": "52001"}, settings={"counts_per_mm": 2000, "counts_per_deg": 1000},
)  # fmt: skip


class Rig:
    """The driver alone, with nothing behind its stages; `way` is where they were, whenever one of them was asked."""

    def __init__(self, **at: float) -> None:
        self.way: list[tuple[float, ...]] = []
        self.behind = Alone(
            {f"{axis} homed": True for axis in AXES}
            | {f"{axis} travel": (-1000.0, 2000.0) for axis in AXES}
            | {f"{axis} position": at.get(axis, 0.0) for axis in AXES}
        )
        write = self.behind.write

        def written(what: str, value: Any) -> None:
            write(what, value)
            self.way.append(self.at())

        self.behind.write = written  # type: ignore[method-assign]
        self.bench = EmulatedBench({"arm1": ENTRY}, lambda name, one: self.behind)
        self.arm: Any = Buses().opened("arm1", self.bench.entries["arm1"])

    def at(self) -> tuple[float, ...]:
        return tuple(float(self.behind.read(f"{axis} position")) for axis in AXES)


@contextmanager
def rigged(**at: float) -> Iterator[Rig]:
    rig = Rig(**at)
    try:
        yield rig
    finally:
        rig.bench.close()


def line(start: tuple[float, ...], end: tuple[float, ...], seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """A straight way that speeds up and slows down [s; m, rad]."""
    share = np.linspace(0.0, 1.0, 40)
    ease = np.clip(np.where(share < 0.5, 2 * share**2, 1 - 2 * (1 - share) ** 2), 0, 1)
    return seconds * share, np.array(start) + ease[:, None] * (np.array(end) - np.array(start))


def test_all_stages_go_straight_to_the_end_of_a_leg_together() -> None:
    with rigged(z=300.0) as rig:

        async def go() -> None:
            await rig.arm.connect()
            found = await rig.arm.follow(*line((0, 0, 0.3, 0), (0.2, 0.1, 0.25, math.radians(30)), 1.5))
            assert found.joints == pytest.approx((0.2, 0.1, 0.25, math.radians(30)), abs=1e-3)
            await rig.arm.close()

        asyncio.run(go())
        middle = [at for at in rig.way if 60 < at[0] < 140]
        assert middle
        for x, y, z, yaw in middle:  # each stage is asked at a time of its own
            assert (y * 2, (300 - z) * 4, yaw * 20 / 3) == pytest.approx((x, x, x), abs=40)


ENDED = {"stop": "stopped", "halt": "halted"}


@pytest.mark.parametrize("how", ENDED)
def test_a_stop_brings_all_stages_to_rest_on_the_way(how: str) -> None:
    with rigged() as rig:

        async def go() -> None:
            await rig.arm.connect()
            moving = asyncio.create_task(rig.arm.follow(*line((0, 0, 0, 0), (1.0, 0.5, 0, 0), 4.0), doing="op3"))
            while rig.at()[0] < 100:
                await asyncio.sleep(0.01)
            assert (await rig.arm.state()).moving
            await getattr(rig.arm, how)()
            with pytest.raises(PicoError, match=f"arm1 was {ENDED[how]} on its way during op3"):
                await moving
            rest = rig.at()
            await asyncio.sleep(0.2)
            assert (await rig.arm.state()).moving is False
            assert rig.at() == rest and 100 < rest[0] < 900 and rest[1] == pytest.approx(rest[0] / 2, abs=90)
            await rig.arm.close()

        asyncio.run(go())


def test_a_stage_that_is_stuck_stops_the_others() -> None:
    with rigged() as rig:
        rig.behind.write("y stuck", 20.0)

        async def go() -> None:
            await rig.arm.connect()
            with pytest.raises(PicoError, match=r"arm1 \(y\) reports: it is stalled"):
                await rig.arm.follow(*line((0, 0, 0, 0), (1.0, 0.1, 0, 0), 2.0))
            rest = rig.at()
            await asyncio.sleep(0.1)
            await rig.arm.state()
            assert rig.at() == rest and rest[0] < 900
            await rig.arm.close()

        asyncio.run(go())


def test_one_that_does_not_know_where_it_is_or_is_elsewhere_does_not_move() -> None:
    with rigged() as rig:

        async def go() -> None:
            await rig.arm.connect()
            with pytest.raises(PicoError, match="does not stand where its path begins: x is 100"):
                await rig.arm.follow(*line((0.1, 0, 0, 0), (0.2, 0, 0, 0), 1.0))
            for stage in rig.bench._running:
                stage.reboot()  # type: ignore[attr-defined]
            with pytest.raises(PicoError, match="x, y, z, yaw was not homed"):
                await rig.arm.ready()
            await rig.arm.close()

        asyncio.run(go())
        assert rig.at() == (0, 0, 0, 0)


def test_its_motion_test_turns_the_hand_and_stops_it() -> None:
    with rigged() as rig:

        async def go() -> None:
            await rig.arm.connect()
            found = await rig.arm.motion_test()
            assert found["off_deg"] < 0.2 and found["stop_deg"] < 2.0
            await rig.arm.close()

        asyncio.run(go())
