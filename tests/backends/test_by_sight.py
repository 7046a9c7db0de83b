"""A bench that works by sight: what it knows of its table is what frames, joints and pads tell, and nothing else."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from benches import shel
from oracles.poison import Poisoned, poisoned
from test_sight import seeing

from pico.backends.device import Began
from pico.backends.last_seen import Taken, recall, remember_hands
from pico.backends.sim.device import SimDevice
from pico.backends.sim.hand import nudge
from pico.backends.sim.session import WorldSession
from pico.backends.sim.store import save_world
from pico.backends.sim.world import new_world
from pico.cameras.simulated import Eyes
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose, angle_between
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.simulated import ArmErrors, SimErrors
from pico.motion.arms import ArmMotion
from pico.motion.types import Blocked

SETUP = seeing()
START, GOAL = Pose(200, 220), Pose(395.0, 420.0, 30.0)
PART = "p2"
SEEN = Pose(480.0, 160.0, -90.0)
"""Where a camera sees a part while the hand is still above it."""


def nothing(_: object) -> None:
    """Hear of nothing."""


class Bench:
    """A device that somebody has taken, and its table."""

    def __init__(self, root: Path, fidelity: str = "physics", setup: Setup = SETUP) -> None:
        self.setup = setup
        self.device = SimDevice(setup, bench_at(root), fidelity, clock=lambda: "2026-11-01T12:00:00Z")
        self.seen = asyncio.run(self.device.observe())
        asyncio.run(self.device.take(1, nothing))
        assert self.device._session is not None
        self.session: WorldSession = self.device._session

    def move(self, start: Pose = START, goal: Pose = GOAL, part: str = PART, **arguments: Any) -> OperationResult:
        said = {"from": {"pose": as_json(start), **arguments}, "to": {"pose": as_json(goal)}, "grasp_yaw": 0.0}
        operation = Operation(
            id="op1", primitive="move", component=part, robot="arm1", arguments=said, reason=Reason(kind="asked")
        )
        began: Began = nothing
        return asyncio.run(self.device.execute(operation, "r/op1/1", began))

    def true(self, part: str = PART) -> Pose:
        pose = self.session.world().components[part].pose
        assert pose is not None
        return pose

    def push(self, dx: float, part: str = PART) -> None:
        """Let a hand push a part while the bench is taken."""
        self.session._world = nudge(self.setup, self.session.world(), part, dx=dx)
        self.session._mover._placed[part] = self.session._world.components[part].pose  # type: ignore[attr-defined]


@pytest.mark.parametrize("fidelity", ["physics", "kinematic"])
def test_parts_are_moved_without_anybody_knowing_the_truth(tmp_path: Path, fidelity: str) -> None:
    with poisoned():
        bench = Bench(tmp_path, fidelity)
        result = bench.move()
        after = result.after
        again = bench.move(GOAL, START)
    assert result.outcome == again.outcome == "done", (result.error, again.error)
    assert after is not None and after.pose is not None and after.uncertainty.position > 0.01
    assert result.data["error_mm"] == after.pose.distance(GOAL)
    assert bench.true().distance(START) < 0.5 and abs(angle_between(bench.true().yaw, 0.0)) < 0.3


def test_what_is_poisoned_is_the_truth(tmp_path: Path) -> None:
    exact = replace(SETUP, lab=replace(SETUP.lab, sim=replace(SETUP.lab.sim, observe="exact")))
    bench = Bench(tmp_path, setup=exact)
    with poisoned(), pytest.raises(Poisoned):
        bench.move()


def test_a_part_that_was_pushed_since_is_picked_where_it_is_seen(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "kinematic")
    bench.push(0.3)
    result = bench.move()
    assert result.outcome == "done" and bench.true().distance(GOAL) < 0.1


@pytest.mark.slow
def test_a_part_that_was_pushed_too_far_is_not_picked(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "kinematic")
    bench.push(30.0)
    result = bench.move()
    assert result.error is not None and result.error.code == "not-there" and "stands 30 mm" in result.error.summary
    assert result.after is not None and result.after.pose is not None
    assert result.after.pose.distance(bench.true()) < 0.3, "it was looked for"


def test_when_no_picture_comes_any_more_the_part_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bench, before, frame = Bench(tmp_path), START, Eyes.frame

    def black(self: Eyes, name: str, region: Any = None) -> Any:
        shown = frame(self, name, region)
        return replace(shown, gray=shown.gray * 0)

    bench.session._known.seen()
    monkeypatch.setattr(Eyes, "frame", black)
    result = bench.move()
    assert result.error is not None and result.outcome == "failed"
    assert {result.error.code} <= {"unseen", "marker-dark"}
    assert bench.true().distance(before) < 0.01


@pytest.mark.parametrize("fidelity", ["physics", "kinematic"])
def test_where_a_part_was_put_down_is_known_to_who_comes_after_a_kill(tmp_path: Path, fidelity: str) -> None:
    """Nobody had looked at it yet, and the arm that stands over it may hide it."""
    bench, known, left = Bench(tmp_path, fidelity), [], recall(bench_at(tmp_path))[PART]
    confirm = bench.session._known.confirm

    def looks(component: str, near: Pose) -> ObservedComponent:
        known.append(recall(bench_at(tmp_path))[component])
        return confirm(component, near)

    bench.session._known.confirm = looks  # type: ignore[method-assign]
    with poisoned():
        bench.move()
    assert left.pose.distance(START) < 0.5 and not left.placed
    assert known[0].pose.distance(GOAL) < 0.5 and known[0].placed and known[0].time > left.time


def test_a_hand_that_was_stopped_is_known_to_hold_its_part_by_who_comes_after(tmp_path: Path) -> None:
    with poisoned():
        bench = Bench(tmp_path)

        async def stopped() -> OperationResult:
            work = asyncio.ensure_future(_move(bench))
            while bench.session.now < 6.0 and not work.done():
                await asyncio.sleep(0)
            await bench.device.stop()
            return await work

        result = asyncio.run(stopped())
        later = Bench(tmp_path)
        held = later.seen.components[PART]
        down = later.move(part=PART, held=True)
    assert result.after is not None and result.after.presence == "held"
    assert later.seen.robots["arm1"].holding == PART and held.presence == "held"
    assert down.outcome == "done", down.error
    assert later.true().distance(GOAL) < 0.5 and abs(angle_between(later.true().yaw, GOAL.yaw)) < 0.3


async def _move(bench: Bench) -> OperationResult:
    said = {"from": {"pose": as_json(START)}, "to": {"pose": as_json(GOAL)}, "grasp_yaw": 0.0}
    operation = Operation(
        id="op1", primitive="move", component=PART, robot="arm1", arguments=said, reason=Reason(kind="asked")
    )
    return await bench.device.execute(operation, "r/op1/1", nothing)


@pytest.mark.parametrize(("right", "code"), [(3, None), (99, "misplaced")])
def test_a_part_that_lands_beside_its_goal_is_set_right_or_told(tmp_path: Path, right: int, code: str | None) -> None:
    bench = Bench(tmp_path, "kinematic")
    carried, tries = bench.session._mover.move, 0

    def beside(operation: Operation, path: Any, stands: Any = None) -> Any:
        nonlocal tries
        tries += 1
        goal = Pose(**operation.arguments["to"]["pose"])
        wrong = replace(goal, x=goal.x + (3.0 if tries < right else 0.0))
        return carried(replace(operation, arguments={**operation.arguments, "to": {"pose": as_json(wrong)}}), path)

    bench.session._mover.move = beside  # type: ignore[method-assign]
    result = bench.move(goal=SEEN)
    assert tries == 3 and (result.error.code if result.error else None) == code


def test_an_arm_that_is_off_sets_right_what_it_put_down_beside_its_goal(tmp_path: Path) -> None:
    arm = ArmErrors(mount_position=2.0, mount_rotation=0.3, joint_zero=0.1, tool_position=0.5, encoder_noise=0.01)
    with poisoned():
        off = seeing(SimErrors(arm=arm))
        bench = Bench(tmp_path, setup=replace(off, lab=replace(off.lab, sim=replace(off.lab.sim, seed=7))))
        result = bench.move(goal=SEEN)
    assert result.outcome == "done", result.error
    assert bench.true().distance(SEEN) < 0.5
    assert result.after is not None and result.after.how != "in hand", "its arm is in doubt"


def test_the_lab_of_the_case_study_sees_its_hand_by_pixels_in_physics() -> None:
    assert shel()[0].lab.sim.sight == "pixels"


def test_a_plan_and_a_run_agree_on_what_a_hand_that_was_stopped_while_it_closed_has(tmp_path: Path) -> None:
    """The run felt a part between the pads and never parked, the plan saw one that stood and never set it down."""
    sim = replace(SETUP.lab.sim, observe="exact", sight="pixels")
    setup, world = replace(SETUP, lab=replace(SETUP.lab, sim=sim)), new_world(SETUP)
    path = ArmMotion(setup).move("arm1", PART, START, GOAL, 0.0, {}, world.robots["arm1"].joints)
    assert not isinstance(path, Blocked)
    grip = next(segment for segment in path.segments if segment.name == "grip")
    robots = {"arm1": replace(world.robots["arm1"], joints=grip.joints[-1])}
    save_world(bench_at(tmp_path), replace(world, robots=robots, openings={"arm1": grip.opening - 0.2}))
    remember_hands(bench_at(tmp_path), {"arm1": Taken(component=PART, pose=Pose(0, 0))})
    for fidelity, holds in (("physics", PART), ("kinematic", None)):
        seen = asyncio.run(SimDevice(setup, bench_at(tmp_path), fidelity, clock=lambda: "").observe())
        assert seen.robots["arm1"].holding == holds
        assert (seen.components[PART].presence == "held") == bool(holds)


def test_a_part_that_a_hand_which_was_stopped_has_just_let_go_of_is_between_its_fingers(tmp_path: Path) -> None:
    """It hides it from the cameras: not known to be there, it was a thing without a marker, and no arm went near it."""
    world = nudge(SETUP, new_world(SETUP), PART, dx=GOAL.x - START.x, dy=GOAL.y - START.y, dyaw=GOAL.yaw)
    path = ArmMotion(SETUP).move("arm1", PART, START, GOAL, 0.0, {}, world.robots["arm1"].joints)
    assert not isinstance(path, Blocked)
    release = next(segment for segment in path.segments if segment.name == "release")
    robots = {"arm1": replace(world.robots["arm1"], joints=release.joints[-1])}
    save_world(bench_at(tmp_path), replace(world, robots=robots, openings={"arm1": release.opening}))
    remember_hands(bench_at(tmp_path), {"arm1": Taken(component=PART, pose=Pose(0, 0))})
    seen = asyncio.run(SimDevice(SETUP, bench_at(tmp_path), "physics", clock=lambda: "").observe())
    assert not seen.unknown and seen.robots["arm1"].holding is None
    pose = seen.components[PART].pose
    assert pose is not None and pose.distance(GOAL) < 0.5 and abs(angle_between(pose.yaw, GOAL.yaw)) < 0.5
