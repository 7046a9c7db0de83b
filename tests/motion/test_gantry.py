"""What a gantry carries past what is taller than it carries: over it, around it, or not at all."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from itertools import pairwise

from benchtop import PART, TALL, bench, moved, refused, stands
from shapely import Polygon, affinity, box

from pico.model.catalog import Footprint, Geometry, Grasp
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.motion.arms import ArmMotion
from pico.motion.types import MovePath, StandingObject

GANTRY = Robot(model="gantry", mount=Mount(x=0, y=0), speed=1.0)
SETUP = bench(robots={"g": GANTRY})
MOTION = ArmMotion(SETUP)
A, B = Pose(200, 400), Pose(900, 400, 90)
LOW = replace(TALL, height=147.0)


def carried(path: MovePath) -> list[Polygon]:
    """What `a` covers on its way, at every few mm of it."""
    transit = next(s for s in path.segments if s.name == "transit")
    found = []
    for p, q in pairwise(transit.joints):
        for i in range(8):
            x, y, _, turn = (u + (v - u) * i / 8 for u, v in zip(p, q, strict=True))
            square = affinity.rotate(box(-30, -30, 30, 30), math.degrees(turn), origin=(0, 0))
            found.append(affinity.translate(square, 1000 * x, 1000 * y))
    return found


def outline(thing: StandingObject) -> Polygon:
    x, y = thing.geometry.footprint.box or (0, 0)
    turned = affinity.rotate(box(-x / 2, -y / 2, x / 2, y / 2), thing.pose.yaw, origin=(0, 0))
    return affinity.translate(turned, thing.pose.x, thing.pose.y)


def test_it_goes_straight_over_what_is_low_and_around_what_is_tall() -> None:
    straight = moved(MOTION.move("g", "a", A, B, 0, stands(at={"a": (PART, A)})))
    over = MOTION.move("g", "a", A, B, 0, stands(at={"a": (PART, A), "low": (LOW, Pose(550, 400))}))
    assert over == straight  # its foot is at 150 mm
    tower = {"tower": (TALL, Pose(550, 400, 20))}
    around = moved(MOTION.move("g", "a", A, B, 0, stands(at={"a": (PART, A), **tower})))
    assert around.seconds > straight.seconds
    assert min(s.distance(outline(stands(at=tower)["tower"])) for s in carried(around)) >= SETUP.lab.margins.body - 0.5


def test_a_row_of_towers_is_named_and_the_height_that_it_tells_would_do() -> None:
    row = stands(at={f"t{n:02}": (replace(TALL, height=300.0), Pose(550, 25 + 50 * n)) for n in range(18)})
    blocked = refused(MOTION.move("g", "a", A, B, 0, row))
    assert blocked.segment in ("approach", "transit") and blocked.obstacle in row and "300 mm tall" in blocked.text
    high = replace(GANTRY, transit_height=float(blocked.help.rsplit(" ", 1)[1].strip("`)")))
    moved(ArmMotion(bench(robots={"g": high})).move("g", "a", A, B, 0, row))


def test_the_empty_hand_goes_around_as_well_and_back_to_where_it_waits() -> None:
    tower = stands(at={"tower": (TALL, Pose(100, 100))})
    over = (0.2, 0.2, 0.25, 0.0)
    straight, around = moved(MOTION.park("g", over, {})), moved(MOTION.park("g", over, tower))
    assert around.end == straight.end and around.seconds > straight.seconds
    low = moved(MOTION.park("g", (0.2, 0.2, 0.1, 0.0), {}))
    risen = [q for q in low.segments[0].joints if q[2] >= 0.25]
    assert risen[0][:2] == (0.2, 0.2)  # up first, and not askew through what stands there


def test_wherever_towers_stand_a_way_keeps_clear_of_them() -> None:
    rng, detours = random.Random(7), 0
    for _ in range(40):
        towers = {
            f"t{n}": (TALL, Pose(rng.uniform(300, 800), rng.uniform(100, 800), rng.uniform(0, 90))) for n in range(5)
        }
        around = moved(MOTION.move("g", "a", A, B, 0, stands(at=towers)))
        detours += len(carried(around)) != len(carried(moved(MOTION.move("g", "a", A, B, 0, {}))))
        shapes = [outline(thing) for thing in stands(at=towers).values()]
        assert min(s.distance(tower) for s in carried(around) for tower in shapes) >= SETUP.lab.margins.body - 0.5
    assert detours > 5, "too easy to mean anything"


def test_a_part_taller_than_the_hand_rises_is_refused_and_the_height_that_it_tells_would_do() -> None:
    tower = Geometry(footprint=Footprint(box=(60, 60)), height=300, mass=1.0, grasp=Grasp(height=260, width=60))
    for robot in (GANTRY, Robot(mount=Mount(x=480, y=760, yaw=-90))):
        setup = bench(robots={"g": robot})
        setup = replace(setup, catalog={**setup.catalog, "part": replace(setup.catalog["part"], geometry=tower)})
        blocked = refused(ArmMotion(setup).reach("g", "a", Pose(480, 400), 0))
        assert (blocked.kind, blocked.by) == ("height", 62.0)
        assert blocked.text == "a is 300 mm tall; to leave it g must rise to 312 mm, and carries at 250 mm"
        assert "transit_height: 312" in blocked.help
        high = replace(setup, lab=replace(setup.lab, robots={"g": replace(robot, transit_height=312.0)}))
        motion = ArmMotion(high)
        path = moved(motion.move("g", "a", Pose(480, 400), Pose(300, 400), 0, {}))
        moved(motion.park("g", path.end, {"a": StandingObject(Pose(300, 400), tower)}))
