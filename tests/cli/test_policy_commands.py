"""Policy and expectations at the command line: what is denied moves nothing, what fails is told by the exit code."""

from __future__ import annotations

import json
from pathlib import Path

from commanding import Pico, edit

NEVER = "  rules:\n    - {name: never, that: size(operations) > 1000, message: not today}\n"
EXPECT = 'expect:\n  - {that: "distance(p1, p2) > 200", message: too near}\n  - {that: "p2.angle < 80"}\n'


def expecting(folder: Path, lines: str = EXPECT) -> None:
    with (folder / "state" / "table.yaml").open("a") as file:
        file.write(lines)


def test_a_plan_shows_the_verdict_and_a_denied_one_moves_nothing(shel: Path, pico: Pico) -> None:
    allowed = pico("plan", "e1")
    assert allowed.code == 0
    assert "policy: 3 rules hold · laser shutter closed during 4 moves" in allowed.out
    before = pico("catalog", "parts", "--json").out
    pico("sim", "person", "here")
    for words in (("plan", "e1"), ("apply", "e1", "--auto-approve"), ("move", "p1", "x=300", "y=420", "-y")):
        denied = pico(*words)
        assert denied.code == 7, words
        assert "policy denies: nobody_near_the_arm: no arm moves while somebody is at the table" in denied.out
    assert pico("set", "p1", "angle=3", "-y").code == 0
    assert pico("catalog", "parts", "--json").out == before
    pico("sim", "person", "away")
    assert pico("apply", "e1", "--auto-approve").code == 0


def test_a_saved_plan_is_judged_again_by_the_bench_as_it_is(shel: Path, pico: Pico) -> None:
    assert pico("plan", "e1", "--out", "e1.plan").code == 0
    pico("sim", "person", "here")
    denied = pico("apply", "./e1.plan", "--auto-approve")
    assert denied.code == 7
    assert "the policy of this lab denies it: nobody_near_the_arm" in denied.err


def test_the_verdicts_are_in_the_plan_as_json(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "  rules:", NEVER.rstrip("\n"))
    found = pico("plan", "e1", "--json")
    assert found.code == 7
    assert {"rule": "never", "level": "mandatory", "holds": False, "text": "not today"} in found.data["policy"]


def test_validate_points_at_the_place_of_a_mistake_in_a_rule_and_an_expectation(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "o.mass <= 1.5", "o.mass <= one")
    expecting(shel, "expect:\n  - {that: p2.angel > 80}\n")
    found = pico("validate")
    assert found.code == 1
    line = (shel / "lab.yaml").read_text()[: (shel / "lab.yaml").read_text().index("one)")].count("\n") + 1
    assert f"lab.yaml:{line}:" in found.err
    assert "nothing is called `one`" in found.err
    assert "did you mean `p2.angle`?" in found.err


def test_expectations_are_checked_after_an_apply_and_at_any_time(shel: Path, pico: Pico) -> None:
    expecting(shel)
    for words in (("apply", "--auto-approve"), ("apply", "--auto-approve"), ("verify",)):
        found = pico(*words)
        assert found.code == 6, words
        assert "`p2.angle < 80` fails: p2.angle is 90" in found.out
        assert "1 of 2 expectations hold." in found.out
    edit(shel / "state" / "table.yaml", "p2.angle < 80", "p2.angle > 80")
    assert pico("verify").code == 0
    pico("sim", "nudge", "p2", "--dx", "3")
    moved = pico("verify")
    assert moved.code == 1
    assert "p2" in moved.out


def test_an_expectation_on_what_nobody_measured_is_not_assured_and_no_failure(shel: Path, pico: Pico) -> None:
    expecting(shel, "expect:\n  - {that: cam.peak > 200, message: no light on the camera}\n")
    applied = pico("apply", "--auto-approve")
    assert applied.code == 0 and "`cam.peak > 200` is not assured: cam.peak was not measured now" in applied.out
    found = pico("verify", "--json")
    assert found.code == 0
    (one,) = json.loads(found.out)["expectations"]
    assert "holds" not in one and not one["assured"]
    assert one["why"] == "cam.peak was not measured now: `pico verify --measure` does it"
