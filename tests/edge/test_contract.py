"""What every edge does: in this process, behind a Unix socket in another one, and on the network."""

from __future__ import annotations

import asyncio
import gc
import shutil
import stat
import threading
from collections.abc import Awaitable, Callable, Iterator
from contextlib import nullcontext, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import forking
import numpy as np
import pytest
from attended import ended_when
from bench_at import bench_at
from benches import plan_to, shel, sim
from relaying import TOKEN, point, relayed
from serving import served

from pico.bench.bench import Bench
from pico.bench.running.execution import Execution
from pico.diagnostics import ExitCode, PicoError
from pico.edge.contract import Edge
from pico.edge.link import place
from pico.edge.link.client import RemoteEdge
from pico.edge.local import LocalEdge
from pico.edge.network.opening import opened
from pico.edge.protocol import Job
from pico.history.examples.example import example_names, make_example
from pico.model.observation import live_state
from pico.model.operation import Operation, Reason
from pico.model.plan import Plan, Target
from pico.model.record import as_json
from pico.model.trace.event import Event
from pico.planning import PlanGoal
from pico.twin.snapshot import Recording
from pico.vision.arm import NOMINAL


@pytest.fixture(scope="session")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("contract") / "shel").root


@pytest.fixture
def lab(example: Path, tmp_path: Path) -> Path:
    shutil.copytree(example, tmp_path / "shel")
    return tmp_path / "shel"


@pytest.fixture
def client(lab: Path, tmp_path: Path) -> Path:
    """Another checkout of the lab, with a bench of its own that nobody means."""
    return Path(shutil.copytree(lab, tmp_path / "client" / "shel"))


