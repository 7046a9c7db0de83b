"""`pico plan --picture`, and what a report says about a component that stayed in a gripper."""

from __future__ import annotations

from pathlib import Path

from attended import ended_when
from commanding import Pico, edit
from pico_cli.views import report as view

from pico.model.trace.report import RunReport


def test_a_plan_can_be_drawn(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "e1", "--picture", "e1.png")
    assert answer.code == 0
    assert "Drew the plan to e1.png" in answer.out
    assert (shel / "e1.png").read_bytes().startswith(b"\x89PNG")


def test_what_is_impossible_can_be_drawn_as_well(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", "  p2:\n    pose:\n      x: 520", "  p2:\n    pose:\n      x: 310")
    drawn = pico("plan", "--picture", "clash.png")
    assert drawn.code == 3
    assert pico("render", "--plan", "--view", "top", "--out", "same.png").code == 0
    assert (shel / "clash.png").read_bytes() == (shel / "same.png").read_bytes()


def test_a_report_says_what_to_do_about_a_held_component() -> None:
    left = RunReport(
        run="r", goal="e1", outcome="interrupted", done=1, failed=1, absent=("p2", "p1"), held={"arm1": "p2"}
    )
    said = " ".join(view.text(left).split())
    assert "Not seen where it should stand: p1." in said
    assert "arm1 still holds p2" in said and "`pico recover`" in said


def test_a_held_component_is_set_down_before_the_work_goes_on(shel: Path, pico: Pico) -> None:
    from pico.bench.bench import Bench

    with Bench.open(shel) as bench:
        report = ended_when(bench, bench.plan("e1"), lambda event: event.data.get("phase") == "transit", at_once=True)
        ((robot, held),) = report.held.items()
        assert f"{robot} still holds {held}" in view.text(report)
    again = pico("plan", "e1")
    assert f"{robot} still holds it" in again.out and "warning[held]" not in again.err
    assert pico("apply", "e1", "--auto-approve").code == 0
