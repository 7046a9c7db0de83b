"""Who may arm a laser, and which armings count: the rule of docs/how-to/laser-safety.md, case by case."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

import pytest
from laser_lab import bench

from pico.model.arming import CLASSES, Arming, ArmingPolicy, LaserRole, within
from pico.model.setup import Setup
from pico.policy import arming

ROLES = {
    "student": LaserRole(people=("Ben",), laser_class="2", hours=2.0),
    "user": LaserRole(people=("Ada", "Ben"), laser_class="3R", hours=8.0),
    "warden": LaserRole(people=("Ada",), laser_class="4", hours=1.0),
}
NOON = datetime.fromisoformat("2026-11-24T12:00:00+00:00")


def lab(roles: Any = ROLES, **policy: Any) -> Setup:
    setup = bench()
    allowed = replace(setup.lab.policy, arming=ArmingPolicy(roles=roles, **policy))
    return replace(setup, lab=replace(setup.lab, policy=allowed))


SETUP = lab()


def at(hours: float) -> str:
    return (NOON + timedelta(hours=hours)).isoformat().replace("+00:00", "Z")


def given(begins: float = 0.0, ends: float = 2.0, **more: Any) -> Arming:
    usual: dict[str, Any] = {"laser": "laser", "by": "Ada", "role": "user", "laser_class": "3R", "backend": "sim"}
    return Arming(**{**usual, "begins": at(begins), "ends": at(ends), **more})


def may(role: LaserRole, person: str, of: Any, hours: float) -> bool:
    """The rule in the words of the documentation: a person in the role, up to its class, for at most its hours."""
    order = "1 2 3R 3B 4"
    return person in role.people and order.index(of) <= order.index(role.laser_class) and (
        hours <= role.hours
    )  # fmt: skip


@pytest.mark.parametrize("of", CLASSES)
@pytest.mark.parametrize("most", CLASSES)
def test_a_class_is_within_those_as_dangerous_or_more(of: Any, most: Any) -> None:
    order = {"1": 0, "2": 1, "3R": 2, "3B": 3, "4": 4}
    assert within(of, most) is (order[of] <= order[most])


@pytest.mark.parametrize("person", ["Ada", "Ben", "Eve", ""])
@pytest.mark.parametrize("of", CLASSES)
@pytest.mark.parametrize("hours", [0.5, 1.0, 1.5, 2.0, 8.0, 8.1])
def test_a_person_arms_in_the_first_role_that_allows_it(person: str, of: Any, hours: float) -> None:
    able = [name for name, role in sorted(ROLES.items()) if may(role, person, of, hours)]
    assert arming.role_for(SETUP, person, of, hours) == (able[0] if able else None)
    assert arming.role_for(bench(), person, of, hours) is None, "a lab that says nothing lets nobody"


@pytest.mark.parametrize("by", ["Ada", "Ben", "Eve", ""])
@pytest.mark.parametrize("role", [*ROLES, "", "owner"])
@pytest.mark.parametrize("of", CLASSES)
@pytest.mark.parametrize("hours", [0.5, 1.0, 2.0, 8.0, 8.01])
def test_an_arming_is_given_only_by_who_may_in_the_role_that_it_names(
    by: str, role: str, of: Any, hours: float
) -> None:
    found = arming.refusal(SETUP, given(ends=hours, by=by, role=role, laser_class=of), at(0))
    allowed = role in ROLES and may(ROLES[role], by, of, hours)
    assert (found is None) is allowed
    if found is not None:
        assert found.severity == "error" and found.code == "unarmed" and found.address == "laser"
        assert f"{by or 'nobody'} may not arm laser (class {of}) for {hours:g} h" == found.summary


@pytest.mark.parametrize(("begins", "ends", "now", "allowed"), [
    (0, 2, 0, True), (0, 2, 1, True), (0, 2, 2, False), (0, 2, 3, False), (1, 1, 0, False), (2, 1, 0, False),
    (24 * 7, 24 * 7 + 2, 0, True), (24 * 7 + 0.01, 24 * 7 + 2, 0, False), (0, 8, 4, True), (5, 7, 0, True),
])  # fmt: skip
def test_an_arming_ends_later_than_now_and_than_it_begins_and_begins_within_a_week(
    begins: float, ends: float, now: float, allowed: bool
) -> None:
    assert (arming.refusal(SETUP, given(begins, ends), at(now)) is None) is allowed


def test_only_a_laser_of_the_bench_is_armed() -> None:
    assert arming.lasers(SETUP) == ["bare", "laser", "second"]
    for name in ("gate", "cam", "nothing"):
        found = arming.refusal(SETUP, given(laser=name), at(0))
        assert found is not None and found.code == "unknown-component" and "bare, laser, second" in found.hint
    assert all(arming.refusal(SETUP, given(laser=name), at(0)) is None for name in arming.lasers(SETUP))


def test_who_may_not_is_told_why_role_by_role_and_what_would_let_them() -> None:
    found = arming.nobody(SETUP, "Ben", "laser", "3B", 4.0)
    assert found.detail == (
        "student: it is for lasers up to class 2; user: it is for lasers up to class 3R; warden: Ben is not in it"
    )
    assert "people: [Ben], laser_class: 3B" in found.hint
    assert "user: it is for 8 h at most" in arming.nobody(SETUP, "Ada", "laser", "3R", 9.0).detail
    assert arming.nobody(bench(), "Ada", "laser", "3R", 1.0).detail == (
        "the lab's policy has no role that may arm a laser"
    )
    nameless = arming.nobody(SETUP, "", "laser", "3R", 1.0)
    assert nameless.summary.startswith("nobody may not arm") and "people: [NAME]" in nameless.hint
    free = arming.needless(SETUP, "Ben", "laser", "3B", 4.0)
    assert (free.summary, free.detail) == (found.summary, found.detail) and "pico set laser shutter=open" in free.hint


@pytest.mark.parametrize("now", [-1.0, 0.0, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("seen_over", [None, True])
@pytest.mark.parametrize("backend", ["sim", "hardware"])
@pytest.mark.parametrize(("by", "of", "still"), [("Ada", "3R", True), ("Eve", "3R", False), ("Ada", "3B", False)])
def test_an_arming_counts_from_its_beginning_to_its_end_on_its_bench_while_its_person_may(
    now: float, seen_over: bool | None, backend: str, by: str, of: Any, still: bool
) -> None:
    one = given(0.0, 2.0, by=by, laser_class=of, seen_over=seen_over)
    ended = now >= 2.0 or bool(seen_over)
    assert arming.at_its_end(one, at(now)) is (now >= 2.0)
    assert bool(arming.over(SETUP, one, at(now))) is (ended or not still)
    counts = now >= 0.0 and not ended and still and backend == "sim"
    assert arming.in_force(SETUP, one, backend, at(now)) is counts
    found = arming.licences(SETUP, "hardware", [one], backend, at(now))
    assert list(found) == (["laser"] if counts else [])
    if counts:
        licence = found["laser"]
        assert (licence.laser_class, licence.by, licence.ends, licence.unattended) == (of, by, one.ends, None)


@pytest.mark.parametrize("minutes", [-1, 0, 1])
@pytest.mark.parametrize("zone", ["+02:00", "-05:00", "Z"])
def test_an_arming_ends_at_a_time_whatever_time_zone_it_names(minutes: int, zone: str) -> None:
    """As text 14:00+02:00 is later than 12:30Z."""
    ends = NOON.astimezone(datetime.fromisoformat(f"2026-11-24T12:00:00{zone}").tzinfo).isoformat()
    one = replace(given(-1.0), ends=ends)
    now = at(minutes / 60)
    assert arming.at_its_end(one, now) is (minutes >= 0)
    assert arming.in_force(SETUP, one, "sim", now) is (minutes < 0)
    assert bool(arming.refusal(SETUP, one, now)) is (minutes >= 0)


def test_a_role_that_was_taken_away_ends_an_arming_but_not_one_whose_hours_were_shortened() -> None:
    one = given(0.0, 8.0)
    assert not arming.over(SETUP, one, at(1))
    shorter = lab({"user": replace(ROLES["user"], hours=0.5)})
    assert not arming.over(shorter, one, at(1))
    assert arming.over(lab({}), one, at(1)) == arming.over(SETUP, replace(one, role="x"), at(1)).replace(
        " x ", " user "
    )
    assert arming.over(bench(), one, at(1)) == "Ada is no user for class 3R any more"


def test_why_an_arming_is_over_is_told() -> None:
    assert arming.over(SETUP, given(), at(2)) == f"the arming by Ada ended at {at(2)}"
    assert arming.over(SETUP, replace(given(), ended_by="Ben"), at(2)) == "Ben disarmed it"
    assert arming.over(SETUP, given(), at(1)) == ""


@pytest.mark.parametrize("known", [True, False])
def test_whoever_ends_an_arming_ends_it_now(known: bool) -> None:
    one = given(0.0, 8.0, unattended=True) if known else None
    ended = arming.ended(SETUP, one, "laser", "Eve", "sim", at(1))
    assert (ended.laser, ended.ends, ended.ended_by) == ("laser", at(1), "Eve")
    assert arming.over(SETUP, ended, at(1)) == "Eve disarmed it"
    assert not arming.licences(SETUP, "hardware", [ended], "sim", at(1))
    if known:
        assert (ended.by, ended.begins, ended.laser_class) == ("Ada", at(0), "3R")
    else:
        assert (ended.by, ended.laser_class, ended.backend) == ("Eve", "1", "sim")


@pytest.mark.parametrize("evidence", ["kinematic", "physics", "emulated", "hardware"])
@pytest.mark.parametrize("waived", [(), ("kinematic",), ("kinematic", "physics", "emulated"), ("hardware",)])
def test_the_waiver_counts_for_what_it_names_and_never_for_hardware(evidence: str, waived: Any) -> None:
    setup = lab(waived=waived)
    free = evidence in waived and evidence != "hardware"
    assert arming.waived(setup, evidence) is free
    assert not arming.waived(bench(), evidence)
    one = given(laser="second")
    found = arming.licences(setup, evidence, [one], "sim", at(1))
    if free:
        assert {n: (x.laser_class, x.by, x.ends) for n, x in found.items()} == dict.fromkeys(
            ("bare", "laser", "second"), ("4", "", "")
        )
    else:
        assert list(found) == ["second"] and found["second"].by == "Ada"


def test_armings_of_what_is_no_laser_here_license_nothing() -> None:
    armings = [given(laser="gate"), given(laser="gone"), given(laser="second", unattended=True), given(5.0, 7.0)]
    found = arming.licences(SETUP, "hardware", armings, "sim", at(1))
    assert list(found) == ["second"] and found["second"].unattended is True
