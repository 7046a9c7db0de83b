"""The table of the guard in the documentation is the rule that its benchmark judges by."""

from __future__ import annotations

import runpy
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def test_the_page_on_laser_safety_has_the_table_of_the_benchmark() -> None:
    made = runpy.run_path(str(ROOT / ".ci" / "safety_table.py"))
    assert (ROOT / "docs/how-to/laser-safety.md").read_text() == made["page"](), "run `make docs`"


def test_light_can_stay_on_only_without_a_dead_man_and_with_nobody_left_to_close_anything() -> None:
    chain = runpy.run_path(str(ROOT / "benchmarks" / "safety_chain.py"))
    for fault in chain["FAULTS"]:
        assert (chain["bar"](fault, dead_man=False) is None) is (fault in ("frozen host", "killed guard"))
        within = chain["bar"](fault, dead_man=True)
        assert within <= (chain["WATCHDOG"] + 0.5 if fault in ("frozen host", "killed guard") else 1.0)
