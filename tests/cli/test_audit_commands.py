"""The beam audit in commands: denied with the branch named and drawn, kept, and not traced again for nothing."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from commanding import Pico, edit

from pico.optics.audit import audit as auditing
from pico.policy import audit as policy

PLACE = "      x: 520\n      y: 420\n      yaw: "
BRANCH = "laser → hwp → p1 → ends on the housing of p2 at (490, 420): 0.806 mW, above the limit of class 1 of 0.39 mW"


def across(shel: Path) -> None:
    """Want the second polarizer turned so that its side is in the beam, and say that its housing is no end for one."""
    edit(shel / "lab.yaml", "  p2:\n", "  p2:\n    ends_beams: false\n")
    edit(shel / "state" / "table.yaml", f"{PLACE}0", f"{PLACE}90")


@pytest.fixture
def traced(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Who was traced for an audit."""
    found: list[str] = []
    light_of = auditing.light_of

    def counted(*given: Any, **more: Any) -> Any:
        found.append("traced")
        return light_of(*given, **more)

    monkeypatch.setattr(auditing, "light_of", counted)
    monkeypatch.setattr(policy, "_VERDICTS", {})
    return found


def test_a_plan_that_opens_the_laser_onto_a_housing_is_denied_and_nothing_moves(shel: Path, pico: Pico) -> None:
    across(shel)
    plan = pico("plan")
    assert plan.code == 7 and "error[beam-audit]" in plan.err and BRANCH in " ".join(plan.err.split())
    assert "`pico plan --picture beams.png` draws it in red" in " ".join(plan.err.split())
    before = pico("status", "--json").data
    assert pico("apply", "--auto-approve").code == 7
    assert pico("status", "--json").data["rows"] == before["rows"]
    assert pico("apply", "--auto-approve", "--exclude", "laser").code == 0
    assert pico("set", "laser.shutter", "open", "-y").code == 0  # it is off
    assert pico("set", "laser.emission", "true", "-y").code == 7
    assert pico("set", "laser.shutter", "closed", "-y").code == 0


def test_validate_tells_it_at_the_line_that_turns_the_laser_on(shel: Path, pico: Pico) -> None:
    assert pico("validate").code == 0
    across(shel)
    told = pico("validate")
    line = 1 + (shel / "state" / "table.yaml").read_text().splitlines().index("    emission: true")
    assert told.code == 1 and BRANCH in " ".join(told.err.split()) and f"state/table.yaml:{line}:" in told.err
    edit(shel / "lab.yaml", "policy:\n", "policy:\n  enclosed: true\n")
    told = pico("validate")
    assert told.code == 0 and "warning[beam-audit]" in told.err
    edit(shel / "state" / "table.yaml", "shutter: open", "shutter: closed")
    assert "beam-audit" not in pico("validate").err


def test_validate_names_the_parts_of_which_nobody_says_what_light_they_can_take(shel: Path, pico: Pico) -> None:
    assert "damage-threshold" not in pico("validate").err
    assert pico("catalog", "new", "bare", "--from", "linear_polarizer").code == 0
    made = next(shel.rglob("bare.yaml"))
    made.write_text("".join(li for li in made.read_text().splitlines(True) if "damage_threshold:" not in li))
    edit(shel / "lab.yaml", "  p1:\n    type: linear_polarizer", "  p1:\n    type: bare")
    told = pico("validate")
    assert told.code == 0 and "note[damage-threshold]: the damage threshold of p1 is unknown" in told.err


def red(path: Path, box: tuple[float, float, float, float]) -> int:
    """Return how many pixels of a box (shares of the picture) are as red as what is not safe."""
    image = cv2.imread(str(path))
    assert image is not None
    high, wide = image.shape[:2]
    left, top, right, bottom = box
    cut = image[int(top * high) : int(bottom * high), int(left * wide) : int(right * wide)].astype(int)
    return int(np.sum((cut[..., 2] > 200) & (cut[..., 1] < 80) & (cut[..., 0] < 80)))


def test_the_branch_is_drawn_in_red(shel: Path, pico: Pico) -> None:
    assert pico("beam", "--manifest", "--picture", "safe.png").code == 0
    across(shel)
    for words in (("plan",), ("beam", "--manifest")):
        assert pico(*words, "--picture", "beams.png").code in (0, 7)
        whole = (0.0, 0.0, 1.0, 0.8)
        assert red(shel / "beams.png", whole) > 1.1 * red(shel / "safe.png", whole) > 0, words


def test_a_verdict_is_kept_and_a_plan_without_changes_never_traces(
    shel: Path, pico: Pico, traced: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert pico("plan").code == 0 and traced
    count = len(traced)
    assert pico("plan").code == 0 and len(traced) == count
    assert pico("apply", "--auto-approve").code == 0
    assert len(traced) == count, "the edge of this process knows the verdict, too"
    kept = shel / ".pico" / "audit.json"
    for content in (kept.read_text(), "", "{", json.dumps({"version": 0, "audits": {}}), '{"version": 1, "audits": 3}'):
        kept.write_text(content)
        assert pico("plan", "--detailed-exitcode").code == 0
    assert len(traced) == count
    edit(shel / "state" / "table.yaml", "angle: 22.75", "angle: 20")
    assert pico("plan").code == 0 and len(traced) == count + 1
    monkeypatch.setattr(policy, "_VERDICTS", {})  # as of another process
    assert pico("apply", "--auto-approve").code == 0
    assert len(traced) == count + 2, "an edge believes no file of a client"


def test_what_an_open_laser_does_is_told_of_a_plan_that_changes_nothing(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    assert pico("sim", "nudge", "cam", "--dy", "50").code == 0
    plan = pico("plan", "--", "p1")  # of p1 alone, which stands as wanted
    assert plan.code == 0 and "error" not in plan.err


def test_rules_of_a_lab_see_the_verdict(shel: Path, pico: Pico) -> None:
    rule = "    - {name: clean, that: 'audit.passes && audit.findings.size() == 0', message: beams}\n"
    edit(shel / "lab.yaml", "    - name: nobody_near_the_arm\n", f"{rule}    - name: nobody_near_the_arm\n")
    holds = {r["rule"]: r["holds"] for r in pico("plan", "--json").data["policy"] if "level" in r}
    assert holds["clean"]
    across(shel)
    holds = {r["rule"]: r["holds"] for r in pico("plan", "--json").data["policy"] if "level" in r}
    assert not holds["clean"]


def test_a_check_of_a_commit_fails_where_its_light_is_not_safe(shel: Path, pico: Pico) -> None:
    assert pico("check").code == 0
    across(shel)
    subprocess.run(["git", "commit", "-qam", "p2 across"], check=True)
    told = pico("check", "--json")
    (policy,) = (c for c in told.data["labs"][0]["checks"] if c["question"] == "policy")
    assert told.code != 0 and policy["verdict"] == "failed" and "; the beam audit finds 1" in policy["text"]
