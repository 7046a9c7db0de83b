"""`pico plan --explain`: what a person reads about one component, and about a plan as a whole."""

from __future__ import annotations

from pathlib import Path

from commanding import Pico, edit


def test_one_component_is_told_with_why_when_and_what_waits(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "e1", "--explain", "p1")
    assert answer.code == 0
    assert "it was seen in storage/b1 and belongs at (290, 420, 0°)" in answer.out
    assert "arm1 does one thing at a time" in answer.out
    assert "on the critical path" in answer.out
    assert "4 components must move, each moves once: no plan has fewer." in answer.out


def test_a_name_alone_is_a_component_of_the_plan_to_the_manifest(shel: Path, pico: Pico) -> None:
    assert "belongs at (520, 420, 0°)" in pico("plan", "--explain", "p2").out
    assert "stays as it is" in pico("plan", "--explain", "ly_200").out


def test_a_saved_plan_is_explained_as_the_revision_is(shel: Path, pico: Pico) -> None:
    pico("plan", "e1", "--out", "e1.plan")
    saved, fresh = pico("plan", "--explain", "e1.plan", "--json").data, pico("plan", "--explain", "e1", "--json").data
    assert saved == fresh
    assert saved["schema"] == "pico.explanation/v1"
    assert {s["operation"]["component"] for s in saved["steps"]} >= {"p1", "p2", "arm1"}


def test_the_order_is_told_with_the_overlap_that_it_avoids(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", "  p1:\n    pose:\n      x: 290", "  p1:\n    pose:\n      x: 520")
    edit(shel / "state" / "table.yaml", "  p2:\n    pose:\n      x: 520", "  p2:\n    pose:\n      x: 290")
    answer = pico("plan", "--explain")
    assert answer.code == 0, answer
    assert "their bases would overlap by" in answer.out
    assert "p1 and p2 block one another in a ring" in answer.out
    assert max(len(line) for line in answer.out.splitlines()) <= 100


def test_what_is_impossible_exits_3_and_says_why(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", "  p2:\n    pose:\n      x: 520", "  p2:\n    pose:\n      x: 310")
    answer = pico("plan", "--explain", "p2")
    assert answer.code == 3
    assert "p1 and p2 can't both stand where they should" in answer.out or "p2 and p1 can't" in answer.out
    assert "error[impossible]" in answer.err


def test_a_plan_explains_one_component_where_it_is_asked_to(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "e1", "--explain", "p1", "--detailed-exitcode")
    assert answer.code == 2
    assert answer.out == pico("plan", "e1", "--explain", "p1").out
    assert pico("plan", "e1", "--explain", "p1", "--json").data["component"] == "p1"


def test_an_unknown_component_exits_1(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "--explain", "e1", "p3")
    assert answer.code == 1
    assert "no component `p3`" in answer.err
