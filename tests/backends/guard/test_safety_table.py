"""The table of the guard in the documentation is the rule that its benchmark judges by."""

from __future__ import annotations

import asyncio
import runpy
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from pico.edge.link.server import edge_of
from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "benchmarks"))

from safety_acts import refuses_teleoperation  # noqa: E402
from safety_world import make_lab  # noqa: E402


def test_the_page_on_laser_safety_has_the_table_of_the_benchmark() -> None:
    made = runpy.run_path(str(ROOT / ".ci" / "safety_table.py"))
    assert (ROOT / "docs/how-to/laser-safety.md").read_text() == made["page"](), "run `make docs`"


@pytest.mark.skipif(not find_spec("xarm"), reason="the extra xarm")
def test_an_emulated_bench_refuses_a_teleoperation_and_begins_no_run(tmp_path: Path) -> None:
    make_lab(tmp_path / "lab", None)
    assert refuses_teleoperation(tmp_path / "lab", "emulated")


def test_a_real_bench_has_no_teleoperation_either(tmp_path: Path) -> None:
    make_lab(tmp_path, None)
    able = asyncio.run(edge_of(BenchPlace(tmp_path, "hardware"), None).describe())  # asks no device
    assert "move" in able.primitives and "teleoperate" not in able.primitives


def test_light_can_stay_on_only_without_a_dead_man_and_with_nobody_left_to_close_anything() -> None:
    chain = runpy.run_path(str(ROOT / "benchmarks" / "safety_chain.py"))
    for fault in chain["FAULTS"]:
        assert (chain["bar"](fault, dead_man=False) is None) is (fault in ("frozen host", "killed guard"))
        within = chain["bar"](fault, dead_man=True)
        assert within <= (chain["WATCHDOG"] + 0.5 if fault in ("frozen host", "killed guard") else 1.0)
