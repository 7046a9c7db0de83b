"""The spatial hash, finger zones, the table's edge, keep-outs and slots."""

from __future__ import annotations

import random

import pytest

from pico.geometry import (
    Grid,
    capture_disc,
    conflict,
    disc,
    finger_height,
    finger_zones,
    fits,
    outline,
    overhang,
    placed,
    reaches,
    rectangle,
)
from pico.model.catalog import Footprint, Grasp
from pico.model.lab import Box2, KeepOut, Slot, Table
from pico.model.pose import Pose
from pico.model.robot import Fingers, Gripper


def random_shapes(count: int) -> dict[int, object]:
    rng = random.Random(count)
    kinds = [Footprint(box=(60, 30)), Footprint(disc=20), Footprint(box=(900, 5))]
    return {
        i: placed(
            rng.choices(kinds, (10, 10, 1))[0],
            Pose(rng.uniform(-900, 900), rng.uniform(-900, 900), rng.uniform(0, 360)),
        )
        for i in range(count)
    }


def test_the_grid_finds_the_pairs_that_comparing_all_with_all_finds() -> None:
    shapes = random_shapes(150)
    every = [(a, b) for a in shapes for b in shapes if a < b and conflict(shapes[a], shapes[b], 5)]
    assert len(every) > 20
    grid = Grid.of(shapes)
    assert [(a, b) for a in shapes for b in sorted(grid.conflicts(shapes[a], 5)) if a < b] == every


def test_a_grid_of_nothing_has_no_conflicts() -> None:
    assert Grid.of({}).conflicts(disc(0, 0, 1000), 1) == []


def test_fingers_reach_outward_from_the_grip_surfaces() -> None:
    # grip 30 wide, opening 10, fingers 14 thick and 22 broad: from 15 to 39 mm on both sides
    right, left = finger_zones(Grasp(height=100, width=30), Gripper(), 0, Pose(0, 0, 0))
    assert sorted(right.vertices) == [(15, -11), (15, 11), (39, -11), (39, 11)]
    assert sorted(left.vertices) == [(-39, -11), (-39, 11), (-15, -11), (-15, 11)]


def test_fingers_turn_with_the_part_and_with_the_grasp() -> None:
    grasp, fingers = Grasp(height=100, width=30), Gripper()
    turned = finger_zones(grasp, fingers, 60, Pose(200, 100, 30))[0]
    assert (turned.x, turned.y) == pytest.approx((200, 127))  # 90 deg in all: along y


def test_a_vacuum_gripper_needs_no_room() -> None:
    assert finger_zones(Grasp(height=100, width=30), Gripper(fingers="none"), 0, Pose(0, 0)) == ()


def test_finger_tips_reach_below_the_tool_center_point() -> None:
    assert finger_height(Grasp(height=100, width=30), Gripper(fingers=Fingers(tip=12))) == 88


def test_overhang_is_how_far_a_part_sticks_out() -> None:
    table = Table(size=(1200, 900))
    assert overhang(table, disc(1190, 450, 30)) == pytest.approx(20)
    assert overhang(table, rectangle((0, 60), (0, 60))) <= 0
    assert overhang(table, disc(float("nan"), 450, 30)) > 0


def test_a_keep_out_counts_only_where_heights_meet() -> None:
    beam = KeepOut(area=Box2(x=(0, 100), y=(0, 50)), z=(200, 300))
    assert outline(beam).radius == pytest.approx((50**2 + 25**2) ** 0.5)
    assert not reaches(beam, 0, 140)
    assert reaches(beam, 90, float("inf"))


def test_a_slot_takes_parts_up_to_its_size() -> None:
    slot = Slot(x=10, y=20, capture=8, fits=40)
    assert capture_disc(slot) == disc(10, 20, 8)
    assert fits(slot, Footprint(disc=40))
    assert not fits(slot, Footprint(box=(60, 60)))
