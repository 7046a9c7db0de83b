"""`pico budget`: of an expression, of a claim, for a wanted result; beside a diff; warned of by validate and commit."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from commanding import Pico, edit

SHIFT = "(plus.cam.centroid.y - minus.cam.centroid.y) / 2"
LOOKS = ("--set", "plus.p1.angle=1", "--set", "minus.p1.angle=179 deg")
CLAIM = f"""claims:
  shift:
    of: {SHIFT}
    looks: {{plus: {{p1.angle: 1}}, minus: {{p1.angle: 179}}}}
    to: 2 %
sim:
"""


def words(text: str) -> str:
    return " ".join(text.split())


def test_what_limits_a_result_and_what_it_would_need(shel: Path, pico: Pico) -> None:
    answer = pico("budget", SHIFT, "e1", *LOOKS, "--for", "2 %")
    told = words(answer.out)
    assert answer.code == 0 and "in e1: -67.9 um" in told and "p1.angle (minus) ± 0.1 deg -43 um/deg" in told
    assert "(4.9 %) within the tolerances" in told and "p1.angle to ± 0.022 deg" in told
    (found,) = pico("budget", SHIFT, "e1", *LOOKS, "--for", "2 %", "--json").data["results"]
    assert found["unit"] == "um" and not found["carried"] and found["tighter"][0]["address"] == "p1.angle"
    assert math.hypot(*(row["tolerated"] for row in found["rows"])) == pytest.approx(found["tolerated"])


def test_a_claim_is_listed_beside_a_diff_and_warned_of(shel: Path, pico: Pico) -> None:
    assert "claims nothing" in pico("budget").out
    edit(shel / "lab.yaml", "sim:\n", CLAIM)
    beside = words(pico("diff", "e1", "e3", "--budget", "shift").out)
    assert "shift: -67.9 um ± 3.34 um" in beside
    assert "by p1.angle (minus) 2.5 um →" in beside
    assert pico("validate").err == ""  # nothing of it can be told here: the result is 0
    assert "can't be told: the result is 0 in this state" in words(pico("budget").out)
    committed = pico("commit", "--planned", "-m", "a claim")
    assert committed.code == 0 and "claim" not in committed.err
    told = pico("budget", "shift", "e1")
    assert "shift to 2 % (1.36 um) needs 3 errors held tighter" in told.out


def test_commit_and_validate_warn_where_the_tolerances_do_not_carry_a_claim(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "sim:\n", "claims:\n  place: {of: cam.centroid.y, to: 5 um}\nsim:\n")
    warned = pico("validate")
    assert warned.code == 0 and "lab.yaml:101:35" in warned.err and "the tolerances do not carry place" in warned.err
    committed = pico("commit", "--planned", "-m", "a claim")
    assert committed.code == 0 and "laser.walk.pitch to 0.0003" in committed.err


def test_a_plan_warns_of_a_claim_that_its_goal_does_not_carry(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit(shel / "lab.yaml", "sim:\n", CLAIM)
    first = pico("plan", "e1")
    assert first.code == 0 and "the tolerances do not carry shift" in words(first.out + first.err)
    assert "p1.angle to ± 0.022 deg and 2 others tighter; `pico budget shift e1` says" in words(first.out + first.err)

    def again(*_: object) -> None:
        raise AssertionError("what is known is reckoned again")

    monkeypatch.setattr("pico.diagnosis.claims.uncarried", again)
    second = pico("plan", "e1", "--json").data
    assert [d["code"] for d in second["diagnostics"] if d["code"] == "claim"] == ["claim"]
    assert "claim" not in {
        d["code"] for d in pico("plan", "--json").data["diagnostics"]
    }  # nothing to do: nothing traced
    edit(shel / "lab.yaml", "to: 2 %", "to: 10 %")
    assert "reckoned again" in pico("plan", "e1").err


def test_a_claim_that_makes_no_sense_is_told_at_its_place(shel: Path, pico: Pico) -> None:
    wrong = CLAIM.replace("minus.cam.centroid.y", "minus.cam.center.y").replace("179", "579").replace("2 %", "2 kg")
    edit(shel / "lab.yaml", "sim:\n", wrong)
    answer = pico("validate")
    assert answer.code == 1 and "lab.yaml:102:9" in answer.err and "p1.angle can't be 579" in answer.err
    edit(shel / "lab.yaml", "minus.cam.center.y", "minus.cam.centroid.y")
    assert "`2 kg` is a mass" in words(pico("validate").err)


def test_what_cannot_be_asked_is_said(shel: Path, pico: Pico) -> None:
    for asked, said in (
        (("budget", "--for", "2 %"), "of what result"), (("budget", "cam.power", "--set", "p1"), "can't read `p1`"),
        (("budget", "cam.power", "--set", "p1.angl=3"), "no tunable `angl`"), (("budget", "cam.powr"), "did you mean"),
        (("budget", "cam.power", "--set", "p1.angle=3 mm"), "is a length, not an angle"),
        (("budget", "cam.power", "nowhere"), "nowhere"), (("budget", "cam.power", "--for", "x"), "`x` is not"),
        (("diff", "e1", "--budget", "cam.powr"), "did you mean"),
    ):  # fmt: skip
        answer = pico(*asked)
        assert answer.code in (1, 64, 2) and said in words(answer.err), asked
        assert "Traceback" not in answer.err
