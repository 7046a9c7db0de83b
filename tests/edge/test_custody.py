"""What an edge does with operations and runs whose client goes away or changes its mind at an awkward moment."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from benches import NOON, changed, plan_to, shel

from pico.backends.sim.device import SimDevice
from pico.edge.local import LocalEdge
from pico.edge.protocol import Job
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Reason

TURN = Operation(id="op1", primitive="set", component="p1", arguments={"tunable": "angle", "to": 20.0},
                 reason=Reason(kind="asked"))  # fmt: skip


class Device(SimDevice):
    """A simulated table whose operations wait until they may go on, and that does something while it is looked at."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.asked, self.begun, self.may = list[str](), asyncio.Event(), asyncio.Event()
        self.meanwhile: Callable[[], Awaitable[None]] | None = None

    async def execute(self, operation: Operation, key: str, began: Any) -> OperationResult:
        self.asked.append(key)
        self.begun.set()
        await self.may.wait()
        return await super().execute(operation, key, began)

    async def observe(self) -> Observation:
        seen = await super().observe()
        if self.meanwhile is not None:
            await self.meanwhile()
        return seen


def edge_of(root: Path) -> tuple[LocalEdge, Device]:
    place, options = bench_at(root), {"fidelity": "kinematic", "clock": lambda: NOON}
    edge = LocalEdge(shel("gantry")[0], place, lambda setup: Device(setup, place, **options))
    assert isinstance(edge.device, Device)
    return edge, edge.device


def test_who_stops_waiting_for_an_operation_leaves_it_going_on_and_hears_of_its_end_later(tmp_path: Path) -> None:
    async def go() -> None:
        edge, device = edge_of(tmp_path)
        lease = await edge.acquire("test")
        waiting = asyncio.create_task(edge.execute(TURN, "r1/op1/1", lease))
        await device.begun.wait()
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting
        assert edge.moving(), "it goes on"
        device.may.set()
        for _ in range(2):  # while it is under way, and out of the journal
            assert (await edge.execute(TURN, "r1/op1/1", lease)).outcome == "done"
        assert device.asked == ["r1/op1/1"]
        assert (await edge.observe()).components["p1"].values["angle"].value == 20.0
        await edge.close()

    asyncio.run(asyncio.wait_for(go(), 30))


@pytest.mark.parametrize("cancelled", [True, False])
def test_a_run_that_is_canceled_while_it_is_judged_moves_nothing(tmp_path: Path, cancelled: bool) -> None:
    async def go() -> None:
        edge, device = edge_of(tmp_path)
        device.may.set()
        plan = await plan_to(edge, changed(shel("gantry")[1], {"p1": {"values": {"angle": 20.0}}}))
        assert plan.operations

        async def cancel() -> None:
            device.meanwhile = None
            await edge.cancel("r1")

        device.meanwhile = cancel if cancelled else None
        await edge.start(Job(plan=plan, holder="test"), "r1")
        report = await edge.report("r1")
        assert report.outcome == ("interrupted" if cancelled else "done") and bool(device.asked) is not cancelled
        assert await edge.holder() is None, "it gave the bench back"
        await edge.close()

    asyncio.run(asyncio.wait_for(go(), 30))
