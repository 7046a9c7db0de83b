"""A part on a cable stays where the cable reaches, and is turned the way that unwinds it."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from planning_benches import GRASP, TALL, TYPES, bench, moves, part, planned, see, want

from pico.geometry.tethers import MOST, tether_fault, turn_between, wound
from pico.manifest.load import load_folder
from pico.model.lab import Slot, Tether
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.types import Blocked, MovePath
from pico.resources import labs_dir

CABLE = Tether(anchor=(400, 0), length=400)


def tied(tether: Tether = CABLE, **calibration: float) -> Setup:
    """A bench with one part on a cable, and one without."""
    return bench({"cam": part(tether=tether, home="s1", calibration=calibration), "free": part(home="s2")})


def test_a_goal_beyond_the_cable_is_refused_with_its_length() -> None:
    setup = tied()
    seen = see(setup, {"cam": (400, 300), "free": (200, 300)})
    made = planned(setup, seen, want({"cam": (700, 400), "free": (200, 300)}))
    (found,) = made.diagnostics
    assert (made.errored, found.code, found.address) == (True, "impossible", "cam.pose")
    assert "its cable is 400 mm long, and (400, 0), where it is anchored, is 500 mm away" in found.summary
    assert found.hint == "place it 100 mm nearer to (400, 0)"
    free = planned(setup, seen, want({"cam": (400, 300), "free": (700, 400)}))
    assert moves(free) == [("free", "700,400")]


def test_a_goal_that_winds_the_cable_too_far_is_refused_with_the_angle() -> None:
    setup = tied(replace(CABLE, yaw_limit=90), tether_yaw=30)
    seen = see(setup, {"cam": (400, 300, 30), "free": (200, 300)})
    found = planned(setup, seen, want({"cam": (400, 300, 150), "free": (200, 300)})).diagnostics[0]
    assert "its cable would be wound by 120°, and takes 90° either way of 30°" in found.summary
    assert not planned(setup, seen, want({"cam": (400, 300, 110), "free": (200, 300)})).errored


def test_in_a_slot_any_turn_that_the_cable_takes_will_do() -> None:
    parts = {"cam": part(tether=replace(CABLE, yaw_limit=30, length=900), home="s1")}
    setup = bench(parts, {"s1": Slot(x=60, y=60), "s2": Slot(x=160, y=60, yaw=-90)})
    made = planned(setup, see(setup, {"cam": (300, 300)}), want({"cam": "s2"}))
    assert not made.errored  # turned by a quarter in its slot, so that the cable is not wound


def test_how_far_a_cable_is_wound_counts_from_where_it_hangs_freely() -> None:
    assert wound(tied(), "cam", 170) == 170
    assert wound(tied(tether_yaw=90), "cam", -170) == 100
    assert turn_between(tied(), "cam", Pose(0, 0, 170), Pose(0, 0, -170)) == -340
    assert turn_between(tied(), "free", Pose(0, 0, 170), Pose(0, 0, -170)) is None


YAWS = st.floats(-MOST, MOST)


@given(neutral=st.floats(-180, 180), yaws=st.lists(YAWS, min_size=2, max_size=8))
def test_turned_again_and_again_a_cable_is_never_wound_by_half_a_turn(neutral: float, yaws: list[float]) -> None:
    setup = tied(Tether(anchor=(0, 0), length=1, yaw_limit=MOST), tether_yaw=neutral)
    poses = [Pose(0, 0, math.remainder(neutral + yaw, 360)) for yaw in yaws]
    assert not any(
        tether_fault(setup, "cam", pose)[0] and abs(w) < MOST - 1e-6 for pose, w in zip(poses, yaws, strict=True)
    )
    total = yaws[0]
    for a, b in pairwise(poses):
        total += turn_between(setup, "cam", a, b) or 0.0
        assert abs(total) < 180
    assert total == pytest.approx(yaws[-1], abs=1e-6)


def shel(neutral: float, model: str = "xarm7") -> Setup:
    setup, _ = load_folder(labs_dir() / "shel").require()
    tether = Tether(anchor=(500, 0), length=800, yaw_limit=MOST)
    cam = replace(setup.lab.inventory["lx_100"], tether=tether, calibration={"tether_yaw": neutral})
    robots = {n: replace(r, model=model) for n, r in setup.lab.robots.items()}
    return replace(setup, lab=replace(setup.lab, inventory={**setup.lab.inventory, "lx_100": cam}, robots=robots))


def carried(setup: Setup, path: MovePath) -> float:
    """By how much the tool turns between grip and release [deg], in steps too small to be read the wrong way."""
    joints = [q for s in path.segments if s.name in ("lift", "transit", "lower") for q in s.joints]
    total = 0.0
    for a, b in pairwise(joints):
        count = 1 + int(max(abs(p - q) for p, q in zip(a, b, strict=True)) / 0.2)
        way = [tuple(p + (q - p) * i / count for p, q in zip(a, b, strict=True)) for i in range(count + 1)]
        yaws = [tool_pose(setup.lab.robots["arm1"], q)[3] if len(q) == 7 else math.degrees(q[3]) for q in way]
        total += sum(math.remainder(v - u, 360) for u, v in pairwise(yaws))
    return total


@settings(max_examples=12, deadline=None)
@example(start=34.777010073318166, goal=0.0, neutral=90.0, model="xarm7")  # fcl saw two hulls meet that do not
@given(start=YAWS, goal=YAWS, neutral=st.sampled_from((0.0, 90.0)), model=st.sampled_from(("xarm7", "gantry")))
def test_the_arm_turns_a_tied_part_through_its_neutral_yaw(
    start: float, goal: float, neutral: float, model: str
) -> None:
    setup = shel(neutral, model)
    a, b = (Pose(x, 420, math.remainder(neutral + yaw, 360)) for x, yaw in ((400, start), (500, goal)))
    path = ArmMotion(setup).move("arm1", "lx_100", a, b, 0.0, {})
    assert isinstance(path, MovePath), path
    assert carried(setup, path) == pytest.approx(goal - start, abs=0.1)


def test_a_part_without_a_cable_turns_the_short_way() -> None:
    setup, _ = load_folder(labs_dir() / "shel").require()
    path = ArmMotion(setup).move("arm1", "lx_100", Pose(400, 420, 170), Pose(500, 420, -170), 0.0, {})
    assert isinstance(path, MovePath)
    assert carried(setup, path) == pytest.approx(20, abs=0.1)


def test_an_arm_refuses_a_place_beyond_the_cable_so_that_nothing_is_staged_there() -> None:
    setup = shel(0.0)
    found = ArmMotion(setup).reach("arm1", "lx_100", Pose(900, 780), 0.0)
    assert isinstance(found, Blocked)
    assert (found.kind, round(found.by or 0)) == ("reach", 77)


def test_nothing_is_put_into_storage_beyond_its_cable() -> None:
    slots = {"near": Slot(x=60, y=60), "far": Slot(x=740, y=60)}
    kinds = {**TYPES, "block": replace(TYPES["block"], geometry=replace(TALL, grasp=GRASP))}
    tether = Tether(anchor=(300, 300), length=360)
    parts = {n: part(home="near", tether=tether) for n in ("a", "b")}
    setup = bench(parts, slots, robots={"arm1": Robot(model="gantry", mount=Mount(x=400, y=500))})
    setup = Setup(lab=setup.lab, catalog=kinds)
    swap = {"a": (300, 300), "b": (400, 300)}, {"a": (400, 300), "b": (300, 300)}
    made = planned(setup, see(setup, swap[0]), want(swap[1]), ArmMotion(setup))
    assert [to for _, to in moves(made) if to in slots] == ["near"]
    taken = bench({**parts, "c": part(home="near")}, slots, robots=setup.lab.robots)
    full = planned(taken, see(taken, {**swap[0], "c": "near"}), want({**swap[1], "c": "near"}), ArmMotion(taken))
    assert full.errored or "far" not in [to for name, to in moves(full) if name in parts]
