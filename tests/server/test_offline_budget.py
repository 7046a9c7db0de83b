"""An optimization that declares for how long it may go on by itself does so where its bench is cut off; others end."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from coordinators import Served
from edges import Connected, client, connected
from test_lapsing import lost, until

from pico.bench.bench import Bench
from pico.control.gate import OFFLINE
from pico.control.leases import TTL
from pico.edge.network.offline import offline
from pico.edge.protocol import Job
from pico.history.examples.example import make_example
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.optimize.loop import STOPPED

GOAL = ("center", "ly_150", "cam")
CUT = 3
"""How often an optimization that the client knows begun asks whether it may go on before its edge is cut off."""


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Setup, dict[float | None, Plan]]:
    """A lab with light on its camera, and plans to a goal by what they declare."""
    root = make_example("shel", tmp_path_factory.mktemp("offline") / "shel").root
    with Bench.open(root) as bench:
        bench.apply("e1")
        goals = bench.goals
        plans = {said: goals.plan(goals.chosen(GOAL, offline=said)) for said in (None, 0.0, 5.0, OFFLINE)}
        return root, bench.setup, plans


@pytest.fixture
def edge(coordinator: Served, planned: tuple[Path, Setup, object], tmp_path: Path) -> Iterator[Connected]:
    shutil.copytree(planned[0], tmp_path / "shel")
    with connected(coordinator, tmp_path / "shel") as found:
        yield found


@pytest.mark.slow
@pytest.mark.parametrize(("said", "past", "goes_on"), [(OFFLINE, 1.0, True), (None, 1.0, False), (5.0, 6.0, False)])
def test_it_goes_on_beyond_the_lease_for_so_long_as_it_declares(
    coordinator: Served, edge: Connected, planned: tuple[Path, Setup, dict[float | None, Plan]],
    said: float | None, past: float, goes_on: bool,
) -> None:  # fmt: skip
    granting, real, asked = edge.uplink.granting, edge.uplink.granting.clock, edge.edge.custody.stops
    times, begun = 0, False

    def stops() -> object:
        nonlocal times
        times += begun
        if times == CUT:
            edge.uplink._enrolment = lost(edge)
            edge.cut()
            granting.clock = lambda: real() + TTL + past
        return asked()

    edge.edge.custody.stops = stops  # type: ignore[assignment, method-assign]
    with client(coordinator, coordinator.person("anna", "operator@shel")) as anna:
        anna.ask("start", Job(plan=planned[2][said], holder="pico optimize"), "r1")
        begun = True
        until(lambda: edge.edge.memory is not None and edge.edge.memory.document("r1") is not None)
        until(lambda: not edge.edge.runs.started.goes_on_with("r1"))
    memory = edge.edge.memory
    assert memory is not None
    (end,) = [r for r in memory.records(run="r1") if r.kind == "done" and "algorithm" in r.data.get("data", {})]
    assert times >= CUT and end.data["data"]["met"] is goes_on
    assert (end.data["data"]["why"] == STOPPED) is not goes_on
    until(lambda: not granting.lapsed and granting.gate.budget == 0.0)  # nothing goes on any more


def test_what_is_declared_is_capped_by_the_lab(planned: tuple[Path, Setup, dict[float | None, Plan]]) -> None:
    _, setup, plans = planned
    assert [offline(setup, plans[said]) for said in (None, 0.0, 5.0, OFFLINE)] == [0.0, 0.0, 5.0, OFFLINE]
    strict = replace(setup, lab=replace(setup.lab, policy=replace(setup.lab.policy, offline=2.0)))
    assert [offline(strict, plans[said]) for said in (None, 5.0, OFFLINE)] == [0.0, 2.0, 2.0]
