"""A disk that is full, a journal that is damaged, a clock that is set back: said clearly, nothing moves unrecorded."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import apply, execute, plan_to, shel, sim

from pico.backends.sim.store import load_world
from pico.diagnostics import PicoError
from pico.edge.local import LocalEdge
from pico.model.diff import diff_observed

SETUP, C3 = shel("gantry")


def reached(root: Path) -> bool:
    return diff_observed(SETUP, asyncio.run(sim(SETUP, root).observe()), C3) == ()


def moved_unrecorded(bench: LocalEdge, before: dict[str, object]) -> list[str]:
    begun = {r.component for r in bench.journal.records() if r.kind == "started"}
    world, _ = load_world(SETUP, bench.place)
    return [n for n, body in world.components.items() if body.pose != before[n] and n not in begun]


def test_a_full_disk_ends_the_run_with_a_true_report_and_nothing_moves_unrecorded(tmp_path: Path) -> None:
    for pages in range(12, 26, 2):
        root = tmp_path / str(pages)
        bench = sim(SETUP, root)
        before: dict[str, object] = {n: b.pose for n, b in load_world(SETUP, bench_at(root))[0].components.items()}
        bench.journal._db.execute(f"PRAGMA max_page_count={pages}")
        planned = asyncio.run(plan_to(bench, C3))
        try:
            result, _ = asyncio.run(execute(bench, planned))
            assert result.outcome in ("interrupted", "done")
        except PicoError as exc:
            assert "full" in str(exc)
        assert moved_unrecorded(bench, before) == []
        bench.journal._db.execute("PRAGMA max_page_count=1000000")
        asyncio.run(bench.close())
        if not reached(root):
            assert apply(sim(SETUP, root), C3, "r2")[1].outcome == "done"
        assert reached(root)


def test_with_a_damaged_journal_looking_and_planning_go_on_and_nothing_moves(tmp_path: Path) -> None:
    path = tmp_path / ".pico/benches/sim" / "journal.sqlite"
    path.parent.mkdir(parents=True)
    path.write_bytes(b"this is no database " * 300)
    bench = sim(SETUP, tmp_path)
    planned = asyncio.run(plan_to(bench, C3))
    with pytest.raises(PicoError, match="damaged") as caught:
        asyncio.run(execute(bench, planned))
    assert str(path) in caught.value.diagnostics[0].summary
    assert "`pico doctor --journal`" in caught.value.diagnostics[0].hint
    assert not (tmp_path / ".pico/benches/sim" / "world.json").exists()
    path.rename(path.with_suffix(".broken"))
    assert apply(sim(SETUP, tmp_path), C3)[1].outcome == "done"


def test_a_clock_that_is_set_back_changes_no_order(tmp_path: Path) -> None:
    for number, time in enumerate(("2026-11-01T12:00:00Z", "2020-01-01T00:00:00Z", "2026-01-01T00:00:00Z")):
        bench = sim(SETUP, tmp_path, clock=lambda t=time: t)
        apply(bench, C3 if number != 1 else shel("gantry")[1], f"r{number}")
        asyncio.run(bench.close())
    bench = sim(SETUP, tmp_path)
    assert [r.run for r in bench.journal.runs()] == ["r0", "r1", "r2"]
    assert [r.seq for r in bench.journal.records()] == sorted(r.seq for r in bench.journal.records())


def test_a_file_where_the_folder_belongs_is_said_and_nothing_moves(tmp_path: Path) -> None:
    (tmp_path / ".pico").write_text("")
    bench = sim(SETUP, tmp_path)
    planned = asyncio.run(plan_to(sim(SETUP, tmp_path / "elsewhere"), C3))
    with pytest.raises(PicoError, match="cannot be"):
        asyncio.run(execute(bench, planned))
