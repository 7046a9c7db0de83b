"""Tunables make up for what was seen of how parts were put down: by the model, within bounds, and for nothing else."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_nominal_bench import ALONG, FOLDED, POSES, ROW, SPOT, goal, standing

from pico.model.goal import Goal
from pico.model.observation import Observation, ObservedComponent, ObservedValue, Uncertainty
from pico.model.pose import Pose
from pico.model.state import LabState
from pico.optics.nominal.bench import Nominal
from pico.optics.nominal.feeding import Limits, Right, fed_forward

WIDE = {"m1.tip": (-12.0, 12.0), "m1.tilt": (-12.0, 12.0)}
ZERO = {"m1": {"tip": 0.0, "tilt": 0.0}}


def seen(
    poses: Mapping[str, Pose], values: Mapping[str, Mapping[str, float]] = ZERO, sigma: float = 0.0
) -> Observation:  # fmt: skip
    unsure = Uncertainty(position=sigma, yaw=sigma)
    return Observation(backend="sim", components={
        name: ObservedComponent(pose=pose, uncertainty=unsure, values={
            t: ObservedValue(value=v) for t, v in values.get(name, {}).items()}) for name, pose in poses.items()
    })  # fmt: skip


def fed(
    poses: Mapping[str, Pose], limits: Limits = WIDE, then: LabState | None = None, *, met: bool = True, **more: object
) -> dict[str, float] | None:
    right = Right(then or standing(POSES), met)
    return fed_forward(FOLDED.setup, seen(poses, **more), goal(limits), right, limits)  # type: ignore[arg-type]


def yawed(by: float, dx: float = 0.0, dy: float = 0.0) -> dict[str, Pose]:
    one = POSES["m1"]
    return {**POSES, "m1": Pose(one.x + dx, one.y + dy, one.yaw + by)}


def test_the_tip_of_a_mirror_makes_up_for_its_yaw() -> None:
    found = fed(yawed(0.2))
    assert found == {"m1.tip": pytest.approx(-math.radians(0.2) * 1e3, rel=1e-3)}


@given(yaw=st.floats(-0.4, 0.4), dx=st.floats(-0.4, 0.4), dy=st.floats(-0.4, 0.4))
@settings(max_examples=20, deadline=None)
def test_afterwards_light_comes_where_it_came(yaw: float, dx: float, dy: float) -> None:
    poses = yawed(yaw, dx, dy)
    found = fed(poses) or {}
    values = {"m1": {"tip": 0.0, "tilt": 0.0} | {k.partition(".")[2]: v for k, v in found.items()}}
    after, before = (Nominal(FOLDED.setup, poses, v).numbers(SPOT) for v in (values, {}))
    assert after is not None and before is not None
    left, was = (math.hypot(*n) for n in (after, before))
    assert left < max(0.05 * was, 5 * math.sqrt(2), 2 * 300 * 0.05), (
        "what is within the tolerance of an axis may be left"
    )


def test_a_stage_makes_up_for_a_lens_that_stands_aside() -> None:
    limits = {"lens.stage_y": (-1.5, 1.5), "lens.stage_z": (-1.5, 1.5)}
    poses = {**ROW, "lens": Pose(400.1, 420.3, 0.0)}
    look = seen(poses, {"lens": {"stage_y": 0.0, "stage_z": 0.0}})
    found = fed_forward(ALONG.setup, look, goal(limits), Right(standing(ROW), met=True), limits)
    assert found == {"lens.stage_y": pytest.approx(-0.3, abs=2e-3)}


def test_it_goes_on_from_where_light_was_right() -> None:
    then = standing(POSES)
    then = replace(then, components={**then.components, "m1": replace(then.components["m1"], values={"tip": 1.5})})
    found = fed(yawed(0.2), then=then)
    assert found is not None and found["m1.tip"] == pytest.approx(1.5 - math.radians(0.2) * 1e3, rel=2e-3)


def test_it_stays_within_its_limits() -> None:
    found = fed(yawed(0.2), {"m1.tip": (-1.0, 1.0), "m1.tilt": (-12.0, 12.0)})
    assert found is not None and found["m1.tip"] == -1.0


@pytest.mark.parametrize(
    ("poses", "more", "expected"),
    [
        (POSES, {}, {}),
        (POSES, {"values": {"m1": {"tip": 0.7, "tilt": 0.0}}}, {}),  # somebody turned it; nothing was put down
        (yawed(0.05), {"sigma": 0.02}, {}),  # no more than can be seen
        (yawed(30.0), {}, None),  # no light comes there
        (yawed(0.0, dx=3.0, dy=3.0), {}, None),  # that is another bench
        ({k: v for k, v in POSES.items() if k != "m1"}, {}, None),
    ],
)
def test_where_nothing_was_put_down_otherwise_or_nobody_can_tell_nothing_is_set(
    poses: Mapping[str, Pose], more: Mapping[str, object], expected: object
) -> None:
    assert fed(poses, **more) == expected  # type: ignore[arg-type]


def test_where_the_goal_was_never_met_light_goes_to_what_it_is_to_reach() -> None:
    """The bench as it was written down has the spot aside; met there, it stays aside."""
    then = standing(POSES)
    then = replace(then, components={**then.components, "m1": replace(then.components["m1"], values={"tip": 1.5})})
    aimed, kept = (fed(yawed(0.2), then=then, met=met) for met in (False, True))
    assert aimed == {"m1.tip": pytest.approx(-math.radians(0.2) * 1e3, rel=2e-3)}
    assert kept == {"m1.tip": pytest.approx(1.5 - math.radians(0.2) * 1e3, rel=2e-3)}


def test_a_power_is_kept_by_where_light_comes_to_the_detector() -> None:
    one = Goal(tunables=WIDE, maximize="cam.power")
    found = fed_forward(FOLDED.setup, seen(yawed(0.2)), one, Right(standing(POSES), met=True), WIDE)
    assert found == {"m1.tip": pytest.approx(-math.radians(0.2) * 1e3, rel=1e-2)}


def test_what_turns_no_beam_is_left_alone() -> None:
    one = Goal(tunables={"m1.angle": (0.0, 90.0)}, minimize="cam.power")
    assert (
        fed_forward(FOLDED.setup, seen(yawed(0.2)), one, Right(standing(POSES), met=True), {"m1.angle": (0.0, 90.0)})
        is None
    )
