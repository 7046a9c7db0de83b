"""A picture as a camera delivers it: gray levels, which part of the sensor they are of, and when they were taken."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Region = tuple[int, int, int, int]
"""A part of a sensor: its upper left pixel (u, v), its width and height [pixels]."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A picture of the camera `camera`, taken at `time` [s].

    `gray` (h, w): uint8, 0 black. `offset`: the pixel (u, v) of the sensor that is `gray[0, 0]`; a pixel of the sensor
    is `offset` plus a pixel of the picture.
    """

    gray: NDArray[np.uint8]
    offset: tuple[int, int]
    camera: str
    time: float

    @property
    def black(self) -> bool:
        """Whether nothing was exposed: a lost frame, a closed shutter, a dark room."""
        return bool(self.gray.size == 0 or self.gray[::7, ::7].mean() < _BLACK)


TRIES = 3
"""Pictures that are asked of a camera before it counts as lost."""


def exposed(take: Callable[[], Frame]) -> Frame:
    """Return what `take` delivers, taken again while it is black; black where it was asked often enough."""
    frame = take()
    for _ in range(TRIES - 1):
        if not frame.black:
            break
        frame = take()
    return frame


_BLACK = 12.0
"""Mean gray level below which a picture shows nothing."""
