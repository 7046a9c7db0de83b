"""Lasers whose arming is over are shut by whoever has the bench, and are forgotten only once they are: case by case."""

from __future__ import annotations

import asyncio
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bench_at import bench_at
from laser_lab import observed
from test_light_kept_in import EVENING, LIT, ONE, given, lab

from pico.edge import armings
from pico.edge.shutting import Shutting
from pico.model.arming import Licence
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult

SETUP = lab()


class Edge:
    """An edge in the midst of a run. `outcomes`: how its operations end one after the other, then `done`."""

    def __init__(self, root: Path, now: str, *outcomes: Any, **values: Any) -> None:
        self.setup, self.place, self.values = SETUP, bench_at(root), values
        self._now, self._outcomes, self.asked = now, list(outcomes), list[str]()
        self.licences = dict[str, Licence]()
        self.alone = SimpleNamespace(due=lambda: False)

    async def observe(self) -> Observation:
        return observed(self.licences, **self.values)

    async def describe(self) -> Any:
        return SimpleNamespace(name="sim", fidelity="kinematic")

    def now(self) -> str:
        return self._now

    def run_under_way(self) -> str | None:
        return "r1"

    async def perform(self, operation: Operation, key: str) -> OperationResult:
        self.asked.append(f"{operation.address} {operation.arguments['to']}")
        outcome = self._outcomes.pop(0) if self._outcomes else "done"
        if outcome == "done":
            own = {**self.values[operation.component], str(operation.arguments["tunable"]): operation.arguments["to"]}
            self.values[operation.component] = own
        return OperationResult(key=key, outcome=outcome)


def kept(edge: Edge) -> list[str]:
    return [one.laser for one in armings.kept(edge.place)]


def shut(edge: Edge, *, sees: bool = False) -> Shutting:
    shutting = Shutting(edge)  # type: ignore[arg-type]

    async def go() -> None:
        await shutting.shut_over(await edge.observe() if sees else None)

    asyncio.run(go())
    return shutting


@pytest.mark.parametrize("now", [ONE, EVENING])
@pytest.mark.parametrize("outcome", ["done", "failed", "unknown"])
@pytest.mark.parametrize("lit", [True, False])
def test_an_arming_that_is_over_is_kept_until_its_laser_is_shut(
    tmp_path: Path, now: str, outcome: str, lit: bool
) -> None:
    edge = Edge(tmp_path, now, outcome, laser=LIT if lit else {**LIT, "shutter": "closed"})
    armings.keep(edge.place, given())
    shutting, over = shut(edge), now == EVENING
    assert edge.asked == (["laser.shutter closed"] if over and lit else [])
    gone = over and (outcome == "done" or not lit)
    assert kept(edge) == ([] if gone else ["laser"])
    told = [(one.severity, one.address) for one in shutting.told()]
    assert told == ([("warning", "laser")] if gone and lit else []) and shutting.told() == ()
    if over and not gone:  # whoever looks next tries again
        assert [one.address for one in shut(edge).told()] == ["laser"]
        assert kept(edge) == [] and edge.asked == ["laser.shutter closed"] * 2


@pytest.mark.parametrize("sees", [True, False])
@pytest.mark.parametrize("licence", [None, "3R", "3B"])
def test_a_laser_that_shines_above_its_licence_is_shut_by_who_looks(
    tmp_path: Path, sees: bool, licence: Any
) -> None:  # fmt: skip
    edge = Edge(tmp_path, ONE, laser={**LIT, "power": 50.0})
    edge.licences = {"laser": Licence(laser_class=licence, by="Ada")} if licence else {}
    shut(edge, sees=sees)
    assert edge.asked == (["laser.shutter closed"] if sees and licence != "3B" else [])


def test_what_is_shut_at_once_is_shut_whatever_arms_it_and_what_could_not_be_is_said(tmp_path: Path) -> None:
    edge = Edge(tmp_path, ONE, "failed", laser=LIT, second={**LIT, "power": 50.0}, bare={"emission": False})
    armings.keep(edge.place, given())
    wrong = asyncio.run(Shutting(edge).shut(("laser", "second", "bare"), "it smokes"))  # type: ignore[arg-type]
    assert [(one.severity, one.address) for one in wrong] == [("error", "laser")]
    assert edge.asked == ["laser.shutter closed", "second.shutter closed"] and kept(edge) == ["laser"]


@pytest.mark.parametrize("jammed", ["failed", "unknown"])
def test_a_laser_that_cannot_be_shut_keeps_no_other_one_open(tmp_path: Path, jammed: str) -> None:
    edge = Edge(tmp_path, EVENING, jammed, laser=LIT, second={**LIT, "power": 50.0}, bare={"emission": False})
    for laser in ("laser", "second"):
        armings.keep(edge.place, given(laser=laser))
    told = shut(edge).told()
    assert edge.asked == ["laser.shutter closed", "second.shutter closed"] and kept(edge) == ["laser"]
    assert [one.address for one in told] == ["second"]
