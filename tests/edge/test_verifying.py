"""A goal that is measured where its tunables stand: what a device is told, and what becomes of it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from pathlib import Path

import pytest
from bench_at import bench_at

from pico.backends.sim.device import SimDevice
from pico.backends.sim.faults import Faults, save_faults
from pico.edge.aligning import Aligning
from pico.execution.report import goal_read
from pico.manifest.load import load_folder
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.planning.optimizing import Turn, optimizing
from pico.planning.sought import Sought
from pico.planning.verifying import readable

LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: stopped}
table: {size: [1200, 900], beam_height: 70}
robots:
  arm1: {model: gantry, mount: {x: 480, y: 820}}
policy: {enclosed: true}
sim: {environment: none}
goals:
  bright:
    tunables: {p2.angle: [-90, 90]}
    looks: {stopped: {iris.opening: 2}}
    maximize: stopped.pd.voltage
inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 220, yaw: 0}}
  p1: {type: linear_polarizer, marker: 1, pose: {x: 320, y: 220, yaw: 0}}
  iris: {type: iris, marker: 4, pose: {x: 390, y: 220, yaw: 0}}
  p2: {type: linear_polarizer, marker: 2, pose: {x: 450, y: 220, yaw: 0}}
  pd: {type: photodiode, marker: 3, pose: {x: 620, y: 220, yaw: 0}}
"""
ASKED = Reason(kind="asked")
Steps = list[tuple[Operation, OperationResult]]


@pytest.fixture
def bench(tmp_path: Path) -> Setup:
    (tmp_path / "lab.yaml").write_text(LAB)
    (tmp_path / "state.yaml").write_text("apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: stopped}\n")
    return load_folder(tmp_path).require()[0]


def verified(
    setup: Setup,
    root: Path,
    *,
    was: Mapping[str, float] | None = None,
    turned: float = 0.0,
    faults: Faults | None = None,
) -> tuple[Steps, OperationResult, Operation]:
    """Measure the goal with p2 turned to an angle; return what the device was told, and what became of it."""

    async def do() -> tuple[Steps, OperationResult, Operation]:
        device, steps = SimDevice(setup, bench_at(root), clock=lambda: "2026-11-01T12:00:00Z"), Steps()
        await device.take(1, lambda _: None)
        begin = (("laser", "emission", True), ("laser", "shutter", "open"), ("p2", "angle", turned))
        for number, (name, tunable, to) in enumerate((*begin, ("iris", "opening", 8.0))):
            arguments = {"tunable": tunable, "to": to}
            first = Operation(id=f"s{number}", primitive="set", component=name, arguments=arguments, reason=ASKED)
            assert (await device.execute(first, f"r0/s{number}/1", lambda _: None)).outcome == "done"
        await device.leave()
        save_faults(bench_at(root), faults or Faults())
        await device.take(2, lambda _: None)

        class Told:
            def __getattr__(self, name: str) -> object:
                return getattr(device, name)

            async def execute(self, operation: Operation, key: str, began: object) -> OperationResult:
                result = await device.execute(operation, key, began)  # type: ignore[arg-type]
                steps.append((operation, result))
                return result

        goal = (setup.lab.goals or {})["bright"]
        turn = Turn(Sought("bright", goal, ""), verify=True, was=was)
        (operation,) = optimizing(setup, await device.observe(), [turn], None)
        doing = Aligning(setup, root, Told(), lambda: "", lambda _: None)  # type: ignore[arg-type]
        result = await doing.execute(operation, "r1/op1/1", lambda _: None)
        await device.leave()
        return steps, result, operation

    return asyncio.run(do())


def test_what_it_looks_through_is_set_and_set_back_and_nothing_is_sought(bench: Setup, tmp_path: Path) -> None:
    steps, result, operation = verified(bench, tmp_path)
    told = [(op.primitive, op.component, op.arguments.get("to")) for op, _ in steps]
    assert told == [("set", "iris", 2), ("measure", "pd", None), ("set", "iris", 8.0)]
    assert result.outcome == "done" and "met" not in result.data and "how it was" in result.data["doubt"]
    last = result.data["last"]
    assert last["iris.opening"] == 8.0 and last["p2.angle"] == 0.0 and last["objective"] > 0
    assert operation.primitive == "verify" and not operation.kind.mutating and operation.resources[0] == "iris.opening"
    read = goal_read(operation.arguments, result.data)
    assert read.met is None and read.word == "not assured" and read.numbers[0].address == "stopped.pd.voltage"


def test_it_is_compared_with_what_it_was(bench: Setup, tmp_path: Path) -> None:
    was = verified(bench, tmp_path)[1].data["last"]
    steps, same, operation = verified(bench, tmp_path, was=was)
    assert same.data["met"] is True and goal_read(operation.arguments, same.data).numbers[0].was == was["objective"]
    less = verified(bench, tmp_path, was=was, turned=30.0)[1].data
    assert less["met"] is False and less["why"].startswith("it is ") and less["last"]["p2.angle"] == 30.0
    assert not [op for op, _ in steps if op.component == "p2"]


def test_a_reading_that_gets_lost_each_time_tells_nothing_and_all_is_set_back(bench: Setup, tmp_path: Path) -> None:
    was = {"objective": 1.0, "objective_sigma": 0.1}
    steps, result, _ = verified(bench, tmp_path, was=was, faults=Faults(rates={"frame": 1.0}))
    assert result.outcome == "done" and "met" not in result.data and result.data["doubt"]
    assert [op.primitive for op, _ in steps] == ["set", "measure", "measure", "measure", "set"]
    assert steps[-1][0].arguments["to"] == 8.0


def test_what_nobody_could_set_back_or_measure_is_not_measured(bench: Setup, tmp_path: Path) -> None:
    async def seen() -> object:
        device = SimDevice(bench, bench_at(tmp_path), clock=lambda: "2026-11-01T12:00:00Z")
        await device.take(1, lambda _: None)
        found = await device.observe()
        await device.leave()
        return found

    here = asyncio.run(seen())
    goals, state = bench.lab.goals or {}, load_folder(tmp_path).require()[1]
    turns, told = readable(bench, here, state, goals, {}, frozenset({"pd.voltage"}))  # type: ignore[arg-type]
    assert not turns and told[0].met is None and "is" in told[0].why, "the laser is off to begin with"
    assert not readable(bench, here, state, goals, {}, frozenset())[0]  # type: ignore[arg-type]
    assert "can't measure pd.voltage" in readable(bench, here, state, goals, {}, frozenset())[1][0].why  # type: ignore[arg-type]
    assert as_json(told[0])["goal"] == "bright"
