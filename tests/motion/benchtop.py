"""A small bench for the tests of motion, and an independent check of the paths that come out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pico.model.body import Body
from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp
from pico.model.lab import KeepOut, Lab, Part, Slot, Table
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.arm import ARM_BIT, WORLD_BIT, attach_arm
from pico.motion.arms import ArmMotion
from pico.motion.engine import add_solids
from pico.motion.kinematics import tool_pose
from pico.motion.paths import between
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject

PART = Geometry(
    footprint=Footprint(box=(60, 60)),
    height=140,
    mass=0.3,
    bodies=(
        Body(name="base", shape="box", size=(60, 60, 12), at=(0, 0, 6)),
        Body(name="post", shape="cylinder", size=(14, 80), at=(0, 0, 50)),
        Body(name="grip", shape="box", size=(34, 34, 50), at=(0, 0, 115)),
    ),
    grasp=Grasp(height=100, width=34),
)
DISC = Geometry(footprint=Footprint(disc=25), height=120, mass=0.2, grasp=Grasp(height=100, width=50))
WIDE = Geometry(footprint=Footprint(box=(80, 80)), height=100, mass=0.2, grasp=Grasp(height=80, width=80))
TALL = Geometry(footprint=Footprint(box=(40, 40)), height=450, mass=2.0)
TRIANGLE = Geometry(footprint=Footprint(polygon=((0, -40), (60, 0), (0, 40))), height=90, mass=0.4)
TYPES = {"part": PART, "disc": DISC, "wide": WIDE, "tall": TALL, "triangle": TRIANGLE}
ARM = Robot(mount=Mount(x=480, y=760, yaw=-90))


def bench(
    *, robots: Mapping[str, Robot] | None = None, keep_out: Mapping[str, KeepOut] | None = None, parts: int = 3
) -> Setup:
    """A table of 1200 mm x 900 mm with the arm at its far edge; parts `a`, `b`, `c`, ... and one `wide`."""
    inventory = {chr(ord("a") + i): Part(type="part", home="store") for i in range(parts)}
    inventory |= {"disc": Part(type="disc", home="store"), "wide": Part(type="wide", home="store")}
    lab = Lab(
        name="test",
        table=Table(size=(1200, 900)),
        slots={"store": Slot(x=100, y=100)},
        robots=robots or {"arm1": ARM},
        keep_out=keep_out or {},
        inventory=inventory,
    )
    return Setup(lab=lab, catalog={n: ComponentType(name=n, title=n, geometry=g) for n, g in TYPES.items()})


def stands(*, at: Mapping[str, tuple[Geometry, Pose]]) -> dict[str, StandingObject]:
    return {name: StandingObject(pose, geometry) for name, (geometry, pose) in at.items()}


def moved(answer: MovePath | Blocked) -> MovePath:
    assert isinstance(answer, MovePath), answer.text
    return answer


def refused(answer: MovePath | Blocked | None, *, by_second: bool = False) -> Blocked:
    """Return why something is blocked: the first collision check has found it, or only the second one."""
    assert isinstance(answer, Blocked), "not blocked"
    assert ("the two collision checks disagree" in answer.text) is by_second, answer.text
    return answer


def collisions(
    motion: ArmMotion, path: MovePath, geometry: Geometry, start: Pose, goal: Pose, yaw: float,
    standing: Mapping[str, StandingObject], step: float = 0.005,
) -> list[str]:  # fmt: skip
    """Return what a path hits, looked at every `step` rad: each leg in a model of its own with static bodies.

    Shares the shapes with the scene, and nothing else: no mocap bodies for what stands, no margins, and the part in
    hand is put where forward kinematics says.
    """
    found = []
    others = {k: v for k, v in standing.items() if k != path.component}
    for segment in path.segments:
        carried = segment.name in ("lift", "transit", "lower")
        there = dict(others)
        if not carried:
            pose = goal if segment.name in ("release", "retreat") else start
            there["its own part"] = StandingObject(pose, geometry)
        found += _leg(motion, path.robot, segment, geometry if carried else None, yaw, there, step)
    return found


def _leg(
    motion: ArmMotion, name: str, segment: Segment, held: Geometry | None, yaw: float,
    standing: Mapping[str, StandingObject], step: float,
) -> Iterator[str]:  # fmt: skip
    import mujoco

    robot = motion.setup.lab.robots[name]
    model = _model(motion.setup, name, held, standing)
    data = mujoco.MjData(model)
    for joints in _postures(segment, step):
        at = model.joint(f"{name}/joint1").qposadr[0]
        data.qpos[at : at + 7] = joints
        # the closed jaws touch what they hold, which is no collision
        data.qpos[at + 7 : at + 9] = (segment.opening + (1.0 if segment.name == "grip" else 0.0)) / 2000
        if held is not None and held.grasp is not None:
            _carry(model, data, tool_pose(robot, joints), held.grasp.height, yaw)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        for contact in data.contact:
            names = sorted(model.body(model.geom_bodyid[g]).name for g in contact.geom)
            # the part stands on the table, its fingers hold it, and the base stands where it stands
            if contact.dist < -1e-5 and not _allowed(names, name):
                yield f"{segment.name}: {names[0]} and {names[1]} by {-contact.dist * 1000:.2f} mm"


def depth_of(
    setup: Setup, held: Geometry | None, yaw: float, standing: Mapping[str, StandingObject]
) -> Callable[[Joints], float]:
    """Return what says how deep anything overlaps at given joints [mm], the pads 50 mm apart."""
    import mujoco

    model = _model(setup, "arm1", held, standing)
    data = mujoco.MjData(model)
    at = model.joint("arm1/joint1").qposadr[0]

    def depth(joints: Joints) -> float:
        data.qpos[at : at + 9] = (*joints, 0.025, 0.025)
        if held is not None and held.grasp is not None:
            _carry(model, data, tool_pose(setup.lab.robots["arm1"], joints), held.grasp.height, yaw)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        deep = [0.0]
        for contact in data.contact:
            names = sorted(model.body(model.geom_bodyid[g]).name for g in contact.geom)
            on_base = names[0] == "arm1/base" and not names[1].startswith("arm1/")
            if not on_base and not _allowed(names, "arm1"):
                deep.append(-contact.dist * 1000)
        return max(deep)

    return depth


def _allowed(names: list[str], robot: str) -> bool:
    if "hand" in names:
        return "table" in names or any(n.startswith(f"{robot}/") and ("finger" in n or "gripper" in n) for n in names)
    return f"{robot}/base" in names and "table" in names


def _model(setup: Setup, name: str, held: Geometry | None, standing: Mapping[str, StandingObject]) -> Any:
    import mujoco

    spec = mujoco.MjSpec()
    x, y = (v / 2000 for v in setup.lab.table.size)
    world = {"contype": WORLD_BIT, "conaffinity": ARM_BIT}
    table = spec.worldbody.add_body(name="table")
    table.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[x, y, 0.05], pos=[x, y, -0.05], **world)
    for other, thing in standing.items():
        half = math.radians(thing.pose.yaw) / 2
        body = spec.worldbody.add_body(
            name=other, pos=[thing.pose.x / 1000, thing.pose.y / 1000, 0], quat=[math.cos(half), 0, 0, math.sin(half)]
        )
        add_solids(spec, body, thing.geometry, **world)
    if held is not None:
        body = spec.worldbody.add_body(name="hand")
        body.add_freejoint(name="hand")  # bodies without a joint, mocap or not, never meet one another
        add_solids(spec, body, held, contype=ARM_BIT, conaffinity=ARM_BIT | WORLD_BIT)
    attach_arm(spec, name, setup.lab.robots[name])
    return spec.compile()


def _carry(model: Any, data: Any, tool: tuple[float, float, float, float], height: float, yaw: float) -> None:
    x, y, z, jaws = tool
    half = math.radians(jaws - yaw) / 2
    at = model.joint("hand").qposadr[0]
    data.qpos[at : at + 7] = (x / 1000, y / 1000, (z - height) / 1000, math.cos(half), 0, 0, math.sin(half))


def _postures(segment: Segment, step: float) -> Iterator[Joints]:
    for a, b in zip(segment.joints, segment.joints[1:], strict=False):
        count = max(1, math.ceil(max(abs(v - u) for u, v in zip(a, b, strict=True)) / step))
        for i in range(count):
            yield between(a, b, i / count)
    yield segment.joints[-1]
