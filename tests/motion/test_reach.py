from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from benchtop import PART, bench, moved, refused, stands
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.manifest.load import load_folder
from pico.model.catalog import Grasp
from pico.model.lab import Box2, KeepOut, Slot
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.model.state import home_state, place_of
from pico.motion.arms import ArmMotion
from pico.motion.types import MovePath, StandingObject

ROOT = Path(__file__).parents[2]
MOTION = ArmMotion(bench())


def test_within_reach_there_is_nothing_to_say():
    assert MOTION.reach("arm1", "a", Pose(520, 420, 30), 0) is None


@pytest.mark.parametrize(
    ("pose", "text"),
    [
        (Pose(1000, 220), "a at (1000, 220, 0°) is 750 mm from arm1's base; it reaches 673 mm at 250 mm height"),
        (Pose(500, 80), "a at (500, 80, 0°) is 681 mm from arm1's base; it reaches 673 mm at 250 mm height"),
        (Pose(480, 720), "a at (480, 720, 0°) is 40 mm from arm1's base; it comes no nearer than 86 mm at 100 mm height"),  # noqa: E501
    ],
)  # fmt: skip
def test_out_of_reach_says_how_far_and_how_far_it_may_be(pose, text):
    blocked = refused(MOTION.reach("arm1", "a", pose, 0))
    assert (blocked.kind, blocked.text, blocked.obstacle) == ("reach", text, None)


def test_a_part_must_stand_on_the_table():
    blocked = refused(MOTION.reach("arm1", "a", Pose(500, 885), 0))
    assert (blocked.kind, blocked.by) == ("table_edge", pytest.approx(15))
    assert blocked.text == "a at (500, 885, 0°) would stick out over the edge of the table by 15 mm"


def test_a_part_must_not_stand_in_a_keep_out_zone_at_its_height():
    low = KeepOut(area=Box2(x=(600, 700), y=(300, 400)), z=(0, 50), reason="beam")
    over = KeepOut(area=Box2(x=(300, 400), y=(300, 400)), z=(150, 400))
    motion = ArmMotion(bench(keep_out={"low": low, "over": over}))
    blocked = refused(motion.reach("arm1", "a", Pose(720, 350), 0))
    assert (blocked.kind, blocked.obstacle, blocked.by) == ("keep_out", "low", pytest.approx(10))
    assert blocked.text == "a at (720, 350, 0°) would stand 10 mm inside the keep-out zone low (beam)"
    assert motion.reach("arm1", "a", Pose(350, 350), 0) is None


def test_a_part_must_fit_between_the_jaws():
    blocked = refused(MOTION.reach("arm1", "wide", Pose(520, 420), 0))
    assert (blocked.kind, blocked.by) == ("width", pytest.approx(16))
    for stroke, fits in ((100.0, True), (99.0, False)):
        setup = bench(robots={"arm1": replace(bench().lab.robots["arm1"], gripper=Gripper(stroke=stroke))})
        assert (ArmMotion(setup).reach("arm1", "wide", Pose(520, 420), 0) is None) == fits
    assert "80 mm wide" in blocked.text and "opens 84 mm" in blocked.text


def test_what_stands_above_the_grasp_must_fit_under_the_palm():
    """From the tool center point to the palm are 72 mm."""
    for height, by in ((172.0, None), (172.5, 0.5), (200.0, 28.0)):
        setup = bench()
        geometry = replace(PART, height=height, bodies=(), grasp=Grasp(height=100, width=34))
        catalog = {**setup.catalog, "part": replace(setup.catalog["part"], geometry=geometry)}
        found = ArmMotion(replace(setup, catalog=catalog)).reach("arm1", "a", Pose(520, 420, 30), 0)
        assert (found and found.by) == (by if by is None else pytest.approx(by))
        assert found is None or "fingers have room for 72 mm" in found.text


