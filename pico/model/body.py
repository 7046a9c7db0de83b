"""Shapes of a housing, and a grip with V-grooves: the pads slide along their flanks until the part is in the middle.

Millimetres."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from pico.model.quantities import Angle, Length
from pico.model.record import record

BREADTH = 22.0
"""Breadth of the fingers that the grooves are cut for [mm]: the default of `Fingers`."""


@record
class Body:
    """One shape of the housing, for the twin and for pictures, in the component's frame [mm]: z = 0 is the table.

    `size`: full edge lengths of a `box` along x, y, z; diameter and length of a `cylinder`. `at`: its center.
    `axis`: what a cylinder's length runs along. `rides`: the stage, one of the tunables `stage_x` to `stage_z`, that
    carries it; `at` is where it is when that is at 0. Pictures in perspective show it where it is.
    """

    name: str
    shape: Literal["box", "cylinder"]
    size: tuple[Length, ...]
    at: tuple[Length, Length, Length]
    axis: Literal["x", "y", "z"] = "z"
    yaw: Angle = 0.0
    color: tuple[float, float, float, float] = (0.25, 0.26, 0.28, 1.0)
    rides: Literal["stage_x", "stage_y", "stage_z"] | None = None

    def __post_init__(self) -> None:
        if len(self.size) != (3 if self.shape == "box" else 2):
            raise ValueError("`size` is [x, y, z] of a box, [diameter, length] of a cylinder")


def grooved(grip: Body, width: float) -> tuple[Body, ...]:
    """Return a square block with a groove in each of its four upright faces: a core and four posts at the corners.

    `width` is what is left between two pads whose edges lie on the flanks, which stand at 45 deg to the face. Pads that
    are off the middle by less than the block's edge less `width`, by half, still find the groove. Raises ValueError for
    a grip that is no upright square block, or has no room for a groove.
    """
    if grip.shape != "box" or grip.size[0] != grip.size[1] or grip.yaw % 90:
        raise ValueError("a `v_groove` is cut into a body `grip` that is a box, as wide as it is deep, at yaw 0")
    half, height = grip.size[0] / 2, grip.size[2]
    reach = (width - BREADTH) / 2  # of a post, from its middle to its edge
    middle = half - reach
    if reach <= 0 or middle <= BREADTH / 2:
        raise ValueError(
            f"no V-groove for fingers of {BREADTH:g} mm fits a grip of {2 * half:g} mm held at {width:g} mm: "
            f"`width` is above {BREADTH:g} and below {2 * half:g} mm"
        )
    floor = 2 * (middle - reach / 2)  # the pads' faces do not touch it
    core = replace(grip, name="grip_core", size=(min(floor, width - 1), min(floor, width - 1), height))
    x, y, z = grip.at
    posts = [
        replace(grip, name=f"grip_{n}", size=(reach * 2**0.5, reach * 2**0.5, height), yaw=45.0,
                at=(x + a * middle, y + b * middle, z))
        for n, (a, b) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1)), 1)
    ]  # fmt: skip
    return core, *posts
