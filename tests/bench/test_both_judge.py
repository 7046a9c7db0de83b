"""Client and edge ask the same judges: whoever plans all, the edge again all that can refuse; light is traced once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import pico
from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.history.examples.example import make_example
from pico.policy import audit
from pico.policy.judging import judges
from pico.policy.judging.case import Judgment, PlanCase
from pico.policy.judging.judges import JUDGES, Judge

REFUSING = [one.name for one in JUDGES if one.refuses]


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[pico.Bench]:
    make_example("shel", tmp_path / "shel")
    with pico.open(tmp_path / "shel") as opened:
        yield opened


def spied(monkeypatch: pytest.MonkeyPatch, ask: Callable[[Judge, PlanCase], Judgment]) -> None:
    """Have every judge asked through `ask`."""

    def through(one: Judge) -> Judge:
        return replace(one, judge=lambda case: ask(one, case))

    monkeypatch.setattr(judges, "JUDGES", tuple(through(one) for one in JUDGES))


def test_client_and_edge_ask_the_same_judges_and_light_is_traced_once(
    bench: pico.Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pico.optics.audit import audit as tracing

    real, traced, asked = tracing.audit, list[Any](), list[tuple[str, PlanCase]]()
    monkeypatch.setattr(tracing, "audit", lambda *given: (traced.append(given), real(*given))[1])
    monkeypatch.setattr(audit, "_VERDICTS", {})

    def ask(one: Judge, case: PlanCase) -> Judgment:
        asked.append((one.name, case))
        return one.judge(case)

    spied(monkeypatch, ask)
    plan = bench.plan("e1")
    assert plan.operations and not plan.errored
    assert [name for name, _ in asked] == [one.name for one in JUDGES]
    assert len(traced) == 1
    asked.clear()
    assert bench.apply(plan).outcome == "done"
    before, after = ([name for name, case in asked if (case.present is None) is early] for early in (True, False))
    assert before == [one.name for one in JUDGES if one.refuses and not one.looks]
    assert after == REFUSING
    assert all(case.able is not None for _, case in asked)
    assert len(traced) == 1


@pytest.mark.parametrize("name", REFUSING)
def test_each_judge_keeps_an_edge_from_starting_a_plan(
    bench: pico.Bench, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = bench.plans.single("p1", "set", {"angle": "3"})
    wrong = Diagnostic("error", name, f"{name} says no")

    def ask(one: Judge, case: PlanCase) -> Judgment:
        return Judgment(denials=(wrong,), exit_code=ExitCode.DENIED) if one.name == name else one.judge(case)

    spied(monkeypatch, ask)
    with pytest.raises(PicoError, match=f"{name} says no") as caught:
        bench.apply(plan)
    assert caught.value.exit_code == ExitCode.DENIED
    monkeypatch.undo()
    assert bench.apply(plan).outcome == "done", "the bench was given back"
