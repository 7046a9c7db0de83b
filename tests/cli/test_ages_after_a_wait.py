"""Ages on a simulated bench are counted by its own clock, which `pico sim wait` moves on."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commanding import Brought, Pico
from test_optimize_command import light_on_camera

from pico.base.clock import seconds_on_bench


@pytest.fixture
def aligned(shel: Path, brought: Brought, pico: Pico) -> Path:
    brought(light_on_camera)
    assert pico("optimize", "centred", "--yes").code == 0
    return shel


@pytest.mark.parametrize("time", ["9h", "9 h", "32400"])
def test_what_lies_before_a_wait_is_as_old_as_that(aligned: Path, pico: Pico, time: str) -> None:
    assert "aligned, just now" in pico("optimize").out
    assert pico("sim", "wait", time).code == 0
    assert "aligned, 9 h ago" in pico("optimize").out
    assert "sim" in (row := next(r for r in pico("bench").out.splitlines() if "last run" in r)) and "9 h ago" in row


def test_a_goal_is_stale_once_its_time_has_passed_on_the_bench(aligned: Path, pico: Pico) -> None:
    assert pico("sim", "wait", "13 h").code == 0
    said = " ".join(pico("optimize").out.split())
    assert "stale, 13 h ago" in said and "older than 12 h" in said


def test_a_morning_says_how_long_ago_its_reference_was_on_the_bench(aligned: Path, pico: Pico) -> None:
    assert pico("morning", "--yes", "--accept").code == 0
    assert pico("sim", "wait", "9 h").code == 0
    found = json.loads(pico("morning", "--yes", "--json").out.splitlines()[-1])
    assert found["age"] == pytest.approx(9 * 3600, abs=60)


def test_only_waits_between_two_times_count() -> None:
    waits = (("2026-01-01T10:00:00Z", 100.0), ("2026-01-01T12:00:00Z", 1000.0))
    assert seconds_on_bench("2026-01-01T11:00:00Z", "2026-01-01T13:00:00Z", waits) == 8200
    assert seconds_on_bench("2026-01-01T09:00:00Z", "2026-01-01T11:00:00Z", waits) == 7300
    assert seconds_on_bench("2026-01-01T13:00:00Z", "2026-01-01T14:00:00Z", waits) == 3600
    assert seconds_on_bench("2026-01-01T13:00:00Z", "2026-01-01T14:00:00Z") == 3600