@pytest.fixture(params=["in this process", "behind a socket", "on the network"])
def kept(request: pytest.FixtureRequest, lab: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[type]:
    """Serve the lab, or not; gives the kind of edge that a client then has."""
    monkeypatch.setenv("PICO_TOKEN", TOKEN)
    if request.param == "on the network":
        with relayed(lab) as url:
            point(request.getfixturevalue("client"), url)
            yield RemoteEdge
        return
    behind = request.param == "behind a socket"
    with served(lab) if behind else nullcontext():
        yield RemoteEdge if behind else LocalEdge


@pytest.fixture
def bench(lab: Path, kept: type, request: pytest.FixtureRequest) -> Iterator[Bench]:
    where = request.getfixturevalue("client") if "on the network" in request.node.name else lab
    with Bench.open(where) as opened_bench:
        assert type(opened_bench.edge) is kept
        yield opened_bench


def edge_of(bench: Bench) -> Edge:
    return bench.edge


def on_edge(bench: Bench, act: Callable[[Edge], Awaitable[Any]]) -> Any:
    """Act on the edge of a bench, in the loop that it lives in."""

    async def go() -> Any:
        return await asyncio.wait_for(act(edge_of(bench)), 60)

    return bench.wait(go())


async def ran(edge: Edge, plan: Plan, run: str, **options: Any) -> list[Event]:
    await edge.start(Job(plan=plan, holder="test", **options), run)
    return [event async for event in edge.events(run)]


def test_who_it_is_and_what_it_can_do(bench: Bench) -> None:
    able = on_edge(bench, lambda edge: edge.describe())
    assert (able.name, able.evidence, able.lab_digest) == ("sim", "kinematic", bench.setup.digest())
    assert on_edge(bench, lambda edge: edge.holder()) is None
    assert edge_of(bench).memory is None or not edge_of(bench).memory.runs()


def test_a_run_is_told_whole_and_from_any_number_on_and_is_remembered(bench: Bench) -> None:
    plan = bench.plan("e1")
    events = on_edge(bench, lambda edge: ran(edge, plan, "r1"))
    assert [event.seq for event in events] == list(range(1, len(events) + 1))
    assert (events[0].kind, events[-1].kind, events[-1].data["outcome"]) == ("run_started", "run_finished", "done")

    async def again(edge: Edge) -> tuple[list[Event], str]:
        return [event async for event in edge.events("r1", 7)], await edge.start(Job(plan=plan, holder="test"), "r1")

    rest, run = on_edge(bench, again)
    assert (rest, run) == (events[7:], "r1")
    report = on_edge(bench, lambda edge: edge.report("r1"))
    assert report.outcome == "done" and report.reached and report.evidence == "kinematic"
    memory = edge_of(bench).memory
    assert memory is not None
    assert [(r.run, r.outcome, r.plan) for r in memory.runs()] == [("r1", "done", plan.digest)]
    assert memory.document("r1") == plan.to_json()
    starts, seen = memory.about("r1")
    assert starts[0]["evidence"] == "kinematic" and seen is not None and seen["reached"]
    assert {r.kind for r in memory.records(run="r1")} == {"intent", "started", "done"}
    assert not memory.unsettled() and memory.moving() == {"r1"}
    moved = next(op.component for op in plan.operations if op.primitive == "move")
    assert next(memory.successes([moved])).after is not None


def test_a_run_goes_at_the_speed_that_was_asked_for_and_the_next_one_at_the_labs(bench: Bench) -> None:
    took = []
    for speed in (0.2, None, 1.0):
        with Bench.open(bench.root, speed=speed) as other:
            plan = other.single("p2", "move", x=560 if speed is None else 520)
            began = other.observe().time
            assert other.apply(plan).outcome == "done"
            took.append(other.observe().time - began)
            assert took[-1] == pytest.approx(plan.makespan, abs=0.5)
    assert took == sorted(took, reverse=True)
    assert on_edge(bench, lambda edge: edge.describe()).lab_digest == bench.setup.digest()


def test_a_run_of_another_plan_does_not_take_its_id(bench: Bench) -> None:
    first, other = bench.plan("e1"), bench.plan("C1")
    on_edge(bench, lambda edge: ran(edge, first, "r1"))
    with pytest.raises(PicoError, match="run r1 is of another plan"):
        on_edge(bench, lambda edge: edge.start(Job(plan=other, holder="test"), "r1"))
    with pytest.raises(PicoError, match="no run r2 was started here"):
        on_edge(bench, lambda edge: ran_again(edge, "r2"))


async def ran_again(edge: Edge, run: str) -> list[Event]:
    return [event async for event in edge.events(run)]


def test_a_plan_is_checked_again_before_anything_moves(bench: Bench) -> None:
    plan = bench.plan("e1")
    stale = replace(plan, lab=replace(plan.lab, digest="sha256:other")).sealed()
    moved = next(op.component for op in plan.operations if op.primitive == "move")
    with pytest.raises(PicoError, match="stale") as caught:
        on_edge(bench, lambda edge: ran(edge, stale, "r1"))
    assert caught.value.exit_code == ExitCode.STALE
    bench.sim.nudge(moved, dx=7)
    with pytest.raises(PicoError, match=f"{moved} changed by 7 mm") as caught:
        on_edge(bench, lambda edge: ran(edge, plan, "r2"))
    assert caught.value.exit_code == ExitCode.STALE
    assert on_edge(bench, lambda edge: edge.holder()) is None


def test_one_moves_it_at_a_time_and_a_lease_that_is_over_moves_nothing(bench: Bench) -> None:
    asked = Reason(kind="asked")
    turn = Operation(
        id="op1", primitive="set", component="p1", arguments={"tunable": "angle", "to": 20.0}, reason=asked
    )

    async def act(edge: Edge) -> None:
        lease = await edge.acquire("first")
        holder = await edge.holder()
        assert holder is not None and (holder.token, holder.what) == (lease.token, "first")
        with pytest.raises(PicoError, match=r"in use by .*: first") as caught:
            await edge.acquire("second")
        assert caught.value.exit_code == ExitCode.LOCKED
        result = await edge.execute(turn, "r1/op1/1", lease)
        assert (result.outcome, result.after.values["angle"].value) == ("done", 20.0)  # type: ignore[union-attr]
        assert await edge.execute(turn, "r1/op1/1", lease) == result
        with pytest.raises(PicoError, match="recorded with other content"):
            await edge.execute(replace(turn, arguments={"tunable": "angle", "to": 30.0}), "r1/op1/1", lease)
        await edge.release(lease)
        later = await edge.acquire("second")
        assert later.token > lease.token
        with pytest.raises(PicoError, match="not the current one") as caught:
            await edge.execute(turn, "r1/op1/2", lease)
        assert caught.value.exit_code == ExitCode.LOCKED
        await edge.release(later)

    on_edge(bench, act)


def opening(bench: Bench) -> Plan:
    """Return the plan of a run whose operations are asked for while it is open."""
    seen = bench.observe()
    goal = PlanGoal(live_state(bench.setup, seen), Target(title="it", cause="recording"), operations=())
    return bench.plans.planner(seen).plan(goal)


def test_an_open_run_has_the_operations_of_all_that_is_started_within_it(bench: Bench) -> None:
    job = Job(plan=opening(bench), holder="test")
    on_edge(bench, lambda edge: edge.open(job, "r1"))
    for n, angle in enumerate((10, 20)):
        plan = bench.single("p1", "set", angle=angle)
        events = on_edge(bench, lambda edge, n=n, plan=plan: ran(edge, plan, f"s{n}", within="r1"))
        assert {event.run for event in events} == {"r1"} and events[-1].data["outcome"] == "done"
    holder = on_edge(bench, lambda edge: edge.holder())
    assert holder is not None and holder.what == "test" and on_edge(bench, lambda edge: edge.unended()) == "r1"
    with pytest.raises(PicoError, match="in use by"):
        on_edge(bench, lambda edge: ran(edge, plan, "r2"))
    with pytest.raises(PicoError, match="run r3 is not open any more"):
        on_edge(bench, lambda edge: ran(edge, plan, "s3", within="r3"))
    report = on_edge(bench, lambda edge: edge.finish("r1", "done"))
    assert (report.run, report.outcome, report.done, report.failed) == ("r1", "done", 2, 0)
    memory = edge_of(bench).memory
    assert memory is not None and [(r.run, r.outcome) for r in memory.runs()] == [("r1", "done")]
    assert {r.key for r in memory.records(run="r1")} == {"r1/1.op1/1", "r1/2.op1/1"}
    assert on_edge(bench, lambda edge: edge.holder()) is None and on_edge(bench, lambda edge: edge.unended()) is None
    with pytest.raises(PicoError, match="run r1 is not open any more"):
        on_edge(bench, lambda edge: edge.finish("r1", "done"))


def test_an_open_run_whose_client_is_gone_is_interrupted(bench: Bench) -> None:
    job = Job(plan=opening(bench), holder="test")

    async def act(edge: Edge) -> None:
        lease = await edge.open(job, "r1")
        await edge.release(lease)

    on_edge(bench, act)
    memory = edge_of(bench).memory
    assert memory is not None and [(r.run, r.outcome) for r in memory.runs()] == [("r1", "interrupted")]
    assert on_edge(bench, lambda edge: edge.holder()) is None


TRIES = ("r1", "r2", "r3", "r4", "r5")
"""Runs of which one is ended before it is over, also on a busy machine."""


@pytest.mark.parametrize("how", ["cancel", "halt", "stop"])
def test_a_run_is_ended_safely_or_at_once(bench: Bench, how: str) -> None:
    for run in TRIES:
        plan = bench.plan("e1")

        async def act(edge: Edge, plan: Plan = plan, run: str = run) -> list[Event]:
            events = []
            await edge.start(Job(plan=plan, holder="test"), run)
            async for event in edge.events(run):
                events.append(event)
                if event.kind == "operation_started" and event.data["primitive"] == "move":
                    await (edge.cancel(run) if how == "cancel" else getattr(edge, how)())
            return events

        events = on_edge(bench, act)
        if events[-1].data["outcome"] == "interrupted":
            break
        bench.apply(bench.recovery.undo_plan())  # it was quicker
    report = on_edge(bench, lambda edge: edge.report(run))
    assert report.outcome == "interrupted"
    assert on_edge(bench, lambda edge: edge.holder()) is None
    if how != "stop":
        assert not report.held
    bench.apply(bench.recovery.resume_plan()[0])
    assert not bench.plan("e1").operations


def test_resume_undo_and_recover_go_by_what_it_remembers(bench: Bench) -> None:
    before = {name: part.pose for name, part in bench.observe().components.items()}
    for _ in TRIES:
        report = ended_when(bench, bench.plan("e1"), lambda e: e.kind == "operation_done" and "error_mm" in e.data)
        if report.outcome == "interrupted":
            break
        bench.apply(bench.recovery.undo_plan())  # it was quicker
    assert report.outcome == "interrupted"
    plan, id = bench.recovery.resume_plan()
    assert id == report.run
    going = bench.run(plan, resumes=id)
    list(going)
    assert going.report.run == id and not bench.plan("e1").operations
    bench.apply(bench.recovery.undo_plan())
    assert {name: part.pose for name, part in bench.observe().components.items()} == before
    assert not bench.recovery.recover_plan().operations
    with pytest.raises(PicoError, match="nobody asks about"):
        bench.recovery.answer("r9/op1/1", done=True)


def test_its_runs_are_committed_with_their_evidence(bench: Bench) -> None:
    bench.apply("e1")
    bench.capture()
    done = bench.commit("as e1")
    assert done.realized and done.evidence == "kinematic" and len(done.runs) == 1
    document, commit = bench.history.recorded_run(done.runs[0])
    assert document.document.evidence == "kinematic" and commit is not None
    found = bench.drift.look()
    assert not found.beyond and not found.held


def test_what_stands_in_the_midst_of_a_run_is_not_captured_and_it_is_said_who_runs_what(
    bench: Bench, kept: type, lab: Path
) -> None:
    run = bench.apply("e1").run
    lease = on_edge(bench, lambda edge: edge.acquire("pico apply"))
    (lab / ".pico/benches/sim" / "run").write_text(run)  # as if it were not over
    server = "the server of this bench, " if kept is RemoteEdge else ""
    for take in (bench.commit, bench.capture, bench.commits.draft):
        with pytest.raises(
            PicoError, match=rf"\({server}process .*\): pico apply e1, (\d+) of \1 operations d"
        ) as caught:
            take()
        assert caught.value.exit_code == ExitCode.LOCKED
    assert [d.code for d in bench.status().cut_short] == ["goes-on"] and not bench.capture(write=False).written
    planned = bench.commit("left out", "planned", empty=True)
    assert (planned.evidence, planned.runs, planned.realized) == ("planned", (), False)
    on_edge(bench, lambda edge: edge.release(lease))


def test_what_moves_can_be_filmed(bench: Bench) -> None:
    recording = Recording()
    run = bench.run(bench.plan("e1"), recording=recording)
    list(run)
    times = [snapshot.time for snapshot in recording.snapshots]
    assert len(times) > 20 and times == sorted(times) and recording.snapshots[-1].places


def test_the_simulated_world_is_changed_as_by_a_hand(bench: Bench) -> None:
    before = bench.sim.placements()["p1"]
    pose = bench.sim.nudge("p1", dx=3, dyaw=2)
    assert bench.observe().components["p1"].pose == pose
    assert bench.sim.placements()["p1"] != before
    bench.sim.person(True)
    assert bench.observe().person is True
    assert bench.sim.faults(["drop=0.5", "seed=3"]) == {"rates": {"drop": 0.5}, "seed": 3}
    assert bench.sim.faults(["off"])["rates"] == {}
    bench.sim.remove("p1")
    assert bench.observe().components["p1"].presence == "missing"
    bench.sim.power_cycle()
    assert bench.observe().components["p2"].values["angle"].status == "unknown"
    with pytest.raises(PicoError, match="p9"):
        bench.sim.nudge("p9")
    angle = bench.observe().components["p2"].values["angle"]
    bench.sim.slip("p2", "angle", 2.0)
    assert bench.observe().components["p2"].values["angle"] == angle
    with pytest.raises(PicoError, match="exposure"):
        bench.sim.slip("cam", "exposure", 2.0)
    seen = bench.observe()
    bench.sim.upset("ly_150", up=0.1, loss=0.2)
    assert bench.observe().components == seen.components
    with pytest.raises(PicoError, match="it is no detector"):
        bench.sim.upset("ly_150", gain=2.0)
    assert bench.sim.hidden() == {"ly_150": {"up": 0.1, "loss": pytest.approx(0.2)}, "p2": {"angle": 2.0}}
    assert bench.sim.clear("ly_150") == ("ly_150",)
    bench.sim.upset("ly_150", optic="plano_convex_100")
    assert bench.sim.clear() == ("ly_150", "p2") and bench.sim.hidden() == {}
    bench.sim.wait(3600.0)
    assert bench.observe().time == pytest.approx(seen.time + 3600.0)
    bench.sim.reset()
    assert bench.observe().components["p1"].presence == "seen"
    assert set(bench.sim.true_cameras())
    assert bench.sim.true_arms() == {"arm1": NOMINAL}


@pytest.mark.slow
def test_cameras_look(bench: Bench) -> None:
    found = bench.cameras.scan()
    assert {"p1", "p2"} <= found.sighting.components.keys()
    assert all(frame.gray.dtype == np.uint8 and frame.gray.any() for frame in found.frames)
    assert found.calibration.cameras.keys() >= {frame.camera for frame in found.frames}


def test_who_is_interrupted_while_it_waits_does_not_stop_the_one_that_moves(bench: Bench) -> None:
    plan = bench.plan("e1")

    lease = on_edge(bench, lambda edge: edge.acquire("first"))
    waiting = Execution(plan, bench.edge, bench.thread, wait=30.0)
    threading.Timer(0.1, waiting.halt).start()
    with pytest.raises(PicoError) as caught:
        next(waiting)
    assert caught.value.exit_code == ExitCode.INTERRUPTED and waiting.over

    async def act(edge: Edge) -> None:
        turn = Operation(
            id="op1", primitive="set", component="p1", arguments={"tunable": "angle", "to": 20.0},
            reason=Reason(kind="asked"),
        )  # fmt: skip
        assert (await edge.execute(turn, "r1/op1/1", lease)).outcome == "done"
        await edge.release(lease)

    on_edge(bench, act)


def test_a_garbage_collection_between_two_events_of_a_run_ends_nothing(bench: Bench) -> None:
    plan = bench.plan("e1")
    gc.freeze()  # what was there before is no part of the run, and need not be looked through each time
    run = bench.run(plan)
    for event in run:
        if event.seq <= 6:
            gc.collect()
    assert run.report.outcome == "done"


def test_who_follows_a_run_of_a_bench_that_is_closed_does_not_wait_for_ever(bench: Bench) -> None:
    run = bench.run(bench.plan("e1"))
    next(run)
    bench.close()
    with suppress(PicoError):
        list(run)
    assert run.over


# only behind a socket


def test_its_fidelity_counts_only_its_user_reaches_the_socket_and_a_second_server_is_refused(lab: Path) -> None:
    with served(lab, "physics"):
        with Bench.open(lab) as bench:
            assert bench.plan().fidelity == "physics"  # nobody asked for another
        path = place.find(bench_at(lab))
        assert path is not None
        assert stat.S_IMODE(path.lstat().st_mode) == 0o600 and stat.S_IMODE(path.parent.lstat().st_mode) == 0o700
        second = forking.ran(forking.PICO, "-C", str(lab), "edge")
        assert second.returncode == ExitCode.LOCKED and "is served already" in second.stderr
    assert place.find(bench_at(lab)) is None and not path.exists()
    setup, _ = shel()
    assert isinstance(opened(setup, bench_at(lab), "kinematic"), LocalEdge)


def test_nonsense_is_answered_and_does_no_harm(lab: Path) -> None:
    import json
    import socket

    with served(lab):
        for data in (b"\n", b"{}\n", b'{"call":"close","with":[]}\n', b'{"call":"start","with":[1,2]}\n', b"\xff\n"):
            with socket.socket(socket.AF_UNIX) as link:
                link.connect(str(place.find(bench_at(lab))))
                link.sendall(data)
                answer = json.loads(link.makefile("rb").readline())
                assert answer["error"][0]["code"] == "link" and "call" in answer["error"][0]["summary"]
        with Bench.open(lab) as bench:
            assert bench.observe().components


def test_a_lease_ends_with_the_client_that_took_it(lab: Path) -> None:
    code = (
        "import asyncio, os, sys; from pathlib import Path; from pico.edge.link import place;"
        "from pico.edge.link.client import RemoteEdge; from pico.edge.link.line import SocketLine\n"
        "from pico.places.bench import BenchPlace\n"
        "async def go():\n"
        " path = place.find(BenchPlace(Path(sys.argv[1]), 'sim'))\n"
        " await RemoteEdge(SocketLine(path)).acquire('somebody'); os.kill(os.getpid(), 9)\n"
        "asyncio.run(go())"
    )
    with served(lab), Bench.open(lab) as bench:
        assert forking.started(code, str(lab)).wait(60) == -9

        async def free(edge: Edge) -> None:
            await edge.release(await edge.acquire("next", 10.0))

        on_edge(bench, free)


@pytest.mark.parametrize("name", [
    name if name == "shel" else pytest.param(name, marks=pytest.mark.slow) for name in example_names()
])  # fmt: skip
def test_the_same_plan_leads_to_the_same_records_and_the_same_end_in_both(name: str, tmp_path: Path) -> None:
    """Only tokens, and times on the wall, are each one's own."""
    example, found = make_example(name, tmp_path / "example").root, []
    for where in ("embedded", "served"):
        lab = tmp_path / where
        shutil.copytree(example, lab)
        with served(lab) if where == "served" else nullcontext(), Bench.open(lab, fidelity="kinematic") as bench:
            plan = bench.plan()
            assert plan.operations
            events = on_edge(bench, lambda edge, plan=plan: ran(edge, plan, "r1"))  # type: ignore[misc]
            memory = edge_of(bench).memory
            assert memory is not None
            records = [(r.key, r.kind, r.component, r.digest, r.data) for r in memory.records()]
            seen = bench.observe()
            found.append((plan.digest, events, records, as_json(seen.components), seen.time))
    assert found[0] == found[1]


def test_a_bench_for_tests_is_an_edge_too(tmp_path: Path) -> None:
    setup, state = shel("gantry")
    edge: Edge = sim(setup, tmp_path)
    assert asyncio.run(plan_to(sim(setup, tmp_path), state)).operations and asyncio.run(edge.observe()).components


def test_faults_are_asked_of_every_edge_and_none_is_cleared_where_there_is_none(bench: Bench) -> None:
    assert bench.recovery.faults() == ()
    with pytest.raises(PicoError) as refused:
        bench.wait(bench.edge.clear_fault("arm1", "Ada"))
    assert refused.value.diagnostics[0].code in ("unknown-device", "link")
