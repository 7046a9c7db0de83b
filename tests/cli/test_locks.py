"""A bench that somebody moves: others are told who, may wait, and may look."""

from __future__ import annotations

from pathlib import Path

from bench_at import bench_at
from commanding import Pico, a_run_goes_on

from pico.edge.lease import BenchLock


def test_movers_end_with_5_and_name_the_holder_and_reading_is_possible(shel: Path, pico: Pico) -> None:
    with a_run_goes_on(shel, "pico apply e2"):
        for words in (
            ("apply", "e1", "--auto-approve"),
            ("set", "p1", "angle=3", "-y"),
            ("apply", "e1", "--auto-approve", "--lock-timeout", "0.1"),
            ("move", "p1", "x=300", "y=420", "-y", "--lock-timeout", "0.1"),
            ("commit", "-m", "in between"),
            ("capture",),
        ):
            refused = pico(*words)
            assert refused.code == 5, words
            assert "pico apply e2" in refused.err
        assert all("a run goes on: " in pico(word).err for word in ("status", "plan", "verify", "drift"))
        assert pico("plan", "--out", "my.plan").code == 0 and "goes-on" not in (shel / "my.plan").read_text()
        for words in (("status",), ("plan", "e1"), ("verify",), ("drift",), ("catalog", "parts")):
            assert pico(*words).code != 5, words
    assert pico("set", "p1", "angle=3", "--lock-timeout", "5", "-y").code == 0


def test_who_has_the_bench_for_an_instant_refuses_no_commit(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    pico("sim", "nudge", "p2", "--dx", "4")
    with BenchLock(bench_at(shel)).held("sim nudge p1"):
        assert pico("status").err == "shel · sim\n" and pico("commit", "-m", "p2", "--capture").code == 0


def test_only_movers_wait(pico: Pico, shel: Path) -> None:
    assert pico("status", "--lock-timeout", "3").code == 1
    assert pico("apply", "--lock-timeout", "-3").code == 1
