"""Calls of a client through a coordinator to an enrolled edge: one lease, written before it is sent, done once."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from coordinators import BENCH, Served
from edges import Client, Connected, client, connected, refusal
from sqlalchemy import select, update

from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.protocol import Job
from pico.history.examples.example import make_example
from pico.model.operation import Operation, Reason
from pico.model.plan import Plan
from pico.planning import Planner, set_values
from pico.server.relay import dispatch
from pico.server.store.commands import CommandRows
from pico.server.store.tables import commands

ANNA = ("operator@shel",)


@pytest.fixture(scope="session")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("relay") / "shel").root


@pytest.fixture
def root(example: Path, tmp_path: Path) -> Path:
    shutil.copytree(example, tmp_path / "shel")
    return tmp_path / "shel"


@pytest.fixture
def edge(coordinator: Served, root: Path) -> Iterator[Connected]:
    with connected(coordinator, root) as found:
        yield found


@pytest.fixture
def anna(coordinator: Served, edge: Connected) -> Iterator[Client]:
    with client(coordinator, coordinator.person("anna", *ANNA)) as found:
        yield found


def turning(edge: Connected, anna: Client, angle: float) -> Plan:
    """A plan that turns one polarizer, made of what is seen through the coordinator."""
    planner = Planner(edge.edge.setup, None, anna.ask("observe"))
    return planner.plan(set_values(planner, "p1", {"angle": angle}))


def turn(angle: float) -> Operation:
    return Operation(
        id="op1", primitive="set", component="p1", arguments={"tunable": "angle", "to": angle},
        reason=Reason(kind="asked"),
    )  # fmt: skip


def test_looking_planning_and_applying_through_the_coordinator(
    coordinator: Served, edge: Connected, anna: Client
) -> None:
    assert anna.ask("describe").name == "sim" and anna.ask("holder") is None
    plan = turning(edge, anna, 33.0)
    assert anna.ask("start", Job(plan=plan, holder="pico apply"), "r1") == "r1"
    assert anna.events("r1")[-1]["data"]["outcome"] == "done"
    assert anna.ask("report", "r1").outcome == "done"
    assert anna.ask("observe").components["p1"].values["angle"].value == pytest.approx(33.0, abs=0.01)
    assert [r.run for r in anna.ask("memory.runs")] == ["r1"]
    (about,) = anna.ask("memory.about", "r1")[0]
    assert about["operator"] == "anna"
    free(coordinator)
    row = coordinator.books.leases.shown(BENCH)[0]
    assert row.token == edge.uplink.granting.gate.memory.fenced == 1


def free(coordinator: Served) -> None:
    """Wait until nobody has the bench."""
    until(lambda: coordinator.books.leases.shown(BENCH)[0].grant is None)


def test_what_is_asked_again_under_its_lease_is_answered_and_not_done_again(edge: Connected, anna: Client) -> None:
    number = anna.begin("acquire", "test", 0.0)
    lease = anna.answer(number)["value"]
    first = anna.ask("execute", turn(20.0), "r1/op1/1", lease)
    again = anna.ask("execute", turn(20.0), "r1/op1/1", lease)
    assert first == again and first.outcome == "done"
    assert [r.kind for r in anna.ask("memory.records", None, "r1/op1/1")] == ["intent", "started", "done"]
    other = refusal(anna, "execute", turn(30.0), "r1/op1/1", lease)
    assert "other content" in other.diagnostics[0].summary
    anna.close(number)
    assert anna.ask("holder") is None
    late = refusal(anna, "execute", turn(30.0), "r1/op2/1", lease)
    assert late.exit_code == ExitCode.LOCKED


def test_what_an_ended_lease_left_open_in_the_books_is_settled_once_the_next_one_counts(
    coordinator: Served, edge: Connected, anna: Client
) -> None:
    number = anna.begin("acquire", "test", 0.0)
    lease = anna.answer(number)["value"]
    anna.ask("execute", turn(20.0), "r1/op1/1", lease)
    rows, database = CommandRows(coordinator.books.database), coordinator.books.database
    rows.submitted(BENCH, lease["token"], "never sent", "digest", "{}")
    until(lambda: rows.open(BENCH) == ("never sent",))  # its answer is written
    with database.writing() as connection:  # as if what it was answered could not be written
        of = update(commands).where(commands.c.key == "r1/op1/1/1")
        connection.execute(of.values(state="waiting", result=""))
    anna.close(number)
    assert len(rows.open(BENCH)) == 2
    anna.ask("world.nudge", "p1", 1.0, 0.0, 0.0)
    until(lambda: not rows.open(BENCH))
    with database.reading() as connection:
        states = {row.key: row.state for row in connection.execute(select(commands))}
    assert states.pop("never sent") == "withdrawn" and set(states.values()) == {"done"}


def until(so: Callable[[], bool]) -> None:
    """Wait until something is so, at most 10 s."""
    end = time.monotonic() + 10.0
    while not so():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_who_has_the_bench_is_told_by_the_name_that_the_coordinator_knows(
    coordinator: Served, edge: Connected, anna: Client
) -> None:
    number = anna.begin("acquire", "a long look", 0.0)
    assert "value" in anna.answer(number)
    with client(coordinator, coordinator.person("ben", *ANNA), "s2") as ben:
        who = ben.ask("holder")
        assert who is not None and (who.user, who.what) == ("anna", "a long look")
        locked = refusal(ben, "acquire", "mine", 0.0)
        assert locked.exit_code == ExitCode.LOCKED and "in use by anna" in locked.diagnostics[0].summary
        waiting = ben.begin("acquire", "mine", 30.0)
        anna.close(number)
        lease = ben.answer(waiting)["value"]
        assert lease["token"] == 2
    with client(coordinator, coordinator.person("cleo", *ANNA), "s3") as cleo:  # ben is gone, and so is his lease
        assert cleo.ask("acquire", "next", 30.0).token == 3


def test_an_enrolled_bench_is_granted_by_its_coordinator_alone(edge: Connected, anna: Client, root: Path) -> None:
    with Bench.open(root) as bench:
        assert bench.observe()
        with pytest.raises(PicoError, match="enrolled as shel/bench1") as caught:
            bench.apply(bench.single("p2", "move", x=560))
    assert caught.value.exit_code == ExitCode.LOCKED


def test_what_hinders_an_edge_from_a_lease_is_told_and_over_once_it_is_mended(
    edge: Connected, anna: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, gate = turning(edge, anna, 33.0), edge.uplink.granting._kept

    def full(token: int) -> None:
        raise PicoError(error("gate", "the disk is full"))

    with monkeypatch.context() as broken:
        broken.setattr(dispatch, "HINDERED", 0.1)
        broken.setattr(gate, "fence", full)
        refused = refusal(anna, "start", Job(plan=plan, holder="pico apply"), "r1")
    assert refused.exit_code is ExitCode.LOCKED
    assert refused.diagnostics[0].summary.endswith("does not get ready for a lease: the disk is full")
    assert anna.ask("start", Job(plan=plan, holder="pico apply"), "r2") == "r2"
    assert anna.events("r2")[-1]["data"]["outcome"] == "done"


def test_roles_are_asked_for_before_anything_is_handed_on(coordinator: Served, edge: Connected) -> None:
    with client(coordinator, coordinator.person("vera", "viewer@shel")) as vera:
        assert vera.ask("observe")
        for call, arguments in (("acquire", ("x", 0.0)), ("world.nudge", ("p1", 1.0, 0.0, 0.0)), ("cancel", ("r1",))):
            assert refusal(vera, call, *arguments).exit_code == ExitCode.DENIED
        vera.ask("halt")
    assert coordinator.books.leases.shown(BENCH)[0].token == 0


def test_the_simulated_world_is_changed_under_a_lease_of_its_own(
    coordinator: Served, edge: Connected, anna: Client
) -> None:
    before = anna.ask("observe").components["p1"].pose
    anna.ask("world.nudge", "p1", 2.0, 0.0, 0.0)
    after = anna.ask("observe").components["p1"].pose
    assert after.x - before.x == pytest.approx(2.0, abs=0.5)
    free(coordinator)
    assert [a["deed"] for a in audit(coordinator)] == ["granted", "released"]


def audit(coordinator: Served) -> list[dict[str, object]]:
    """The audit of leases."""
    from pico.server.store.ordered import read_audit

    with coordinator.books.database.reading() as connection:
        return [row for row in read_audit(connection) if row["deed"] in ("granted", "stolen", "released", "lapsed")]


def test_calls_over_http(coordinator: Served, edge: Connected) -> None:
    token = coordinator.person("anna", *ANNA)
    with client(coordinator, token) as anna:
        plan = turning(edge, anna, 12.0)
    from pico.model.record import as_json

    at = f"/api/benches/{BENCH}/calls"
    job = as_json(Job(plan=plan, holder="test"))
    assert coordinator.ask("POST", f"{at}/start", token, {"with": [job, "r9"]}) == (200, {"value": "r9"})
    status, report = coordinator.ask("POST", f"{at}/report", token, {"with": ["r9"]})
    assert status == 200 and report["value"]["outcome"] == "done"
    viewer = coordinator.person("vera", "viewer@shel")
    assert coordinator.ask("POST", f"{at}/start", viewer, {"with": [job, "r9"]})[0] == 403
    assert coordinator.ask("POST", f"{at}/acquire", token, {"with": ["x", 0.0]})[0] in (404, 405)


def test_a_line_that_is_cut_is_dialled_again_and_a_run_goes_on(edge: Connected, anna: Client) -> None:
    plan = turning(edge, anna, 50.0)
    assert anna.ask("start", Job(plan=plan, holder="test"), "r1") == "r1"
    edge.cut()
    assert anna.ask("report", "r1").outcome == "done"
    edge.cut()
    assert anna.ask("observe").components["p1"].values["angle"].value == pytest.approx(50.0, abs=0.01)
