"""A bench that somebody moves: others are told who, may wait, and may look."""

from __future__ import annotations

from pathlib import Path

from commanding import Pico

from pico.edge.lease import BenchLock


def test_movers_end_with_5_and_name_the_holder_and_reading_is_possible(shel: Path, pico: Pico) -> None:
    with BenchLock(shel).held("pico apply e2"):
        for words in (
            ("apply", "e1", "--auto-approve"),
            ("set", "p1", "angle=3", "-y"),
            ("apply", "e1", "--auto-approve", "--lock-timeout", "0.1"),
            ("move", "p1", "x=300", "y=420", "-y", "--lock-timeout", "0.1"),
        ):
            refused = pico(*words)
            assert refused.code == 5, words
            assert "pico apply e2" in refused.err
        for words in (("status",), ("plan", "e1"), ("verify",), ("drift",), ("catalog", "parts")):
            assert pico(*words).code != 5, words
    assert pico("set", "p1", "angle=3", "--lock-timeout", "5", "-y").code == 0


def test_only_movers_wait(pico: Pico, shel: Path) -> None:
    assert pico("status", "--lock-timeout", "3").code == 1
    assert pico("apply", "--lock-timeout", "-3").code == 1
