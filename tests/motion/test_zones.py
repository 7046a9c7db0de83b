"""Where two arms may meet."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import numpy as np
from benchtop import ARM, bench, moved
from oracles.inverse import ik
from outline import OUTLINE

from pico.geometry import disc, polygon, separation
from pico.model.lab import Table
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.motion import frames
from pico.motion.arms import ArmMotion
from pico.motion.recheck import Recheck
from pico.motion.xarm7 import LIMITS
from pico.motion.zones import HAND, _shadow, enters, outermost, shared_zones


def two(x):
    """Two arms side by side at the far edge, the second one at `x`."""
    setup = bench(robots={"arm1": ARM, "arm2": Robot(mount=Mount(x=x, y=760, yaw=-90))})
    return replace(setup, lab=replace(setup.lab, table=Table(size=(2600, 900))))


def test_arms_that_never_meet_share_nothing():
    assert shared_zones(bench()) == ()
    assert shared_zones(two(2300)) == ()


def test_a_point_is_in_the_zone_where_both_reach_it():
    setup = two(1600)
    (zone,) = shared_zones(setup)
    assert zone.robots == ("arm1", "arm2")
    area, rng = polygon(zone.corners), random.Random(1)
    reach = outermost(setup, ARM)
    for _ in range(500):
        x, y = rng.uniform(0, 2600), rng.uniform(0, 900)
        far = max(math.hypot(x - 480, y - 760), math.hypot(x - 1600, y - 760))
        inside = separation(disc(x, y, 0.0), area) <= 0
        if far <= reach:
            assert inside
        if far > reach * 1.003:  # the circle has corners
            assert not inside


def test_a_move_on_its_own_side_does_not_enter_and_one_to_the_middle_does():
    setup = two(1600)
    (zone,) = shared_zones(setup)
    motion = ArmMotion(setup)
    own = moved(motion.move("arm1", "a", Pose(290, 300), Pose(480, 300), 0, {}))
    middle = moved(motion.move("arm1", "a", Pose(290, 300), Pose(990, 600), 0, {}))
    assert not enters(setup, zone, own)
    assert enters(setup, zone, middle)


def test_seen_from_above_no_part_of_the_arm_sticks_out_of_its_discs():
    """Of the links as the vendor has them in any posture, and of the gripper where it is upright."""
    rng, recheck = random.Random(2), Recheck(bench(), "arm1")
    for number in range(60):
        joints = [rng.uniform(*limits) for limits in LIMITS]
        if number % 2:
            joints[2], joints[4] = rng.uniform(-0.01, 0.01), rng.uniform(-0.01, 0.01)
        assert max(out_of_discs(joints)) < 0.0
    for _ in range(60):
        found = ik(ARM, rng.uniform(150, 810), rng.uniform(150, 520), rng.uniform(80, 250), rng.uniform(-180, 180))
        if not found:
            continue
        turns, origins = frames.in_plane(frames.one(found[0]), (0.0, 0.0))
        spin, base = frames.world(ARM.mount, np.array(found[0][:1]))
        shadow = list(_shadow(ARM, found[0], HAND))
        assert max(out_of_discs(found[0])) < 0.0
        for link, hull in recheck._links:
            if link != frames.GRIPPER:
                continue
            turn = spin[0] @ turns[0, link] @ hull.turn
            center = spin[0] @ (turns[0, link] @ hull.center + origins[0, link]) + base
            for angle in np.linspace(0, 2 * math.pi, 16):
                n = np.array((math.cos(angle), math.sin(angle), 0.0))
                edge = 1000 * (center + n * hull.support((n @ turn).tolist()))
                assert min(math.hypot(edge[0] - d.x, edge[1] - d.y) - d.radius for d in shadow) < 1.0


def out_of_discs(joints):
    """How far each point of the links' outline is out of the nearest disc [mm], negative inside."""
    turns, origins = frames.in_plane(frames.one(joints), (0.0, 0.0))
    spin, base = frames.world(ARM.mount, np.array(joints[:1]))
    shadow = list(_shadow(ARM, joints, HAND))
    for link, points in enumerate(OUTLINE):
        for point in np.array(points) / 1000:
            x, y, _ = 1000 * (spin[0] @ (turns[0, link] @ point + origins[0, link]) + base)
            yield min(math.hypot(x - d.x, y - d.y) - d.radius for d in shadow)
