"""On the simulated bench no arm comes where another one works, whatever the plan let run at once."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from benches import sim

from pico.manifest.load import load_folder
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose
from pico.model.record import as_json

LAB = Path(__file__).resolve().parents[2] / "labs" / "two_arms"
SETUP, _ = load_folder(LAB).require()
ZONE = "zone/arm1+arm2"
MIDDLE, LEFT, RIGHT = Pose(1000, 450), Pose(500, 450), Pose(1180, 450)


def move(id: str, robot: str, name: str, goal: Pose, *zones: str) -> Operation:
    home = SETUP.lab.slots[SETUP.lab.inventory[name].home or ""].pose
    places = {"from": {"pose": as_json(home)}, "to": {"pose": as_json(goal)}}
    return Operation(
        id=id, primitive="move", component=name, robot=robot, arguments=places, reason=Reason(kind="asked"),
        resources=(robot, name, *zones),
    )  # fmt: skip


def at_once(folder: Path, *operations: Operation) -> list[OperationResult]:
    bench = sim(SETUP, folder)

    async def go() -> list[OperationResult]:
        lease = await bench.acquire("test")
        try:
            return await asyncio.gather(*(bench.execute(o, f"r1/{o.id}/1", lease) for o in operations))
        finally:
            await bench.release(lease)

    return asyncio.run(go())


@pytest.mark.parametrize(
    ("first", "second", "outcome"),
    [
        (move("a", "arm1", "p1", MIDDLE), move("b", "arm2", "iris_out", RIGHT), "failed"),  # both come into the zone
        (move("a", "arm1", "p1", LEFT, ZONE), move("b", "arm2", "iris_out", RIGHT), "failed"),  # one only holds it
        (move("a", "arm1", "p1", LEFT), move("b", "arm2", "iris_out", RIGHT), "done"),
    ],
)
def test_an_arm_does_not_come_where_another_one_works(
    tmp_path: Path, first: Operation, second: Operation, outcome: str
) -> None:
    one, two = at_once(tmp_path, first, second)
    assert (one.outcome, two.outcome) == ("done", outcome)
    if outcome == "failed":
        assert two.error is not None and two.error.code == "blocked"
        assert ZONE in two.error.summary and "arm1" in two.error.summary
