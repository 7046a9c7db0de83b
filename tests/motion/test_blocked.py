"""Each refusal names component, segment, obstacle, by how much, and what might help."""

from __future__ import annotations

from dataclasses import replace

import pytest
from benchtop import ARM, DISC, PART, bench, moved, refused, stands
from oracles.inverse import ik

from pico.geometry.mass import center_of_mass
from pico.model.body import Body
from pico.model.catalog import Footprint, Geometry, Grasp
from pico.model.lab import Box2, KeepOut
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.recheck import Recheck, Task
from pico.motion.stability import check_stability

START, GOAL = Pose(290, 300, 10), Pose(620, 420, 40)
ALONE = stands(at={"a": (PART, START)})
MOTION = ArmMotion(bench())


def keep_out(x, y, z):
    return ArmMotion(bench(keep_out={"lamp": KeepOut(area=Box2(x=x, y=y), z=z)}))


def test_the_carried_part_keeps_out_of_a_zone_that_the_empty_hand_passes_over():
    """Carried, the part's foot is at 150 mm; the fingers end at 240 mm. The zone ends at 200: the way goes around."""
    straight = moved(MOTION.move("arm1", "a", START, GOAL, 0, ALONE))
    motion = keep_out((530, 550), (0, 500), (145, 200))
    assert moved(motion.move("arm1", "a", START, GOAL, 0, ALONE)).seconds > straight.seconds
    again = Recheck(motion.setup, "arm1").check(straight, Task("a", PART, START, GOAL, 0), ALONE, {})
    found = refused(again, by_second=True)
    assert (found.segment, found.obstacle) == ("transit", "lamp") and "a in the hand of arm1" in found.text
    lower = keep_out((530, 550), (0, 500), (100, 145))
    assert lower.move("arm1", "a", START, GOAL, 0, ALONE) == straight


def test_a_zone_across_the_whole_way_is_named_with_its_depth():
    there = ik(ARM, START.x, START.y, 250, START.yaw)[0]
    lamp = KeepOut(area=Box2(x=(470, 480), y=(0, 510)), z=(145, 1000))
    wall = KeepOut(area=Box2(x=(200, 760), y=(930, 1100)))  # else the arm turns the other way around
    motion = ArmMotion(bench(keep_out={"lamp": lamp, "wall": wall}))
    blocked = refused(motion.move("arm1", "a", START, GOAL, 0, ALONE, there))
    assert (blocked.kind, blocked.segment, blocked.obstacle) == ("keep_out", "transit", "lamp")
    assert "would hit the keep-out zone lamp by" in blocked.text and "carrying a from" in blocked.text
    assert blocked.by is not None and blocked.by > 0 and blocked.help.startswith("make the zone lamp smaller")


def test_a_link_keeps_out_of_a_zone_that_the_hand_never_comes_near():
    """The zone is high up between base and hand: only upper arm and elbow come by."""
    path = moved(MOTION.move("arm1", "a", START, GOAL, 0, ALONE))
    assert max(tool_pose(ARM, joints)[1] for segment in path.segments for joints in segment.joints) < 600
    blocked = refused(keep_out((300, 660), (620, 700), (420, 900)).move("arm1", "a", START, GOAL, 0, ALONE))
    assert (blocked.kind, blocked.obstacle) == ("keep_out", "lamp")
    assert blocked.text.startswith("link") and blocked.by is not None and blocked.help


def test_the_fingers_keep_out_of_a_low_zone_beside_the_part():
    motion = keep_out((640, 700), (380, 460), (85, 130))
    blocked = refused(motion.move("arm1", "a", START, Pose(605, 420), 0, ALONE))
    assert (blocked.kind, blocked.obstacle) == ("keep_out", "lamp")
    moved(motion.move("arm1", "a", START, Pose(605, 420), 90, ALONE))  # another yaw, as the help says


@pytest.mark.parametrize(
    ("standing", "yaw", "segment", "obstacle", "help"),
    [
        ({"b": (DISC, START.compose(Pose(64, 0)))}, 0, "descend", "b",
         "move b away first, or choose another grasp yaw (`grasp.yaws` of its type)"),
        ({"b": (PART, GOAL.compose(Pose(61, 0)))}, 90, "lower", "b",
         "move b away first, or choose another grasp yaw (`grasp.yaws` of its type) or another place or slot"),
        ({}, 33, "grip", "a", "use a grasp yaw (`grasp.yaws` of its type) at which the jaws close on parallel faces"),
    ],
)  # fmt: skip
def test_what_is_in_the_way_is_named_with_what_might_help(standing, yaw, segment, obstacle, help):
    blocked = refused(MOTION.move("arm1", "a", START, GOAL, yaw, ALONE | stands(at=standing)))
    assert (blocked.segment, blocked.obstacle, blocked.help) == (segment, obstacle, help)
    assert blocked.by is not None and blocked.by > 0


