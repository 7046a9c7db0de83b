"""Who may move a bench, in this process and behind a socket: the lease is taken, halted, and lost to a stop."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from serving import served

from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError
from pico.edge.contract import Edge
from pico.edge.link import line, place
from pico.edge.link.client import RemoteEdge
from pico.edge.link.line import SocketLine
from pico.edge.link.server import edge_of
from pico.edge.local import started
from pico.edge.protocol import Asking, Job
from pico.edge.stopping import ask_to_stop
from pico.history.examples.example import make_example
from pico.model.operation import Operation, Reason
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport
from pico.planning import Planner, set_values

Acting = Callable[[Callable[[Edge], Awaitable[Any]]], Any]


@pytest.fixture(params=["in this process", "behind a socket"])
def on_edge(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Acting]:
    root = make_example("shel", tmp_path / "shel").root
    behind = request.param == "behind a socket"

    async def go(act: Callable[[Edge], Awaitable[Any]]) -> Any:
        path = place.find(bench_at(root))
        edge: Edge = RemoteEdge(SocketLine(path)) if path else edge_of(bench_at(root), "kinematic")
        try:
            return await asyncio.wait_for(act(edge), 60)
        finally:
            await edge.close()

    with served(root) if behind else nullcontext():
        yield lambda act: asyncio.run(go(act))


def turn(angle: float) -> Operation:
    return Operation(
        id="op1", primitive="set", component="p1", arguments={"tunable": "angle", "to": angle},
        reason=Reason(kind="asked"),
    )  # fmt: skip


@contextmanager
def refused(code: ExitCode) -> Iterator[None]:
    with pytest.raises(PicoError) as caught:
        yield
    assert caught.value.exit_code == code


@pytest.mark.parametrize("how", ["safely", "now"])
def test_who_only_has_the_bench_loses_it_to_a_stop(on_edge: Acting, tmp_path: Path, how: Asking) -> None:
    async def act(edge: Edge) -> None:
        first = await edge.acquire("first")
        assert (await edge.execute(turn(20.0), "r1/op1/1", first)).outcome == "done"
        await asyncio.to_thread(ask_to_stop, bench_at(tmp_path / "shel"), first.token, how)
        while await edge.holder() is not None:
            await asyncio.sleep(0.01)
        with refused(ExitCode.LOCKED):
            await edge.execute(turn(20.0), "r1/op1/2", first)
        await edge.release(first)
        later = await edge.acquire("second")
        assert later.token > first.token
        assert (await edge.execute(turn(30.0), "r1/op1/3", later)).outcome == "done"
        await edge.release(later)

    on_edge(act)


def test_who_asks_for_a_bench_does_not_lift_the_halt_of_another(on_edge: Acting) -> None:
    async def act(edge: Edge) -> None:
        lease = await edge.acquire("first")
        await edge.halt()
        with refused(ExitCode.LOCKED):
            await edge.acquire("second")
        with refused(ExitCode.INTERRUPTED):
            await edge.execute(turn(20.0), "r1/op1/1", lease)
        await edge.release(lease)
        later = await edge.acquire("second")
        assert (await edge.execute(turn(20.0), "r1/op1/2", later)).outcome == "done"
        await edge.release(later)

    on_edge(act)


def test_only_the_last_runs_are_kept_for_who_follows_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(started, "KNOWN", 3)
    root = make_example("shel", tmp_path / "shel").root

    async def act() -> None:
        edge = edge_of(bench_at(root), "kinematic")
        for number in range(6):
            seen, angle = await edge.observe(), 10.0 + number
            planner = Planner(edge.setup, None, seen)
            plan = planner.plan(set_values(planner, "p1", {"angle": angle}))
            await edge.start(Job(plan=plan, holder="test"), f"r{number}")
            await edge.report(f"r{number}")
        assert len([event async for event in edge.events("r5")]) > 2
        assert len([event async for event in edge.events("r3")]) > 2
        with pytest.raises(PicoError, match="no run r2 was started here"):
            await edge.report("r2")
        assert edge.memory is not None and len(edge.memory.runs()) == 6
        await edge.close()

    asyncio.run(act())


def test_who_follows_a_run_hears_what_became_of_it_where_the_server_is_told_to_end(tmp_path: Path) -> None:
    root = make_example("shel", tmp_path / "shel").root
    with Bench.open(root) as planning:
        plan = planning.plan("e1")

    async def act(server: int) -> tuple[list[Event], RunReport]:
        path = place.find(bench_at(root))
        assert path is not None
        edge, events = RemoteEdge(SocketLine(path)), []
        await edge.start(Job(plan=plan, holder="test"), "r1")
        async for event in edge.events("r1"):
            events.append(event)
            if event.kind == "operation_started" and event.data["primitive"] == "move":
                os.kill(server, signal.SIGTERM)
        with pytest.raises(PicoError, match="about to end"):
            await edge.acquire("another")
        return events, await edge.report("r1")

    with served(root) as server:
        events, report = asyncio.run(act(server))
    assert events[-1].data["outcome"] == report.outcome == "interrupted"


def test_an_edge_that_stands_still_is_not_waited_for_without_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(line, "ANSWER", 0.2)
    root = make_example("shel", tmp_path / "shel").root
    with served(root) as server, Bench.open(root) as bench:
        assert bench.observe()
        os.kill(server, signal.SIGSTOP)
        try:
            for ask in (bench.observe, lambda: bench.edge.memory):
                with pytest.raises(PicoError, match="the edge does not answer"):
                    ask()
        finally:
            os.kill(server, signal.SIGCONT)
