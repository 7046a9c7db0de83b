"""The example labs: manifests without a fault, parts clear of one another, within reach, and free to be gripped."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import shapely
from shapely import affinity

from pico.history.examples.example import example_names, make_example
from pico.manifest.load import load_files, load_folder
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Fingers
from pico.model.setup import Setup
from pico.model.state import LabState, home_state, place_of
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.types import MovePath
from pico.planning import PlanGoal, Planner
from pico.resources import labs_dir

Example = tuple[Setup, dict[str, LabState]]


@pytest.fixture(scope="module", params=example_names())
def example(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Example:
    return read(request.param, tmp_path_factory.mktemp(request.param))


def read(name: str, folder: Path) -> Example:
    """The bench of an example, and its states by tag, with the one where all is at home."""
    repository = make_example(name, folder)
    setup, _ = load_folder(folder).require()
    states = {"home": home_state(setup)}
    for commit in repository.log(repository.tips()):
        states[commit.label] = load_files(repository.files(commit.id), setup=setup).require()[1]
    return setup, states


def test_there_are_five_and_they_load_without_a_word() -> None:
    assert example_names() == ("crowded", "mach_zehnder", "minimal", "shel", "two_arms")
    sizes = {}
    for name in example_names():
        manifests = load_folder(labs_dir() / name)
        assert manifests.diagnostics == () and manifests.setup
        sizes[name] = len(manifests.setup.lab.inventory)
    assert sizes == {"crowded": 30, "mach_zehnder": 13, "minimal": 3, "shel": 9, "two_arms": 14}


def standing(setup: Setup, state: LabState) -> dict[str, tuple[Pose, shapely.Geometry]]:
    return {name: (place_of(setup, state, name)[1], outline(setup, state, name)) for name in setup.lab.inventory}


def outline(setup: Setup, state: LabState, name: str) -> shapely.Geometry:
    footprint, pose = setup.type_of(name).geometry.footprint, place_of(setup, state, name)[1]
    shape = shapely.Point(0, 0).buffer(footprint.disc) if footprint.disc else shapely.Polygon(footprint.vertices)
    return at(shape, pose)


def at(shape: shapely.Geometry, pose: Pose, yaw: float = 0) -> shapely.Geometry:
    return affinity.translate(affinity.rotate(shape, pose.yaw + yaw, origin=(0, 0)), pose.x, pose.y)


def open_fingers(width: float, pose: Pose, yaw: float) -> Iterator[shapely.Geometry]:
    fingers = Fingers()
    near, far, half = width / 2, width / 2 + fingers.opening + fingers.thickness, fingers.breadth / 2
    for box in (shapely.box(near, -half, far, half), shapely.box(-far, -half, -near, half)):
        yield at(box, pose, yaw)


def test_in_every_state_parts_stand_clear_of_one_another_and_can_be_gripped(example: Example) -> None:
    setup, states = example
    for tag, state in states.items():
        parts = standing(setup, state)
        for (a, (_, one)), (b, (_, other)) in itertools.combinations(parts.items(), 2):
            assert one.distance(other) >= setup.lab.margins.body, (tag, a, b)
        for name, (pose, _) in parts.items():
            if setup.movable(name):
                grasp = setup.type_of(name).geometry.grasp
                assert grasp is not None
                others = shapely.union_all([shape for other, (_, shape) in parts.items() if other != name])
                assert any(
                    all(
                        finger.distance(others) >= setup.lab.margins.fingers
                        for finger in open_fingers(grasp.width, pose, y)
                    )
                    for y in grasp.yaws
                ), (tag, name)


def test_an_arm_reaches_every_slot_and_every_place(example: Example) -> None:
    setup, states = example
    motion = ArmMotion(setup)
    movable = [name for name in setup.lab.inventory if setup.movable(name)]
    places = {(name, place_of(setup, state, name)[1]) for state in states.values() for name in movable}
    places |= {(movable[0], slot.pose) for slot in setup.lab.slots.values()}
    for name, pose in places:
        mounts = {arm: robot.mount for arm, robot in setup.lab.robots.items()}
        near = [arm for arm, m in mounts.items() if 300 <= math.hypot(pose.x - m.x, pose.y - m.y) <= 660]
        assert near, (name, pose)
        grasp = setup.type_of(name).geometry.grasp
        assert grasp is not None
        assert all(motion.reach(arm, name, pose, yaw) is None for arm in near for yaw in grasp.yaws), (name, pose)


def planned(setup: Setup, motion: ArmMotion, a: LabState, b: LabState) -> Plan:
    seen = {}
    for name in setup.lab.inventory:
        part = a.components.get(name)
        values = {k: ObservedValue(value=v) for k, v in part.values.items()} if part else {}
        seen[name] = ObservedComponent(pose=place_of(setup, a, name)[1], values=values)
    live = Observation(backend="sim", components=seen)
    return Planner(setup, motion, live).plan(PlanGoal(b))


EVERY_WAY = [
    ("minimal", True), ("mach_zehnder", False), ("shel", False),
    *(pytest.param(name, True, marks=pytest.mark.slow) for name in ("mach_zehnder", "shel")),
]  # fmt: skip


@pytest.mark.parametrize(("name", "every"), EVERY_WAY)
def test_every_state_can_be_reached_from_every_other(name: str, every: bool, tmp_path: Path) -> None:
    """Each from each, or, quicker, each from the one before it."""
    setup, states = read(name, tmp_path)
    motion = ArmMotion(setup)
    ways = itertools.permutations(states.items(), 2) if every else itertools.pairwise(states.items())
    for (a, one), (b, other) in ways:
        found = planned(setup, motion, one, other)
        assert not found.errored, (a, b, [d.summary for d in found.diagnostics])
        assert found.staging.count == 0, (a, b)


@pytest.mark.slow
def test_crowded_can_be_planned_along_its_history_and_needs_staging(tmp_path: Path) -> None:
    setup, states = read("crowded", tmp_path)
    motion = ArmMotion(setup)
    steps = [("stored", "packed"), ("packed", "swapped"), ("swapped", "exchanged"), ("swapped", "tilted")]
    plans = {(a, b): planned(setup, motion, states[a], states[b]) for a, b in steps}
    assert not any(found.errored for found in plans.values())
    assert plans["packed", "swapped"].staging.count >= 3  # rings of two, three and four cost a stop each


def test_no_tool_is_faster_than_its_lab_allows_at_full_speed(example: Example) -> None:
    setup, states = example
    robots = {name: replace(robot, speed=1.0) for name, robot in setup.lab.robots.items()}
    motion, speeds = ArmMotion(replace(setup, lab=replace(setup.lab, robots=robots)), second_check=False), []
    for state, name in itertools.product(states.values(), setup.lab.inventory):
        start, goal = (place_of(setup, s, name)[1] for s in (states["home"], state))
        for robot in robots if start != goal else ():
            path = motion.move(robot, name, start, goal, 0.0, {})
            for leg in path.segments if isinstance(path, MovePath) else ():
                points = [tool_pose(robots[robot], joints)[:3] for joints in leg.joints]
                speeds += [math.dist(*pair) / leg.times[1] for pair in itertools.pairwise(points)]
    assert 300 < max(speeds) <= 1000
