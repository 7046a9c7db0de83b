"""Pictures of a bench, live or planned: in perspective by ray casting, or drawn from above. No OpenGL."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pico.disk import write_whole
from pico.drawing.beams import Place, beam_paths
from pico.model.body import Body
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion.engine import require_mujoco
from pico.motion.kinematics import tool_pose
from pico.motion.types import Joints
from pico.optics.axis import Values, shift
from pico.twin.placement import Placement, upright

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.conflict_marks import Mark
    from pico.drawing.dimensions import Dimension
    from pico.drawing.label_places import Box
    from pico.drawing.perspective import Beam
    from pico.drawing.steps import DrawnStep
    from pico.drawing.viewpoint import Viewpoint

    Image = NDArray[np.uint8]

View = Literal["perspective", "top"]

WIDTH = 960
"""Pixels."""
_IN_HAND = 8.0
"""A part whose grasp is nearer to the tool center point than this is drawn as held [mm]."""


def render(
    setup: Setup,
    poses: Mapping[str, Place],
    joints: Mapping[str, Joints],
    *,
    view: View = "perspective",
    width: int = WIDTH,
    height: int | None = None,
    ghosts: Mapping[str, Pose] | None = None,
    labels: bool = True,
    beams: bool = True,
    marks: Sequence[Mark] = (),
    steps: Sequence[DrawnStep] = (),
    dimensions: Sequence[Dimension] = (),
    red: Sequence[Sequence[tuple[float, float]]] = (),
    values: Values | None = None,
) -> Image:
    """Return a picture (height, width, 3) of the bench, sRGB; without a `height` as high as what is in it.

    `poses`: where components stand, by name; a `Placement` where one does not stand on its base; names that are
    missing are not drawn. `joints`: of each robot [rad], parked where missing. `beams`: draw the light of sources up to
    what stops it; with `values`, as those say: mirrors tipped, nothing of a laser that is off. In the view from above
    only: `ghosts`, where components are to go, dashed; `marks`, what is in whose way, red; `steps`, what is moved
    where, numbered, with a list below that makes the picture higher; `dimensions`, lengths; `red`, beams that
    are not safe.
    """
    if view == "top":
        from pico.drawing.topview import draw

        return draw(
            setup, poses, joints, width=width, height=height, ghosts=ghosts or {}, labels=labels, beams=beams,
            values=values, marks=marks, steps=steps, dimensions=dimensions, red=red,
        )  # fmt: skip
    light = glow(setup, poses, values=values) if beams else ()
    return _perspective(carried(setup, values or {}), poses, joints, width, height, labels, light)


def carried(setup: Setup, values: Values) -> Setup:
    """Return a bench on which what rides on stages is where these carry it: such a component has a type of its own."""
    inventory, catalog = dict(setup.lab.inventory), dict(setup.catalog)
    for name, part in setup.lab.inventory.items():
        kind = setup.type_of(name)
        if not any(body.rides for body in kind.geometry.bodies):
            continue
        moved = {key: shift(kind, values.get(name, {}), key) for key in ("stage_x", "stage_y", "stage_z")}
        bodies = tuple(_moved(body, moved) for body in kind.geometry.bodies)
        catalog[f"{part.type}/{name}"] = replace(kind, geometry=replace(kind.geometry, bodies=bodies))
        inventory[name] = replace(part, type=f"{part.type}/{name}")
    return replace(setup, lab=replace(setup.lab, inventory=inventory), catalog=catalog)


def _moved(body: Body, stages: Mapping[str, float]) -> Body:
    by = [stages[key] if body.rides == key else 0.0 for key in ("stage_x", "stage_y", "stage_z")]
    return replace(body, at=(body.at[0] + by[0], body.at[1] + by[1], body.at[2] + by[2]))


def png(image: Image) -> bytes:
    """Return `image` (h, w, 3), sRGB, as a PNG file."""
    import cv2

    written, content = cv2.imencode(".png", image[:, :, ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 6])
    assert written  # an array of bytes always encodes
    return bytes(content.tobytes())


def write_png(image: Image, path: Path) -> None:
    """Write `image` (h, w, 3), sRGB, as PNG; raises PicoError where the file can't be written."""
    write_whole(path, png(image))


def placed(poses: Mapping[str, Place]) -> dict[str, Placement]:
    """Return placements in space: poses on the table stand upright."""
    return {name: upright(at) if isinstance(at, Pose) else at for name, at in poses.items()}


def _perspective(
    setup: Setup,
    poses: Mapping[str, Place],
    joints: Mapping[str, Joints],
    width: int,
    height: int | None,
    labels: bool,
    light: tuple[Beam, ...],
) -> Image:
    from pico.drawing.perspective import Stage, photograph
    from pico.drawing.standpoint import standpoint
    from pico.twin.surfaces import surfaces

    places = placed(poses)
    model, data = posed_model(setup, places, joints)
    points = scene_extent(setup, model, data)
    view = standpoint(model, data, places, points, width, height)
    stage = Stage(model, data, surfaces(setup, model, places), light, center_of(setup))
    image = photograph(stage, view)
    if labels:
        from pico.drawing.camera_marks import mark_cameras
        from pico.drawing.labels import Anchor, engrave, label

        tops = {n: (p.position[0], p.position[1], top_of(setup, n, p)) for n, p in places.items()}
        anchors = [Anchor(name, at) for name, at in sorted(tops.items())]
        mark_cameras(image, view, setup, model, data)
        taken = shadows(view, model, data)
        named = label(image, view, anchors, taken)
        slots = sorted(setup.lab.slots.items())
        plates = [Anchor(name.rpartition("/")[2], (s.x / 1000, s.y / 1000, 0.0)) for name, s in slots]
        eyes = [(n, c.position) for n, c in sorted(setup.lab.cameras.items()) if c.robot is None]
        plates += [Anchor(name, (x / 1000, (y - 40) / 1000, 0.0)) for name, (x, y, _) in eyes]
        engrave(image, view, plates, [*(box for _, box in taken), *named.values()])
    return image


