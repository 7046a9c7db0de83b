"""Light above class 2 comes out by a person's arming alone, and goes when that is over."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from commanding import Pico, edit

from pico.bench.bench import Bench
from pico.edge import armings

WAIVED = "  arming: {waived: [kinematic, physics, emulated]}"
ROLES = "  arming: {roles: {laser_user: {people: [Ada Lovelace], laser_class: 3R, hours: 8}}}"


@pytest.fixture
def guarded(shel: Path) -> Path:
    """The bench of the case study, whose lab waives nothing: Ada Lovelace, who sits here, may arm up to class 3R."""
    text = (shel / "lab.yaml").read_text()
    line = next(line for line in text.splitlines() if line.startswith(WAIVED))
    (shel / "lab.yaml").write_text(text.replace(line, ROLES))
    subprocess.run(["git", "-C", str(shel), "config", "user.name", "Ada Lovelace"], check=True)
    return shel


def row(pico: Pico) -> Any:
    return pico("laser", "--json").data["lasers"][0]


def operations(answer: Any) -> list[tuple[str, Any]]:
    return [(o["component"], o["arguments"].get("to")) for o in answer["operations"] if o["component"] == "laser"]


def test_apply_leaves_a_laser_above_class_2_shut_and_says_what_opens_it(guarded: Path, pico: Pico) -> None:
    told = pico("apply", "--yes")
    assert told.code == 0 and "The bench equals the manifest" in told.out
    assert "laser (class 3R) stays dark: nobody has armed it" in told.err
    assert "`pico laser arm laser`" in told.err and not row(pico)["emits"]
    assert pico("plan", "--detailed-exitcode").code == 0


def test_a_lab_may_waive_it_where_nothing_is_emitted_and_light_comes_last(shel: Path, pico: Pico) -> None:
    made = pico("plan", "--json").data
    last = max(made["operations"], key=lambda o: o["start"])
    assert (last["component"], last["arguments"]["to"]) == ("laser", "open")
    assert pico("apply", "--yes").code == 0 and row(pico)["emits"] and row(pico)["lets"] == "waived"


def test_where_nobody_has_to_arm_what_lets_light_out_is_said(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0 and "lets it out" not in pico("laser").out
    assert "`pico apply` lets it out" in pico("laser", "disarm", "laser").out
    told = pico("laser", "arm", "laser", "-y")
    assert told.code == 7 and "nobody has to arm it here" in told.err and "`pico apply`" in told.err
    assert pico("set", "laser", "shutter=open", "--yes").code == 0 and row(pico)["emits"]


def test_a_laser_of_class_1_or_2_needs_nobody(guarded: Path, pico: Pico) -> None:
    edit(
        guarded / "lab.yaml",
        "    type: hene_laser_expanded\n",
        "    type: hene_laser_expanded\n    parameters: {power: 0.9}\n",
    )
    assert pico("apply", "--yes").code == 0
    assert row(pico)["emits"] and row(pico)["lets"] == "low"


def test_a_person_arms_it_and_it_opens_after_the_audit_and_undo_shuts_it(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0
    armed = pico("laser", "arm", "laser", "--hours", "2", "-y")
    assert armed.code == 0, armed
    known = row(pico)
    assert known["emits"] and known["lets"] == "armed" and known["arming"]["by"] == "Ada Lovelace"
    assert (known["arming"]["role"], known["arming"]["laser_class"]) == ("laser_user", "3R")
    assert "armed by Ada Lovelace (laser_user) until" in pico("laser").out
    assert pico("undo", "--yes").code == 0 and not row(pico)["emits"]
    back = pico("undo", "--yes")
    assert "undoing lets no light out" in back.err and not row(pico)["emits"]


def test_it_is_refused_to_whom_the_policy_does_not_name_and_beyond_class_and_hours(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0
    assert pico("laser", "arm", "laser", "--hours", "9", "-y").code == 7
    assert pico("laser", "arm", "laser", "--class", "3B", "-y").code == 7
    assert pico("laser", "arm", "laser", "--role", "laser_chief", "-y").code == 7
    assert pico("laser", "arm", "laser", "--from", "22:00", "-y").code == 1
    assert pico("laser", "arm", "lazer", "-y").code == 1
    subprocess.run(["git", "-C", str(guarded), "config", "user.name", "Charles Babbage"], check=True)
    told = pico("laser", "arm", "laser", "-y")
    assert told.code == 7 and "Charles Babbage may not arm laser (class 3R)" in told.err
    assert "Charles Babbage is not in it" in told.err and not row(pico)["emits"]


def test_an_arming_onto_a_housing_is_refused_by_the_audit_and_arms_nothing(guarded: Path, pico: Pico) -> None:
    edit(guarded / "lab.yaml", "  p2:\n", "  p2:\n    ends_beams: false\n")
    edit(
        guarded / "state" / "table.yaml",
        "      x: 520\n      y: 420\n      yaw: 0",
        "      x: 520\n      y: 420\n      yaw: 90",
    )
    assert pico("apply", "--yes").code == 0  # the laser stays shut
    told = pico("laser", "arm", "laser", "-y")
    assert told.code == 7 and "error[beam-audit]" in told.err
    assert row(pico)["lets"] == "nothing" and not armings.kept(bench_at(guarded))


def test_nothing_else_lets_light_out(guarded: Path, pico: Pico) -> None:
    """Neither a setting nor a measurement, an alignment, a resumption, a checkout or a recovery."""
    assert pico("apply", "--yes").code == 0
    assert pico("set", "laser.emission", "true", "-y").code == 0  # behind its shutter it warms up
    told = pico("set", "laser.shutter", "open", "-y")
    assert told.code == 7 and "error[unarmed]: laser (class 3R) stays shut: nobody has armed it" in told.err
    assert pico("do", "laser", "set", "shutter=open", "-y").code == 7
    for words in (("measure", "cam.power"), ("optimize", "center", "ly_150", "cam", "--yes"), ("recover", "--yes"),
                  ("checkout", "e1", "--yes"), ("undo", "--yes"), ("apply", "e2", "--exact", "--yes"),
                  ("do", "cam", "auto_range", "--yes"), ("resume", "--yes")):  # fmt: skip
        pico(*words)
        assert not row(pico)["emits"], words


def test_a_measurement_without_its_light_says_so_and_what_brings_it(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0
    told = pico("measure", "cam.centroid")
    said = " ".join((told.out + told.err).split())
    assert "unknown" in said and "laser.shutter is closed" in said and "`pico laser arm laser` opens it" in said


def test_after_a_move_the_light_comes_back_only_where_it_was_armed(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0 and pico("laser", "arm", "laser", "-y").code == 0
    assert operations(pico("plan", "e1", "--json").data) == [("laser", "closed"), ("laser", "open")]
    armings.forget(bench_at(guarded), "laser")  # as if nobody ever had: it was opened by hand
    told = pico("plan", "e1", "--json").data
    assert operations(told) == [("laser", "closed")]
    assert any(d["code"] == "unarmed" and "stays dark" in d["summary"] for d in told["diagnostics"])


@pytest.mark.parametrize(
    "broken", ['{"schema": "pico.arming/v1", "laser": "la', "null", "[]", '{"schema": "pico.arming/v9"}']
)
def test_a_file_that_is_broken_or_of_somebody_else_arms_nothing_and_shuts_the_laser(
    guarded: Path, pico: Pico, broken: str
) -> None:
    assert pico("apply", "--yes").code == 0 and pico("laser", "arm", "laser", "-y").code == 0
    kept = guarded / ".pico/benches/sim" / "armed" / "laser.json"
    kept.write_text(broken)
    assert row(pico)["lets"] == "nothing" and row(pico)["broken"]
    told = pico("set", "cam.exposure", "8", "-y")
    assert told.code == 0 and "laser was shut: its arming can't be read" in told.err
    assert not row(pico)["emits"] and not kept.exists()


def test_an_arming_that_a_checkout_brought_arms_nothing(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0 and pico("laser", "arm", "laser", "-y").code == 0
    kept = guarded / ".pico/benches/sim" / "armed" / "laser.json"
    longer = json.loads(kept.read_text())
    longer["ends"] = "2099-01-01T00:00:00Z"
    kept.write_text(json.dumps(longer))
    assert row(pico)["lets"] == "nothing"


def test_disarming_shuts_at_once_and_asks_nobody(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0 and pico("laser", "arm", "laser", "-y").code == 0
    assert pico("laser", "disarm", "laser").code == 0
    assert not row(pico)["emits"] and row(pico)["lets"] == "nothing"
    with Bench.open(guarded) as bench:
        memory = bench.edge.memory
        assert memory is not None
        assert memory.runs()[-1].outcome == "done" and "disarmed it" in (memory.document(memory.runs()[-1].run) or "")
    assert pico("set", "laser.shutter", "open", "-y").code == 7


@pytest.mark.parametrize("waived", [True, False])
def test_disarming_in_another_worktree_shuts_the_bench_where_it_is(shel: Path, pico: Pico, waived: bool) -> None:
    if not waived:
        edit(shel / "lab.yaml", WAIVED, ROLES + "  #")
        subprocess.run(["git", "-C", str(shel), "config", "user.name", "Ada Lovelace"], check=True)
    assert pico("apply", "--yes").code == 0
    assert waived or pico("laser", "arm", "laser", "-y").code == 0
    other = shel.parent / "other"
    subprocess.run(["git", "-C", str(shel), "worktree", "add", "-q", str(other), "-b", "second"], check=True)
    assert row(pico)["emits"]
    shut = pico("-C", str(other), "laser", "disarm", "laser")
    assert shut.code == 0 and not row(pico)["emits"], shut
    assert not (other / ".pico/benches").exists()


def test_an_arming_given_beforehand_opens_nothing_and_lets_a_later_run_open_it(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0
    assert pico("laser", "arm", "laser", "--unattended", "--hours", "8", "-y").code == 0
    known = row(pico)
    assert not known["emits"] and known["lets"] == "armed" and known["arming"]["unattended"]
    assert pico("apply", "--yes").code == 0 and row(pico)["emits"]


def test_a_saved_plan_goes_without_the_light_that_nobody_lets_out_any_more(guarded: Path, pico: Pico) -> None:
    assert pico("laser", "arm", "laser", "--unattended", "-y").code == 0
    assert pico("plan", "--out", "lit.plan").code == 0
    assert pico("laser", "disarm", "laser").code == 0
    told = pico("apply", "./lit.plan", "--yes")
    assert told.code == 0 and "stays dark" in told.err and not row(pico)["emits"]


def test_hardware_is_never_waived(guarded: Path, pico: Pico) -> None:
    edit(guarded / "lab.yaml", ROLES, "  arming: {waived: [hardware]}")
    told = pico("validate")
    assert told.code == 1 and "lab.yaml:" in told.err


def test_who_takes_the_waiver_out_while_light_is_out_has_it_shut_by_the_next_run(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0 and row(pico)["emits"]
    text = (shel / "lab.yaml").read_text()
    line = next(line for line in text.splitlines() if line.startswith(WAIVED))
    (shel / "lab.yaml").write_text(text.replace(line, ROLES))
    assert pico("bench", "update", "--yes").code == 0
    told = pico("set", "p1", "angle=20", "--yes")
    assert told.code == 0 and not row(pico)["emits"]
    assert "laser was shut: it is of class 3R, and nobody has armed it" in told.err + told.out


def test_another_laser_in_the_housing_needs_an_arming_of_its_own_and_the_audit(guarded: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0 and pico("laser", "arm", "laser", "-y").code == 0 and row(pico)["emits"]
    text = (guarded / "lab.yaml").read_text()
    (guarded / "lab.yaml").write_text(text.replace("laser_class: 3R", "laser_class: 3B"))
    edit(guarded / "lab.yaml", "    type: hene_laser_expanded\n",
         "    type: hene_laser_expanded\n    parameters: {power: 40}\n")  # fmt: skip
    assert pico("bench", "update", "--yes").code == 0
    told = pico("laser", "arm", "laser", "-y")
    assert told.code == 7 and "beam-audit" in told.err
    assert pico("set", "p1", "angle=20", "--yes").code == 0 and not row(pico)["emits"]