def test_the_other_arm_stands_where_it_is_said_to_stand():
    robots = {"arm1": ARM, "arm2": Robot(mount=Mount(x=480, y=100, yaw=90))}
    motion = ArmMotion(bench(robots=robots))
    moved(motion.move("arm1", "a", START, GOAL, 0, ALONE))
    reaching = {"arm2": ik(robots["arm2"], GOAL.x, GOAL.y, 250, 0)[0]}
    blocked = refused(motion.move("arm1", "a", START, GOAL, 0, ALONE, others=reaching))
    assert blocked.obstacle == "arm2" and blocked.help.startswith("move arm2 away first")
    moved(motion.move("arm1", "a", START, GOAL, 0, ALONE))  # parked again


@pytest.mark.parametrize(
    ("pose", "kind", "help"),
    [
        (Pose(500, 885), "table_edge", "place it 15 mm farther in"),
        (
            Pose(1000, 220),
            "reach",
            "place it 77 mm nearer to arm1's base, which stands at (480, 760), or use another arm",
        ),
        (
            Pose(480, 720),
            "reach",
            "place it farther from arm1's base, which stands at (480, 760), or use another arm",
        ),
    ],
)
def test_a_place_that_is_none_says_where_there_would_be_one(pose, kind, help):
    blocked = refused(MOTION.reach("arm1", "a", pose, 0))
    assert (blocked.kind, blocked.help) == (kind, help)
    assert blocked.by is not None and blocked.by > 0


def pillar(**change):
    return replace(
        Geometry(footprint=Footprint(box=(20, 20)), height=140, mass=0.3, grasp=Grasp(height=100, width=20)), **change
    )


def test_a_tall_thin_part_is_not_put_down_by_an_arm():
    blocked = refused(check_stability("rod", pillar()))
    assert blocked.kind == "unstable"
    assert blocked.text.startswith("rod is too tall and thin to be let go: it topples at a lean of 8.1°")
    assert blocked.by == pytest.approx(70 * 0.17633 - 10, abs=0.01) and "10° are needed" in blocked.help
    assert check_stability("rod", pillar(height=100)) is None


def test_a_foot_makes_it_stand_and_a_head_beside_it_makes_it_topple():
    foot = Body(name="foot", shape="box", size=(60, 60, 12), at=(0, 0, 6))
    post = Body(name="post", shape="cylinder", size=(14, 128), at=(0, 0, 76))
    assert check_stability("rod", pillar(footprint=Footprint(box=(60, 60)), bodies=(foot, post))) is None
    head = Body(name="head", shape="box", size=(60, 60, 60), at=(90, 0, 110))
    narrow = replace(foot, size=(30, 60, 12))
    wide = pillar(footprint=Footprint(box=(240, 60)), bodies=(narrow, head))
    assert center_of_mass(wide)[0] == pytest.approx(0.4 * 90)
    blocked = refused(check_stability("lamp", wide))
    assert blocked.text == "lamp would topple when it is let go: its center of mass is 21 mm outside what it stands on"
    assert blocked.by == pytest.approx(24)


@pytest.mark.parametrize("side", [1, -1])
def test_the_center_of_mass_keeps_three_millimetres_from_the_edge(side):
    """A foot that holds all of the mass, `off` mm beside the middle of a base of 60 mm."""

    def standing(off):
        foot = Body(name="foot", shape="box", size=(20, 20, 10), at=(side * off, 0, 5))
        return pillar(footprint=Footprint(box=(60, 60)), bodies=(foot,), mass=2.0)

    assert check_stability("foot", standing(26.9)) is None
    blocked = refused(check_stability("foot", standing(27.5)))
    assert "its center of mass is only 2.5 mm from the edge of what it stands on" in blocked.text
    assert blocked.by == pytest.approx(0.5) and blocked.help.startswith("3 mm are needed")


def test_a_light_part_that_is_held_high_is_pushed_over():
    light = pillar(footprint=Footprint(box=(40, 40)), mass=0.04)
    blocked = refused(check_stability("card", light))
    assert "a push of 0.078 N where it is held topples it" in blocked.text
    assert check_stability("card", replace(light, mass=0.06)) is None


def test_an_unstable_part_is_refused_where_it_is_asked_for():
    setup = bench()
    catalog = {**setup.catalog, "part": replace(setup.catalog["part"], geometry=pillar())}
    blocked = refused(ArmMotion(replace(setup, catalog=catalog)).reach("arm1", "a", GOAL, 0))
    assert blocked.kind == "unstable" and "let a person move it" in blocked.help


@pytest.mark.parametrize(
    ("park", "text"),
    [
        ((0, -60, 0, 30, 0, 90), "`park` of an xarm7 has the angles of its 7 joints, not 6"),
        ((0, -160, 0, 30, 0, 90, 0), "joint 2 of `park` is -160 deg; it turns from -117.97 to 120 deg"),
    ],
)
def test_a_park_pose_that_the_arm_does_not_have_is_an_error(park, text):
    with pytest.raises(ValueError, match="park") as error:
        Robot(mount=Mount(x=0, y=0), park=park)
    assert str(error.value) == text
    Robot(model="gantry", mount=Mount(x=0, y=0), park=park)
