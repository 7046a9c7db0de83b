"""What the arms answer to a table of questions, kept as text: see `kept`. Angles to 0.01 deg, times to 1 ms."""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from benchtop import ARM, DISC, PART, TALL, TRIANGLE, WIDE, bench, moved, stands

sys.path.append(str(Path(__file__).resolve().parent.parent))

from kept import differs
from oracles.inverse import ik

from pico.model.catalog import Footprint, Grasp
from pico.model.lab import Box2, KeepOut, Margins
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.motion.arm import build_arm
from pico.motion.arms import ArmMotion
from pico.motion.hulls import of_geometry, of_shapes
from pico.motion.recheck import Recheck, Task
from pico.motion.scene import Scene
from pico.motion.shapes import LINKS, finger
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject
from pico.motion.zones import enters, outermost, shared_zones, within

START, GOAL = Pose(290, 300, 10), Pose(620, 420, 40)
LONG = replace(PART, height=260.0, bodies=(), footprint=Footprint(box=(40, 240)))
FAR = Robot(mount=Mount(x=480, y=40, yaw=90))
GANTRY = Robot(model="gantry", mount=Mount(x=0, y=0), speed=1.0)
CUP = replace(ARM, gripper=Gripper(fingers="none"))
EYE = replace(ARM, gripper=Gripper(eyes=((60.0, 0.0, -70.0),)), speed=0.5)


