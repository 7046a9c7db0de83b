"""The xArm7 with its parallel gripper as a MuJoCo model built in code, for the collision scene and for the twin.

Names within an arm: bodies `base`, `link1` to `link7`, `gripper`, `left_finger`, `right_finger`; joints `joint1` to
`joint7`, `left_slide`, `right_slide`; geoms `left_pad`, `right_pad`, and `<body>_<n>`; actuators `joint1` to
`joint7` [rad] and `gripper` (travel of each finger [m], so that the opening is twice it); site `tcp`. `attach_arm`
puts the robot's name before them: `arm1/tcp`.

What is seen is in geom group 2, what is only hit in group 3; what is only seen has contype and conaffinity 0.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pico.model.robot import Fingers, Robot
from pico.motion.engine import require_mujoco
from pico.motion.shapes import FINGER_MASS, LINK_MASSES, LINKS, PALM_MASS, LinkShape, cup, finger, palm
from pico.motion.xarm7 import LIMITS, ORIGINS, ROLLS
from pico.vision.arm import NOMINAL, ArmOffsets

if TYPE_CHECKING:
    import mujoco

ARM_BIT = 1
"""Bit of contype and conaffinity of arms and grippers: they meet one another and what has `WORLD_BIT`."""
WORLD_BIT = 2
"""Bit of contype and conaffinity of everything else; a table or component with it meets arms and other components."""

VISUAL_GROUP = 2
COLLISION_GROUP = 3
SITE_GROUP = 4
FINGERS = ("left", "right")
GRIP_FORCE = 28.0
"""What each pad presses with at most, in rest [N]."""

_TORQUE = (50.0, 50.0, 30.0, 30.0, 30.0, 20.0, 20.0)  # N m, what the joints' gears stand
_STIFFNESS = (6000.0, 6000.0, 4000.0, 4000.0, 2000.0, 2000.0, 1000.0)  # N m/rad
_TIME_CONSTANT = 0.05  # s, of a joint's servo
_ARMATURE = 0.1  # kg m2, the rotors seen through their gears
_FINGER_DAMPING = 300.0  # N s/m: the gripper shuts at 90 mm/s at most


def build_arm(robot: Robot, offsets: ArmOffsets = NOMINAL) -> mujoco.MjSpec:
    """Return a model of `robot` with its base at the origin, in metres and radians; joints at zero, gripper shut.

    `offsets`: how joints and tool differ from the lab's; the joints are those that encoders read.

    Raises PicoError where MuJoCo can't be imported for want of OpenGL; see `require_mujoco`.
    """
    require_mujoco()
    import mujoco

    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    parent = spec.worldbody.add_body(name="base", gravcomp=1)
    _add_shapes(parent, LINKS[0], LINK_MASSES[0])
    for index in range(7):
        parent = _add_link(parent, index, offsets.zeros[index])
        _add_servo(spec, index)
    _add_gripper(spec, parent, robot, offsets.tool)
    for first, second in NEIGHBORS:
        if robot.gripper.fingers == "none" and "finger" in second:
            continue
        spec.add_exclude(bodyname1=first, bodyname2=second)
    return spec


NEIGHBORS = (
    ("base", "link1"),
    ("base", "link2"),
    ("link1", "link3"),
    ("link2", "link4"),
    ("link3", "link5"),
    ("link4", "link6"),
    ("link5", "link7"),
    ("link6", "gripper"),
    ("left_finger", "right_finger"),
    ("link7", "left_finger"),
    ("link7", "right_finger"),
)
"""Bodies that touch by construction, besides parent and child, of which MuJoCo looks at a base and what turns on it."""


def attach_arm(
    spec: mujoco.MjSpec, name: str, robot: Robot, arm: mujoco.MjSpec | None = None, offsets: ArmOffsets = NOMINAL
) -> None:
    """Add `robot` to `spec` at its mount, its names prefixed with `name/`; z = 0 is the top of the table.

    `arm` is its model where the caller has built and changed one; `offsets`: how it differs from the lab's.
    """
    mount = robot.mount
    half = math.radians(mount.yaw) / 2
    place = [(v + shift) / 1000 for v, shift in zip((mount.x, mount.y, mount.z), offsets.shift, strict=True)]
    frame = spec.worldbody.add_frame(pos=place, quat=_turned(offsets.turn, (math.cos(half), 0, 0, math.sin(half))))
    frame.attach_body((arm or build_arm(robot, offsets)).body("base"), f"{name}/", "")


def _turned(vector: tuple[float, float, float], quaternion: tuple[float, ...]) -> list[float]:
    """The quaternion turned by the rotation vector [deg]."""
    if not any(vector):
        return list(quaternion)
    import mujoco
    import numpy as np

    turn, found = np.zeros(4), np.zeros(4)
    axis = np.radians(vector)
    mujoco.mju_axisAngle2Quat(turn, axis / np.linalg.norm(axis), float(np.linalg.norm(axis)))
    mujoco.mju_mulQuat(found, turn, np.array(quaternion))
    return [float(v) for v in found]


def _add_link(parent: Any, index: int, zero: float) -> Any:
    half, own = math.radians(ROLLS[index]) / 2, math.radians(zero) / 2
    (a, b), (c, d) = ((math.cos(angle), math.sin(angle)) for angle in (half, own))
    body = parent.add_body(
        name=f"link{index + 1}",
        pos=[v / 1000 for v in ORIGINS[index]],
        quat=[a * c, b * c, -b * d, a * d],
        gravcomp=1,
    )
    body.add_joint(name=f"joint{index + 1}", axis=[0, 0, 1], range=list(LIMITS[index]), armature=_ARMATURE)
    _add_shapes(body, LINKS[index + 1], LINK_MASSES[index + 1])
    return body


def _add_servo(spec: Any, index: int) -> None:
    name, stiffness, torque = f"joint{index + 1}", _STIFFNESS[index], _TORQUE[index]
    actuator = _actuator(spec, name, name, LIMITS[index], torque)
    actuator.set_to_position(kp=stiffness, kv=stiffness * _TIME_CONSTANT)


def _actuator(spec: Any, name: str, joint: str, ctrlrange: tuple[float, float], force: float) -> Any:
    import mujoco

    return spec.add_actuator(
        name=name,
        target=joint,
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        ctrlrange=list(ctrlrange),
        forcerange=[-force, force],
        ctrllimited=1,
        forcelimited=1,
    )


def _add_gripper(spec: Any, flange: Any, robot: Robot, off: tuple[float, float, float]) -> None:
    import mujoco

    gripper = robot.gripper
    place = [-off[0] / 1000, -off[1] / 1000, off[2] / 1000]  # half a turn about the flange's axis
    body = flange.add_body(name="gripper", pos=place, quat=[0, 0, 0, 1], gravcomp=1)
    _add_shapes(body, palm(gripper), PALM_MASS)
    body.add_site(name="tcp", pos=[0, 0, gripper.tool / 1000], size=[0.003, 0, 0], group=SITE_GROUP)
    if gripper.fingers == "none":
        _geom(body, cup(gripper.tool), "cup", FINGER_MASS)
        return
    travel = gripper.stroke / 2000
    for name, side in zip(FINGERS, (1, -1), strict=True):
        _add_finger(body, name, side, gripper.fingers, gripper.tool, travel)
    spec.add_equality(
        type=mujoco.mjtEq.mjEQ_JOINT,
        objtype=mujoco.mjtObj.mjOBJ_JOINT,
        name1="left_slide",
        name2="right_slide",
        data=[0, 1, *[0] * 10],
        solref=[0.004, 1],
        solimp=[0.99, 0.999, 0.0005, 0.5, 2],
    )
    # one motor closes both fingers, so each pad gets half of its force
    actuator = _actuator(spec, "gripper", "left_slide", (0.0, travel), 2 * GRIP_FORCE)
    actuator.set_to_position(kp=8000.0, kv=0.0)


def _add_finger(palm: Any, name: str, side: int, fingers: Fingers, tool: float, travel: float) -> None:
    import mujoco

    body = palm.add_body(name=f"{name}_finger", gravcomp=1)
    body.add_joint(
        name=f"{name}_slide",
        type=mujoco.mjtJoint.mjJNT_SLIDE,
        axis=[0, side, 0],
        range=[0, travel],
        armature=0.1,
        damping=[_FINGER_DAMPING, 0, 0],
    )
    for label, shape in zip(("pad", "bar"), finger(side, fingers, tool), strict=True):
        _geom(body, shape, f"{name}_{label}", FINGER_MASS / 2)


def _add_shapes(body: Any, shapes: tuple[LinkShape, ...], mass: float) -> None:
    colliding = sum(shape.collides for shape in shapes)
    for number, shape in enumerate(shapes, 1):
        _geom(body, shape, f"{body.name}_{number}", mass / colliding if shape.collides else 0.0)


def _geom(body: Any, shape: LinkShape, name: str, mass: float) -> None:
    import mujoco

    bits = ARM_BIT if shape.collides else 0
    geom = body.add_geom(
        name=name,
        type=getattr(mujoco.mjtGeom, f"mjGEOM_{shape.kind.upper()}"),
        rgba=list(shape.color),
        group=VISUAL_GROUP if shape.color[3] else COLLISION_GROUP,
        contype=bits,
        conaffinity=bits | (WORLD_BIT if bits else 0),
        mass=mass,
    )
    a, b = [v / 1000 for v in shape.a], [v / 1000 for v in shape.b]
    if shape.kind in ("capsule", "cylinder"):
        geom.fromto = [*a, *b]
        geom.size = [shape.radius / 1000, 0, 0]
    else:
        geom.pos, geom.size = a, b
