"""The bench as a MuJoCo scene: table, components, arms. Metres and kilograms; origin at the table's front-left corner.

Bodies are named as the components (`p1`), their geoms `<component>/<part of the housing>`; the top of the table is the
geom `table` at z = 0. Arms come with their names as prefix (`arm1/tcp`), see `pico.motion.arm`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.geometry.mass import bodies_of, masses
from pico.model.body import Body
from pico.model.catalog import Geometry
from pico.model.setup import Setup
from pico.motion.engine import require_mujoco
from pico.twin.arms import TwinArm
from pico.twin.placement import Placement
from pico.vision.arm import NOMINAL

if TYPE_CHECKING:
    import mujoco

TIMESTEP = 0.002
"""Step of the simulation [s]."""
TABLE_THICKNESS = 0.06
"""Thickness of the table's top [m]."""
OPAQUE_GROUP = 1
CLEAR_GROUP = 0
"""Geom groups of components: what hides what is behind it, and what light passes."""
PART_FRICTION = 0.6
"""Sliding friction coefficient of a base on the table."""

_HARD = (0.005, 1.0)  # s, time constant of contacts; softer ones let a part sink by 0.1 mm
_FIRM = (0.95, 0.99, 0.001, 0.5, 2.0)
_GRIPPY = (0.9, 0.95, 0.001, 0.5, 2.0)
_STEEL = (0.66, 0.68, 0.70, 1.0)


@dataclass(frozen=True, slots=True)
class SceneBody:
    """Something on the table: its shape, where it is, and whether it is free to move."""

    geometry: Geometry
    placement: Placement
    free: bool = False


def build_scene(
    setup: Setup,
    things: Mapping[str, SceneBody],
    *,
    pad_friction: float | None = None,
    arms: Mapping[str, TwinArm] | None = None,
) -> mujoco.MjSpec:
    """Return the scene of a bench with `things` by name on its table and every arm at its mount, joints at zero.

    `pad_friction`: sliding friction coefficient of the fingers' pads; the lab's where None. `arms`: as they are built;
    as the lab says where they are left out.
    """
    require_mujoco()
    import mujoco

    spec = mujoco.MjSpec()
    spec.modelname = setup.lab.name
    _set_options(spec)
    _add_table(spec, setup)
    for name, thing in sorted(things.items()):
        _add_thing(spec, name, thing)
    _add_arms(spec, setup, setup.lab.sim.pad_friction if pad_friction is None else pad_friction, arms or {})
    return spec


def lull(model: mujoco.MjModel, things: Mapping[str, SceneBody]) -> None:
    """Let every component begin asleep that stands on the table and touches nothing that is awake.

    MuJoCo warns of what is to begin asleep and cannot: on the terminal, and in a file where the command was started.
    """
    import mujoco

    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    touching = model.body_treeid[model.geom_bodyid[data.contact.geom]]
    asleep = {int(model.body_treeid[model.body(name).id]) for name, thing in things.items() if _rests(thing)}
    while awake := {int(t) for pair in touching for t in pair if t in asleep and set(pair) - asleep - {-1}}:
        asleep -= awake
    model.tree_sleep_policy[list(asleep)] = mujoco.mjtSleepPolicy.mjSLEEP_INIT


def _rests(thing: SceneBody) -> bool:
    return thing.free and abs(thing.placement.position[2]) < 1e-6 and thing.placement.tilt < 1e-3


def _set_options(spec: Any) -> None:
    import mujoco

    option = spec.option
    option.timestep = TIMESTEP
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC  # pyramids creep in the hand
    option.impratio = 10
    option.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP  # what rests costs nothing
    spec.compiler.degree = False


def _add_table(spec: Any, setup: Setup) -> None:
    import mujoco

    from pico.motion.arm import ARM_BIT, WORLD_BIT

    width, depth = (v / 1000 for v in setup.lab.table.size)
    spec.worldbody.add_geom(
        name="table",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[width / 2, depth / 2, -TABLE_THICKNESS / 2],
        size=[width / 2, depth / 2, TABLE_THICKNESS / 2],
        contype=WORLD_BIT,
        conaffinity=WORLD_BIT | ARM_BIT,
        condim=4,
        friction=[PART_FRICTION, 0.005, 0.0001],
        solref=list(_HARD),
        solimp=list(_FIRM),
        rgba=list(_STEEL),
        group=OPAQUE_GROUP,
    )


def _add_arms(spec: Any, setup: Setup, friction: float, arms: Mapping[str, TwinArm]) -> None:
    from pico.motion.arm import FINGERS, attach_arm

    for name, robot in sorted(setup.lab.robots.items()):
        if robot.model != "xarm7":
            continue
        attach_arm(spec, name, robot, offsets=arms[name].built if name in arms else NOMINAL)
        for finger in FINGERS:
            pad = spec.geom(f"{name}/{finger}_pad")
            if pad is None:  # a vacuum gripper
                continue
            pad.friction = [friction, 0.005 * min(friction, 1.0), 0.0001]
            pad.condim, pad.priority = 4, 1  # the pad's friction counts, not the greater of the two
            pad.solref, pad.solimp = list(_HARD), list(_GRIPPY)


def _add_thing(spec: Any, name: str, thing: SceneBody) -> None:

    body = spec.worldbody.add_body(name=name, pos=list(thing.placement.position), quat=list(thing.placement.quaternion))
    if thing.free:
        body.add_freejoint(name=name)
    shapes = bodies_of(thing.geometry)
    for shape, mass in zip(shapes, masses(thing.geometry, shapes), strict=True):
        _add_shape(spec, body, f"{name}/{shape.name}", shape, mass)


def _add_shape(spec: Any, body: Any, name: str, shape: Body, mass: float) -> None:
    import mujoco

    from pico.motion.arm import ARM_BIT, WORLD_BIT

    geom = body.add_geom(
        name=name,
        pos=[v / 1000 for v in shape.at],
        quat=list(orientation(shape)),
        mass=mass,
        rgba=list(shape.color),
        group=OPAQUE_GROUP if shape.color[3] >= 1.0 else CLEAR_GROUP,
        contype=WORLD_BIT,
        conaffinity=WORLD_BIT | ARM_BIT,
        condim=4,
        friction=[PART_FRICTION, 0.005, 0.0001],
        solref=list(_HARD),
        solimp=list(_FIRM),
    )
    if shape.shape == "box":
        geom.type, geom.size = mujoco.mjtGeom.mjGEOM_BOX, [v / 2000 for v in shape.size]
    else:
        geom.type = mujoco.mjtGeom.mjGEOM_CYLINDER
        geom.size = [shape.size[0] / 2000, shape.size[1] / 2000, 0]


def orientation(shape: Body) -> tuple[float, float, float, float]:
    """Return the quaternion (w, x, y, z) of a shape in its component's frame: a cylinder's own z turned onto its axis,
    then its yaw."""
    half, c = math.radians(shape.yaw) / 2, math.sqrt(0.5)
    w, z = math.cos(half), math.sin(half)
    if shape.shape == "box" or shape.axis == "z":
        return w, 0.0, 0.0, z
    if shape.axis == "x":  # a quarter turn about y
        return w * c, -z * c, w * c, z * c
    return w * c, -w * c, -z * c, z * c  # a quarter turn about -x
