"""A gantry of stages with a vacuum cup, through the hardware path on emulators at the wire."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.drivers.registry import Buses
from pico.drivers.zaber_gantry import AXES
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.manifest.load import load_folder
from pico.model.wiring import DeviceEntry

pytestmark = pytest.mark.skipif(not find_spec("zaber_motion"), reason="the extra zaber")
ROOT = Path(__file__).resolve().parents[3]
ARM = {
    "driver": "zaber.gantry", "address": {"host": "192.0.2.30", "port": 55550}, "identity": {"serial": "52001"},
    "settings": {"counts_per_mm": 2000, "counts_per_deg": 1000},
}  # fmt: skip
CUP = {"driver": "switches.gripper", "of": "arm1", "address": {"host": "192.0.2.20", "port": 4000, "name": "cup"}}
LIGHT = {
    f"laser_{name}": {
        "driver": f"switches.{kind}", "of": "laser", "address": {"host": "192.0.2.20", "port": 4000, "name": name}
    }
    for name, kind in (("shutter", "shutter"), ("head", "laser"))
}  # fmt: skip
SIGHT = {
    name: {"driver": "frames.camera", "address": {"host": "192.0.2.10", "port": 5000 + n}}
    for n, name in enumerate(("left", "right", "camera"))
}


def made_lab(folder: Path, **devices: Any) -> Path:
    """Write the lab `minimal` with a gantry, and its devices."""
    lab = yaml.safe_load((ROOT / "labs" / "minimal" / "lab.yaml").read_text())
    cup = {"fingers": "none"}
    lab["robots"] = {"arm1": {"model": "gantry", "mount": {"x": 100, "y": 800}, "transit_height": 300, "gripper": cup}}
    lab["cameras"] = {name: {**lab["cameras"][name], "pixels": [1224, 1024]} for name in ("left", "right")}
    (folder / "state").mkdir(parents=True)
    (folder / "lab.yaml").write_text(yaml.safe_dump(lab))
    (folder / "state" / "table.yaml").write_bytes((ROOT / "labs/minimal/state/table.yaml").read_bytes())
    head = {"apiVersion": "pico/v1", "kind": "Devices", "metadata": {"lab": "minimal"}}
    whole = {"arm1": ARM, "arm1_hand": CUP, **SIGHT, **LIGHT} | devices
    (folder / "devices.yaml").write_text(yaml.safe_dump({**head, "devices": whole}))
    return folder


def test_a_part_is_moved_grasped_and_placed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PICO_EMULATED_PACE", "20")
    with Bench.open(made_lab(tmp_path / "lab"), backend="emulated") as bench:
        plan = bench.single("lens", "move", x=660, y=420, yaw=15)
        report = bench.apply(plan)
        assert report.outcome == "done", report
        seen = bench.observe()
        lens, arm = seen.components["lens"], seen.robots["arm1"]
        assert lens.pose is not None and lens.pose.distance(type(lens.pose)(660, 420, 15)) < 0.1
        assert lens.pose.yaw == pytest.approx(15, abs=0.2)
        assert arm.holding is None and bench.setup.lab.robots["arm1"].is_parked(arm.joints)


def test_a_cup_that_holds_nothing_has_missed_the_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PICO_EMULATED_PACE", "20")
    monkeypatch.setattr("pico.backends.emulated.world.BETWEEN", -1.0)
    with Bench.open(made_lab(tmp_path / "lab"), backend="emulated") as bench:
        events = list(bench.run(bench.single("lens", "move", x=660, y=420)))
        assert "arm1 missed lens: its hand holds nothing" in str([event.data for event in events])
        assert bench.observe().robots["arm1"].holding is None


@pytest.mark.parametrize(
    ("name", "driver", "hint"),
    [("arm1", "xarm.arm", "zaber.gantry"), ("arm1_hand", "xarm.gripper", "switches.gripper")],
)
def test_a_driver_for_another_robot_is_told_with_those_that_fit(
    tmp_path: Path, name: str, driver: str, hint: str
) -> None:
    entry = {"driver": driver, "of": "arm1", "address": {"host": "192.0.2.222"}}
    found = load_folder(made_lab(tmp_path / "lab", **{name: entry}))
    (one,) = [d for d in found.diagnostics if "is for the model" in d.summary]
    assert one.summary == f"arm1 is of the model `gantry`, and `{driver}` is for the model `xarm7`"
    assert hint in one.hint and one.source is not None and one.source.snippet.strip() == f"driver: {driver}"


class Rig:
    """The driver alone, with nothing behind its stages; `way` is where they were, whenever one of them was asked."""

    def __init__(self, pace: float = 1.0, **at: float) -> None:
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
        entry = DeviceEntry(**{**ARM, "emulator": "zaber"})  # type: ignore[arg-type]
        self.bench = EmulatedBench({"arm1": entry}, lambda name, one: self.behind)
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
            found = await rig.arm.follow(*line((0, 0, 0.3, 0), (0.2, 0.1, 0.25, math.radians(30)), 0.5))
            assert found.joints == pytest.approx((0.2, 0.1, 0.25, math.radians(30)), abs=1e-3)
            await rig.arm.close()

        asyncio.run(go())
        middle = [at for at in rig.way if 60 < at[0] < 140]
        assert middle
        for x, y, z, yaw in middle:  # each stage is asked at a time of its own
            assert (y * 2, (300 - z) * 4, yaw * 20 / 3) == pytest.approx((x, x, x), abs=35)


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
            assert rig.at() == rest and 100 < rest[0] < 900 and rest[1] == pytest.approx(rest[0] / 2, abs=30)
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
