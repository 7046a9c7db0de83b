"""A person at the table locks the bench: whose work is refused then, what never is, and who takes the lock off."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from bench_at import bench_at

from pico.base.state_files import TABLE_LOCK
from pico.bench.bench import Bench
from pico.bench.cut_short import told_first
from pico.diagnostics import ExitCode, PicoError
from pico.edge.guard import table_lock
from pico.edge.lease import on_behalf_of
from pico.history.examples.example import make_example
from pico.model.trace.unattended import Terms

ADA = "Ada Lovelace"


@pytest.fixture(scope="module")
def lit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A lab whose laser emits."""
    root = make_example("shel", tmp_path_factory.mktemp("locked") / "shel").root
    with Bench.open(root) as bench:
        for values in ({"emission": "true"}, {"shutter": "open"}):
            assert bench.apply(bench.single("laser", "set", **values)).outcome == "done"
    return root


@pytest.fixture
def lab(lit: Path, tmp_path: Path) -> Path:
    root = shutil.copytree(lit, tmp_path / "shel")
    table_lock.lock(bench_at(root), ADA, "mirrors are being cleaned")
    return root


@contextmanager
def refused(what: str) -> Iterator[None]:
    with pytest.raises(PicoError) as raised:
        yield
    said = raised.value.diagnostics[0]
    assert said.code == "table-lock" and raised.value.exit_code == ExitCode.LOCKED
    assert ADA in said.summary and "mirrors are being cleaned" in said.summary and what in said.summary
    assert "pico lease unlock" in said.hint


def terms() -> Terms:
    return Terms(recipe="night@20261124T230000Z-abcdef", laser_class="3R", until="2099-01-01T00:00:00Z", every=600.0)


def test_remote_work_is_refused_and_that_of_a_person_here_is_not(lab: Path) -> None:
    with Bench.open(lab) as bench:
        plan = bench.single("cam", "set", exposure="7")
        with on_behalf_of("bob"), refused("remote work"):
            bench.apply(plan)
        with on_behalf_of("bob"), refused("remote work"):
            bench.wait(bench.edge.acquire("bob"))
        assert any("locked the bench" in said.summary for said in told_first(bench, bench.observe()))
        assert bench.apply(plan).outcome == "done"


def test_unattended_work_is_refused_whoever_starts_it(lab: Path) -> None:
    with Bench.open(lab) as bench, refused("unattended work"):
        bench.wait(bench.edge.hold(terms()))


def test_nobody_is_kept_from_stopping_or_from_shutting_a_laser(lab: Path) -> None:
    with Bench.open(lab) as bench, on_behalf_of("bob"):
        bench.wait(bench.edge.halt())
        bench.wait(bench.edge.stop())
        assert bench.wait(bench.edge.disarm("laser", "bob"))
        assert bench.observe().components["laser"].values["shutter"].value == "closed"


def test_what_goes_on_for_somebody_far_away_lets_nothing_begin_but_what_ends_light(lab: Path) -> None:
    place = bench_at(lab)
    table_lock.unlock(place, ADA)
    with Bench.open(lab) as bench, on_behalf_of("bob"):
        from pico.model.operation import Operation, Reason

        def operation(to: str) -> Operation:
            return Operation(id=to, primitive="set", component="laser", reason=Reason(kind="asked"),
                             arguments={"tunable": "shutter", "to": to})  # fmt: skip

        custody = bench.edge.custody  # type: ignore[union-attr]

        async def perform() -> tuple[str, str]:
            lease = await bench.edge.acquire("bob")
            custody._obeying.cancel()  # else it ends the lease of who runs nothing
            table_lock.lock(place, ADA, "")
            shut = await custody.perform(operation("closed"), "r/closed/1")
            opened = await custody.perform(operation("open"), "r/open/1")
            await bench.edge.release(lease)
            return shut.outcome, opened.error.code if opened.error else opened.outcome

        assert bench.wait(perform()) == ("done", "table-lock")


def test_the_lock_outlives_every_process_and_only_who_put_it_on_takes_it_off(lab: Path) -> None:
    place = bench_at(lab)
    found = table_lock.read(place)
    assert found is not None and found.by == ADA
    for other in (lambda: table_lock.unlock(place, "Bob"), lambda: table_lock.lock(place, "Bob", "")):
        with pytest.raises(PicoError) as raised:
            other()
        assert raised.value.exit_code == ExitCode.LOCKED and ADA in raised.value.diagnostics[0].summary
    assert table_lock.lock(place, ADA, "").reason == "mirrors are being cleaned"
    assert table_lock.unlock(place, ADA) == found and table_lock.read(place) is None
    assert table_lock.unlock(place, ADA) is None


def test_a_lock_that_cannot_be_read_lets_nothing_remote_in(lab: Path) -> None:
    TABLE_LOCK.path(bench_at(lab).folder).write_bytes(b"{")
    with Bench.open(lab) as bench, on_behalf_of("bob"), pytest.raises(PicoError, match="cannot be read"):
        bench.wait(bench.edge.acquire("bob"))


def test_what_somebody_far_away_has_is_brought_to_its_safe_end_once_the_bench_is_locked(lab: Path) -> None:
    place = bench_at(lab)
    table_lock.unlock(place, ADA)
    with Bench.open(lab) as bench:
        custody = bench.edge.custody  # type: ignore[union-attr]
        with on_behalf_of("bob"):
            lease = bench.wait(bench.edge.acquire("bob"))
        table_lock.lock(place, ADA, "")
        began = time.monotonic()
        while not custody.halted:
            assert time.monotonic() - began < 5.0
            time.sleep(0.02)
        assert custody.why_ended() == "a person at the table locked the bench"
        bench.wait(bench.edge.release(lease))
        here = bench.wait(bench.edge.acquire("pico apply"))
        time.sleep(0.5)
        assert not custody.halted, "a person here goes on"
        bench.wait(bench.edge.release(here))
