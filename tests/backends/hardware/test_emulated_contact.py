"""An emulated arm hits what is in its way: the bench behind it sees where the joints are, and knows no plan."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from emulated_lab import wired_lab

from pico.backends.emulated.behind import OfArm
from pico.backends.emulated.world import EmulatedWorld
from pico.emulators.xarm.control_box import READY
from pico.emulators.xarm.server import XArmEmulator
from pico.model.catalog import Footprint
from pico.model.instruments.emulation import Visitor
from pico.model.observation import UnknownObject
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.wiring import SafetyEntry
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.types import Joints, MovePath, StandingObject

GOAL = Pose(395, 420, 0)


@pytest.fixture(scope="module")
def setup(tmp_path_factory: pytest.TempPathFactory) -> Setup:
    return wired_lab(tmp_path_factory.mktemp("lab"))


@pytest.fixture(scope="module")
def path(setup: Setup) -> MovePath:
    """The way of lx_125 from its slot onto the table, past everything that stands there."""
    world = EmulatedWorld(setup, bench_at(Path("/nonexistent"), "emulated")).world()
    standing = {
        n: StandingObject(b.pose, setup.type_of(n).geometry) for n, b in world.components.items() if b.pose is not None
    }
    start = standing["lx_125"].pose
    found = ArmMotion(setup).move("arm1", "lx_125", start, GOAL, 0.0, standing)
    assert isinstance(found, MovePath)
    return found


class Arm:
    """An emulated arm before its world, without any wire and at times of its own."""

    def __init__(self, setup: Setup, folder: Path, people: Collection[Visitor] = ()) -> None:
        self.clock = 0.0
        self.world = EmulatedWorld(setup, bench_at(folder, "emulated"), wall=lambda: self.clock, people=people)
        behind = OfArm(self.world, "arm1")
        self.emulator = XArmEmulator(
            joints=behind.read("joints"), moved=behind.read("moved"), way=behind.read("way"),
            fingers=behind.read("fingers"), width=behind.read("width"),
        )  # fmt: skip
        behind.write("emulator", self.emulator)
        self.box = self.emulator.box
        self.box.settings.load = (0.8 + setup.type_of("lx_125").geometry.mass, 0.0, 0.0, 0.0)
        self.start()

    def start(self) -> None:
        self.box.clear()
        self.box.enabled, self.box.state = True, READY

    def go(self, joints: Joints, speed: float = 1.0) -> int:
        """Move to nominal joints, and return the error that this ended with."""
        arm = self.world._arms["arm1"]
        self.box.plan(tuple(float(v) for v in arm.told([joints])[0]), speed, 5.0, 1)
        while self.box.queue or self.box.motion is not None:
            self.box.advance(self.box.now + 0.02)
        return self.box.error

    def open(self, width: float) -> None:
        claw = self.box.claw
        claw.enabled = True
        claw.go(width * 850 / claw.stroke)
        claw.advance(self.box.now + 10)

    def follow(self, path: MovePath, until: str = "retreat") -> int:
        for segment in path.segments:
            for joints in segment.joints:
                if self.go(joints):
                    return self.box.error
            self.open(segment.opening)
            if segment.name == until:
                break
        return 0


@pytest.fixture
def arm(setup: Setup, tmp_path: Path) -> Arm:
    return Arm(setup, tmp_path)


def test_an_undisturbed_way_with_a_part_touches_nothing(arm: Arm, path: MovePath) -> None:
    assert arm.follow(path) == 0
    put = arm.world.world().components["lx_125"]
    assert put.presence == "seen" and put.pose is not None and put.pose.distance(GOAL) < 1e-6


def test_an_arm_that_is_driven_into_the_table_stops_on_it_and_can_be_moved_off_again(arm: Arm, setup: Setup) -> None:
    parked = arm.box.joints
    assert arm.go((0.0, 1.3, 0.0, 1.2, 0.0, 0.3, 0.0)) == 31 and arm.box.state == 4 and arm.box.motion is None
    height = tool_pose(setup.lab.robots["arm1"], arm.world.joints("arm1"))[2]
    assert height > -20, "the arm stops where it touches"
    arm.start()
    assert arm.go(parked) == 0


def test_a_fast_arm_does_not_jump_through_the_table_between_two_looks(arm: Arm) -> None:
    arm.box.plan((0.0, 1.3, 0.0, 1.2, 0.0, 0.3, 0.0), math.pi, 20.0, 1)
    arm.box.advance(0.0)
    arm.box.advance(9.0)
    assert arm.box.error == 31


def test_a_part_or_a_strange_thing_in_the_way_of_what_is_carried_is_hit(arm: Arm, path: MovePath) -> None:
    over = next(s for s in path.segments if s.name == "lower").joints[-1]
    pose = Pose(*tool_pose(arm.world.setup.lab.robots["arm1"], over)[:2])
    strange = UnknownObject(pose=pose, footprint=Footprint(disc=20), height=60)
    arm.world.change(lambda world: replace(world, unknown={"unknown/7": strange}))
    assert arm.follow(path) == 31
    assert arm.world.world().robots["arm1"].holding == "lx_125"


@pytest.mark.parametrize(("detection", "error"), [(True, 22), (False, 31)])
def test_an_arm_that_folds_into_itself_says_so_if_it_detects_that(arm: Arm, detection: bool, error: int) -> None:
    arm.box.settings.self_collision = detection
    assert arm.go((arm.box.joints[0], -1.9, 0.0, -0.1, 0.0, 1.5, 0.0)) == error


def test_a_part_that_is_lifted_with_a_load_far_from_its_own_is_an_abnormal_current(arm: Arm, path: MovePath) -> None:
    arm.box.settings.load = (4.0, 0.0, 0.0, 0.0)
    assert arm.follow(path, "grip") == 0, "nothing is lifted yet"
    assert arm.follow(path) == 31


@pytest.mark.parametrize(("clock", "error"), [(0.0, 0), (7.0, 31), (11.0, 0)])
def test_a_person_in_the_way_is_hit_while_it_is_there(
    setup: Setup, path: MovePath, tmp_path: Path, clock: float, error: int
) -> None:
    over = next(s for s in path.segments if s.name == "lower").joints[-1]
    x, y = tool_pose(setup.lab.robots["arm1"], over)[:2]
    arm = Arm(setup, tmp_path, [Visitor(x=x, y=y + 150, radius=130, height=700, arrives=5, leaves=10)])
    arm.clock = clock
    assert arm.follow(path) == error
    put = arm.world.world().components["lx_125"].pose
    assert put is not None and (put.distance(GOAL) < 1.0) == (error == 0)
    if error:
        arm.clock = 20.0
        arm.start()
        assert arm.go(path.segments[0].joints[0]) == 0, "the person has left"


def test_a_person_beside_the_table_is_hit_by_an_arm_that_reaches_over_its_edge(setup: Setup, tmp_path: Path) -> None:
    mount = setup.lab.robots["arm1"].mount
    reach = (0.0, 0.2, 0.0, 0.9, 0.0, 0.7, 0.0)
    x, y = tool_pose(setup.lab.robots["arm1"], (math.pi, *reach[1:]))[:2]
    outside = Visitor(x=x, y=y, radius=100, height=900)
    assert (x - mount.x) ** 2 + (y - mount.y) ** 2 > 300**2
    turned = (Arm(setup, tmp_path / str(n), people) for n, people in enumerate(([], [outside])))
    assert [[one.go(reach), one.go((math.pi, *reach[1:]))][-1] for one in turned] == [0, 31]


def test_a_curtain_notices_a_person_and_a_door_does_not(setup: Setup, tmp_path: Path) -> None:
    assert setup.wiring is not None
    inputs = {"veil": SafetyEntry(kind="curtain", device="veil"), "door": SafetyEntry(kind="door", device="box")}
    wired = replace(setup, wiring=replace(setup.wiring, safety_inputs=inputs))
    clock = [0.0]
    people = [Visitor(x=0, y=0, arrives=5, leaves=10)]
    world = EmulatedWorld(wired, bench_at(tmp_path, "emulated"), wall=lambda: clock[0], people=people)
    for clock[0], safe in ((0.0, True), (6.0, False), (11.0, True)):
        assert (world.safe("veil"), world.safe("box")) == (safe, True)


def test_a_scenario_opens_a_door_for_a_while(setup: Setup, tmp_path: Path) -> None:
    clock = [0.0]
    world = EmulatedWorld(
        setup, bench_at(tmp_path, "emulated"), pace=2.0, wall=lambda: clock[0], unsafe={"box": (4.0, 10.0)}
    )
    for clock[0], safe in ((0.0, True), (2.5, False), (5.5, True)):
        assert (world.safe("box"), world.safe("lid")) == (safe, True)
