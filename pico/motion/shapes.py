"""What the arm looks like and weighs: capsules, cylinders and boxes in the links' frames, in mm and kg.

The shapes that collide enclose the outline that the vendor publishes, of both makes of the arm (measured in the meshes
of the vendor's ROS package: `tests/motion/outline.py`); rings and caps are only seen. A link's mass is spread over its
colliding shapes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from pico.model.robot import Fingers, Gripper

Point = tuple[float, float, float]
Color = tuple[float, float, float, float]

WHITE: Color = (0.93, 0.94, 0.95, 1.0)
DARK: Color = (0.13, 0.14, 0.16, 1.0)
GREY: Color = (0.55, 0.57, 0.60, 1.0)
BLUE: Color = (0.10, 0.38, 0.66, 1.0)
NONE: Color = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class LinkShape:
    """One shape of a link. A capsule or cylinder runs from `a` to `b` with a radius; a box is centered
    at `a` with the half-lengths `b`."""

    kind: Literal["capsule", "cylinder", "box"]
    a: Point
    b: Point
    radius: float = 0.0
    color: Color = WHITE
    collides: bool = False


def _solid(kind: Literal["capsule", "cylinder", "box"], a: Point, b: Point, radius: float = 0.0) -> LinkShape:
    return LinkShape(kind, a, b, radius, WHITE, True)


def _disc(a: Point, b: Point, radius: float, color: Color = DARK) -> LinkShape:
    return LinkShape("cylinder", a, b, radius, color)


LINKS: tuple[tuple[LinkShape, ...], ...] = (
    (  # base: a plate on the table, a column, and the sockets with their plugs behind it
        _solid("cylinder", (0, 0, 0), (0, 0, 156), 49.1),
        _solid("cylinder", (0, 0, 0), (0, 0, 13), 64),
        LinkShape("box", (-65.5, 0, 32), (27.5, 34, 24), color=DARK, collides=True),
    ),
    (  # shoulder: a stump under a barrel that lies across
        _solid("capsule", (0, 0, -103), (0, -13, 0), 51),
        _solid("capsule", (0, -14.5, 0), (0, 60, 0), 51),
        _disc((0, 0, -112), (0, 0, -106), 51.6),
    ),
    (  # upper arm: beside the barrel, up, and back into the arm's plane to joint 3
        _solid("capsule", (0, -1.5, 75), (0, -105, 69), 58),
        _solid("capsule", (0, -107, 75), (0, -111, 20), 49),
        _solid("capsule", (0, -100, 1), (0, -175, 0), 47),
        _disc((0, -188, 0), (0, -182, 0), 47.6),
    ),
    (  # elbow: from joint 3 forward to a barrel that lies across
        _solid("capsule", (0, 0, -101), (0, 0, -72), 46.5),
        _solid("capsule", (-1, 8.5, -45), (43, 23, -1), 54),
        _solid("capsule", (52.5, 10, 0), (52.5, -54, 0), 46),
        _disc((0, 0, -108), (0, 0, -102), 47),
    ),
    (  # forearm: slants forward beside the barrel, then back into the arm's plane to joint 5
        _solid("capsule", (2, -1, 65), (77.5, -84, 64), 52.5),
        _solid("capsule", (77.5, -80, 56), (77.5, -88, 4.5), 47.5),
        _solid("capsule", (77.5, -85, 0), (77.5, -156, 0), 46.5),
        _disc((77.5, -168, 0), (77.5, -162, 0), 47.1),
    ),
    (  # lower forearm: a bow around the wrist to the barrel of joint 6
        _solid("capsule", (0, 0, -163.5), (0, 8, -145), 49),
        _solid("capsule", (0, 27, -120), (0, 47.5, -81), 43.5),
        _solid("capsule", (0, 52, -64), (0, 54.5, -16), 43),
        _solid("capsule", (0, 55, 0), (0, 17.5, 0), 41),
        _disc((0, 0, -178), (0, 0, -172), 49),
    ),
    (  # wrist: reaches forward to the barrel of joint 7
        _solid("capsule", (5.5, -1, -6), (0, 0, 22.5), 45.5),
        _solid("capsule", (8.5, 0, 19.5), (78, 0, 2.5), 40.5),
        _solid("cylinder", (76, -37.5, 0), (76, 69.5, 0), 40),
        _disc((76, 62, 0), (76, 68, 0), 40.5),
        _disc((0, 0, 67), (0, 0, 68.5), 18, BLUE),
    ),
    (  # flange, and the socket for the tool
        _solid("cylinder", (0, 0, -33.5), (0, 0, 0.5), 39.6),
        LinkShape("box", (0, -46.5, -16.5), (16, 10, 17), color=DARK, collides=True),
        _disc((0, 0, -8), (0, 0, 0.6), 39.8, GREY),
    ),
)
"""Shapes of the base and of links 1 to 7."""

PALM: tuple[LinkShape, ...] = (
    LinkShape("cylinder", (0, 0, 0), (0, 0, 34), 34, DARK, True),
    LinkShape("box", (0, 0, 64), (26, 58, 30), color=NONE, collides=True),
    LinkShape("box", (0, 0, 64), (26, 32, 30), color=WHITE),
    LinkShape("box", (0, 0, 97), (21, 55, 4), color=DARK),
    LinkShape("cylinder", (0, -32, 34), (0, -32, 94), 26, WHITE),
    LinkShape("cylinder", (0, 32, 34), (0, 32, 94), 26, WHITE),
    LinkShape("box", (0, 0, 62), (26.5, 24, 11), color=BLUE),
)
"""Shapes of the gripper's body, z out of the flange; the fingers hang below z = 100."""

