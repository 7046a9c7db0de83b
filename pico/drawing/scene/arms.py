"""Arms as chains of links with simple shapes, so that who draws them can turn the joints. Lengths in mm."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

from pico.model.robot import Robot
from pico.motion.kinematics import reaches
from pico.motion.shapes import LINKS, PALM, LinkShape, cup, finger, palm
from pico.motion.xarm7 import LIMITS, ORIGINS, ROLLS

Link = dict[str, Any]
_LOW = 40.0  # mm, about where parts are held above the table
_FAR, _STEP = 1000, 5  # mm


@cache
def reach_of(robot: Robot) -> tuple[float, float] | None:
    """Return between which distances from its base's axis an arm reaches down to parts on the table [mm]; None for a
    gantry, which comes everywhere."""
    if robot.model == "gantry":
        return None
    x, y = robot.mount.x, robot.mount.y
    within = [r for r in range(0, _FAR, _STEP) if reaches(robot, x + r, y, _LOW)]
    return (float(within[0]), float(within[-1])) if within else (0.0, 0.0)


def links_of(robot: Robot) -> list[Link]:
    """Return the links of an arm from its mount on, each in the frame of the one before it (`parent`, None: the mount).

    A link's frame is at `origin`, turned by `quaternion` (w, x, y, z), and then driven: `drive` is the number of the
    joint whose value turns it about `axis`, or shifts it along that by `factor` mm for 1; `width` is the distance
    between the pads; None stands still.
    """
    return _gantry(robot) if robot.model == "gantry" else [*_xarm7(), *_hand(robot)]


def _xarm7() -> list[Link]:
    chain = [_link("base", None, shapes=LINKS[0])]
    for index, (origin, roll) in enumerate(zip(ORIGINS, ROLLS, strict=True)):
        half = math.radians(roll) / 2
        link = _link(f"link{index + 1}", index, origin, (math.cos(half), math.sin(half), 0.0, 0.0), LINKS[index + 1])
        chain.append(link | {"drive": index, "kind": "turns", "axis": [0, 0, 1], "range": list(LIMITS[index])})
    return chain


def _hand(robot: Robot) -> list[Link]:
    gripper = robot.gripper
    half_a_turn = (0.0, 0.0, 0.0, 1.0)
    if gripper.fingers == "none":
        return [_link("gripper", 7, turned=half_a_turn, shapes=(*palm(gripper), cup(gripper.tool)))]
    return [_link("gripper", 7, turned=half_a_turn, shapes=palm(gripper)), *(
        _link(name, 8, shapes=finger(side, gripper.fingers, gripper.tool))
        | {"drive": "width", "kind": "slides", "axis": [0, side, 0], "factor": 0.5}
        for name, side in (("left_finger", 1), ("right_finger", -1))
    )]  # fmt: skip


def _gantry(robot: Robot) -> list[Link]:
    """The tool of a gantry, which stands over the table: x, y, z [m], and its yaw [rad]."""
    slides = [
        _link(f"axis{n + 1}", n - 1 if n else None)
        | {"drive": n, "kind": "slides", "axis": [int(n == a) for a in range(3)], "factor": 1000.0}
        for n in range(3)
    ]
    tool = robot.gripper.tool
    down = _link("gripper", 3, (0.0, 0.0, tool), (0.0, 1.0, 0.0, 0.0), (*PALM, cup(tool)))
    yaw = _link("axis4", 2) | {"drive": 3, "kind": "turns", "axis": [0, 0, 1]}
    return [*slides, yaw, down]


def _link(
    name: str, parent: int | None, origin: tuple[float, ...] = (0.0, 0.0, 0.0),
    turned: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0), shapes: tuple[LinkShape, ...] = (),
) -> Link:  # fmt: skip
    seen = [_shape(shape) for shape in shapes if shape.color[3]]
    return {
        "name": name, "parent": parent, "origin": list(origin), "quaternion": list(turned), "drive": None,
        "shapes": seen,
    }  # fmt: skip


def _shape(shape: LinkShape) -> dict[str, Any]:
    """A capsule or cylinder from `a` to `b` with a `radius`; a box at `a`, of the whole `size` along x, y, z."""
    if shape.kind == "box":
        return {"shape": "box", "at": list(shape.a), "size": [2 * v for v in shape.b], "color": list(shape.color)}
    return {
        "shape": shape.kind, "a": list(shape.a), "b": list(shape.b), "radius": shape.radius, "color": list(shape.color),
    }  # fmt: skip