@given(st.floats(40, 1160), st.floats(40, 860), st.floats(-180, 180))
@settings(max_examples=40, deadline=None)
def test_where_nothing_else_stands_what_is_reached_can_be_set_down(x, y, yaw):
    """Nearer than 230 mm the arm is in its own way, which only a motion can tell."""
    goal, start = Pose(x, y, yaw), Pose(290, 300)
    if goal.distance(Pose(480, 760)) < 230:
        return
    reached = MOTION.reach("arm1", "a", goal, 0) is None
    answer = MOTION.move("arm1", "a", start, goal, 0, stands(at={"a": (PART, start)}))
    assert isinstance(answer, MovePath) == reached


def test_a_gantry_reaches_everywhere_and_sets_down_where_it_should():
    gantry = Robot(model="gantry", mount=Mount(x=0, y=0), speed=1.0)
    motion = ArmMotion(bench(robots={"gantry": gantry}))
    start, goal = Pose(40, 40), Pose(1160, 860, 90)
    assert motion.reach("gantry", "a", goal, 0) is None
    path = moved(motion.move("gantry", "a", start, goal, 0, stands(at={"a": (PART, start)})))
    assert path.segments[6].joints[0] == pytest.approx((1.16, 0.86, 0.1, 1.5708), abs=1e-4)
    # 1388 mm at 1 m/s, with a quarter of a second to speed up and to slow down
    assert path.segments[4].seconds == pytest.approx(1.388 + 0.25, abs=1e-3)
    assert motion.park("gantry", path.end, {}).end == motion.park_joints("gantry")
    blocked = refused(motion.move("gantry", "a", start, goal, 0, stands(at={"b": (PART, Pose(1110, 860))})))
    assert (blocked.obstacle, blocked.by) == ("b", pytest.approx(10))


def test_storage_of_a_gantry_may_lie_beside_the_table_and_that_of_an_arm_may_not():
    for model, kind in (("gantry", None), ("xarm7", "table_edge")):
        setup = bench(robots={"robot": Robot(model=model, mount=Mount(x=100, y=300))})
        lab = replace(setup.lab, slots={"store": Slot(x=-60, y=100)})
        motion = ArmMotion(replace(setup, lab=lab))
        found = motion.reach("robot", "a", Pose(-60, 100), 0)
        assert (found and found.kind) == kind
        assert refused(motion.reach("robot", "a", Pose(-60, 300), 0)).kind == "table_edge"


def test_asking_for_reach_does_not_load_the_simulator():
    code = (
        "import sys; sys.path.insert(0, 'tests/motion')\n"
        "from pico.motion.arms import ArmMotion\n"
        "import pico.motion.kinematics, pico.motion.types\n"
        "print([m for m in ('mujoco', 'numpy', 'ruckig') if m in sys.modules])"
    )
    out = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert out.strip() == "[]"


SHEL = load_folder(ROOT / "labs" / "shel").require()[0]
SHEL_MOTION = ArmMotion(SHEL)
HOME = {n: StandingObject(place_of(SHEL, home_state(SHEL), n)[1], SHEL.type_of(n).geometry) for n in SHEL.lab.inventory}
BEAM_LINE = [Pose(x, 420) for x in range(290, 721, 43)]


@pytest.mark.parametrize("goal", [*(s.pose for s in SHEL.lab.slots.values()), *BEAM_LINE, Pose(520, 420, 30)], ids=str)
def test_the_arm_serves_every_place_of_the_case_study(goal):
    others = {n: s for n, s in HOME.items() if s.pose.distance(goal) > 85 and n != "lx_100"}
    start = Pose(380, 130) if goal != Pose(380, 130) else Pose(470, 130)
    answers = [SHEL_MOTION.move("arm1", "lx_100", start, goal, yaw, others) for yaw in (0, 90)]
    assert any(isinstance(answer, MovePath) for answer in answers)


def test_the_parked_arm_leaves_the_case_studys_beam_free():
    """With everything at its tallest, nothing is near the parked arm, and the hand is well behind the beam line."""
    from pico.motion.kinematics import tool_pose

    joints = SHEL_MOTION.park_joints("arm1")
    _, y, z, _ = tool_pose(SHEL.lab.robots["arm1"], joints)
    assert y - 420 > 120 and z > SHEL.lab.robots["arm1"].transit_height
    assert SHEL_MOTION.park("arm1", joints, HOME).seconds == 0