_EYE = 10.0  # mm, half of a small camera
_BEHIND = 16.0  # mm, from its lens to its middle


def palm(gripper: Gripper) -> tuple[LinkShape, ...]:
    """Return the shapes of the gripper's body with the cameras beside it, each on an arm that keeps out of their
    sight."""
    return PALM + tuple(shape for eye in gripper.eyes for shape in _camera(eye, gripper.tool))


def _camera(eye: Point, tool: float) -> tuple[LinkShape, ...]:
    x, y, z = eye[0], eye[1], eye[2] + tool
    out = math.hypot(x, y)
    if out < _BEHIND:  # within the gripper's body
        return ()
    far = (out + _BEHIND) / out
    head = LinkShape("box", (x * far, y * far, z), (_EYE, _EYE, _EYE), color=DARK, collides=True)
    top = z - _EYE - 4
    return head, LinkShape("capsule", (0, 0, top), (x * far, y * far, top), 4, GREY, True)


PALM_LENGTH = 100.0
"""How far the gripper's body reaches from the flange [mm]; the fingers hang below it."""
PAD_HEIGHT = 45.0
"""Height of the pads [mm], from the tips of the fingers up."""
_RECESS = 2.0  # mm, how far the bar of a finger is set back, so that only the pad meets the part


def finger(side: int, fingers: Fingers, tool: float) -> tuple[LinkShape, LinkShape]:
    """Return the pad and the bar of a finger in the gripper's frame, the gripper shut: a bar from the palm to below the
    tool center point `tool` mm from the flange, its inner face the pad. `side` is 1 or -1; it opens along y."""
    tip = tool + fingers.tip
    pad_top = tip - PAD_HEIGHT
    pad, bar = (
        LinkShape(
            "box",
            (0.0, side * (fingers.thickness + recess) / 2, (low + high) / 2),
            (fingers.breadth / 2, (fingers.thickness - recess) / 2, (high - low) / 2),
            color=color,
            collides=True,
        )
        for low, high, recess, color in ((pad_top, tip, 0.0, DARK), (PALM_LENGTH, pad_top, _RECESS, GREY))
    )
    return pad, bar


def cup(tool: float) -> LinkShape:
    """Return the suction cup of a vacuum gripper; it ends 1 mm above what it holds."""
    return LinkShape("cylinder", (0, 0, PALM_LENGTH), (0, 0, tool - 1), 14, DARK, True)


LINK_MASSES = (2.1, 2.0, 1.9, 1.6, 1.6, 1.2, 1.1, 0.4)
"""Of the base and links 1 to 7 [kg]; about 12 kg in all, spread by the links' sizes."""
PALM_MASS = 0.62
FINGER_MASS = 0.09
"""Of one finger with its pad [kg]."""
