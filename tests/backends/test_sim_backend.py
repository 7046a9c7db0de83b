"""The simulated bench behind the protocol of every backend."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from benches import shel, sim
from tables import change_world, reset_world

from pico.backends.devices import opener
from pico.backends.sim.hand import nudge
from pico.backends.sim.store import load_world, world_path
from pico.backends.sim.world import new_world
from pico.diagnostics import ExitCode, PicoError
from pico.edge.contract import Edge
from pico.edge.local import LocalEdge
from pico.edge.protocol import Lease
from pico.model.lab import Policy
from pico.model.observation import ObservedValue, UnknownObject
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.trace.event import Event

SETUP, _ = shel("gantry")
SETUP = replace(SETUP, lab=replace(SETUP.lab, policy=Policy(open_beam=True)))  # no plan closes the shutter here
ASKED = Reason(kind="asked")


def move(name: str, start: Pose, goal: Pose, id: str = "op1", **more: Any) -> Operation:
    arguments = {"from": {"pose": as_json(start)}, "to": {"pose": as_json(goal)}, "grasp_yaw": 90.0}
    return Operation(id=id, primitive="move", component=name, robot="arm1", arguments=arguments | more, reason=ASKED)


def setting(name: str, tunable: str, value: Any, id: str = "op2", primitive: Any = "set") -> Operation:
    arguments = {"tunable": tunable, "to": value}
    return Operation(id=id, primitive=primitive, component=name, arguments=arguments, reason=ASKED)


def during(bench: LocalEdge, act: Callable[[Lease], Awaitable[Any]]) -> Any:
    async def go() -> Any:
        lease = await bench.acquire("test")
        try:
            return await asyncio.wait_for(act(lease), 20)  # instead of a test that hangs
        finally:
            await bench.release(lease)

    return asyncio.run(go())


def listening(bench: LocalEdge) -> asyncio.Queue[Event]:
    """Return where the events of the device come from now on."""
    queue: asyncio.Queue[Event] = asyncio.Queue()
    bench.runs.hear = queue.put_nowait  # type: ignore[method-assign]
    return queue


def executed(bench: LocalEdge, operation: Operation, key: str = "r1/op1/1") -> OperationResult:
    result: OperationResult = during(bench, lambda lease: bench.execute(operation, key, lease))
    return result


@pytest.fixture
def bench(tmp_path: Path) -> LocalEdge:
    return sim(SETUP, tmp_path)


P1, GOAL = Pose(110, 220, 0), Pose(320, 420, 30)


def test_a_move_ends_exactly_at_its_goal_takes_its_time_and_is_stored(bench: LocalEdge) -> None:
    edge: Edge = bench  # it is one, says mypy
    result = executed(bench, move("p1", P1, GOAL))
    assert (result.outcome, result.error) == ("done", None)
    assert result.before is not None
    assert result.after is not None
    assert (result.before.pose, result.after.pose) == (P1, GOAL)
    seen = asyncio.run(edge.observe())
    assert seen.components["p1"].pose == GOAL
    assert seen.time == result.ended == pytest.approx(result.seconds)
    assert seen.time > 3
    assert seen.observed_at == "2026-11-01T12:00:00Z"
    assert [r.kind for r in bench.journal.records(key="r1/op1/1")] == ["intent", "started", "done"]


def test_a_known_key_returns_its_result_and_moves_nothing(bench: LocalEdge) -> None:
    operation = move("p1", P1, GOAL)
    first = executed(bench, operation)
    change_world(SETUP, bench.place.root, "test", lambda w: nudge(SETUP, w, "p1", dx=3))
    assert executed(bench, operation) == first
    assert asyncio.run(bench.observe()).components["p1"].pose == Pose(323, 420, 30)
    with pytest.raises(PicoError, match="other content"):
        executed(bench, replace(operation, component="p2"))


def test_a_key_that_comes_twice_at_once_moves_once(bench: LocalEdge) -> None:
    async def twice(lease: Lease) -> list[OperationResult]:
        both = [bench.execute(move("p1", P1, GOAL), "r1/op1/1", lease) for _ in range(2)]
        return list(await asyncio.gather(*both))

    first, second = during(bench, twice)
    assert first == second
    assert len(bench.journal.records()) == 3


def test_only_the_holder_of_the_current_lease_moves_anything(bench: LocalEdge) -> None:
    old = during(bench, lambda lease: asyncio.sleep(0, lease))

    async def late(lease: Lease) -> None:
        await bench.execute(move("p1", P1, GOAL), "r1/op1/1", old)

    with pytest.raises(PicoError, match="not the current one") as caught:
        during(bench, late)
    assert caught.value.exit_code == ExitCode.LOCKED


def test_looking_works_while_another_moves(bench: LocalEdge) -> None:
    other = sim(SETUP, bench.place.root)

    async def look(lease: Lease) -> None:
        await bench.execute(move("p1", P1, GOAL), "r1/op1/1", lease)
        assert (await other.observe()).components["p1"].pose == GOAL
        with pytest.raises(PicoError) as caught:
            await other.acquire("other")
        assert caught.value.exit_code == ExitCode.LOCKED

    during(bench, look)


@pytest.mark.parametrize(
    ("operation", "code", "words"),
    [
        (move("p1", Pose(112, 220, 0), GOAL), "not-there", "p1 stands 2 mm and 0° from where it was to be picked"),
        (move("p1", Pose(110, 220, 8), GOAL), "not-there", "8°"),
        (move("p1", P1, Pose(222, 430)), "blocked", "hwp"),
        (replace(move("p1", P1, GOAL), arguments={}), "bad-plan", "from where to where"),
        (replace(move("p1", P1, GOAL), robot="arm7"), "bad-plan", "arm7"),
        (setting("p1", "angle", 400.0), "range", "0 to 360 deg"),
        (setting("p1", "angle", True), "range", "number"),
        (setting("laser", "shutter", "ajar"), "range", "open"),
        (setting("p1", "hue", 1.0), "bad-plan", "no tunable hue"),
        (setting("cam", "spectrum", None, primitive="measure"), "not-simulated", "not simulated"),
        (setting("hwp", "pose", None, primitive="operator"), "bad-plan", "no tunable pose"),
    ],
)
def test_what_cannot_be_done_fails_with_its_reason_and_changes_nothing(
    bench: LocalEdge, operation: Operation, code: str, words: str
) -> None:
    result = executed(bench, operation)
    assert result.outcome == "failed"
    assert result.error is not None
    assert result.error.code == code
    assert words in f"{result.error.summary} {result.error.hint}"
    assert load_world(SETUP, bench.place)[0] == new_world(SETUP)


def test_an_unknown_object_is_in_the_way_too(bench: LocalEdge) -> None:
    thing = UnknownObject(pose=Pose(330, 420), footprint=SETUP.type_of("p1").geometry.footprint, height=50)
    change_world(SETUP, bench.place.root, "test", lambda w: replace(w, unknown={"unknown/17": thing}))
    result = executed(bench, move("p1", P1, GOAL))
    assert result.error is not None
    assert "unknown/17" in result.error.summary


def test_values_are_driven_at_the_speed_of_their_axis_and_then_settle(bench: LocalEdge) -> None:
    result = executed(bench, setting("p1", "angle", 75.0))
    kind = SETUP.type_of("p1").tunables["angle"]
    assert kind.axis is not None
    assert result.seconds == pytest.approx(75 / kind.axis.speed + kind.settle / 1000)
    assert result.after is not None
    assert result.after.values["angle"] == ObservedValue(value=75.0)


def test_homing_makes_an_unknown_value_known(bench: LocalEdge) -> None:
    lost = ObservedValue(value=None, status="unknown")
    change_world(SETUP, bench.place.root, "test", lambda w: w.with_value("p1", "angle", lost))
    result = executed(bench, setting("p1", "angle", None, primitive="home"))
    assert result.after is not None
    assert result.after.values["angle"] == ObservedValue(value=0.0)
    kind = SETUP.type_of("p1").tunables["angle"]
    assert kind.axis is not None
    assert result.seconds == pytest.approx(360 / kind.axis.speed + kind.settle / 1000)


def test_settings_go_on_beside_the_arm(bench: LocalEdge) -> None:
    async def both(lease: Lease) -> list[OperationResult]:
        return list(await asyncio.gather(
            bench.execute(move("p1", P1, GOAL), "r1/op1/1", lease),
            bench.execute(setting("p2", "angle", 50.0, "op2"), "r1/op2/1", lease),
            bench.execute(setting("hwp", "angle", 25.0, "op3"), "r1/op3/1", lease),
        ))  # fmt: skip

    moved, *turned = during(bench, both)
    assert asyncio.run(bench.observe()).time == pytest.approx(moved.seconds)
    assert all(t.ended == pytest.approx(t.seconds) for t in turned)


def test_giving_up_waiting_does_not_stop_the_arm(bench: LocalEdge) -> None:
    async def impatient(lease: Lease) -> None:
        task = asyncio.create_task(bench.execute(move("p1", P1, GOAL), "r1/op1/1", lease))
        await asyncio.sleep(0)
        task.cancel()
        await asyncio.wait([task])
        assert task.cancelled()

    during(bench, impatient)
    assert asyncio.run(bench.observe()).components["p1"].pose == GOAL
    assert bench.journal.records()[-1].kind == "done"


def test_stopped_on_the_way_the_gripper_holds_and_the_next_lease_says_so(bench: LocalEdge) -> None:
    async def go(lease: Lease) -> OperationResult:
        task = asyncio.create_task(bench.execute(move("p1", P1, GOAL), "r1/op1/1", lease))
        while not ((event := await events.get()).data.get("phase") == "transit" and event.data["pose"]["x"] > 120):
            pass
        await bench.stop()
        with pytest.raises(PicoError) as caught:
            await bench.execute(move("p2", Pose(200, 220), GOAL), "r1/op2/1", lease)
        assert caught.value.exit_code == ExitCode.INTERRUPTED
        return await task

    events = listening(bench)
    result = during(bench, go)
    assert (result.outcome, result.error.code) == ("failed", "stopped")
    world, _ = load_world(SETUP, bench.place)
    assert world.robots["arm1"].holding == "p1"
    pose = world.components["p1"].pose
    assert pose is not None
    assert P1.x + 10 < pose.x < GOAL.x - 10
    again = executed(bench, move("p2", Pose(200, 220), Pose(520, 420)), "r2/op1/1")
    assert again.error is not None
    assert "arm1 still holds p1" in again.error.summary


def test_the_carried_part_goes_with_the_tool(bench: LocalEdge) -> None:
    async def go(lease: Lease) -> list[dict[str, float]]:
        poses = []
        task = asyncio.create_task(bench.execute(move("p1", P1, GOAL), "r1/op1/1", lease))
        while (event := await events.get()).data.get("phase") != "retreat":
            if "pose" in event.data:
                poses.append(event.data["pose"])
        await task
        return poses

    events = listening(bench)
    poses = [Pose(**p) for p in during(bench, go)]
    assert poses[0].distance(P1) < 1e-6
    assert poses[-1].distance(GOAL) < 1e-6
    assert poses[-1].yaw == pytest.approx(30)
    assert [p.x for p in poses] == sorted(p.x for p in poses)


def test_a_broken_world_does_not_leave_the_bench_locked(bench: LocalEdge) -> None:
    world_path(bench.place).parent.mkdir(parents=True)
    world_path(bench.place).write_text("{")
    for _ in range(2):
        with pytest.raises(PicoError, match=r"world\.json"):
            asyncio.run(bench.acquire("test"))


def test_a_table_that_was_moved_and_is_not_stored_is_an_error_until_it_is_reset(bench: LocalEdge) -> None:
    executed(bench, move("p1", P1, GOAL))
    world_path(bench.place).unlink()
    with pytest.raises(PicoError, match=r"world\.json is gone, and the journal has runs") as caught:
        asyncio.run(bench.observe())
    assert caught.value.diagnostics[0].code == "world-file" and "pico sim reset" in caught.value.diagnostics[0].hint
    reset_world(SETUP, bench.place.root, "test")
    assert asyncio.run(bench.observe()).components["p1"].pose == P1


@pytest.mark.parametrize("backend", [None, "emulated"])
def test_a_journal_without_a_simulated_run_does_not_ask_for_a_simulated_table(
    bench: LocalEdge, backend: str | None
) -> None:
    assert not bench.journal.runs()
    if backend:
        bench.journal.begin_run("r1", "plan", "test", about={"environment": {"backend": backend}})
        executed(bench, move("p1", P1, GOAL))
        world_path(bench.place).unlink()
    assert asyncio.run(bench.observe()).components["p1"].pose == P1


def test_what_nothing_measures_is_refused(bench: LocalEdge) -> None:
    with pytest.raises(PicoError, match="spectrum of cam is not simulated"):
        asyncio.run(bench.peek("cam", "spectrum"))


def test_what_it_can_do_is_said_before(bench: LocalEdge) -> None:
    able = asyncio.run(bench.describe())
    assert (able.name, able.evidence, able.robots) == ("sim", "kinematic", ("arm1",))
    assert able.lab_digest == SETUP.digest()
    assert "operator" in able.primitives, "a simulated person does what only a person can do"
    assert {"p1.angle", "p1.pose", "left.frame", "cam.exposure", "cam.image", "cam.centroid"} <= able.measurables
    assert {"cam.pose", "left.pose"}.isdisjoint(able.measurables)


def test_the_real_bench_says_what_is_missing(tmp_path: Path) -> None:
    with pytest.raises(PicoError) as caught:
        opener("hardware")(SETUP, bench_at(tmp_path, "hardware"), "kinematic", lambda: "")
    (found,) = caught.value.diagnostics
    assert "arm1" in found.detail
    assert "p1.angle" in found.detail
    assert "--backend sim" in found.hint
