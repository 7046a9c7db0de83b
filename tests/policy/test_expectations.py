"""Expectations: true, false, or unknown, which is a failure that says why."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from pico.diagnostics import ExitCode
from pico.manifest.load import load_folder
from pico.model.measurement import Measurement
from pico.model.observation import Observation, ObservedComponent, ObservedValue, Uncertainty
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import Expectation
from pico.model.trace.expectation import Expected, Verified
from pico.model.trace.report import RunReport
from pico.model.vocabulary import shown
from pico.policy.expectations import check_expectations
from pico.policy.reaching import reaching
from pico.resources import labs_dir


@pytest.fixture(scope="module")
def shel() -> Setup:
    return load_folder(labs_dir() / "shel").require()[0]


def expected(setup: Setup, that: str, **parts: ObservedComponent) -> Expected:
    seen: dict[str, Any] = {
        "p1": ObservedComponent(pose=Pose(290, 420, 0), values={"angle": ObservedValue(value=90.0)}),
        "p2": ObservedComponent(pose=Pose(520, 420, 350), values={"angle": ObservedValue(value=1.0)}),
        "lx_100": ObservedComponent(pose=Pose(112, 310, 77)),
        **parts,
    }
    return check_expectations(setup, Observation(backend="sim", components=seen), [Expectation(that=that)])[0]


@pytest.mark.parametrize("that", [
    "p2.pose.x == 520 && distance(p1, p2) == 230", "turned(p2.pose.yaw, 10) == 20", "p1.angle > p2.angle",
    "lx_100.slot == 'storage/a1' && p2.slot == ''", "inside(p1, 'beam_line') && !inside(lx_100, 'beam_line')",
    "cam.presence == 'missing' && abs(p2.angle - 2) <= 1", "p1.angle == 90 || cam.peak > 200",
])  # fmt: skip
def test_poses_slots_and_set_points_can_be_expected(shel: Setup, that: str) -> None:
    assert expected(shel, that) == Expected(that=that, holds=True)


def test_a_failing_expectation_shows_what_the_bench_shows(shel: Setup) -> None:
    found = expected(shel, "p1.angle < 45 && p2.pose.x > 0")
    assert found.holds is False
    assert found.why == "p1.angle is 90, p2.pose.x is 520"


def test_what_is_shown_reads_as_in_an_expression() -> None:
    values: dict[str, object] = {
        "a.on": True,
        "a.b": False,
        "a.x": 1 / 3,
        "a.n": 12345678,
        "a.s": "open",
        "a.xy": 1.0,
        "n": 2,
    }
    assert shown("a.on && a.x > a.n", values) == "a.n is 1.23457e+07, a.on is true, a.x is 0.333333"
    assert shown("!a.b || a.s == 'x' && n > 1", values) == "a.b is false, a.s is `open`"
    assert shown("b.a.on", values) == "" == shown("a.onto", values)


@pytest.mark.parametrize(("that", "part", "why"), [
    ("p2.pose.x > 0", ObservedComponent(presence="missing"), "p2 is missing"),
    ("distance(p1, p2) > 0", ObservedComponent(presence="toppled", pose=Pose(1, 1, 0)), "p2 is toppled"),
    ("p2.pose.x > 0", ObservedComponent(pose=Pose(520, 420, 0), uncertainty=Uncertainty(position=3)), "seen to 3 mm"),
    ("distance(p1, p2) > 0", ObservedComponent(pose=Pose(5, 4, 0), uncertainty=Uncertainty(yaw=9)), "9 deg only"),
    ("p2.angle > 0", ObservedComponent(values={"angle": ObservedValue(value=1.0, status="commanded")}), "read back"),
    ("p2.angle > 0", ObservedComponent(values={"angle": ObservedValue(value=None, status="unknown")}), "nobody knows"),
    ("p2.angel > 0", None, "did you mean `p2.angle`?"),
    ("inside(p1, 'kitchen')", None, "there is no region `kitchen`"),
])  # fmt: skip
def test_what_is_not_assured_is_unknown_and_says_why(
    shel: Setup, that: str, part: ObservedComponent | None, why: str
) -> None:
    found = expected(shel, that, **({"p2": part} if part else {}))
    assert found.holds is None
    assert why in found.why


def image(**about: Any) -> dict[str, Measurement]:
    taken = {"component": "cam", "measurable": "image", "value": {"peak": 231.0, "mean": 4.0}, "assured": ("settled",)}
    return {"cam.image": Measurement(**taken | about)}


@pytest.mark.parametrize(("that", "taken", "holds", "why"), [
    ("cam.peak > 200", image(), True, ""),
    ("cam.mean > 200", image(), False, "cam.mean is 4"),
    ("left.peak > 1", {"left.frame": replace(image()["cam.image"], component="left", measurable="frame")}, True, ""),
    ("cam.peak > 200", {}, None, "nobody measured cam.peak"),
    ("cam.peak > 200 && p1.angle == 90", {}, None, "nobody measured cam.peak"),
    ("cam.peak > 200", image(not_assured={"shutter": "laser is open"}), None, "shutter: laser is open"),
    ("cam.peak > 200", image(value=None), None, "nobody measured cam.peak"),
])  # fmt: skip
def test_what_was_measured_can_be_expected_and_what_was_not_is_not_assured(
    shel: Setup, that: str, taken: dict[str, Measurement], holds: bool | None, why: str
) -> None:
    parts = {"p1": ObservedComponent(values={"angle": ObservedValue(value=90.0)})}
    seen = Observation(backend="sim", components=parts, measurements=taken)
    (found,) = check_expectations(shel, seen, [Expectation(that=that)])
    assert (found.holds, found.assured, found.failed) == (holds, holds is not None, holds is False)
    assert why in found.why


def test_what_is_not_assured_is_no_failure() -> None:
    found = (Expected(that="x", holds=True), Expected(that="y", holds=None, assured=False))
    assert Verified(goal="e1", expectations=found).exit_code == ExitCode.DONE
    assert RunReport(run="r", goal="e1", outcome="done", expectations=found).exit_code == ExitCode.DONE


@pytest.mark.parametrize(("holds", "code"), [(True, 0), (False, 6), (None, 6)])
def test_an_expectation_that_does_not_hold_or_is_unknown_ends_a_command_with_6(holds: bool | None, code: int) -> None:
    found = (Expected(that="x", holds=True), Expected(that="y", holds=holds))
    assert Verified(goal="e1", expectations=found).exit_code == code
    assert RunReport(run="r", goal="e1", outcome="done", expectations=found).exit_code == code
    assert RunReport(run="r", goal="e1", outcome="failed", expectations=found).exit_code == ExitCode.ERROR
    assert RunReport(run="r", goal="e1", outcome="interrupted", expectations=found).exit_code == ExitCode.INTERRUPTED


def test_where_a_beam_comes_is_asked_of_lasers_and_of_what_is_seen(shel: Setup) -> None:
    at = {"laser": Pose(100, 420, 0), "p1": Pose(290, 420, 0), "p2": Pose(520, 300, 0)}
    parts = {name: ObservedComponent(pose=pose) for name, pose in at.items()}
    parts["lx_100"] = ObservedComponent(presence="toppled", pose=Pose(1, 1, 0))
    reaches = reaching(shel, Observation(backend="sim", components=parts))
    assert reaches("laser", "p1") and not reaches("laser", "p2")
    for laser, part, says in (
        ("laser", "lx_100", "lx_100 is toppled"), ("laser", "lx_125", "lx_125 is missing"),
        ("p1", "laser", "p1 is no source of light"), ("laser", "p9", "there is no component `p9`"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=says):
            reaches(laser, part)
