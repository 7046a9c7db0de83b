"""Expectations and rules that make no sense are refused with their place, before anything moves."""

from __future__ import annotations

from pathlib import Path

import pytest
from commanding import Pico, edit
from killed_commands import git

from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.model.state import Expectation

SENSELESS = ["p22.pose.yaw < 3", "cam.exposre < 20", "p2.pose.yaw < 'three'", "p2.pose.yaw", "p2.pose.yaw <"]
RULE = "  rules:\n    - {name: typo, that: p22.angle < 400}"


def expect(folder: Path, that: str) -> None:
    state = folder / "state" / "table.yaml"
    state.write_text(f'{state.read_text()}expect:\n  - {{that: "{that}"}}\n')


@pytest.mark.parametrize("that", SENSELESS)
def test_plan_and_apply_refuse_what_the_manifest_cannot_expect(shel: Path, pico: Pico, that: str) -> None:
    expect(shel, that)
    told = pico("validate")
    assert told.code == 1 and "error[expression]" in told.err
    for words in (("plan",), ("apply", "--auto-approve"), ("plan", "--out", "p.json")):
        answer = pico(*words)
        assert answer.code == 1 and answer.err.strip() == told.err.strip()
        assert "--> state/table.yaml:" in answer.err
    assert not (shel / "p.json").exists()
    with Bench.open(shel) as bench:
        p1 = bench.observe().components["p1"].pose
    assert p1 is not None and p1.x == 110  # in storage, as at first


def test_a_revision_that_cannot_be_expected_is_refused_but_parts_of_it_are_not(shel: Path, pico: Pico) -> None:
    git(shel, "checkout", "-q", "e1")
    expect(shel, SENSELESS[0])
    git(shel, "commit", "-qam", "a typo")
    git(shel, "checkout", "-q", "main")
    for command in ("plan", "apply"):
        answer = pico(command, "e1", *(["--auto-approve"] if command == "apply" else []))
        assert answer.code == 1 and "p22" in answer.err and "table.yaml:" in answer.err
    assert pico("checkout", "e1", "--auto-approve").code == 1
    assert git(shel, "branch", "--show-current") == "main"
    assert pico("apply", "e1", "--auto-approve", "--", "p2").code == 0


def test_a_plan_in_memory_that_expects_nonsense_moves_nothing(shel: Path) -> None:
    from dataclasses import replace

    with Bench.open(shel) as bench:
        plan = bench.plan("e1")
        target = replace(plan.target, expect=(Expectation(that=SENSELESS[1]),))
        before = bench.observe().components
        with pytest.raises(PicoError, match="exposre"):
            bench.apply(replace(plan, target=target).sealed())
        assert bench.observe().components == before


def test_a_rule_that_makes_no_sense_is_refused_with_its_place(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "  rules:", RULE)
    for words in (("plan", "e1"), ("apply", "e1", "--auto-approve")):
        answer = pico(*words)
        assert answer.code == 1 and "this rule can't be told" in answer.err and "--> lab.yaml:" in answer.err


def test_a_bisection_minds_what_it_asks_for_and_not_what_commits_expect(shel: Path, pico: Pico) -> None:
    good = git(shel, "rev-parse", "HEAD")
    expect(shel, SENSELESS[0])
    git(shel, "commit", "-qam", "a typo")
    edit(shel / "state" / "table.yaml", "angle: 90", "angle: 80")
    git(shel, "commit", "-qam", "turned")
    answer = pico("bisect", "run", "main", good, "--auto-approve")
    assert answer.code == 1 and "p22" in answer.err and "operations" not in answer.out
    answer = pico("bisect", "run", "main", good, "--expect", "p1.angle > 85", "--auto-approve")
    assert answer.code == 0 and "is the first bad commit" in answer.out
