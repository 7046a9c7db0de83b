"""What an enrolled edge does where its lease is over: stolen, cut off, or with one of the two started anew."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from bench_at import bench_at
from coordinators import BENCH, Served
from edges import Client, Connected, client, connected, refusal

from pico.base.clock import now
from pico.bench.bench import Bench
from pico.control.leases import TTL
from pico.diagnostics import ExitCode
from pico.edge.network.enrolment import Enrolment
from pico.edge.protocol import Job
from pico.edge.remembering import Remembering
from pico.history.examples.example import make_example
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.server.store.ordered import read_events

WAITS = 30.0


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Plan]:
    """A lab, and a plan of many moves in it."""
    root = make_example("shel", tmp_path_factory.mktemp("lapsing") / "shel").root
    with Bench.open(root) as bench:
        return root, bench.plan("e1")


@pytest.fixture
def root(planned: tuple[Path, Plan], tmp_path: Path) -> Path:
    shutil.copytree(planned[0], tmp_path / "shel")
    return tmp_path / "shel"


@pytest.fixture
def edge(coordinator: Served, root: Path) -> Iterator[Connected]:
    with connected(coordinator, root) as found:
        yield found


@pytest.fixture
def anna(coordinator: Served, edge: Connected) -> Iterator[Client]:
    with client(coordinator, coordinator.person("anna", "operator@shel")) as found:
        yield found


def until(true: Callable[[], bool]) -> None:
    """Wait until something is so."""
    end = time.monotonic() + WAITS
    while not true():
        assert time.monotonic() < end, "it did not become so"
        time.sleep(0.01)


def begun(anna: Client, plan: Plan, run: str = "r1") -> int:
    """Start a run, and return the number of the call that follows it, once its first part is moved."""
    assert anna.ask("start", Job(plan=plan, holder="pico apply"), run) == run
    events = anna.begin("events", run, 0)
    while (said := anna.answer(events))["next"]["kind"] != "operation_started":
        pass
    assert said["next"]["run"] == run
    return events


def outcome(edge: Connected, run: str = "r1") -> str | None:
    """How a run ended, by the journal."""
    memory = edge.edge.memory
    assert memory is not None
    return next(one.outcome for one in memory.runs() if one.run == run)


def starts(edge: Connected) -> list[str]:
    """The keys of all that began to move."""
    memory = edge.edge.memory
    assert memory is not None
    return [record.key for record in memory.records() if record.kind == "started"]


def parked(edge: Connected) -> bool:
    """Whether all arms are at their place, with nothing in their hands."""
    robots = edge.edge.setup.lab.robots
    return all(not one.holding and robots[name].is_parked(one.joints) for name, one in seen(edge).robots.items())


def seen(edge: Connected) -> Observation:
    """What the edge sees now."""
    import asyncio

    return asyncio.run_coroutine_threadsafe(edge.edge.observe(), edge.loop).result(WAITS)


def test_a_lease_that_is_stolen_ends_the_run_safely_before_the_next_one_begins(
    coordinator: Served, edge: Connected, anna: Client, planned: tuple[Path, Plan]
) -> None:
    begun(anna, planned[1])
    thief = coordinator.person("ben", "operator@shel", "lease:steal@shel")
    body = {"session": "s2", "reason": "it smokes"}
    status, _ = coordinator.ask("POST", f"/api/benches/{BENCH}/lease/steal", thief, body)
    assert status in (200, 202)
    until(lambda: edge.uplink.granting.gate.memory.fenced == 2)
    assert outcome(edge) == "interrupted"
    assert [d.summary[:19] for d in anna.ask("report", "r1").diagnostics if d.code == "ended"] == [
        "its lease was over:"
    ]
    with client(coordinator, thief, "s2") as ben:
        until(lambda: coordinator.books.leases.shown(BENCH)[0].grant.fenced)  # type: ignore[union-attr]
        assert ben.ask("start", Job(plan=mended(ben, planned[1]), holder="test"), "r2") == "r2"
        assert ben.ask("report", "r2").outcome == "done"
    moved = [r for r in edge.edge.memory.records() if r.kind == "started"]  # type: ignore[union-attr]
    assert [r.token for r in moved] == sorted(r.token for r in moved)


def test_who_stopped_a_run_is_told_in_its_report(
    coordinator: Served, edge: Connected, anna: Client, planned: tuple[Path, Plan], monkeypatch: pytest.MonkeyPatch
) -> None:
    from pico.backends.sim.session import WorldSession

    tell = WorldSession._tell

    def telling(self: WorldSession, *what: object) -> None:
        tell(self, *what)  # type: ignore[arg-type]
        time.sleep(0.1)  # or it could be over before it is stopped

    monkeypatch.setattr(WorldSession, "_tell", telling)
    begun(anna, planned[1])
    with client(coordinator, coordinator.person("vera", "viewer@shel"), "s3") as vera:
        vera.ask("halt")
    report = anna.ask("report", "r1")
    assert report.outcome == "interrupted"
    assert [d.summary for d in report.diagnostics if d.code == "ended"] == ["vera stopped it"]


def mended(ben: Client, plan: Plan) -> Plan:
    """A plan of nothing, made of what stands on the table now."""
    from dataclasses import replace

    from pico.model.observation import live_state
    from pico.model.plan import Target
    from pico.model.setup import Setup
    from pico.planning import PlanGoal, Planner

    seen, setup = ben.ask("observe"), _setup(ben)
    assert isinstance(setup, Setup)
    goal = PlanGoal(live_state(setup, seen), Target(title="as it is", cause="recording"), operations=())
    return replace(Planner(setup, None, seen).plan(goal), lab=plan.lab)


def _setup(ben: Client) -> object:
    from pico.edge.own_lab import setup_of

    return setup_of(ben.ask("lab"))


def test_an_edge_that_is_cut_off_parks_when_its_lease_is_over_and_starts_nothing_more(
    coordinator: Served, edge: Connected, anna: Client, planned: tuple[Path, Plan]
) -> None:
    begun(anna, planned[1])
    granting, real = edge.uplink.granting, edge.uplink.granting.clock
    there = edge.uplink._enrolment
    edge.uplink._enrolment = lost(edge)
    edge.cut()
    granting.clock = lambda: real() + TTL + 1.0
    until(lambda: outcome(edge) == "interrupted" and edge.edge.run_under_way() is None)
    until(lambda: granting.lapsed is False and parked(edge))
    memory = edge.edge.memory
    assert memory is not None
    late = {one.holder for one in memory.runs() if one.run != "r1"}
    assert late <= {"the edge"}
    started = [r for r in memory.records(run="r1") if r.kind == "started"]
    assert len(started) < len(planned[1].operations)
    edge.uplink._enrolment, granting.clock = there, real
    until(lambda: left(coordinator) == [[]])
    until(lambda: edge.uplink._left is None)
    assert left(coordinator) == [[]], "it is told once"


def left(coordinator: Served) -> list[list[str]]:
    """What could not be done, each time that the bench was left because its lease was over, as those who watch hear."""
    with coordinator.books.database.reading() as connection:
        return [event["data"]["wrong"] for event in read_events(connection, 0) if event["kind"] == "left"]


def lost(edge: Connected) -> Enrolment:
    """An enrolment that leads nowhere."""
    from dataclasses import replace

    return replace(edge.uplink._enrolment, url="http://127.0.0.1:9")


def test_a_run_that_was_cut_short_with_its_edge_is_known_afterwards_and_not_begun_again(
    coordinator: Served, root: Path, planned: tuple[Path, Plan]
) -> None:
    token = coordinator.person("anna", "operator@shel")
    with ExitStack() as first:
        edge = first.enter_context(connected(coordinator, root))
        anna = first.enter_context(client(coordinator, token))
        begun(anna, planned[1])
        first.pop_all().__exit__(RuntimeError, None, None)
    fenced, moved = edge.uplink.granting.gate.memory.fenced, starts(edge)
    with connected(coordinator, root) as again, client(coordinator, token) as anna:
        assert again.uplink.granting.gate.memory.fenced == fenced
        until(lambda: not again.uplink.granting.gate.memory.unsettled)
        until(lambda: coordinator.books.leases.shown(BENCH)[0].grant is None)
        assert starts(again) == moved
        missing = refusal(anna, "report", "r1")
        assert missing.diagnostics[0].code == "no-run" and missing.exit_code == ExitCode.ERROR


def test_an_edge_that_was_killed_during_a_run_closes_shutters_when_it_comes_back(
    coordinator: Served, root: Path
) -> None:
    with Bench.open(root) as bench:
        bench.apply("e1")
        assert lit(bench.observe())
    remembers = Remembering(bench_at(root), now)
    with connected(coordinator, root) as edge:  # of a run that ended what is as it should be stays
        until(lambda: edge.uplink._link is not None)
        assert lit(seen(edge))
    remembers.journal.begin_run("cut-short", "sha256:0", "pico apply")
    remembers.begun("cut-short")
    remembers.close()
    with connected(coordinator, root) as edge:
        until(lambda: not lit(seen(edge)))


def lit(seen: Observation) -> bool:
    """Whether light leaves the laser."""
    return seen.components["laser"].values["shutter"].value == "open"
