"""Estimates on a bench with devices come from what earlier operations took there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pico.manifest.load import load_folder
from pico.model.operation import Operation, Reason
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.planning.passes.schedule import schedule
from pico.runs.durations import as_measured, measured_durations
from pico.runs.journal import JournalRecord


@pytest.fixture(scope="module")
def setup() -> Setup:
    return load_folder(Path(__file__).resolve().parents[2] / "labs" / "shel").require()[0]


MOVE = Operation(
    id="op1", primitive="move", component="p2", robot="arm1", resources=("arm1", "p2"), reason=Reason(kind="asked"),
    seconds=6.0,
)  # fmt: skip
SET = Operation(
    id="op2", primitive="set", component="cam", arguments={"tunable": "exposure", "to": 5.0},
    resources=("cam.exposure", "cam"), reason=Reason(kind="asked"), seconds=0.1,
)  # fmt: skip


def records(*done: tuple[Operation, float]) -> list[JournalRecord]:
    found: list[JournalRecord] = []
    for n, (op, took) in enumerate(done):
        own: dict[str, Any] = {"seq": 2 * n, "key": f"r{n}/op/1", "component": op.component, "digest": "", "token": 1}
        found.append(JournalRecord(**own, kind="intent", at="", data=as_json(op)))
        found.append(JournalRecord(**{**own, "seq": 2 * n + 1}, kind="done", at="", data={"seconds": took}))
    return found


def test_a_plan_takes_as_long_as_earlier_operations_took(setup: Setup) -> None:
    durations = measured_durations(setup, records((MOVE, 120.0), (replace(MOVE, seconds=5.0), 95.0), (SET, 2.5)))
    move, exposure = as_measured(setup, (MOVE, SET), durations)
    assert move.seconds == pytest.approx(6.0 * 19.5) and move.nominal == 6.0, "the median of 20 and 19 times"
    assert exposure.seconds == pytest.approx(2.5) and exposure.nominal == 0.1
    assert schedule((move,))[0].seconds == move.seconds
    again = measured_durations(setup, records((MOVE, 120.0), (move, 117.0), (move, 117.0)))
    assert as_measured(setup, (MOVE,), again)[0].seconds == pytest.approx(117.0), "what was measured is not taken twice"


def test_what_was_never_done_there_takes_what_its_path_says(setup: Setup) -> None:
    assert as_measured(setup, (MOVE, SET), measured_durations(setup, records((SET, 2.5))))[0] == MOVE
    many = records((MOVE, 60.0), *[(MOVE, 12.0)] * 10)
    assert as_measured(setup, (MOVE,), measured_durations(setup, many))[0].seconds == pytest.approx(12.0)
