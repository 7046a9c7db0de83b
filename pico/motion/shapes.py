"""What the arm looks like and weighs: capsules, cylinders, ellipsoids and boxes in the links' frames, in mm and kg.

Drawn after the real arm's outline. Shapes that collide round off the white ones; caps and rings are only seen. A link's
mass is spread over its colliding shapes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from pico.model.lab import Fingers, Gripper

Point = tuple[float, float, float]
Color = tuple[float, float, float, float]

WHITE: Color = (0.93, 0.94, 0.95, 1.0)
DARK: Color = (0.13, 0.14, 0.16, 1.0)
GREY: Color = (0.55, 0.57, 0.60, 1.0)
BLUE: Color = (0.10, 0.38, 0.66, 1.0)
NONE: Color = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class LinkShape:
    """One shape of a link. A capsule or cylinder runs from `a` to `b` with a radius; a box or ellipsoid is centered
    at `a` with the half-lengths `b`."""

    kind: Literal["capsule", "cylinder", "box", "ellipsoid"]
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
    (  # base: a plate on the table and the housing of joint 1
        _solid("cylinder", (0, 0, 0), (0, 0, 186), 60),
        _disc((0, 0, 0), (0, 0, 12), 68, GREY),
        _disc((0, 0, 186), (0, 0, 191), 57),
        LinkShape("box", (-58, 0, 45), (9, 30, 24), color=DARK),
    ),
    (  # shoulder: a stump under a barrel that lies across
        _solid("capsule", (0, 0, -20), (0, 0, 0), 58),
        _disc((0, 0, -76), (0, 0, -18), 58.6, WHITE),
        _solid("capsule", (0, -22, 0), (0, 22, 0), 58),
        _disc((0, -81, 0), (0, -60, 0), 38),
        _disc((0, 60, 0), (0, 81, 0), 38),
    ),
    (  # upper arm: from the barrel straight up to joint 3
        _solid("capsule", (0, 0, 0), (0, -190, 0), 51),
        LinkShape("ellipsoid", (0, -30, 0), (55, 62, 57), color=WHITE),
        _disc((0, -228, 0), (0, -234, 0), 49),
        _disc((0, -228, 0), (0, -150, 0), 51.6, WHITE),
    ),
    (  # elbow: the stump of joint 3, and a barrel set forward of it
        _solid("capsule", (0, 0, -10), (20, 0, 0), 50),
        _disc((0, 0, -58), (0, 0, -8), 50.6, WHITE),
        _solid("capsule", (52.5, -24, 0), (52.5, 24, 0), 50),
        _disc((52.5, -75, 0), (52.5, -58, 0), 33),
        _disc((52.5, 58, 0), (52.5, 75, 0), 33),
        _disc((0, 0, 46), (0, 0, 52), 20, BLUE),
    ),
    (  # forearm: slants forward, then runs straight towards the wrist
        _solid("capsule", (0, 0, 0), (77.5, -95, 0), 45),
        _solid("capsule", (77.5, -95, 0), (77.5, -205, 0), 44),
        _disc((77.5, -205, 0), (77.5, -243, 0), 44.6, WHITE),
        _disc((77.5, -243, 0), (77.5, -249, 0), 42),
    ),
    (  # lower forearm: tapers to the barrel of joint 6
        _solid("capsule", (0, 0, -50), (0, 0, 0), 40),
        _disc((0, 0, -93), (0, 0, -45), 40.6, WHITE),
        _solid("capsule", (0, -18, 0), (0, 18, 0), 42),
        _disc((0, -64, 0), (0, -52, 0), 27),
        _disc((0, 52, 0), (0, 64, 0), 27),
    ),
    (  # wrist: reaches forward to the housing of joint 7
        _solid("capsule", (0, 0, 0), (76, 10, 0), 37),
        _solid("capsule", (76, 10, 0), (76, 38, 0), 37.5),
        _disc((76, 30, 0), (76, 72, 0), 38, WHITE),
        _disc((76, 72, 0), (76, 76, 0), 35),
        _disc((76, -32, 0), (76, -26, 0), 18, BLUE),
    ),
    (  # flange
        _solid("cylinder", (0, 0, -20), (0, 0, 0), 36),
        _disc((0, 0, -8), (0, 0, 0), 36.5, GREY),
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