def shown(answer: MovePath | Blocked | None) -> Iterator[str]:
    if isinstance(answer, MovePath):
        for leg in answer.segments:
            at = (0, len(leg.joints) // 3, -1)
            ways = " -> ".join(", ".join(f"{math.degrees(q) + 0.0:.2f}" for q in leg.joints[i]) for i in at)
            times = f"{leg.times[0]:g} to {leg.seconds:.3f} s, {len(leg.times)} points"
            yield f"  {leg.name} {times}, open {leg.opening:g}: {ways}"
    elif answer is None:
        yield "  nothing to say"
    else:
        by = "" if answer.by is None else f"{answer.by:.2f}"
        yield f"  {answer.kind} {answer.segment} {answer.obstacle} {by}: {answer.text} | {answer.help}"


def around(*places: tuple[str, float, float]) -> dict[str, StandingObject]:
    kinds = {"part": PART, "disc": DISC, "wide": WIDE, "tall": TALL, "triangle": TRIANGLE}
    return stands(at={f"{kind}{n}": (kinds[kind], Pose(x, y, 20.0 * n)) for n, (kind, x, y) in enumerate(places)})


def moves() -> Iterator[tuple[str, MovePath | Blocked | None]]:
    lone = ArmMotion(bench())
    for yaw in (0, 90, -35):
        yield f"alone, held along {yaw}", lone.move("arm1", "a", START, GOAL, yaw, {})
    yield "a disc", lone.move("arm1", "disc", START, Pose(700, 300), 0, {})
    yield "turned in place", lone.move("arm1", "a", START, replace(START, yaw=100), 0, {})
    low = ik(ARM, 400, 300, 120, 30)[0]
    yield "from above another part", lone.move("arm1", "a", START, GOAL, 0, around(("part", 400, 300)), low)
    tall = around(("tall", 455, 400))
    yield "a tall part in the way", lone.move("arm1", "a", START, GOAL, 0, tall)
    crowd = around(("part", 360, 300), ("disc", 620, 340), ("triangle", 700, 420), ("wide", 480, 200))
    yield "in a crowd", lone.move("arm1", "a", START, GOAL, 90, crowd)
    yield "too near to another", lone.move("arm1", "a", START, GOAL, 0, around(("part", 660, 445)))
    yield "walled in", lone.move("arm1", "a", START, GOAL, 0, around(*(("tall", 560 + 60 * n, 350) for n in range(3))))
    for name, z in (("low", (0.0, 60.0)), ("middle", (145.0, 200.0)), ("high", (200.0, 600.0))):
        zone = KeepOut(area=Box2(x=(530, 550), y=(0, 500)), z=z)
        yield f"a {name} zone between", ArmMotion(bench(keep_out={"lamp": zone})).move("arm1", "a", START, GOAL, 0, {})
    roof = KeepOut(area=Box2(x=(360, 440), y=(260, 340)), z=(330, 400))
    for zone, where in ((roof, "a roof"), (replace(roof, z=(450, 500)), "a high roof")):
        under = ArmMotion(bench(keep_out={"roof": zone}))
        yield f"from under {where}", under.move("arm1", "a", START, GOAL, 0, {}, low)
        yield f"parked from under {where}", under.park("arm1", low, {})
        yield f"put down from under {where}", under.set_down("arm1", "a", Pose(400, 300), GOAL, {}, low)
    both = ArmMotion(bench(robots={"arm1": ARM, "arm2": FAR}))
    yield "beside a parked arm", both.move("arm1", "a", START, GOAL, 0, {})
    yield "the arm over there", both.move("arm2", "a", START, GOAL, 0, {})
    reaching = {"arm2": ik(FAR, 600, 400, 150, 0)[0]}
    yield "beside an arm at work", both.move("arm1", "a", START, GOAL, 0, {}, None, reaching)
    yield "a cup", ArmMotion(bench(robots={"arm1": CUP})).move("arm1", "a", START, GOAL, 0, crowd)
    yield "an eye on a slow hand", ArmMotion(bench(robots={"arm1": EYE})).move("arm1", "a", START, GOAL, 0, {})
    gantry = ArmMotion(bench(robots={"g": GANTRY}))
    yield "a gantry", gantry.move("g", "a", START, GOAL, 90, crowd, (0.1, 0.2, 0.05, 1.0))
    yield "a gantry onto another", gantry.move("g", "a", START, GOAL, 90, around(("part", 650, 440)))


def rests() -> Iterator[tuple[str, MovePath | Blocked | None]]:
    lone, crowd = ArmMotion(bench()), around(("part", 400, 300), ("disc", 620, 340))
    path = moved(lone.move("arm1", "a", START, GOAL, 0, {}))
    for name in ("lift", "transit", "lower"):
        leg = next(leg for leg in path.segments if leg.name == name)
        joints = leg.joints[len(leg.joints) // 2]
        yield f"put down from {name}", lone.set_down("arm1", "a", Pose(450, 350, 25), Pose(500, 250, 90), crowd, joints)
        yield f"parked from {name}", lone.park("arm1", joints, crowd)
    yield "put down where another stands", lone.set_down("arm1", "a", START, Pose(410, 310), crowd, path.end)
    leaning = (0.2, 0.3, 0.1, 1.2, -0.1, 1.4, 0.3)
    yield "parked from a lean", lone.park("arm1", leaning, {})
    yield "parked already", lone.park("arm1", (), {})
    gantry = ArmMotion(bench(robots={"g": GANTRY}))
    over = (0.3, 0.3, 0.25, 0.1)
    yield "put down by a gantry", gantry.set_down("g", "a", START, GOAL, {}, over)
    yield "onto another by a gantry", gantry.set_down("g", "a", START, GOAL, around(("part", 650, 440)), over)
    yield "a gantry parked", gantry.park("g", over, {})


def reaches() -> Iterator[tuple[str, MovePath | Blocked | None]]:
    zone = KeepOut(area=Box2(x=(600, 700), y=(300, 400)), z=(0, 50), reason="beam")
    lone = ArmMotion(bench(keep_out={"lamp": zone}, robots={"arm1": ARM, "high": replace(ARM, transit_height=900.0)}))
    for pose in (Pose(520, 420), Pose(1000, 220), Pose(500, 80), Pose(480, 720), Pose(500, 885), Pose(720, 350)):
        yield f"at {pose}", lone.reach("arm1", "a", pose, 0)
    yield "too wide", lone.reach("arm1", "wide", GOAL, 0)
    yield "too high", lone.reach("high", "a", Pose(520, 420), 0)
    setup = bench()
    for what, change in (
        ("no grasp", {"grasp": None}),
        ("too tall", {"height": 200.0, "grasp": Grasp(height=100, width=34)}),
    ):
        geometry = replace(PART, bodies=(), **change)
        catalog = {**setup.catalog, "part": replace(setup.catalog["part"], geometry=geometry)}
        yield what, ArmMotion(replace(setup, catalog=catalog)).reach("arm1", "a", GOAL, 0)


@pytest.mark.parametrize("questions", [moves, rests, reaches])
def test_the_arms_answer_as_they_did(questions) -> None:
    lines = [line for name, answer in questions() for line in (name, *shown(answer))]
    assert not differs(f"motion_{questions.__name__}.txt", "\n".join(lines) + "\n")


def test_what_ways_take_is_what_they_took() -> None:
    lines = []
    places = [None, START, GOAL, Pose(480, 300, -90), Pose(700, 250, 170), Pose(1100, 100)]
    for name, robot in (("arm", ARM), ("slow", EYE), ("cup", CUP), ("gantry", GANTRY)):
        motion = ArmMotion(bench(robots={"r": robot}))
        hand = (0.2, 0.1, 0.3, 0.7) if name == "gantry" else ik(ARM, 400, 300, 120, 30)[0]
        for i, start in enumerate([*places, hand]):
            for k, goal in enumerate(places):
                way = motion.travel("r", start, goal, 0.0, 35.0)
                both = start is not None and goal is not None and isinstance(start, Pose)
                load = f", loaded {motion.carry('r', 'a', start, goal, 90.0):.4f}" if both else ""
                lines.append(f"{name} {i} to {k}: {way:.4f} s{load}")
    assert not differs("motion_ways.txt", "\n".join(lines) + "\n")


def test_arms_meet_where_they_met() -> None:
    lines = []
    for name, other in (
        ("across", FAR),
        ("beside", replace(ARM, mount=Mount(x=900, y=760, yaw=-90))),
        ("gantry", GANTRY),
    ):
        setup = bench(robots={"arm1": ARM, "two": other})
        for zone in shared_zones(setup):
            lines += [f"{name}: {zone.name}", *(f"  {x:.3f}, {y:.3f}" for x, y in zone.corners)]
            lines += [f"  arm1 comes as far as {outermost(setup, ARM):.3f}"]
            for goal in (Pose(480, 760 - 60 * n) for n in range(2, 12)):
                for component in (None, "wide"):
                    joints = [q for z in (100.0, 250.0) for q in ik(ARM, goal.x, goal.y, z, 0.0)[:1]]
                    said = [within(setup, zone, "arm1", q, component, m) for q in joints for m in (0.0, 25.0, 60.0)]
                    lines.append(f"  at {goal} with {component}: {', '.join(map(str, said))}")
            path = moved(ArmMotion(setup, second_check=False).move("arm1", "a", START, GOAL, 0, {}))
            lines.append(f"  on the way: {enters(setup, zone, path)}")
    assert not differs("motion_zones.txt", "\n".join(lines) + "\n")


def test_arms_and_parts_have_the_shapes_that_they_had() -> None:
    """Of the arm all that is seen and all that collides, with masses, ranges and motors; of both checks the solids."""
    lines = []
    for name, robot in (("fingers", EYE), ("cup", CUP)):
        spec = build_arm(robot)
        model = spec.compile()
        lines.append(name)
        for n in range(model.ngeom):
            geom, kind = model.geom(n), mujoco.mjtGeom(model.geom_type[n]).name
            bits = (*geom.contype.tolist(), *geom.conaffinity.tolist(), *geom.group.tolist())
            where = " ".join(f"{v + 0.0:.4f}" for v in (*geom.pos, *geom.quat, *geom.size, *geom.rgba))
            lines.append(f"  {geom.name} {kind} {bits} {where}")
        for n in range(model.nbody):
            body = model.body(n)
            lines.append(
                f"  {body.name} {float(body.mass[0]):.4f} kg "
                + " ".join(f"{v + 0.0:.4f}" for v in (*body.pos, *body.quat))
            )
        for n in range(model.njnt):
            joint = model.joint(n)
            turning = (*joint.range, *model.dof_armature[joint.dofadr], *model.dof_damping[joint.dofadr], *joint.axis)
            lines.append(f"  {joint.name} " + " ".join(f"{v + 0.0:.4f}" for v in turning))
        for n in range(model.nu):
            drive = model.actuator(n)
            numbers = (*drive.ctrlrange, *drive.forcerange, *drive.gainprm[:3], *drive.biasprm[:3])
            lines.append(f"  {drive.name} " + " ".join(f"{v + 0.0:.4f}" for v in numbers))
        lines.append("  " + " ".join(f"{v:.4f}" for v in (*np.ravel(model.eq_solref), *np.ravel(model.eq_solimp))))
    hulls = [h for i, link in enumerate(LINKS) for h in of_shapes(f"link{i}", link, 0.25e-3)]
    hulls += of_shapes("finger", finger(-1, ARM.gripper.fingers, ARM.gripper.tool), 0.001)
    hulls += [h for geometry in (PART, DISC, WIDE, TALL, TRIANGLE) for h in of_geometry("part", geometry, 0.002)]
    for hull in hulls:
        numbers = (*hull.half, *hull.center, *np.ravel(hull.turn), hull.radius, *np.ravel(hull.corners))
        lines.append(f"  {hull.part} {hull.kind} " + " ".join(f"{float(v) + 0.0:.5f}" for v in numbers))
    assert not differs("motion_shapes.txt", "\n".join(lines) + "\n")


def configurations() -> Iterator[tuple[str, Scene, Joints]]:
    """Arms as they stand in the way of themselves, of what they hold, of one another and of the table."""
    rng = random.Random(8)
    both = bench(
        robots={"arm1": ARM, "arm2": FAR},
        keep_out={"lamp": KeepOut(area=Box2(x=(600, 640), y=(300, 500)), z=(100, 300))},
    )
    cup = bench(robots={"arm1": CUP, "arm2": FAR})
    standing = around(("part", 400, 350), ("tall", 560, 420), ("triangle", 480, 250))
    for title, setup in (("fingers", both), ("cup", cup)):
        scene = Scene(setup, "arm1", {PART: 2, TALL: 1, TRIANGLE: 1, LONG: 1})
        for held in (None, PART, LONG):
            scene.arrange(standing)
            scene.hold(held, 30.0)
            for n in range(12):
                scene.ignored = frozenset({"part0"} if n % 3 == 0 else ())
                scene.open(20.0 * (n % 4))
                scene.place_robots({"arm2": ik(FAR, 420 + 20 * n, 320, 200, 0)[0]})
                if n % 2:
                    folded = (
                        rng.uniform(-1, 1),
                        rng.uniform(0.2, 1.8),
                        0.0,
                        rng.uniform(2.2, 3.6),
                        0.0,
                        rng.uniform(1, 3),
                        0.0,
                    )
                    yield f"{title}, {held and held.height}, {n}, folded", scene, folded
                else:
                    over = ik(
                        ARM, rng.uniform(380, 640), rng.uniform(250, 450), rng.uniform(90, 260), rng.uniform(-90, 90)
                    )
                    yield f"{title}, {held and held.height}, {n}", scene, over[0]


def test_what_is_too_near_is_what_was_too_near() -> None:
    lines = []
    for name, scene, joints in configurations():
        slack, hit = scene.look(joints)
        said = f"{hit.part} {hit.obstacle} {hit.kind} {hit.gap:.2f} {hit.missing:.2f}" if hit else "free"
        lines.append(f"{name}: {slack:.2f} {said}")
        recheck = Recheck(scene.setup, "arm1")
        path = MovePath("arm1", None, (Segment("retreat", (0.0, 0.0), (joints, joints), 40.0),))
        again = recheck.check(
            path, Task(), {"t": StandingObject(Pose(560, 420), TALL)}, {"arm2": ik(FAR, 500, 320, 200, 0)[0]}
        )
        lines.append(
            "  " + (f"{again.obstacle} {again.by:.2f}: {again.text}" if again and again.by is not None else "free")
        )
    assert not differs("motion_near.txt", "\n".join(lines) + "\n")


def test_margins_are_kept_to_a_hundredth_of_a_millimetre() -> None:
    """Two parts side by side along x, and what is reported where one comes too near."""
    lines = []
    for margin in (0.0, 2.0, 5.0):
        setup = bench()
        motion = ArmMotion(replace(setup, lab=replace(setup.lab, margins=Margins(body=margin, fingers=margin))))
        for gap in (margin - 0.5, margin + 0.5):
            there = stands(at={"other": (PART, Pose(620, 420 + 60 + gap, 0))})
            answer = motion.move("arm1", "a", START, replace(GOAL, yaw=0), 0, there)
            said = "free" if isinstance(answer, MovePath) else next(shown(answer))
            lines.append(f"margin {margin:g}, gap {gap:g}: {said}")
    assert not differs("motion_margins.txt", "\n".join(lines) + "\n")
