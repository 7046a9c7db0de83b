"""Pictures of a bench, live or planned: in perspective by ray casting, or drawn from above. No OpenGL."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pico.diagnostics import PicoError, error
from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.motion.types import Joints
from pico.twin.placement import Placement, upright

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    from pico.twin.perspective import Beam
    from pico.twin.viewpoint import Viewpoint

    Image = NDArray[np.uint8]

View = Literal["perspective", "top"]
Place = Pose | Placement

_AZIMUTH, _ELEVATION, _FIELD = -80.0, 30.0, 24.0
_STOPS = ("detector", "block", "mirror")


def render(
    setup: Setup,
    poses: Mapping[str, Place],
    joints: Mapping[str, Joints],
    *,
    view: View = "perspective",
    width: int = 960,
    height: int = 720,
    ghosts: Mapping[str, Pose] | None = None,
    labels: bool = True,
    beams: bool = True,
) -> Image:
    """Return a picture (height, width, 3) of the bench, sRGB.

    `poses`: where components stand, by name; a `Placement` where one does not stand on its base; names that are
    missing are not drawn. `joints`: of each robot [rad], parked where missing. `ghosts`: where components are to go,
    drawn dashed in the view from above. `beams`: draw the light of sources up to what stops it.
    """
    if view == "top":
        from pico.twin.topview import draw

        return draw(setup, poses, joints, width=width, height=height, ghosts=ghosts or {}, labels=labels, beams=beams)
    return _perspective(setup, poses, joints, width, height, labels, beams)


def write_png(image: Image, path: Path) -> None:
    """Write `image` (h, w, 3), sRGB, as PNG; raises PicoError where the file can't be written."""
    import cv2

    written, content = cv2.imencode(".png", image[:, :, ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 6])
    assert written  # an array of bytes always encodes
    try:
        path.write_bytes(content.tobytes())
    except OSError as exc:
        raise PicoError(error("unwritable", f"cannot write the picture {path}: {exc.strerror}")) from exc


def placed(poses: Mapping[str, Place]) -> dict[str, Placement]:
    """Return placements in space: poses on the table stand upright."""
    return {name: upright(at) if isinstance(at, Pose) else at for name, at in poses.items()}


def _perspective(
    setup: Setup,
    poses: Mapping[str, Place],
    joints: Mapping[str, Joints],
    width: int,
    height: int,
    labels: bool,
    beams: bool,
) -> Image:
    from pico.twin.perspective import Stage, photograph
    from pico.twin.surfaces import surfaces

    places = placed(poses)
    model, data = posed_model(setup, places, joints)
    points = _extent(setup, model, data)
    view = viewpoint(setup, points, width, height)
    light = beam_lines(setup, poses) if beams else ()
    stage = Stage(model, data, surfaces(setup, model, places), light, _middle(setup))
    image = photograph(stage, view)
    if labels:
        from pico.twin.labels import Anchor, label

        tops = {n: (p.position[0], p.position[1], _top(setup, n, p)) for n, p in places.items()}
        label(image, view, [Anchor(name, at) for name, at in sorted(tops.items())])
    return image


def posed_model(
    setup: Setup, places: Mapping[str, Placement], joints: Mapping[str, Joints]
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the scene with everything where it is, ready to be looked at."""
    import math

    import mujoco

    from pico.twin.scene import Thing, build_scene

    things = {name: Thing(setup.type_of(name).geometry, place) for name, place in places.items()}
    model = build_scene(setup, things).compile()
    data = mujoco.MjData(model)
    for name, robot in setup.lab.robots.items():
        if robot.model != "xarm7":
            continue
        angles = joints.get(name) or tuple(math.radians(a) for a in robot.park)
        for number, angle in enumerate(angles, 1):
            data.joint(f"{name}/joint{number}").qpos[0] = angle
        for finger in ("left", "right"):
            data.joint(f"{name}/{finger}_slide").qpos[0] = robot.gripper.stroke / 2000
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return model, data


def viewpoint(setup: Setup, points: Any, width: int, height: int) -> Viewpoint:
    """Return the camera in front of the table that has all of `points` (n, 3) [m] in the picture."""
    from pico.twin.viewpoint import framing

    return framing(points, _AZIMUTH, _ELEVATION, _FIELD, width, height, margin=0.04)


def beam_lines(setup: Setup, poses: Mapping[str, Place]) -> tuple[Beam, ...]:
    """Return the light of each source, straight on at the height of its exit, up to what stops it."""
    import numpy as np

    from pico.twin.perspective import Beam

    found = []
    for name, start, end in beam_paths(setup, poses):
        z = setup.type_of(name).frames.optical[2]
        found.append(Beam(np.array((*start, z)) / 1000, np.array((*end, z)) / 1000))
    return tuple(found)


def beam_paths(
    setup: Setup, poses: Mapping[str, Place]
) -> Sequence[tuple[str, tuple[float, float], tuple[float, float]]]:
    """Return (source, start, end) [mm] of straight beams seen from above, each up to the first detector, block or
    mirror that it meets, or the table's edge."""
    flat = {name: at.pose if isinstance(at, Placement) else at for name, at in poses.items()}
    found = []
    for name, pose in sorted(flat.items()):
        kind = setup.type_of(name)
        if kind.optics.element != "source":
            continue
        start = Pose(*pose.apply(*kind.frames.optical[:2]), pose.yaw)
        length = min([_to_edge(setup, start), *_stops(setup, flat, name, start)])
        found.append((name, (start.x, start.y), start.apply(length, 0.0)))
    return found


def _stops(setup: Setup, poses: Mapping[str, Pose], source: str, axis: Pose) -> list[float]:
    """Distances from the source to the optics that stop its beam [mm]."""
    found = []
    for name, pose in poses.items():
        kind = setup.type_of(name)
        if name == source or kind.optics.element not in _STOPS:
            continue
        aperture = kind.geometry.clear_aperture
        center = aperture.center if aperture else kind.frames.optical
        local = axis.inverse().compose(Pose(*pose.apply(center[0], center[1])))
        if local.x > 0 and abs(local.y) < (aperture.diameter / 2 if aperture else 12.0):
            found.append(local.x)
    return found


def _to_edge(setup: Setup, axis: Pose) -> float:
    ahead = axis.apply(1.0, 0.0)
    ways = [
        ((size if step > 0 else 0.0) - at) / step
        for at, step, size in zip(
            (axis.x, axis.y), (ahead[0] - axis.x, ahead[1] - axis.y), setup.lab.table.size, strict=True
        )
        if abs(step) > 1e-9
    ]
    return max(0.0, min(ways))


def _middle(setup: Setup) -> Any:
    import numpy as np

    return np.array((*(v / 2000 for v in setup.lab.table.size), 0.0))


def _extent(setup: Setup, model: mujoco.MjModel, data: mujoco.MjData) -> Any:
    """Points (n, 3) that enclose table, components and arms."""
    import numpy as np

    width, depth = (v / 1000 for v in setup.lab.table.size)
    corners = [(x, y, z) for x in (0, width) for y in (0, depth) for z in (-0.06, 0.0)]
    visible = (model.geom_bodyid > 0) & (model.geom_group < 4)
    reach = model.geom_rbound[visible, None] * 0.8
    centers = data.geom_xpos[visible]
    return np.vstack([corners, *(centers + reach * np.array(step) for step in ((0, 0, 1), (1, 0, 0), (-1, 0, 0)))])


def _top(setup: Setup, name: str, place: Placement) -> float:
    height = setup.type_of(name).geometry.height
    return place.position[2] + (height if place.tilt < 45 else setup.type_of(name).geometry.footprint.radius) / 1000
