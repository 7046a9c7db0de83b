"""The nominal bench answers as geometry says; a goal whose tunables do not span what placing parts does is refused."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from light_benches import kind, setup_of

from pico.geometry.seat import scatter_of
from pico.model.goal import Goal
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.optics.nominal.bench import Nominal
from pico.optics.nominal.spans import missing, nominal_of, span_of

SPOT = ("cam.centroid.x", "cam.centroid.y")
KINDS = {"laser": kind("hene_laser"), "m1": kind("mirror_tip_tilt"), "cam": kind("beam_camera")}
POSES = {"laser": Pose(100, 600), "m1": Pose(500, 600, 45), "cam": Pose(500, 300, -90)}
LENS = {"laser": kind("hene_laser"), "lens": kind("plano_convex_150_stage", radius_of_curvature=None),
        "cam": kind("beam_camera")}  # fmt: skip
ROW = {"laser": Pose(100, 420), "lens": Pose(400, 420), "cam": Pose(520, 420)}


def bench(kinds: Mapping[str, object], poses: Mapping[str, Pose], goals: Mapping[str, Goal] | None = None) -> Setup:
    setup = setup_of(kinds)  # type: ignore[arg-type]
    fixed = {n: replace(p, home=None, pose=poses[n]) if n in ("laser", "cam") else p
             for n, p in setup.lab.inventory.items()}  # fmt: skip
    return replace(setup, lab=replace(setup.lab, inventory=fixed, goals=goals))


def standing(poses: Mapping[str, Pose]) -> LabState:
    return LabState(lab="light", components={n: ComponentState(pose=pose) for n, pose in poses.items()})


FOLDED = Nominal(bench(KINDS, POSES), POSES, {})
ALONG = Nominal(bench(LENS, ROW), ROW, {})


def test_a_mirror_moves_the_spot_by_twice_its_angle_times_the_way() -> None:
    tip, tilt = (FOLDED.by_tunable(SPOT, f"m1.{name}") for name in ("tip", "tilt"))
    assert tip is not None and tilt is not None
    assert np.abs(tip) == pytest.approx([2 * 300, 0], abs=1), "um per mrad: 2 L"
    assert np.abs(tilt) == pytest.approx([0, 2 * 300 * math.cos(math.radians(45))], abs=1)


def test_the_yaw_of_a_mirror_is_its_tip_and_its_pitch_its_tilt() -> None:
    for way, tunable in (("yaw", "tip"), ("pitch", "tilt")):
        placed, tuned = FOLDED.by_placing(SPOT, "m1", way), FOLDED.by_tunable(SPOT, f"m1.{tunable}")
        assert placed is not None and tuned is not None
        moved = 0.0 if way == "yaw" else 70 * math.radians(1) * 1e3 * math.sqrt(2)  # its face moves back as it leans
        assert np.abs(placed) == pytest.approx(np.abs(tuned) * math.radians(1) * 1e3 + [moved, 0], rel=5e-3, abs=3)


@given(height=st.floats(-0.2, 0.2))
@settings(max_examples=10, deadline=None)
def test_a_lens_that_is_off_moves_the_spot_by_that_times_the_way_over_its_focal_length(height: float) -> None:
    found = ALONG.put("lens", "height", height).numbers(SPOT)
    assert found == pytest.approx([0, 1e3 * height * 120 / 150], abs=0.5)
    stage = ALONG.by_tunable(SPOT, "lens.stage_z")
    assert stage == pytest.approx([0, 1e3 * 120 / 150], abs=0.5)


def test_nothing_is_told_of_what_no_light_comes_to_or_of_other_numbers() -> None:
    away = replace(FOLDED, poses={**POSES, "m1": Pose(700, 700)})
    assert away.numbers(SPOT) is None and away.by_tunable(SPOT, "m1.tip") is None
    assert FOLDED.numbers(("cam.power",)) is None
    assert FOLDED.on_the_way(SPOT) == ("laser", "m1", "cam")


def goal(tunables: Mapping[str, tuple[float, float]], tolerance: float = 5.0) -> Goal:
    return Goal(tunables=tunables, reach=dict.fromkeys(SPOT, 0.0), tolerance=tolerance)


def said(tunables: Mapping[str, tuple[float, float]], tolerance: float = 5.0) -> str:
    setup = FOLDED.setup
    return " / ".join(f"{d.summary}; {d.hint}" for d in missing(setup, standing(POSES), "g", goal(tunables, tolerance)))


def test_a_goal_that_its_tunables_span_is_right() -> None:
    assert said({"m1.tip": (-12, 12), "m1.tilt": (-12, 12)}) == ""


def test_what_nothing_moves_is_named_with_what_would() -> None:
    assert said({"m1.tip": (-12, 12)}) == "nothing that g tunes moves cam.centroid.y; tilt of m1 would"
    assert said({"m1.tilt": (-12, 12)}) == "nothing that g tunes moves cam.centroid.x; tip of m1 would"


def test_bounds_that_are_too_narrow_say_how_far_they_lead() -> None:
    assert "moves cam.centroid.x by 600 um only" in said({"m1.tip": (-1, 1), "m1.tilt": (-12, 12)})
    assert "moves cam.centroid.x one way only" in said({"m1.tip": (-12, 0), "m1.tilt": (-12, 12)})


def test_what_is_near_enough_already_needs_no_tunable() -> None:
    assert said({"m1.tip": (-12, 12)}, 5000.0) == ""


def test_a_state_without_the_light_says_nothing() -> None:
    state = standing({**POSES, "m1": Pose(700, 700)})
    assert [*missing(FOLDED.setup, state, "g", goal({"m1.tip": (-12, 12)}))] == []


def test_a_state_without_what_is_tuned_says_nothing() -> None:
    """A goal of a lens that is in storage is one of other states."""
    setup = bench({**LENS, "other": kind("plano_convex_150_stage", radius_of_curvature=None)}, ROW)
    away = {"other.stage_y": (-1.5, 1.5), "other.stage_z": (-1.5, 1.5)}
    aside = standing({**ROW, "other": Pose(300, 700)})
    assert [*missing(setup, aside, "g", goal(away))] == []
    assert [*missing(setup, aside, "g", goal({"lens.stage_y": (-1.5, 1.5)}))] != []


@given(low=st.floats(-12, 0), high=st.floats(0, 12), more=st.floats(0, 5))
@settings(max_examples=25, deadline=None)
def test_wider_bounds_lead_as_far_and_further(low: float, high: float, more: float) -> None:
    one = span_of(FOLDED, "g", goal({"m1.tip": (low, high), "m1.tilt": (low, high)}))
    other = span_of(FOLDED, "g", goal({"m1.tip": (low - more, high + more), "m1.tilt": (low - more, high + more)}))
    assert one and other
    for way in ([1.0, 0.0], [0.0, 1.0], [0.6, -0.8]):
        assert other.able(np.array(way)) >= one.able(np.array(way)) - 1e-9


def test_what_placing_does_is_three_sigma_of_each_way_together() -> None:
    """Of a mirror at 45 deg: yaw, and how far its face is shifted along its normal by x, y and by leaning."""
    span = span_of(FOLDED, "g", goal({"m1.tip": (-12, 12)}))
    one = scatter_of(FOLDED.setup, "m1")
    yaw = 2 * 300 * math.radians(one.yaw) * 1e3
    shift = math.hypot(one.x, one.y, math.sqrt(2) * 70 * math.radians(one.pitch)) * 1e3
    assert span and span.needed(np.array([1.0, 0.0])) == pytest.approx(3 * math.hypot(yaw, shift), rel=2e-2)


def test_what_is_fixed_is_not_put_down() -> None:
    setup = bench(KINDS, POSES)
    bolted = {**setup.lab.inventory, "m1": replace(setup.lab.inventory["m1"], home=None, pose=POSES["m1"])}
    fixed = replace(setup, lab=replace(setup.lab, inventory=bolted))
    assert [*missing(fixed, standing(POSES), "g", goal({"m1.tip": (-12, 12)}))] == []
    assert nominal_of(fixed, standing({})).poses["m1"] == POSES["m1"]


@pytest.mark.parametrize("begun", [False, True], ids=["light not known before", "light known before"])
def test_what_is_set_and_put_one_after_the_other_has_the_light_of_a_bench_of_its_own(begun: bool) -> None:
    bench = Nominal(FOLDED.setup, POSES, {})
    if begun:
        bench.light()
    found = bench.set_to("m1.tip", 0.3).put("cam", "x", 1.5).put("m1", "pitch", 0.1).set_to("m1.tilt", -0.2)
    alone = Nominal(found.setup, found.poses, found.values, found.unseen)
    numbers, whole = found.numbers(SPOT), alone.numbers(SPOT)
    assert numbers is not None and whole is not None and numbers.tolist() == whole.tolist()
    assert bench.put("laser", "yaw", 0.05).numbers(SPOT) != pytest.approx(bench.numbers(SPOT))
