"""What may stop a run before it starts, what a failure takes with it, and how a run is interrupted."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from benches import apply, changed, execute, plan_to, run, shel, sim
from results import RunResult
from tables import change_world

from pico.backends.sim.hand import nudge, remove
from pico.backends.sim.store import load_world
from pico.backends.sim.world import World
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.local import LocalEdge
from pico.execution.report import measured
from pico.model.measurement import Measurement
from pico.model.operation import Operation, Reason, ReasonKind
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.state import LabState
from pico.model.trace.event import Event

SETUP, C3 = shel("gantry")


@pytest.fixture
def bench(tmp_path: Path) -> LocalEdge:
    return sim(SETUP, tmp_path)


def disturb(bench: LocalEdge, change: Callable[[World], World]) -> None:
    change_world(bench.setup, bench.place.root, "test", change)


def replanned(bench: LocalEdge, wanted: LabState, change: Callable[[Plan], Plan]) -> Plan:
    return change(asyncio.run(plan_to(bench, wanted)))


def refusal(bench: LocalEdge, planned: Plan) -> PicoError:
    with pytest.raises(PicoError) as caught:
        asyncio.run(execute(bench, planned))
    assert not (bench.place.root / ".pico/benches/sim" / "world.json").exists() or not bench.journal.records()
    return caught.value


def test_a_plan_with_errors_is_refused_as_impossible(bench: LocalEdge) -> None:
    broken = replanned(bench, C3, lambda p: replace(p, diagnostics=(error("impossible", "p1 cannot stand there"),)))
    found = refusal(bench, broken)
    assert found.exit_code == ExitCode.IMPOSSIBLE
    assert "p1 cannot stand there" in str(found)


def test_a_plan_for_what_the_backend_cannot_do_is_refused_naming_all_of_it(bench: LocalEdge) -> None:
    def ask(planned: Plan) -> Plan:
        first, second, third, *rest = planned.operations
        dark = replace(third, primitive="measure", component="cam", arguments={"measurable": "spectrum"})
        wrong = (replace(first, robot="arm2"), replace(second, primitive="scan"), dark)
        return replace(planned, operations=(*wrong, *rest))

    found = refusal(bench, replanned(bench, C3, ask))
    assert [d.code for d in found.diagnostics] == ["capability", "unmeasured", "capability"]
    assert "cannot scan" in str(
        found
    ) and "cam.spectrum can't be measured: the simulator has nothing that measures it" in str(found)
    assert "arm2" in str(found)


def test_a_simulated_person_does_what_only_a_person_can(bench: LocalEdge) -> None:
    goal = Pose(222, 420, 3)
    planned, result, _ = apply(bench, changed(C3, {"hwp": {"pose": goal}}))
    assert [op.component for op in planned.operations if op.primitive == "operator"] == ["hwp"]
    assert result.outcome == "done"
    body = load_world(bench.setup, bench.place)[0].components["hwp"]
    assert body.pose is not None and 0 < body.pose.distance(goal) <= 0.5


def test_a_plan_for_another_lab_is_stale(bench: LocalEdge) -> None:
    planned = replanned(bench, C3, lambda p: replace(p, lab=replace(p.lab, digest="sha256:other")))
    assert refusal(bench, planned).exit_code == ExitCode.STALE


@pytest.mark.parametrize("slot", [True, False])
def test_a_part_that_moved_since_the_plan_makes_it_stale_and_says_by_how_much(bench: LocalEdge, slot: bool) -> None:
    if not slot:
        apply(bench, C3)
    wanted = changed(C3, {"p2": {"pose": Pose(520, 420, 30)}})
    planned = asyncio.run(plan_to(bench, wanted))
    disturb(bench, lambda w: nudge(SETUP, w, "p2", dx=3.0, dy=4.0))
    with pytest.raises(PicoError, match="p2") as caught:
        asyncio.run(execute(bench, planned, "r2"))
    assert caught.value.exit_code == ExitCode.STALE
    assert "5 mm" in str(caught.value) or "523" in str(caught.value)


def test_a_move_within_tolerance_does_not_make_a_plan_stale_and_the_part_ends_at_its_goal(bench: LocalEdge) -> None:
    planned = asyncio.run(plan_to(bench, C3))
    disturb(bench, lambda w: nudge(SETUP, w, "p2", dx=0.3, dyaw=0.3))
    result, _ = asyncio.run(execute(bench, planned))
    assert result.outcome == "done"
    assert asyncio.run(bench.observe()).components["p2"].pose == Pose(520, 420, 0)


def test_a_part_that_was_turned_in_its_slot_since_is_not_picked_as_planned(bench: LocalEdge) -> None:
    """In its slot it still would be right, whatever its yaw; but the jaws would close along another side of it."""
    planned = asyncio.run(plan_to(bench, changed(C3, {"p2": {"pose": Pose(520, 420, 30)}})))
    disturb(bench, lambda w: nudge(SETUP, w, "p2", dyaw=8.0))
    found = refusal(bench, planned)
    assert found.exit_code == ExitCode.STALE
    assert "p2 changed by 0 mm, 8°" in str(found)


def test_what_the_backend_says_of_another_run_is_not_told_of_this_one(bench: LocalEdge) -> None:
    planned, real = asyncio.run(plan_to(bench, C3)), bench.runs.hear

    def both(event: Event) -> None:
        real(replace(event, run="another", time=1e6))
        real(event)

    bench.runs.hear = both  # type: ignore[method-assign]
    result, events = asyncio.run(execute(bench, planned))
    assert {event.run for event in events} == {"r1"}
    assert [event.seq for event in events] == list(range(1, len(events) + 1))
    assert result.outcome == "done" and result.seconds < 1000


def while_running(
    bench: LocalEdge, planned: Plan, when: Callable[[Event], bool], act: Callable[[], Awaitable[None] | None]
) -> tuple[RunResult, list[Event]]:
    """Run a plan, and act once when an event comes."""

    async def go() -> list[Event]:
        events, acted = [], False
        async for event in run(planned, bench, run_id="r1"):
            events.append(event)
            if when(event) and not acted:
                acted = True
                waiting = act()
                if waiting is not None:
                    await waiting
        return events

    events = asyncio.run(go())
    return RunResult.of(events), events


def hidden(bench: LocalEdge, name: str) -> None:
    """A hand takes a part away in the middle of a run, lock or no lock."""
    session = bench.device._session
    assert session is not None
    session._world = remove(SETUP, session.world(), name)


def test_a_failure_skips_what_depends_on_it_and_nothing_else_and_the_next_apply_goes_on(bench: LocalEdge) -> None:
    wanted = changed(C3, {"lx_100": {"pose": Pose(420, 420)}})
    planned = asyncio.run(plan_to(bench, wanted))
    first, *later = [op for op in planned.operations if op.primitive == "move"]
    chained = replace(planned, operations=tuple(
        replace(op, after=(*op.after, later[0].id)) if op.primitive == "set" and op.component == "p2" else op
        for op in planned.operations
    ))  # fmt: skip
    lost = later[0].component
    result, events = while_running(bench, chained, lambda e: e.kind == "operation_started", lambda: hidden(bench, lost))
    assert result.outcome == "failed"
    failed = {k: r for k, r in result.operations.items() if r.outcome == "failed"}
    assert later[0].id in failed
    assert f"{lost} is not on the table" in failed[later[0].id].data["diagnostic"]["summary"]
    skipped = {k: r.data["because"] for k, r in result.operations.items() if r.outcome == "skipped"}
    assert set(skipped.values()) == {later[0].id}
    assert {op.primitive for op in planned.operations if op.id in skipped} == {"set"}  # the arm parks all the same
    assert {result.operations[op.id].outcome for op in (first, *later[1:])} == {"done"}
    assert result.done + result.failed + result.skipped == len(planned.operations)
    assert events[-1].kind == "run_finished"
    assert asyncio.run(bench.observe()).components[lost].presence == "missing"
    disturb(bench, lambda w: nudge(SETUP, w, lost))
    assert apply(bench, wanted, "r2")[1].outcome == "done"


def test_interrupted_by_a_callable_finishes_what_is_under_way_and_starts_nothing_more(bench: LocalEdge) -> None:
    planned, pressed = asyncio.run(plan_to(bench, C3)), [False]

    async def go() -> list[Event]:
        events = []
        async for event in run(planned, bench, run_id="r1", cancelled=lambda: pressed[0]):
            events.append(event)
            pressed[0] = True
        return events

    events = asyncio.run(go())
    result = RunResult.of(events)
    assert result.outcome == "interrupted"
    under_way = {e.operation for e in events if e.kind == "operation_started"}
    assert {k for k, r in result.operations.items() if r.outcome == "done"} == under_way
    assert result.skipped == len(planned.operations) - len(under_way)
    assert asyncio.run(bench.observe()).robots["arm1"].holding is None
    assert bench.journal.runs()[0].outcome == "interrupted"
    assert apply(bench, C3, "r2")[1].outcome == "done"


def chain(planned: Plan) -> Plan:
    """The plan with a long setting of the laser beside short ones of the camera, one after the other."""
    laser = next(op for op in planned.operations if op.arguments.get("tunable") == "emission")
    cam = next(op for op in planned.operations if op.component == "cam")
    links = [
        replace(
            cam, id=f"cam{n}", after=(f"cam{n - 1}",) if n else (), arguments={"tunable": "exposure", "to": 1.0 + n}
        )
        for n in range(20)
    ]
    return replace(planned, operations=(laser, *links))


def test_what_may_follow_starts_at_the_very_moment_of_the_end_while_others_go_on(bench: LocalEdge) -> None:
    planned = replanned(bench, C3, chain)
    result, events = asyncio.run(execute(bench, planned))
    starts = [e.time for e in events if e.kind == "operation_started" and e.component == "cam"]
    each = result.operations["cam0"].data["seconds"]
    assert starts == pytest.approx([n * each for n in range(20)])
    assert result.seconds == pytest.approx(5.0)


def test_a_slow_reader_changes_nothing(tmp_path: Path) -> None:
    async def read(name: str, turns: int) -> list[Event]:
        bench = sim(SETUP, tmp_path / name)
        planned, events = await plan_to(bench, C3), []
        async for event in run(planned, bench, run_id="r1"):
            events.append(event)
            for _ in range(turns):
                await asyncio.sleep(0)
        return events

    assert asyncio.run(read("quick", 0)) == asyncio.run(read("slow", 50))


def test_a_report_tells_how_far_from_their_goals_parts_were_placed(bench: LocalEdge) -> None:
    _, _, events = apply(bench, C3)
    report, placed = asyncio.run(bench.report("r1")), [e for e in events if "error_mm" in e.data]
    assert report.off is not None and len(placed) > 1
    assert report.off["mm"] == max(e.data["error_mm"] for e in placed)
    assert report.off["deg"] == max(e.data["error_deg"] for e in placed)
    assert report.off["part"] in {e.component for e in placed}
    again, _, _ = apply(bench, C3, "r2")
    assert not again.operations and asyncio.run(bench.report("r2")).off is None


def test_halt_lets_the_move_end_and_stop_leaves_the_part_in_the_gripper(tmp_path: Path) -> None:
    def carrying(event: Event) -> bool:
        return event.kind == "operation_progress" and event.data["phase"] == "transit"

    outcome: dict[str, Mapping[str, Any]] = {}
    for name in ("halt", "stop"):
        bench = sim(SETUP, tmp_path / name)
        planned = asyncio.run(plan_to(bench, C3))
        result, _ = while_running(bench, planned, carrying, getattr(bench, name))
        assert result.outcome == "interrupted"
        seen, carried = asyncio.run(bench.observe()), next(o.component for o in planned.operations if o.robot)
        outcome[name] = {"part": seen.components[carried].presence, "holding": seen.robots["arm1"].holding}
    assert outcome == {"halt": {"part": "seen", "holding": None}, "stop": {"part": "held", "holding": carried}}


def test_a_part_put_down_beside_its_goal_is_placed_again_at_most_twice(bench: LocalEdge) -> None:
    planned = asyncio.run(plan_to(bench, changed(C3, {"p1": {"slot": "storage/b1"}})))
    misses = iter([4.0, 1.0, 0.0])

    async def go(plan: Plan) -> tuple[RunResult, list[Event]]:
        real = bench.custody.execute

        async def clumsy(operation: Operation, key: str, lease: Any, *, tidies: bool = False) -> Any:
            session = bench.device._session
            assert session is not None
            result = await real(operation, key, lease, tidies=tidies)
            miss = next(misses) if operation.primitive == "move" else 0.0
            if not miss:
                return result
            session._mover._placed["p2"] = Pose(520 + miss, 420)  # type: ignore[attr-defined]
            seen = (await bench.observe()).components["p2"]
            return replace(result, outcome="failed", error=error("misplaced", "p2 is off"), after=seen)

        bench.custody.execute = clumsy  # type: ignore[method-assign]
        return await execute(bench, plan)

    result, events = asyncio.run(go(planned))
    assert result.outcome == "done"
    assert asyncio.run(bench.observe()).components["p2"].pose == Pose(520, 420, 0)
    move = next(op.id for op in planned.operations if op.primitive == "move")
    keys = [r.key for r in bench.journal.records() if r.kind == "started" and f"/{move}/" in r.key]
    assert keys == [f"r1/{move}/{attempt}" for attempt in (1, 2, 3)]
    assert sum(e.kind == "operation_done" and e.operation == move for e in events) == 1


def test_a_run_whose_journal_breaks_stops_and_says_so(bench: LocalEdge, monkeypatch: pytest.MonkeyPatch) -> None:
    planned = asyncio.run(plan_to(bench, C3))

    def full(*_: object) -> None:
        raise PicoError(error("journal", "the journal cannot be used: disk full"))

    monkeypatch.setattr(bench.journal, "started", full)
    result, _ = asyncio.run(execute(bench, planned))
    assert result.outcome == "interrupted"
    assert result.done == 0
    assert result.unknown > 0


def test_what_the_bench_was_changed_after_was_not_measured_of_it() -> None:
    def op(id: str, primitive: str, kind: ReasonKind = "asked", **arguments: str) -> Operation:
        return Operation(id=id, primitive=primitive, component="p1", arguments=arguments, reason=Reason(kind=kind))

    operations = (
        op("op1", "measure", measurable="pose"), op("op2", "set", "interlock"),
        op("op3", "measure", measurable="angle"),
        op("op4", "park", "parked"), op("op5", "set", tunable="angle"), op("op6", "measure", measurable="angle"),
    )  # fmt: skip
    ref = LabRef(name="shel", digest="")
    plan = Plan(lab=ref, backend="sim", fidelity="kinematic", base=Base(), target=Target(), operations=operations)
    events = []
    for n, one in enumerate(operations):
        taken = Measurement(component="p1", measurable=str(one.arguments.get("measurable")), value=n)
        data = {"measurement": as_json(taken)} if one.primitive == "measure" else {}
        about: dict[str, Any] = {"run": "r", "seq": n, "time": 0.0, "operation": one.id}
        events += [Event(kind="operation_started", **about), Event(kind="operation_done", data=data, **about)]
        if one.id == "op4":
            assert {a: m.value for a, m in measured(plan, events).items()} == {"p1.pose": 0, "p1.angle": 2}
    assert {a: m.value for a, m in measured(plan, events).items()} == {"p1.angle": 5}