def shadows(view: Viewpoint, model: mujoco.MjModel, data: mujoco.MjData) -> list[tuple[str, Box]]:
    """Return the boxes [pixels] in which each shape of components and arms is seen, with the body that it is of."""
    import numpy as np

    boxes = []
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    for geom in np.flatnonzero((model.geom_bodyid > 0) & (model.geom_group < 4)):
        center, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        points = data.geom_xpos[geom] + (center + corners * half) @ data.geom_xmat[geom].reshape(3, 3).T
        u, v, _ = view.project(points).T
        body = model.body(int(model.body_rootid[model.geom_bodyid[geom]])).name
        boxes.append((body, (float(u.min()), float(v.min()), float(u.max()), float(v.max()))))
    return boxes


def posed_model(
    setup: Setup, places: Mapping[str, Placement], joints: Mapping[str, Joints]
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the scene with everything where it is, ready to be looked at."""
    model, data = model_of(setup, places)
    pose_model(setup, model, data, places, joints)
    return model, data


def model_of(setup: Setup, places: Mapping[str, Placement]) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the scene with the components at `places`, arms stretched out."""
    require_mujoco()
    import mujoco

    from pico.twin.scene import SceneBody, build_scene

    things = {name: SceneBody(setup.type_of(name).geometry, place) for name, place in places.items()}
    scene = build_scene(setup, things)
    _add_feet(scene, setup)
    model = scene.compile()
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)  # else what is not free stays where it was at first
    return model, mujoco.MjData(model)


def _add_feet(scene: mujoco.MjSpec, setup: Setup) -> None:
    """Let the table stand on four feet; nothing meets them."""
    import mujoco

    from pico.drawing.perspective import FLOOR, FOOT
    from pico.twin.scene import OPAQUE_GROUP

    width, depth = (v / 1000 for v in setup.lab.table.size)
    for x in (0.12, width - 0.12):
        for y in (0.12, depth - 0.12):
            scene.worldbody.add_geom(
                type=mujoco.mjtGeom.mjGEOM_CYLINDER, pos=[x, y, FLOOR + FOOT / 2], size=[0.055, FOOT / 2, 0],
                rgba=[0.16, 0.17, 0.19, 1], contype=0, conaffinity=0, group=OPAQUE_GROUP,
            )  # fmt: skip


def pose_model(
    setup: Setup,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    places: Mapping[str, Placement],
    joints: Mapping[str, Joints],
) -> None:
    """Bring the components of a scene to `places`, and its arms to `joints`, parked where missing."""
    import math

    import mujoco

    for name, place in places.items():
        body = model.body(name)
        body.pos, body.quat = place.position, place.quaternion
    for name, robot in setup.lab.robots.items():
        if robot.model != "xarm7":
            continue
        angles = joints.get(name) or tuple(math.radians(a) for a in robot.park)
        for number, angle in enumerate(angles, 1):
            data.joint(f"{name}/joint{number}").qpos[0] = angle
        if robot.gripper.fingers != "none":
            opening = _opening(setup, robot, angles, places)
            for finger in ("left", "right"):
                data.joint(f"{name}/{finger}_slide").qpos[0] = opening / 2000
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)


def _opening(setup: Setup, robot: Robot, joints: Joints, places: Mapping[str, Placement]) -> float:
    """How far a gripper is open [mm]: closed on the part that it holds, or else all the way."""
    x, y, z, _ = tool_pose(robot, joints)
    for name, place in places.items():
        grasp = setup.type_of(name).geometry.grasp
        if grasp is None or place.pose.distance(Pose(x, y)) > _IN_HAND:
            continue
        if abs(place.position[2] * 1000 + grasp.height - z) < _IN_HAND:
            return grasp.width
    return robot.gripper.stroke


def glow(
    setup: Setup, lit: Mapping[str, Place], poses: Mapping[str, Place] | None = None, *, values: Values | None = None
) -> tuple[Beam, ...]:
    """Return the light of each source among `lit`, up to what stops it among `poses`."""
    import numpy as np

    from pico.drawing.perspective import Beam

    paths = beam_paths(setup, lit if poses is None else poses, values)
    return tuple(Beam(np.array(start) / 1000, np.array(end) / 1000) for name, start, end in paths if name in lit)


def center_of(setup: Setup) -> Any:
    """Return the middle of the table (3,) [m]."""
    import numpy as np

    return np.array((*(v / 2000 for v in setup.lab.table.size), 0.0))


def scene_extent(setup: Setup, model: mujoco.MjModel, data: mujoco.MjData) -> Any:
    """Return points (n, 3) [m] that enclose table, components and arms."""
    import numpy as np

    from pico.drawing.perspective import FLOOR

    width, depth = (v / 1000 for v in setup.lab.table.size)
    corners = [(x, y, z) for x in (0, width) for y in (0, depth) for z in (FLOOR, 0.0)]
    visible = (model.geom_bodyid > 0) & (model.geom_group < 4)
    reach = model.geom_rbound[visible, None] * 0.8
    centers = data.geom_xpos[visible]
    return np.vstack([corners, *(centers + reach * np.array(step) for step in ((0, 0, 1), (1, 0, 0), (-1, 0, 0)))])


def top_of(setup: Setup, name: str, place: Placement) -> float:
    """Return the height of a component's highest point [m]."""
    height = setup.type_of(name).geometry.height
    return place.position[2] + (height if place.tilt < 45 else setup.type_of(name).geometry.footprint.radius) / 1000
