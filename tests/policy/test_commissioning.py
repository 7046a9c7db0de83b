"""When the report of a commissioning counts, and what is said where it does not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from pico.model.commissioning import STEPS, Basis, Commissioning, StepResult, slowly
from pico.policy.commissioning import refusal, until, why_not

ARM = {"vendor": "UFACTORY", "model": "xArm7", "serial": "XI1", "firmware": "2.1.0"}
BASIS = Basis(wired="sha256:a", bench="sha256:b", identities={"arm1": ARM})
NOW, LATER = "2026-11-25T12:00:00Z", "2027-02-24T12:00:00Z"


def step(outcome: Any = "passed", at: str = NOW, told: str = "found well") -> StepResult:
    return StepResult(outcome=outcome, at=at, by="Ada Lovelace", told=told)


WHOLE = Commissioning(lab="shel", bench="hardware", basis=BASIS, steps=dict.fromkeys(STEPS, step()))


def but(**steps: StepResult | None) -> Commissioning:
    return replace(WHOLE, steps={n: s for n, s in {**WHOLE.steps, **steps}.items() if s is not None})


def test_a_whole_report_counts_for_as_long_as_it_says() -> None:
    assert why_not(WHOLE, "hardware", BASIS, NOW) == ()
    assert f"{until(WHOLE):%Y-%m-%d}" == "2027-02-23"
    late = why_not(WHOLE, "hardware", BASIS, LATER)
    assert len(late) == len(STEPS) and late[0] == "devices was done on 2026-11-25, and counts for 90 days"
    assert why_not(replace(WHOLE, days=120.0), "hardware", BASIS, LATER) == ()
    one = but(drift=step(at="2026-08-20T12:00:00Z"))
    assert why_not(one, "hardware", BASIS, NOW) == ("drift was done on 2026-08-20, and counts for 90 days",)
    assert f"{until(one):%Y-%m-%d}" == "2026-11-18", "as old as its oldest step"


def test_a_clock_that_was_set_back_makes_no_report_younger() -> None:
    assert "is to come" in why_not(WHOLE, "hardware", BASIS, "2026-11-01T12:00:00Z")[0]


def test_what_was_not_done_or_failed_or_goes_on_is_named() -> None:
    assert why_not(None, "hardware", BASIS, NOW) == ("it was never commissioned",)
    assert why_not(but(drift=None, reach=None), "hardware", BASIS, NOW) == ("not done: reach, drift",)
    assert why_not(but(drift=step("begun", told="1 look")), "hardware", BASIS, NOW) == ("drift goes on: 1 look",)
    assert why_not(but(reach=step("failed", told="a fence")), "hardware", BASIS, NOW) == ("reach failed: a fence",)


def test_a_calibration_that_was_changed_since_is_told() -> None:
    measured = StepResult(outcome="passed", at=NOW, by="Ada", told="", data={"digest": "sha256:" + 64 * "1"})
    report = but(calibration=measured)
    assert why_not(report, "hardware", BASIS, NOW, "sha256:" + 64 * "1") == ()
    (other,) = why_not(report, "hardware", BASIS, NOW, "sha256:" + 64 * "2")
    assert other == (
        "the calibration was changed since: sha256:111111111111 was commissioned, and it is sha256:222222222222 now"
    )
    (gone,) = why_not(report, "hardware", BASIS, NOW, "")
    assert gone.endswith("and it is gone")
    assert why_not(report, "hardware", BASIS, NOW) == why_not(WHOLE, "hardware", BASIS, NOW, "sha256:2") == ()


def test_a_report_counts_for_its_own_bench_alone() -> None:
    emulated = replace(WHOLE, bench="emulated")
    assert why_not(emulated, "emulated", BASIS, NOW) == ()
    assert why_not(emulated, "hardware", BASIS, NOW) == (
        "the report is of the emulated bench, and counts for that alone",
    )
    assert slowly(emulated, "hardware", BASIS)


@pytest.mark.parametrize(
    ("basis", "said"),
    [
        (replace(BASIS, wired="sha256:c"), "the devices or safety inputs of the lab's files were changed since"),
        (replace(BASIS, bench="sha256:c"), "the table, arms, cameras or keep-out zones of the lab were changed since"),
        (replace(BASIS, identities={"arm1": {**ARM, "serial": "XI2"}}), "the serial of arm1 is XI2, and was XI1"),
        (replace(BASIS, identities={"arm1": {**ARM, "firmware": ""}}), "the firmware of arm1 is none, and was 2.1.0"),
        (replace(BASIS, identities={}), "arm1 is not there any more"),
        (replace(BASIS, identities={"arm1": ARM, "lid": {}}), "lid is new"),
    ],
)  # fmt: skip
def test_another_bench_than_it_was_makes_it_stale_for_the_reason(basis: Basis, said: str) -> None:
    assert why_not(WHOLE, "hardware", basis, NOW) == (said,)
    assert slowly(WHOLE, "hardware", basis)


def test_tools_are_slow_until_their_stop_and_the_inputs_were_tried() -> None:
    assert slowly(None, "hardware", BASIS) and not slowly(None, "emulated", BASIS)
    assert not slowly(but(drift=None, pick_and_place=step("failed")), "hardware", BASIS)
    for name in ("first_move", "stop_distance", "safety_inputs"):
        assert slowly(but(**{name: step("begun")}), "hardware", BASIS), name
    assert not slowly(WHOLE, "hardware", BASIS), "age alone slows nothing"


def test_who_is_refused_is_told_the_command() -> None:
    told = refusal("hardware", "laser", ("it was never commissioned",))
    assert told.summary == "laser stays shut: this hardware bench is not commissioned: it was never commissioned"
    assert "`pico --backend hardware commission`" in told.hint
    assert "`pico --backend hardware --emulate commission`" in refusal("emulated", "laser", ("x", "y")).hint


def test_a_report_that_makes_no_sense_is_none() -> None:
    with pytest.raises(ValueError, match="at most 366"):
        replace(WHOLE, days=1e9)
