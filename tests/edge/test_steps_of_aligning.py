"""What a device is told during an optimization: one thing after the other, from the side of the axis, within bounds."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from bench_at import bench_at

from pico.backends.device import Began
from pico.backends.sim.device import SimDevice
from pico.backends.sim.faults import Faults, save_faults
from pico.edge.aligning import Aligning
from pico.manifest.load import load_folder
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.setpoint import set_seconds
from pico.model.setup import Setup
from pico.planning.optimizing import Turn, optimizing
from pico.planning.sought import Sought

LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: crossed}
table: {size: [1200, 900], beam_height: 70}
robots:
  arm1: {model: gantry, mount: {x: 480, y: 820}}
policy: {enclosed: true}
sim: {environment: none}
goals:
  null:
    tunables: {p2.angle: [10, 170]}
    minimize: pd.voltage
    budget: {measurements: 25, seconds: 900}
inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 220, yaw: 0}}
  p1: {type: linear_polarizer, marker: 1, pose: {x: 320, y: 220, yaw: 0}}
  p2: {type: linear_polarizer, marker: 2, pose: {x: 450, y: 220, yaw: 0}}
  pd: {type: photodiode, marker: 3, pose: {x: 620, y: 220, yaw: 0}}
"""
NONE = Faults()
ASKED = Reason(kind="asked")


class Told:
    """A device, and what it is told: each operation with its result."""

    def __init__(self, device: SimDevice) -> None:
        self.device, self.steps = device, list[tuple[Operation, OperationResult]]()
        self.at_once = 0

    def __getattr__(self, name: str) -> object:
        return getattr(self.device, name)

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        self.at_once += 1
        assert self.at_once == 1, "a measurement begins once what is set has settled"
        result = await self.device.execute(operation, key, began)
        self.at_once -= 1
        self.steps.append((operation, result))
        return result


@pytest.fixture
def crossed(tmp_path: Path) -> Setup:
    (tmp_path / "lab.yaml").write_text(LAB)
    (tmp_path / "state.yaml").write_text("apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: crossed}\n")
    return load_folder(tmp_path).require()[0]


def sought(setup: Setup, root: Path, algorithm: str, faults: Faults = NONE) -> tuple[Told, OperationResult]:
    """Seek the null of `p2` from 40 deg by an algorithm, with faults from then on."""

    async def do() -> tuple[Told, OperationResult]:
        told = Told(SimDevice(setup, bench_at(root), clock=lambda: "2026-11-01T12:00:00Z"))
        await told.device.take(1, lambda _: None)
        for number, (name, tunable, to) in enumerate(
            [("laser", "emission", True), ("laser", "shutter", "open"), ("p2", "angle", 40.0)]
        ):
            first = Operation(
                id=f"s{number}", primitive="set", component=name, arguments={"tunable": tunable, "to": to}, reason=ASKED
            )
            assert (await told.device.execute(first, f"r0/s{number}/1", lambda _: None)).outcome == "done"
        await told.device.leave()
        save_faults(bench_at(root), faults)
        await told.device.take(2, lambda _: None)
        goals = setup.lab.goals or {}
        (operation,) = optimizing(
            setup, await told.device.observe(), [Turn(Sought("null", goals["null"], algorithm))], None
        )
        doing = Aligning(setup, bench_at(root), told, lambda: "", lambda _: None)  # type: ignore[arg-type]
        result = await doing.execute(operation, "r1/op1/1", lambda _: None)
        await told.device.leave()
        return told, result

    return asyncio.run(do())


@pytest.mark.parametrize("algorithm", ["malus", "nelder_mead"])
def test_a_device_is_told_one_thing_after_the_other_from_the_side_of_the_axis(
    crossed: Setup, tmp_path: Path, algorithm: str
) -> None:
    told, result = sought(crossed, tmp_path, algorithm)
    kind = crossed.type_of("p2").tunables["angle"]
    assert result.outcome == "done" and kind.axis and kind.axis.approach == "positive" and kind.axis.backlash > 0
    here = 40.0
    for n, (operation, done) in enumerate(told.steps):
        if operation.primitive == "set":
            goal = float(operation.arguments["to"])
            assert 10 <= goal <= 170
            assert done.seconds == pytest.approx(set_seconds(kind, here, goal)), "no faster than the axis, then settled"
            measured_there = n + 1 < len(told.steps) and told.steps[n + 1][0].primitive == "measure"
            assert goal >= here or not measured_there, "what is measured was come to from below"
            here = goal


def test_an_axis_that_stops_is_driven_again_and_comes_from_its_side_then_too(crossed: Setup, tmp_path: Path) -> None:
    told, result = sought(crossed, tmp_path, "malus", Faults(rates={"jam": 0.15}, seed=3))
    sets = [(op, done) for op, done in told.steps if op.primitive == "set"]
    failed = [n for n, (_, done) in enumerate(sets) if done.outcome != "done"]
    assert failed and result.outcome == "done" and result.data["met"], result.data["why"]
    for n in failed:
        assert sets[n + 1][0].arguments["to"] <= sets[n][0].arguments["to"]


def test_an_axis_that_sticks_is_named_with_its_last_reading(crossed: Setup, tmp_path: Path) -> None:
    told, result = sought(crossed, tmp_path, "nelder_mead", Faults(rates={"stick": 0.2}, seed=2))
    done = [float(op.arguments["to"]) for op, d in told.steps if op.primitive == "set" and d.outcome == "done"]
    assert result.outcome == "failed" and result.error
    assert f"p2.angle does not go where it is sent; it last stood at {[40.0, *done][-1]:g} deg" in result.error.summary
    assert [d.outcome for op, d in told.steps if op.primitive == "set"][-3:] == ["failed"] * 3


def test_what_gets_lost_is_measured_again_where_it_stands(crossed: Setup, tmp_path: Path) -> None:
    told, result = sought(crossed, tmp_path, "malus", Faults(rates={"frame": 0.3}, seed=1))
    lost = [n for n, (_, done) in enumerate(told.steps) if done.error and done.error.code == "frame"]
    again = [told.steps[n + 1][0].primitive for n in lost if n - 1 not in lost]
    assert lost and result.data["met"] and set(again) == {"measure"}
