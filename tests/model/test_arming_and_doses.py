"""Classes of lasers in their order, what a role and an arming must say, and what a sample may have still."""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from pico.model.arming import CLASSES, Arming, ArmingPolicy, LaserRole, Licence, within
from pico.model.trace.dose import Dose


@pytest.mark.parametrize(("of", "most"), list(itertools.product(["1", "2", "3R", "3B", "4"], repeat=2)))
def test_a_class_is_within_those_that_are_as_dangerous_or_more(of: Any, most: Any) -> None:
    order = {"1": 0, "2": 1, "3R": 2, "3B": 3, "4": 4}
    assert within(of, most) is (order[of] <= order[most]) and tuple(order) == CLASSES


@pytest.mark.parametrize(("hours", "fine"), [
    (-1.0, False), (0.0, False), (0.01, True), (8.0, True), (168.0, True), (168.01, False), (float("nan"), False)
])  # fmt: skip
def test_a_role_is_for_some_hours_and_a_week_at_most(hours: float, fine: bool) -> None:
    if fine:
        assert LaserRole(people=("Ada",), hours=hours).hours == hours
    else:
        with pytest.raises(ValueError, match="`hours` is above 0 and at most 168"):
            LaserRole(people=("Ada",), hours=hours)


def test_without_a_word_a_role_is_for_a_working_day_up_to_class_3r_and_nothing_is_waived() -> None:
    assert (LaserRole(people=()).laser_class, LaserRole(people=()).hours) == ("3R", 8.0)
    assert ArmingPolicy() == ArmingPolicy(waived=(), roles={})
    assert Licence(laser_class="2") == Licence(laser_class="2", by="", ends="", unattended=None, withheld=None)


@pytest.mark.parametrize("begins", ["2026-11-24T12:00:00Z", "2026-11-24T12:00:00", "noon"])
@pytest.mark.parametrize("ends", ["2026-11-24T18:00:00+01:00", "2026-11-24T18:00:00", ""])
def test_an_arming_says_its_times_with_their_zone(begins: str, ends: str) -> None:
    def made() -> Arming:
        return Arming(laser="l", by="Ada", role="r", laser_class="3R", begins=begins, ends=ends, backend="sim")

    if begins.endswith("Z") and ends.endswith("+01:00"):
        assert (made().unattended, made().ended_by, made().seen_over) == (None, None, None)
    else:
        with pytest.raises(ValueError, match=r"names no time zone|isoformat"):
            made()


@pytest.mark.parametrize(("spent", "budget", "left"), [
    (0.0, None, None), (9.0, None, None), (0.0, 5.0, 5.0), (4.8, 5.0, 0.2), (5.0, 5.0, 0.0), (7.0, 5.0, 0.0)
])  # fmt: skip
def test_a_sample_may_have_what_is_left_of_its_budget(spent: float, budget: float | None, left: float | None) -> None:
    dose = Dose(sample="W1", component="holder", spent=spent, budget=budget)
    assert dose.left == (None if left is None else pytest.approx(left)) and dose.power == 0.0
    of = " mJ" if budget is None else f" of its {budget:g} mJ"
    assert dose.said == f"W1 in holder has had {spent:.4g}{of} of light"
