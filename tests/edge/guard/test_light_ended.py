"""Light that ends beside any run stands in the journal, in a run of its own or in the one under way."""

from __future__ import annotations

import asyncio
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from threading import Thread
from types import SimpleNamespace
from typing import Any

import pytest
from bench_at import bench_at
from laser_lab import bench

from pico.backends.device import Capabilities
from pico.backends.hardware.guard.ending import Closing, LightEnd
from pico.backends.hardware.guard.note import Ended
from pico.base.state_files import JOURNAL, LOCK
from pico.diagnostics import PicoError, error
from pico.edge import armings, emission
from pico.edge.guard.journaling import record_ended
from pico.edge.local import LocalEdge
from pico.model.arming import Arming, ArmingPolicy, LaserRole
from pico.places.bench import BenchPlace
from pico.runs.journal import Journal

SETUP = bench()
ENDS = (
    LightEnd(laser="laser", closings=(Closing(address="laser.shutter", dark=True),)),
    LightEnd(laser="bare", closings=(Closing(address="bare.emission", dark=False, wrong="it still reads on"),)),
    LightEnd(laser="second", closings=()),
)


async def _describe() -> Capabilities:
    return Capabilities(
        name="hardware", fidelity="physics", evidence="hardware", lab_digest=SETUP.digest(),
        primitives=frozenset(), robots=(),
    )  # fmt: skip


DEVICE: Any = SimpleNamespace(describe=_describe)


@pytest.mark.parametrize("within", [False, True])
def test_each_device_is_an_operation_of_the_run_under_way_or_of_one_of_its_own(tmp_path: Path, within: bool) -> None:
    path = JOURNAL.path(bench_at(tmp_path).folder)
    ended = Ended(at="2026-11-24T12:00:00Z", why="door_box (door) is not safe", ends=ENDS)
    with closing(Journal(path)) as journal:
        if within:
            journal.begin_run("r1", "sha256:p", "ada")
        record_ended(SETUP, DEVICE, path, ended, "r1" if within else None, 0)
        (run,) = journal.runs()
        assert (run.holder, run.outcome) == (("ada", None) if within else ("the guard", "failed"))
        done = {r.component: (r.kind, r.data.get("error", {}).get("summary")) for r in journal.records(run=run.run)}
        assert done == {"laser": ("done", None), "bare": ("failed", "bare.emission: it still reads on")}
        assert journal.unsettled() == ()
        intents = [r.data["reason"]["text"] for r in journal.records(run=run.run) if r.kind == "intent"]
        assert set(intents) == {"the guard ended light: door_box (door) is not safe"}


def test_it_is_written_from_any_loop_that_runs(tmp_path: Path) -> None:
    path = JOURNAL.path(bench_at(tmp_path).folder)
    ended = Ended(at="2026-11-24T12:00:00Z", why="a person stopped the bench", ends=ENDS[:1], by="a stop")

    async def within() -> None:
        await asyncio.to_thread(record_ended, SETUP, DEVICE, path, ended, None, 0)

    asyncio.run(within())
    with closing(Journal(path)) as journal:
        assert [(run.holder, run.outcome) for run in journal.runs()] == [("a stop", "done")]


def test_a_journal_that_was_locked_for_long_has_the_entry_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"{Journal.__module__}.PATIENCE", 0.05)
    monkeypatch.setattr(f"{record_ended.__module__}.AGAIN", 0.05)
    path = JOURNAL.path(bench_at(tmp_path).folder)
    Journal(path).close()
    ended = Ended(at="2026-11-24T12:00:00Z", why="a person stopped the bench", ends=ENDS[:1], by="a stop")
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        writing = Thread(target=record_ended, args=(SETUP, DEVICE, path, ended, None, 0))
        writing.start()
        writing.join(0.3)
        assert writing.is_alive(), "it tries again"
        other.execute("ROLLBACK")
    writing.join(10.0)
    with closing(Journal(path)) as journal:
        assert [(run.holder, run.outcome) for run in journal.runs()] == [("a stop", "done")]


LATER, NOW = "2099-11-24T12:00:00Z", "2026-11-24T12:00:00Z"


def armed(place: BenchPlace, laser: str, of: Any, begins: str = "2026-11-24T10:00:00Z") -> None:
    armings.keep(place, Arming(laser=laser, by="Ada", role="user", laser_class=of, begins=begins, ends=LATER,
                               backend="hardware"))  # fmt: skip


def test_what_arms_lasers_above_class_2_is_over_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place, roles = bench_at(tmp_path), {"user": LaserRole(people=("Ada",), laser_class="3B")}
    policy = replace(SETUP.lab.policy, arming=ArmingPolicy(roles=roles))
    setup = replace(SETUP, lab=replace(SETUP.lab, policy=policy))
    armed(place, "laser", "3B")
    armed(place, "bare", "3R", LATER)
    armed(place, "second", "2")
    assert emission.disarm_all(setup, place, "a stop", NOW) == ("bare", "laser")
    over = emission.over(setup, place, NOW)
    assert over == {"bare": "a stop disarmed it", "laser": "a stop disarmed it"}
    assert emission.disarm_all(setup, place, "the guard", NOW) == (), "it is over already"

    def full(*_: Any, **__: Any) -> None:
        raise PicoError(error("unwritable", "the disk is full"))

    armed(place, "laser", "3B")
    monkeypatch.setattr(armings, "keep", full)
    assert emission.disarm_all(setup, place, "a stop", NOW) == ("laser",)
    assert "laser" not in {one.laser for one in armings.kept(place)}


def test_light_that_ended_is_told_as_such_if_the_lock_is_no_file(tmp_path: Path) -> None:
    place = bench_at(tmp_path)
    LOCK.path(place.folder).mkdir(parents=True)
    edge = LocalEdge(SETUP, place, lambda setup: DEVICE)
    edge._light_ended(
        Ended(at="2026-11-24T12:00:00Z", why="a person stopped the bench", ends=ENDS[:1], by="a stop"), None
    )
