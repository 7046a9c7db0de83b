"""Two arms at one table: each reaches its half and the middle, and what crosses the middle changes hands there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from checker import check

from pico.backends.sim.kinematic import KinematicWorld
from pico.bench.bench import Bench
from pico.history.examples.example import make_example
from pico.manifest.load import load_files, load_folder
from pico.model.arming import Licence
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, place_of
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import fk, joint_at
from pico.motion.recheck import Recheck, Task
from pico.motion.types import MovePath, Segment
from pico.planning import PlanGoal, Planner

THICK = 90.0
"""How far an arm, its hand or what it carries reaches from the lines between its joints [mm]."""
WAY = ("stored", "polarized", "focused", "wide", "tilted", "circular", "stored")
States = dict[str, LabState]


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> tuple[Setup, States, ArmMotion]:
    folder = tmp_path_factory.mktemp("two_arms")
    repository = make_example("two_arms", folder)
    setup, _ = load_folder(folder).require()
    commits = repository.log(repository.tips())
    states = {c.label: load_files(repository.files(c.id), setup=setup).require()[1] for c in commits}
    return setup, states, ArmMotion(setup)


def observed(setup: Setup, state: LabState) -> Observation:
    seen = {}
    for name in setup.lab.inventory:
        values = state.components[name].values if name in state.components else {}
        known = {k: ObservedValue(value=v) for k, v in values.items()}
        seen[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=known)
    waived = {name: Licence(laser_class="3B") for name in seen if setup.type_of(name).optics.element == "source"}
    return Observation(backend="sim", components=seen, licences=waived)


def planned(lab: tuple[Setup, States, ArmMotion], a: str, b: str) -> Plan:
    setup, states, motion = lab
    return Planner(setup, motion, observed(setup, states[a])).plan(PlanGoal(states[b]))


def arms(setup: Setup, pose: Pose) -> set[str]:
    mounts = {name: robot.mount for name, robot in setup.lab.robots.items()}
    return {name for name, m in mounts.items() if 300 <= math.hypot(pose.x - m.x, pose.y - m.y) <= 660}


def test_each_arm_has_storage_of_its_own_and_both_reach_the_middle(lab: tuple[Setup, States, ArmMotion]) -> None:
    setup, _, motion = lab
    reached = {}
    for name, slot in setup.lab.slots.items():
        reached[name] = {arm for arm in setup.lab.robots if motion.reach(arm, "p1", slot.pose, 0.0) is None}
        assert arms(setup, slot.pose) <= reached[name]
    sides = {
        side: {frozenset(reached[n]) for n in reached if n.startswith(side)} for side in ("left", "right", "shared")
    }
    assert sides == {
        "left": {frozenset({"arm1"})},
        "right": {frozenset({"arm2"})},
        "shared": {frozenset(setup.lab.robots)},
    }


@pytest.mark.slow
def test_states_are_reached_from_one_another_and_only_what_crosses_is_put_down(
    lab: tuple[Setup, States, ArmMotion],
) -> None:
    setup, states, _ = lab
    for n, pair in enumerate(itertools.combinations(states, 2)):
        a, b = pair if n % 2 else pair[::-1]
        made = planned(lab, a, b)
        assert not made.errored, (a, b, [d.summary for d in made.diagnostics])
        assert check(setup, observed(setup, states[a]), states[b], made, extensions=1) == [], (a, b)
        assert made.staging.count == ("circular" in (a, b)), (a, b)
        for move in made.operations:
            if move.primitive in ("move", "stow"):
                ends = [Pose(**move.arguments[end]["pose"]) for end in ("from", "to")]
                assert all(move.robot in arms(setup, end) for end in ends), (a, b, move)


def test_a_part_that_crosses_the_table_changes_hands_in_the_middle(lab: tuple[Setup, States, ArmMotion]) -> None:
    made = planned(lab, "focused", "circular")
    first, second = (o for o in made.operations if o.component == "qwp" and o.primitive in ("move", "stow"))
    assert (first.robot, second.robot) == ("arm1", "arm2")
    assert first.arguments["to"]["slot"].startswith("shared/")
    assert first.reason.text == "put down for arm2 to take on"
    assert (made.staging.count, made.staging.proven) == (1, True)


def test_arms_work_at_the_same_time_where_they_do_not_meet(lab: tuple[Setup, States, ArmMotion]) -> None:
    made = planned(lab, "stored", "focused")
    work = sum(o.seconds for o in made.operations if o.robot)
    assert made.bound is not None
    assert made.bound <= made.makespan < 0.6 * work


def test_where_arms_meet_one_waits_for_the_other(lab: tuple[Setup, States, ArmMotion]) -> None:
    made = planned(lab, "polarized", "focused")
    inside = [o for o in made.operations if "zone/arm1+arm2" in o.resources]
    assert {o.robot for o in inside} == {"arm1", "arm2"}
    for a, b in itertools.pairwise(inside):
        assert a.start + a.seconds <= b.start + 1e-6


def chain(setup: Setup, robot: str, joints: tuple[float, ...]) -> np.ndarray:
    """Points along the links of an arm, down to the finger tips, on the table [mm]."""
    mounted = setup.lab.robots[robot]
    c, s = math.cos(math.radians(mounted.mount.yaw)), math.sin(math.radians(mounted.mount.yaw))
    bends = [(0.0, 0.0, 0.0), *(joint_at(joints, n) for n in (2, 4, 6, 7)), fk(joints, mounted.gripper.tool)[0]]
    points = [p + (q - p) * t for p, q in itertools.pairwise(np.array(bends)) for t in np.linspace(0, 1, 12)]
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.array(points) @ turn + np.array([mounted.mount.x, mounted.mount.y, mounted.mount.z])


@pytest.mark.slow
def test_arms_never_come_near_one_another_while_the_bench_follows_its_history(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[tuple[tuple[float, ...], tuple[float, ...]]] = []
    walk = KinematicWorld._walk

    def watched(self: KinematicWorld, robot: str, segment: Segment) -> Iterator[float]:
        for pause in walk(self, robot, segment):
            yield pause
            seen.append((self._joints["arm1"], self._joints["arm2"]))

    monkeypatch.setattr(KinematicWorld, "_walk", watched)
    make_example("two_arms", tmp_path / "lab")
    with Bench.open(tmp_path / "lab") as bench:
        for tag in WAY:
            made = bench.plan(tag)
            report = bench.apply(made)
            assert (report.outcome, report.failed, report.remaining) == ("done", 0, ()), (tag, report.diagnostics)
            assert report.seconds == pytest.approx(made.makespan, rel=0.01)
            assert bench.plan(tag).operations == ()
        setup = bench.setup
    both = [b for a, b in itertools.pairwise(seen) if a[0] != b[0] or a[1] != b[1]]
    nearest = min(
        np.linalg.norm(chain(setup, "arm1", one)[:, None] - chain(setup, "arm2", two)[None], axis=2).min()
        for one, two in both[::3]
    )
    assert nearest > 2 * THICK, "an arm is no thicker than that, nor what it carries"
    checks = {name: Recheck(setup, name) for name in setup.lab.robots}
    for one, two in both[::12]:
        assert checks["arm1"].check(held_still("arm1", one), Task(), {}, {"arm2": two}) is None


def held_still(robot: str, joints: tuple[float, ...]) -> MovePath:
    return MovePath(robot, None, (Segment("transit", (0.0, 1.0), (joints, joints), 80.0),))


@pytest.mark.parametrize("apart", [1.0, pytest.param(0.1, marks=pytest.mark.slow)])
def test_what_the_arms_do_at_the_same_time_does_not_collide_in_the_plan_either(
    lab: tuple[Setup, States, ArmMotion], monkeypatch: pytest.MonkeyPatch, apart: float
) -> None:
    """Looked at in moments so far `apart` [s]."""
    setup, _, motion = lab
    found: dict[tuple[str, str], list[MovePath]] = {}

    def kept(ask: Callable[..., Any], robot: str, *rest: Any, **more: Any) -> Any:
        path = ask(robot, *rest, **more)
        if isinstance(path, MovePath):
            found.setdefault((robot, path.component or "park"), []).append(path)
        return path

    for name in ("move", "park"):
        monkeypatch.setattr(motion, name, partial(kept, getattr(motion, name)))
    made = planned(lab, "stored", "circular")
    lanes: dict[str, list[tuple[Operation, MovePath]]] = {name: [] for name in setup.lab.robots}
    for op in made.operations:
        if op.robot:
            paths = found[op.robot, "park" if op.primitive == "park" else op.component]
            lanes[op.robot].append((op, next(p for p in paths if abs(p.seconds - op.seconds) < 1e-5)))
    checks = {name: Recheck(setup, name) for name in setup.lab.robots}
    together = 0
    for t in np.arange(0.0, made.makespan, apart):
        now = {name: moment(motion, name, lane, t) for name, lane in lanes.items()}
        together += sum(op is not None for op, _ in now.values()) == 2
        for a, b in (("arm1", "arm2"), ("arm2", "arm1")):
            op, still = now[a]
            part = None if op is None or op.primitive == "park" else op.component
            geometry = setup.type_of(part).geometry if part else None
            there = Pose(-5000, -5000)
            task = Task(part, geometry, there, there, float(op.arguments["grasp_yaw"]) if part and op else 0.0)
            assert checks[a].check(still, task, {}, {b: now[b][1].end}) is None, (t, a)
    assert together > 0.7 * made.makespan / apart, "and they do work at the same time"
    ends = {name: motion.move(name, "sample", Pose(1000, 500), Pose(1000, 450), 0.0, {}) for name in lanes}
    one, two = (end.end for end in ends.values() if isinstance(end, MovePath))
    assert checks["arm1"].check(held_still("arm1", one), Task(), {}, {"arm2": two}) is not None, "it can tell"


def moment(
    motion: ArmMotion, robot: str, lane: list[tuple[Operation, MovePath]], t: float
) -> tuple[Operation | None, MovePath]:
    """What an arm does at a time of the plan, and how it then stands, as a path that stays there."""
    before = motion.park_joints(robot)
    for op, path in lane:
        if t < op.start:
            break
        left = t - op.start
        for segment in path.segments if left < op.seconds else ():
            if left <= segment.seconds:
                k = min(range(len(segment.times)), key=lambda k: abs(segment.times[k] - left))
                joints = segment.joints[k]
                still = Segment(segment.name, (0.0, 1.0), (joints, joints), segment.opening)
                return op, MovePath(robot, path.component, (still,))
            left -= segment.seconds
        before = path.end
    return None, held_still(robot, before)


@pytest.mark.slow
def test_the_arms_hand_a_part_over_in_the_physical_world(tmp_path: Path) -> None:
    make_example("two_arms", tmp_path / "lab")
    with Bench.open(tmp_path / "lab", fidelity="physics") as bench:
        for tag in ("focused", "circular"):
            made = bench.plan(tag)
            report = bench.apply(made)
            assert (report.outcome, report.failed, report.remaining) == ("done", 0, ()), (tag, report.diagnostics)
            moves = sum(o.primitive in ("move", "stow") for o in made.operations)
            assert made.makespan <= report.seconds < made.makespan + 3.0 * moves
            assert bench.plan(tag).operations == ()


def test_an_arm_left_where_arms_meet_parks_before_the_other_comes_in(lab: tuple[Setup, States, ArmMotion]) -> None:
    setup, states, motion = lab
    there = motion.move("arm1", "p1", setup.lab.slots["left/a6"].pose, Pose(1000, 450, 0), 0.0, {})
    assert isinstance(there, MovePath)
    seen = observed(setup, states["polarized"])
    seen = replace(seen, robots={"arm1": ObservedRobot(joints=there.end), "arm2": ObservedRobot(joints=())})
    wanted = replace(states["polarized"], components={
        **states["polarized"].components, "iris_out": ComponentState(pose=Pose(1180, 450, 0)),
    })  # fmt: skip
    made = Planner(setup, motion, seen).plan(PlanGoal(wanted))
    assert not made.errored, [d.summary for d in made.diagnostics]
    park, move = (next(o for o in made.operations if o.component == name) for name in ("arm1", "iris_out"))
    assert park.start + park.seconds <= move.start + 1e-6
    assert park.id in move.after
