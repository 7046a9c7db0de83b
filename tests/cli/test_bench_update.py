"""`pico bench update`: what the lab's files propose, as people read it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commanding import Pico, Typed, edit


def test_nothing_is_asked_where_nothing_differs(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    answer = pico("bench", "update")
    assert answer.code == 0 and "Nothing to adopt" in answer.out


def test_the_difference_is_shown_and_adopted_only_with_consent(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = pico("apply", "--auto-approve")
    assert "note[bench-lab]" in first.err
    edit(shel / "lab.yaml", "seed: 1", "seed: 2")
    for words in (["plan"], ["status"], ["drift"], ["apply", "--auto-approve"]):
        told = pico(*words)
        assert told.code == 0 and told.err.count("warning[bench-lab]") == 1 and "sim.seed 1 → 2" in told.err
    valid = pico("validate")
    assert valid.code == 0 and "note[bench-lab]" in valid.err and "sim.seed 1 → 2" in valid.err
    shown = pico("bench", "update", "--dry-run")
    assert shown.code == 0 and "+  seed: 2" in shown.out and "-  seed: 1" in shown.out
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    refused = pico("bench", "update")
    assert refused.code == 1 and "the bench stays what it is" in refused.out
    assert "warning[bench-lab]" in pico("plan").err
    assert pico("bench", "update", "--json").code == 1
    adopted = json.loads(pico("bench", "update", "--json", "--auto-approve").out)
    assert adopted["adopted"] and adopted["differences"] == ["sim.seed 1 → 2"]
    assert not pico("plan").err


def test_an_import_is_the_benchs_own_at_once(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "lab.yaml", "  lx_125:\n    type: plano_convex_125\n    marker: 5\n    home: storage/a3\n", "")
    edit(shel / "state" / "table.yaml", "  lx_125:\n    slot: storage/a3\n", "")
    adopted = json.loads(pico("bench", "update", "--json", "--auto-approve").out)
    assert adopted["differences"] == ["inventory.lx_125 removed"]
    edit(
        shel / "lab.yaml", "  ly_150:\n", "  lx_125: {type: plano_convex_125, marker: 5, home: storage/a3}\n  ly_150:\n"
    )
    edit(shel / "state" / "table.yaml", "  ly_150:\n", "  lx_125:\n    slot: storage/a3\n  ly_150:\n")
    lacking = pico("status")
    assert lacking.code == 1 and "bench-lab" not in lacking.err and "`pico bench update` adopts it" in lacking.err
    edit(shel / "lab.yaml", "  lx_125: {type: plano_convex_125, marker: 5, home: storage/a3}\n", "")
    edit(shel / "state" / "table.yaml", "  lx_125:\n    slot: storage/a3\n", "")
    edit(shel / "lab.yaml", "seed: 1", "seed: 2")
    refused = pico("import", "--types", "5=plano_convex_125:lx_125")
    assert refused.code == 1 and "adopt that first: `pico bench update`" in refused.err
    edit(shel / "lab.yaml", "seed: 2", "seed: 1")
    assert pico("import", "--types", "5=plano_convex_125:lx_125").code == 0
    answer = pico("plan")
    assert answer.code == 0 and not answer.err
