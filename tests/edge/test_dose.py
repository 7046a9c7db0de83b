"""The light that a sample has had is counted, and none gets more than its budget."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from pico.bench.bench import Bench
from pico.bench.cut_short import told_first
from pico.diagnostics import ExitCode, PicoError
from pico.edge.dose import Ledger
from pico.history.examples.example import make_example
from pico.model.lab import Part
from pico.model.trace.dose import Dose
from pico.recipes.doing import Doing

POWER = 2.0
"""Of the laser [mW]; the part right behind it gets all of that."""


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    root = make_example("shel", tmp_path / "shel").root
    text = (root / "lab.yaml").read_text()
    part = "    type: half_wave_plate\n"
    assert text.count(part) == 1
    (root / "lab.yaml").write_text(text.replace(part, f"{part}    sample: WSe2-041\n    dose_budget: 10\n"))
    with Bench.open(root) as opened:
        yield opened


def dose(bench: Bench) -> Dose:
    (found,) = bench.wait(bench.edge.doses())
    return found


def opened(bench: Bench) -> float:
    """Let the light out; return when."""
    bench.apply(bench.single("laser", "set", emission="true"))
    bench.apply(bench.single("laser", "set", shutter="open"))
    return bench.observe().time


def test_what_falls_on_it_is_counted_by_the_clock_of_the_bench_and_stands_in_the_trace(bench: Bench) -> None:
    assert dose(bench) == Dose(sample="WSe2-041", component="hwp", spent=0.0, budget=10.0)
    since, first = opened(bench), dose(bench)
    assert first.power == pytest.approx(POWER) and first.spent <= POWER * since  # while the shutter opened, at the most
    bench.sim.wait(1.5)
    report = bench.apply(bench.single("p1", "set", angle="3"))
    assert report.outcome == "done"
    now = bench.observe().time
    assert dose(bench).spent - first.spent == pytest.approx(POWER * (now - since)) and now - since > 1.5
    assert bench.edge.memory is not None
    ends = [r.data for r in bench.edge.memory.records(run=report.run) if r.kind == "done"]
    assert [end["data"]["dose"]["WSe2-041"] for end in ends] == [pytest.approx(POWER * (now - since - 1.5), abs=0.1)]
    notes = [d for d in told_first(bench, bench.observe()) if d.code == "dose"]
    assert "WSe2-041 in hwp has had" in notes[0].summary and "are left" in notes[0].summary
    bench.apply(bench.single("laser", "set", shutter="closed"))
    dark = dose(bench)
    bench.sim.wait(100)
    assert dose(bench).spent == dark.spent and dark.power == 0.0


def test_what_would_exceed_its_budget_is_refused_with_the_numbers_and_it_can_be_darkened(bench: Bench) -> None:
    opened(bench)
    with pytest.raises(PicoError) as caught:
        Doing(bench).pause(6.0)
    assert caught.value.exit_code == ExitCode.DENIED and "of its 10 mJ" in str(caught.value)
    assert "12 mJ more, in 6 s" in str(caught.value)
    Doing(bench).pause(4.0)
    before = bench.observe().known_values["p1"]["angle"]
    plan = bench.single("p1", "set", angle="80")
    assert plan.exit_code == ExitCode.DENIED and any("of its 10 mJ" in d.summary for d in plan.diagnostics)
    plan = replace(plan, diagnostics=()).sealed()  # who does not look at it
    with pytest.raises(PicoError) as caught:
        bench.apply(plan)
    assert caught.value.exit_code == ExitCode.DENIED and bench.observe().known_values["p1"]["angle"] == before
    assert bench.apply(bench.single("laser", "set", shutter="closed")).outcome == "done"
    assert bench.apply(bench.single("p1", "set", angle="80")).outcome == "done"  # in the dark


def test_a_budget_is_of_a_sample_and_a_clock_that_begins_anew_counts_nothing(bench: Bench) -> None:
    with pytest.raises(ValueError, match="sample"):
        Part(type="half_wave_plate", home="a", dose_budget=3.0)
    seen = bench.observe()
    assert Ledger(at=seen.time + 50, power={"WSe2-041": 2.0}).until(bench.setup, seen).spent == {"WSe2-041": 0.0}
